#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace airlight::scene {

/// For each triangle the number of its plane, from 0 in the order of the triangles: equal for two of them
/// where the corners of both, as the floats they are, lie in exactly one plane, whichever way they face. A
/// triangle without a plane, its corners in line exactly, has a number of its own.
///
/// The numbers come from arithmetic modulo a prime of 63 bits, without any rounding. Let the unit of length
/// be the least positive float: then all coordinates are integers, and so are the components of a triangle's
/// normal n = (b − a) × (c − a) and of d = n · a. Sums and products of residues are the residues of sums and
/// products. Two triangles are in one plane where their (n, d) are multiples of each other, that is, where
/// all 2 × 2 determinants of the two are 0. A determinant that is 0 is 0 modulo the prime too, so that the
/// residues of (n, d) are multiples of each other as well: unless they are all 0, the same component of n is
/// the first whose residue is not 0, and division by it gives the same quotients. (That component may be
/// preceded by one that is 0 only modulo the prime; it is so for all triangles of the plane.)
///
/// What can go wrong is that the prime happens to divide a number that is not 0. If it divides all components
/// of n, the triangle has a number of its own though it has a plane. If it divides all the determinants,
/// different planes have one number. Neither can happen where these numbers are less than the prime, as with
/// coordinates that are small integers times a power of 2. Elsewhere the chance is about 2^-62 for a
/// triangle, and for a pair: among two million triangles 2^-41 and 2^-21.
std::vector<std::uint32_t> planes_of(const Geometry& geometry);

}  // namespace airlight::scene
