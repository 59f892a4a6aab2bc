#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace airlight::quality {

// ꟻLIP: how different two images look to one who flips between them, from 0, no difference, to 1.
//
// Based on: P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "ꟻLIP: A
// Difference Evaluator for Alternating Images", HPG 2020; P. Andersson, J. Nilsson, P. Shirley,
// T. Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021 (short
// papers). Written from the papers.

/// The mean over pixels of LDR-ꟻLIP, as seen on an sRGB display at 67 pixels per degree.
/// @param x, r linear RGB, size.x · size.y each; multiplied by `exposure` and cut to [0, 1] before
/// @throws scene::Error (bad_file) where the lengths differ or a value is NaN or infinite
double ldr_flip(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size, float exposure);

/// The same of each pixel.
std::vector<float> ldr_flip_map(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size,
                                float exposure);

/// The mean over pixels of HDR-ꟻLIP: of each pixel the largest LDR-ꟻLIP over the exposures of
/// `flip_exposures`, the images tone-mapped by Narkowicz' fit of ACES. NaN where the reference is dark.
/// @param x, r linear RGB, size.x · size.y each
/// @param floor luminance up to which a pixel of r is dark, in the images' unit
/// @throws scene::Error (bad_file) as ldr_flip does
double hdr_flip(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size,
                double floor = 0.0);

/// The same of each pixel; empty where the reference is dark.
std::vector<float> hdr_flip_map(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size,
                                double floor = 0.0);

/// The exposures of HDR-ꟻLIP, as factors: from the one that maps the brightest pixel of the reference to 0.85
/// of white to the one that does so with its median, about a stop apart, two at least. **Deviation:** the
/// median is that of the pixels that are not dark, for where more than half of an image is black there is
/// none of all. None where all are.
std::vector<float> flip_exposures(std::span<const glm::vec3> r, double floor = 0.0);

/// The steps of ꟻLIP, for tests.
namespace flip {

/// Y, X − Y and Y − Z of linear RGB, each of X, Y, Z over its value of white: what YCxCz is made of, without
/// its constant factors, which filters keep.
glm::vec3 opponents(const glm::vec3& rgb);
glm::vec3 rgb_of_opponents(const glm::vec3& opponents);

/// L*a*b*, a* and b* weaker where it is dark (the Hunt effect). @param rgb in [0, 1]
glm::vec3 hunt_lab(const glm::vec3& rgb);

/// |ΔL| + √(Δa² + Δb²). S. Abasi, M. A. Tehran, M. D. Fairchild, 2020.
float hyab(const glm::vec3& a, const glm::vec3& b);

/// Of a distance of colours, from 0 to 1: small ones are spread.
float redistributed(float hyab);

/// One side of a filter's taps, which the other side mirrors: the centre first.
using Taps = std::vector<float>;

/// A part of a contrast sensitivity's filter: a Gaussian in x times the same one in y, whose sums are 1.
struct Gaussian {
  Taps taps;
  float weight;
};

/// Of luminance, red against green, and blue against yellow, whose filter is a sum of two.
struct SpatialFilters {
  Gaussian luminance, red_green;
  Gaussian blue_yellow[2];
};
const SpatialFilters& spatial_filters();

/// Of features, as wide as an edge is seen. Across: `smooth`, whose sum is 1. Along: the first and second
/// derivative, `edge` and `point`, whose positive and negative taps each sum to 1; edge changes its sign on
/// the other side.
struct FeatureFilters {
  Taps smooth, edge, point;
};
const FeatureFilters& feature_filters();

/// Narkowicz' fit of the ACES film curve, cut to [0, 1]. K. Narkowicz, "ACES Filmic Tone Mapping Curve",
/// 2016.
float tone_mapped(float radiance);

/// Of a map that is not empty.
double mean(const std::vector<float>& map);

/// LDR-ꟻLIP of each pixel. @param x, r linear RGB in [0, 1]
std::vector<float> map(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size);

}  // namespace flip

}  // namespace airlight::quality
