#pragma once

#include <span>
#include <string>
#include <vector>

#include "quality/methods.h"

namespace airlight::quality {

/// The rrmse that counts which are automatic are enough for, where nobody says another.
constexpr double k_first_look_error = 0.01;

/// The names of a method's counts that are automatic; none of one that is fitted to a view.
std::vector<std::string> automatic_counts(const VolumeChoice& volume);

/// Of each of several methods its automatic_counts.
using AutomaticCounts = std::vector<std::vector<std::string>>;

/// Gives counts of methods that were automatic as few cells as the scene needs, by the rule of `tune`: the
/// fewest of which an error is found that is not above a limit, by a sample of the truth.
///
/// From the counts that the views ask for, a pixel apart, on, they are halved in turn, each until two samples
/// of the truth no longer both find the error not above the limit. Counts along the light angle, which no
/// view asks for, are doubled first while that helps. Images and truths alone decide, no time does, so the
/// counts are the same in every run.
/// @param volumes fitted to the views
/// @param automatic what of them was automatic before
/// @param views of which up to k_looked_at are looked at
/// @param shadow_map side of a face [texels]
/// @param limit rrmse
/// @throws scene::Error as the methods do
void take_first_looks(gpu::Context& context, const scene::Geometry& geometry,
                      std::span<const scene::View> views, std::vector<VolumeChoice>& volumes,
                      const AutomaticCounts& automatic, int shadow_map, double limit,
                      const Progress& progress);

}  // namespace airlight::quality
