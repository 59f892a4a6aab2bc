#include "app/settings.h"

#include <optional>
#include <utility>

#include "quality/axes.h"
#include "scene/error.h"

namespace airlight::app {

using scene::Error;
using scene::ExitCode;

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
