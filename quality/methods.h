#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "epipolar/volume.h"
#include "frame/methods.h"
#include "media/vsv.h"
#include "reference/reference.h"

namespace airlight::quality {

/// What methods can be told. A method reads those that its registry line lists, and no others.
struct Settings {
  media::VsvIntegral integral = media::VsvIntegral::table;
  media::PhiCells phi_cells = media::PhiCells::growing;
  epipolar::VolumeSettings volume;
  int samples = 512;  ///< of `reference`: uniform steps in φ a view ray that look for changes of visibility
  int steps = 512;    ///< of `reference-march`: shadow rays a view ray
  reference::RayMode rays = reference::RayMode::packet;  ///< of `reference-march`
};

/// One setting as text or number, as results.json shows it.
using Value = std::variant<int, std::string>;

/// One setting that a user can give: as METHOD:name=value, and some as --name too.
struct Key {
  std::string_view name;
  std::string_view meaning;  ///< one line, with the valid values
  /// @throws scene::Error (usage) naming `where` and the valid values
  void (*set)(Settings& settings, const std::string& where, std::string_view value);
  Value (*get)(const Settings& settings);
};

/// @returns the key of that name, which must exist
const Key& key(std::string_view name);

/// Tells how far long work is: what is being done, and the fraction done of it.
using Progress = std::function<void(const std::string& what, double fraction)>;

/// What the reference methods of one view share: the acceleration structure, and each image that is asked for
/// twice.
class SharedReference {
 public:
  /// @param geometry, view kept by reference
  SharedReference(const scene::Geometry& geometry, const scene::View& view, Progress progress);

  /// Builds the acceleration structure, unless it is there, so that no frame is charged for it.
  void prepare();

  const reference::SurfaceImage& surfaces();
  const reference::AirlightImage& converged(int samples);
  reference::AirlightImage march(int steps, reference::RayMode rays);  ///< traced anew each time

  /// What was asked for since the last `take_work`.
  struct Work {
    std::uint64_t airlight_rays = 0;  ///< occlusion rays for airlight
    double airlight_ms = 0.0;         ///< time of tracing those
    double kept_airlight_ms =
        0.0;  ///< the part of `airlight_ms` not spent now, because the image had been kept
    double kept_surface_ms = 0.0;  ///< the same for surfaces
  };
  Work take_work() { return std::exchange(work_, {}); }

 private:
  reference::Progress report(const std::string& what) const;

  const scene::Geometry& geometry_;
  const scene::View& view_;
  Progress progress_;
  std::optional<reference::Reference> reference_;
  std::optional<reference::SurfaceImage> surfaces_;
  double surfaces_ms_ = 0.0;
  std::map<int, reference::AirlightImage> converged_;  ///< by number of samples
  Work work_;
};

/// A method of airlight or of surface shadow: one line of the registry.
template <typename Interface>
struct Method {
  std::string_view name;
  std::string_view description;        ///< one line
  std::vector<std::string_view> keys;  ///< the settings that it reads
  bool is_judged;                      ///< whether --max-error applies: not to the truth, nor to `none`
  std::unique_ptr<Interface> (*make)(const gpu::Context&, SharedReference&, const Settings&);
};

using VolumeMethod = Method<frame::Airlight>;
using SurfaceMethod = Method<frame::SurfaceShadow>;

std::span<const VolumeMethod> volume_methods();
std::span<const SurfaceMethod> surface_methods();

/// A method with its settings, as asked for by METHOD:key=value:key=value.
template <typename MethodType>
struct Choice {
  std::string spec;  ///< as the user wrote it
  const MethodType* method;
  Settings settings;

  /// The settings that the method reads, by key.
  std::map<std::string, Value> values() const {
    std::map<std::string, Value> values;
    for (std::string_view name : method->keys) values[std::string(name)] = key(name).get(settings);
    return values;
  }
};

using VolumeChoice = Choice<VolumeMethod>;
using SurfaceChoice = Choice<SurfaceMethod>;

/// Reads a comma-separated list of specs; their own keys override `common`.
/// @throws scene::Error (usage) for an unknown method, key or value, naming it and the valid ones; for a spec
/// given twice.
std::vector<VolumeChoice> parse_volumes(std::string_view list, const Settings& common);
std::vector<SurfaceChoice> parse_surfaces(std::string_view list, const Settings& common);

/// Fits methods to what they will show: gives the counts of grids that are `auto` their value, and adds a
/// warning to the scene's report where parts that are not watertight are to be voxelized as solids.
/// @throws scene::Error (usage) naming a choice that cannot show what the view asks for, as a light texture
void fit(std::span<VolumeChoice> volumes, std::span<SurfaceChoice> surfaces, const scene::View& view,
         scene::Scene& scene);

}  // namespace airlight::quality
