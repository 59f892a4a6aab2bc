#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "app/options.h"
#include "quality/sweep.h"

namespace airlight::app {

/// Lists of methods and of shadow maps' sizes whose braces stand for several entries: quality::expand_braces.
/// @param list as the user typed it @throws scene::Error (usage)
std::vector<quality::VolumeChoice> expanded_volumes(std::string_view list,
                                                    std::span<const quality::CommonOption> common);
std::vector<quality::SurfaceChoice> expanded_surfaces(std::string_view list,
                                                      std::span<const quality::CommonOption> common);
std::vector<int> expanded_shadow_maps(std::string_view list);

/// Settings worth sweeping of every method of airlight that is judged, without what cannot show the views.
/// @param most of a method @param refused gets how many cannot show the views
/// @throws scene::Error (usage) where none can
std::vector<quality::VolumeChoice> every_volume(const Options& options, const Subject& subject,
                                                std::size_t most, std::size_t& refused);

/// Each with each; a shadow map that neither method reads is no axis.
std::vector<quality::Setting> product(const std::vector<quality::VolumeChoice>& volumes,
                                      const std::vector<quality::SurfaceChoice>& surfaces,
                                      const std::vector<int>& shadow_maps);

}  // namespace airlight::app
