#pragma once

#include <vector>

#include "epipolar/volume.h"

namespace airlight::epipolar {

/// Pictures of a filled shadow volume, as fractions of N_φ (Wyman 2011, Figs. 6 and 7). The grid is bound.
///
/// `grid_before_scan`, `grid_after_scan`: how many bits each view ray of the grid has set; a row for each θ,
/// α to the right; box-averaged where a side were longer than 4096. Before the scan a light ray has one bit,
/// at the first voxel in shadow, where the paper's has one for each voxel that is occupied.
/// `shadowed_samples`: for each pixel, how many samples of its view ray are in shadow before it ends.
///
/// Leaves the grid unscanned.
std::vector<frame::DebugImage> debug_images(ShadowVolume& volume, const frame::FrameInputs& inputs);

/// The half-plane that a view ray lies in: a row for each α, φ to the right, 0 where a voxel is in shadow.
/// The ray's own row is grey.
/// @param direction of the ray, unit length
frame::DebugImage debug_slice(const ShadowVolume& volume, glm::vec3 direction);

}  // namespace airlight::epipolar
