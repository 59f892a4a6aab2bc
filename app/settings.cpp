#include "app/settings.h"

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "quality/axes.h"
#include "scene/error.h"
#include "scene/numbers.h"

namespace airlight::app {

using scene::Error;
using scene::ExitCode;

namespace {

std::string expanded(const char* option, std::string_view list) {
  return fmt::format("{}", fmt::join(quality::expand_braces(option, list), ","));
}

}  // namespace

std::vector<quality::VolumeChoice> expanded_volumes(std::string_view list,
                                                    std::span<const quality::CommonOption> common) {
  return quality::parse_volumes(expanded("--volume", list), common);
}

std::vector<quality::SurfaceChoice> expanded_surfaces(std::string_view list,
                                                      std::span<const quality::CommonOption> common) {
  return quality::parse_surfaces(expanded("--surface", list), common);
}

std::vector<int> expanded_shadow_maps(std::string_view list) {
  std::vector<int> sizes;
  for (const std::string& word : quality::expand_braces("--shadow-map", list))
    sizes.push_back(scene::parse_count("--shadow-map", word));
  return sizes;
}

std::vector<quality::VolumeChoice> every_volume(const Options& options, const Subject& subject,
                                                std::size_t most, std::size_t& refused) {
  std::vector<quality::VolumeChoice> volumes;
  for (const quality::VolumeMethod& method : quality::volume_methods()) {
    if (!method.traits.is_judged()) continue;
    for (quality::VolumeChoice& volume :
         quality::settings_worth_sweeping(method, common_method_options(options), most)) {
      quality::VolumeChoice fitted = volume;
      try {
        fitted.fit(subject.views());
        volumes.push_back(std::move(volume));
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  if (volumes.empty()) throw Error(ExitCode::usage, options.command, "no method can show the view");
  return volumes;
}

std::vector<quality::Setting> product(const std::vector<quality::VolumeChoice>& volumes,
                                      const std::vector<quality::SurfaceChoice>& surfaces,
                                      const std::vector<int>& shadow_maps) {
  std::vector<quality::Setting> settings;
  for (const quality::VolumeChoice& volume : volumes)
    for (const quality::SurfaceChoice& surface : surfaces)
      for (const int shadow_map : shadow_maps) {
        const bool is_read = quality::is_read("shadow-map", {&volume, 1}, {&surface, 1});
        settings.push_back({volume, surface, is_read ? std::optional(shadow_map) : std::nullopt});
      }
  return settings;
}

}  // namespace airlight::app
