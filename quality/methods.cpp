#include "quality/methods.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "epipolar/surface_lookup.h"
#include "scene/components.h"
#include "scene/error.h"
#include "scene/numbers.h"
#include "surface_shadows/shadow_map_lookup.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;
using scene::parse_count;
using scene::split;

/// Words that stand for the values of an enumeration, in its order.
template <std::size_t n>
using Words = std::array<std::string_view, n>;

std::string join(std::span<const std::string_view> words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

template <std::size_t n>
std::size_t parse_word(const std::string& where, std::string_view value, const Words<n>& words) {
  const auto found = std::find(words.begin(), words.end(), value);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  throw Error(ExitCode::usage, where, fmt::format("'{}' is unknown", value),
              fmt::format("use {}", fmt::join(words, ", ")));
}

constexpr Words<3> k_integrals = {"table", "riemann", "factored"};
constexpr Words<3> k_populates = {"shadow-map", "conservative", "screen-space"};
constexpr Words<3> k_scans = {"fused", "column", "multi-pass"};
constexpr Words<3> k_ranges = {"frame", "alpha-phi", "full"};
constexpr Words<2> k_phi_cells = {"growing", "equal"};
constexpr Words<2> k_theta_cells = {"fitted", "equal"};
constexpr Words<2> k_rays = {"single", "packet"};

constexpr int k_automatic = 0;

/// Reads one count of the grid and checks it with the rules of the grid.
void set_resolution(Settings& settings, const std::string& where, std::string_view value,
                    int epipolar::Resolution::*count) {
  if (value == "auto") {
    settings.volume.resolution.*count = k_automatic;
    return;
  }
  epipolar::Resolution resolution;  // the other counts are good
  resolution.*count = parse_count(where, value);
  try {
    epipolar::validate(resolution);
  } catch (const Error& error) {
    // The grid knows its rule and the option; the spec, where there is one, is known here.
    const std::string_view what = error.what();
    throw Error(ExitCode::usage, where, std::string(what.substr(what.find(": ") + 2)));
  }
  settings.volume.resolution.*count = resolution.*count;
}

Value text_of_count(int count) {
  return count == k_automatic ? Value("auto") : Value(count);
}

/// `given` with what is automatic taken from `automatic`.
epipolar::Resolution resolved(epipolar::Resolution given, const epipolar::Resolution& automatic) {
  for (const auto count :
       {&epipolar::Resolution::alpha, &epipolar::Resolution::theta, &epipolar::Resolution::phi})
    if (given.*count == k_automatic) given.*count = automatic.*count;
  return given;
}

const std::vector<Key>& keys() {
  static const std::vector<Key> keys = {
      {"integral", "how visibility becomes radiance: table (default), riemann or factored",
       [](Settings& settings, const std::string& where, std::string_view value) {
         settings.integral = static_cast<media::VsvIntegral>(parse_word(where, value, k_integrals));
       },
       [](const Settings& settings) -> Value {
         return std::string(k_integrals[static_cast<std::size_t>(settings.integral)]);
       }},
      {"populate",
       "what fills the grid: shadow-map (default), conservative (every voxel that a triangle touches) or "
       "screen-space (the inside of watertight parts)",
       [](Settings& settings, const std::string& where, std::string_view value) {
         settings.volume.populate = static_cast<epipolar::Populate>(parse_word(where, value, k_populates));
       },
       [](const Settings& settings) -> Value {
         return std::string(k_populates[static_cast<std::size_t>(settings.volume.populate)]);
       }},
      {"scan",
       "how shadow is drawn out along light rays: fused (one pass that only writes; default but for "
       "screen-space), column (one pass over set bits) or multi-pass (the paper's)",
       [](Settings& settings, const std::string& where, std::string_view value) {
         settings.volume.scan = static_cast<epipolar::Scan>(parse_word(where, value, k_scans));
       },
       [](const Settings& settings) -> Value {
         return std::string(k_scans[static_cast<std::size_t>(epipolar::scan_of(settings.volume))]);
       }},
      {"ranges",
       "angles that the grid covers: frame (default: what is seen), alpha-phi (the paper's: all theta) or "
       "full",
       [](Settings& settings, const std::string& where, std::string_view value) {
         settings.volume.ranges = static_cast<epipolar::Ranges>(parse_word(where, value, k_ranges));
       },
       [](const Settings& settings) -> Value {
         return std::string(k_ranges[static_cast<std::size_t>(settings.volume.ranges)]);
       }},
      {"phi-cells", "cells of the grid along the light angle: growing (default) or equal (the paper's)",
       [](Settings& settings, const std::string& where, std::string_view value) {
         settings.phi_cells = static_cast<media::PhiCells>(parse_word(where, value, k_phi_cells));
       },
       [](const Settings& settings) -> Value {
         return std::string(k_phi_cells[static_cast<std::size_t>(settings.phi_cells)]);
       }},
      {"theta-cells",
       "half-planes of the grid: fitted (default: denser where they reach farther) or equal (the paper's)",
       [](Settings& settings, const std::string& where, std::string_view value) {
         settings.volume.theta_cells =
             static_cast<epipolar::ThetaCells>(parse_word(where, value, k_theta_cells));
       },
       [](const Settings& settings) -> Value {
         return std::string(k_theta_cells[static_cast<std::size_t>(settings.volume.theta_cells)]);
       }},
      {"alpha", "cells of the grid along the view angle (default 512), or auto: a pixel apart",
       [](Settings& settings, const std::string& where, std::string_view value) {
         set_resolution(settings, where, value, &epipolar::Resolution::alpha);
       },
       [](const Settings& settings) -> Value { return text_of_count(settings.volume.resolution.alpha); }},
      {"theta",
       "half-planes of the grid about the axis from eye to light (default 2048), or auto: a pixel apart",
       [](Settings& settings, const std::string& where, std::string_view value) {
         set_resolution(settings, where, value, &epipolar::Resolution::theta);
       },
       [](const Settings& settings) -> Value { return text_of_count(settings.volume.resolution.theta); }},
      {"phi", "cells of the grid along the light angle, a multiple of 128, or auto (default: 512)",
       [](Settings& settings, const std::string& where, std::string_view value) {
         set_resolution(settings, where, value, &epipolar::Resolution::phi);
       },
       [](const Settings& settings) -> Value { return text_of_count(settings.volume.resolution.phi); }},
      {"samples", "uniform steps in the light angle that look for changes of visibility (default 512)",
       [](Settings& settings, const std::string& where, std::string_view value) {
         settings.samples = parse_count(where, value);
       },
       [](const Settings& settings) -> Value { return settings.samples; }},
      {"steps", "shadow rays a view ray (default 512)",
       [](Settings& settings, const std::string& where, std::string_view value) {
         settings.steps = parse_count(where, value);
       },
       [](const Settings& settings) -> Value { return settings.steps; }},
      {"rays", "how shadow rays are traced: packet (default) or single",
       [](Settings& settings, const std::string& where, std::string_view value) {
         settings.rays = static_cast<reference::RayMode>(parse_word(where, value, k_rays));
       },
       [](const Settings& settings) -> Value {
         return std::string(k_rays[static_cast<std::size_t>(settings.rays)]);
       }},
  };
  return keys;
}

void upload(const std::vector<glm::vec3>& image, const gpu::Texture& texture) {
  std::vector<glm::vec4> rgba;
  rgba.reserve(image.size());
  for (const glm::vec3& value : image) rgba.emplace_back(value, 0.0f);
  texture.write(rgba.data());
}

/// `reference`, presented as a method like the others.
class ConvergedAirlight : public frame::Airlight {
 public:
  ConvergedAirlight(SharedReference& shared, int samples) : shared_(shared), samples_(samples) {
    shared.prepare();
  }
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override {
    inputs.timer.time("integrate", [&] { upload(shared_.converged(samples_).radiance, radiance); });
  }

 private:
  SharedReference& shared_;
  int samples_;
};

/// `reference-march`, presented as a method like the others.
class MarchedAirlight : public frame::Airlight {
 public:
  MarchedAirlight(SharedReference& shared, int steps, reference::RayMode rays)
      : shared_(shared), steps_(steps), rays_(rays) {
    shared.prepare();
  }
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override {
    inputs.timer.time("integrate", [&] { upload(shared_.march(steps_, rays_).radiance, radiance); });
  }

 private:
  SharedReference& shared_;
  int steps_;
  reference::RayMode rays_;
};

/// `reference` for surfaces. A pixel whose surface the G-buffer sees and the rays miss, at an edge, is dark.
class TracedShadow : public frame::SurfaceShadow {
 public:
  explicit TracedShadow(SharedReference& shared) : shared_(shared) { shared.prepare(); }
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override {
    inputs.timer.time("surface_query", [&] { visibility.write(shared_.surfaces().visibility.data()); });
  }

 private:
  SharedReference& shared_;
};

template <typename MethodType>
std::vector<Choice<MethodType>> parse_choices(const std::string& option, std::string_view list,
                                              const Settings& common, std::span<const MethodType> methods) {
  std::vector<Choice<MethodType>> choices;
  for (std::string_view spec : split(list, ',')) {
    const std::vector<std::string_view> parts = split(spec, ':');

    const auto method =
        std::find_if(methods.begin(), methods.end(), [&](const MethodType& m) { return m.name == parts[0]; });
    if (method == methods.end()) {
      std::vector<std::string_view> names;
      for (const MethodType& m : methods) names.push_back(m.name);
      throw Error(ExitCode::usage, option, fmt::format("there is no method '{}'", parts[0]),
                  fmt::format("use {}", join(names)));
    }

    Choice<MethodType> choice{std::string(spec), &*method, common};
    for (std::string_view part : std::span(parts).subspan(1)) {
      const std::size_t equals = part.find('=');
      const std::string_view name = part.substr(0, equals);
      const std::string where = fmt::format("{} {}", option, spec);
      if (std::find(method->keys.begin(), method->keys.end(), name) == method->keys.end()) {
        throw Error(ExitCode::usage, where, fmt::format("{} has no key '{}'", method->name, name),
                    method->keys.empty() ? "it has none" : fmt::format("use {}", join(method->keys)));
      }
      if (equals == std::string_view::npos) {
        throw Error(ExitCode::usage, where, fmt::format("the key '{}' has no value", name),
                    fmt::format("write {}=VALUE: {}", name, key(name).meaning));
      }
      key(name).set(choice.settings, fmt::format("{}, {}", where, name), part.substr(equals + 1));
    }

    if (std::any_of(choices.begin(), choices.end(), [&](const auto& c) { return c.spec == spec; })) {
      throw Error(ExitCode::usage, option, fmt::format("{} is there twice", spec), "name each method once");
    }
    choices.push_back(std::move(choice));
  }
  return choices;
}

}  // namespace

const Key& key(std::string_view name) {
  const auto found = std::find_if(keys().begin(), keys().end(), [&](const Key& k) { return k.name == name; });
  assert(found != keys().end());
  return *found;
}

// The registry: a new method is one line here.

std::span<const VolumeMethod> volume_methods() {
  static const std::vector<VolumeMethod> methods = {
      {"none",
       "no airlight",
       {},
       false,
       [](const gpu::Context&, SharedReference&, const Settings&) -> std::unique_ptr<frame::Airlight> {
         return std::make_unique<frame::NoAirlight>();
       }},
      {"vsv",
       "epipolar voxelized shadow volumes",
       {"integral", "populate", "scan", "ranges", "alpha", "theta", "phi", "theta-cells", "phi-cells"},
       true,
       [](const gpu::Context& context, SharedReference&,
          const Settings& s) -> std::unique_ptr<frame::Airlight> {
         return std::make_unique<media::Vsv>(context, s.volume, s.integral, s.phi_cells);
       }},
      {"reference",
       "converged ray tracing on the CPU (Embree): the truth",
       {"samples"},
       false,
       [](const gpu::Context&, SharedReference& shared,
          const Settings& s) -> std::unique_ptr<frame::Airlight> {
         return std::make_unique<ConvergedAirlight>(shared, s.samples);
       }},
      {"reference-march",
       "ray marching with shadow rays on the CPU (Embree)",
       {"steps", "rays"},
       false,
       [](const gpu::Context&, SharedReference& shared,
          const Settings& s) -> std::unique_ptr<frame::Airlight> {
         return std::make_unique<MarchedAirlight>(shared, s.steps, s.rays);
       }},
  };
  return methods;
}

std::span<const SurfaceMethod> surface_methods() {
  static const std::vector<SurfaceMethod> methods = {
      {"none",
       "no shadow: every surface is lit",
       {},
       false,
       [](const gpu::Context&, SharedReference&, const Settings&) -> std::unique_ptr<frame::SurfaceShadow> {
         return std::make_unique<frame::NoShadow>();
       }},
      {"shadow-map",
       "one look-up of the shadow cube a pixel",
       {},
       true,
       [](const gpu::Context&, SharedReference&, const Settings&) -> std::unique_ptr<frame::SurfaceShadow> {
         return std::make_unique<surface_shadows::ShadowMapLookup>();
       }},
      {"vsv",
       "one bit of an epipolar voxelized shadow volume a pixel: to look at the volume",
       {"populate", "scan", "ranges", "alpha", "theta", "phi", "theta-cells"},
       true,
       [](const gpu::Context& context, SharedReference&,
          const Settings& s) -> std::unique_ptr<frame::SurfaceShadow> {
         return std::make_unique<epipolar::SurfaceLookup>(context, s.volume);
       }},
      {"reference",
       "one shadow ray a pixel on the CPU (Embree): the truth",
       {},
       false,
       [](const gpu::Context&, SharedReference& shared, const Settings&)
           -> std::unique_ptr<frame::SurfaceShadow> { return std::make_unique<TracedShadow>(shared); }},
  };
  return methods;
}

namespace {

/// Whether a method has a voxel grid.
bool has_grid(const auto& choice) {
  const auto& keys = choice.method->keys;
  return std::find(keys.begin(), keys.end(), "populate") != keys.end();
}

/// @throws Error (usage) where settings of a grid contradict each other.
void require_sound_grids(const auto& choices) {
  for (const auto& choice : choices) {
    if (!has_grid(choice)) continue;
    epipolar::VolumeSettings volume = choice.settings.volume;
    volume.resolution = resolved(volume.resolution, {});
    epipolar::validate(volume);
  }
}

/// Gives the counts of grids that are automatic their value.
/// @returns whether a grid is filled by the screen-space voxelization
bool fit_grids(auto choices, const scene::View& view) {
  bool fills_solids = false;
  for (auto& choice : choices) {
    if (!has_grid(choice)) continue;
    epipolar::VolumeSettings& volume = choice.settings.volume;
    volume.resolution =
        resolved(volume.resolution, epipolar::pixel_exact(view, volume.ranges, volume.theta_cells));
    fills_solids = fills_solids || volume.populate == epipolar::Populate::screen_space;
  }
  return fills_solids;
}

}  // namespace

std::vector<VolumeChoice> parse_volumes(std::string_view list, const Settings& common) {
  auto choices = parse_choices("--volume", list, common, volume_methods());
  require_sound_grids(choices);
  return choices;
}

std::vector<SurfaceChoice> parse_surfaces(std::string_view list, const Settings& common) {
  auto choices = parse_choices("--surface", list, common, surface_methods());
  require_sound_grids(choices);
  return choices;
}

void fit(std::span<VolumeChoice> volumes, std::span<SurfaceChoice> surfaces, const scene::View& view,
         scene::Scene& scene) {
  for (const VolumeChoice& choice : volumes) {
    if (has_grid(choice)) media::Vsv::require_support(choice.settings.integral, view.lights[0]);
  }
  const bool in_volumes = fit_grids(volumes, view), in_surfaces = fit_grids(surfaces, view);
  if (!in_volumes && !in_surfaces) return;
  const scene::Components components = scene::find_components(scene.geometry);
  if (!components.is_watertight()) {
    scene.report.warnings.push_back(
        "populate=screen-space fills the inside of watertight parts, and will show shadow and light where "
        "there is none: " +
        scene::describe_gaps(components));
  }
}

SharedReference::SharedReference(const scene::Geometry& geometry, const scene::View& view, Progress progress)
    : geometry_(geometry), view_(view), progress_(std::move(progress)) {}

void SharedReference::prepare() {
  if (!reference_) reference_.emplace(geometry_, view_);
}

reference::Progress SharedReference::report(const std::string& what) const {
  if (!progress_) return {};
  return [this, what](double fraction) { progress_(what, fraction); };
}

const reference::SurfaceImage& SharedReference::surfaces() {
  prepare();
  if (surfaces_) {
    work_.kept_surface_ms += surfaces_ms_;
  } else {
    const auto start = std::chrono::steady_clock::now();
    surfaces_ = reference_->surfaces(report("reference, surfaces"));
    surfaces_ms_ =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return *surfaces_;
}

const reference::AirlightImage& SharedReference::converged(int samples) {
  prepare();
  const auto kept = converged_.find(samples);
  const bool is_kept = kept != converged_.end();
  const reference::AirlightImage& image =
      is_kept ? kept->second
              : converged_.emplace(samples, reference_->converged(samples, report("reference, airlight")))
                    .first->second;
  work_.airlight_rays += image.rays;
  work_.airlight_ms += image.ms;
  if (is_kept) work_.kept_airlight_ms += image.ms;
  return image;
}

reference::AirlightImage SharedReference::march(int steps, reference::RayMode rays) {
  prepare();
  reference::AirlightImage image = reference_->march(steps, rays, report("reference-march"));
  work_.airlight_rays += image.rays;
  work_.airlight_ms += image.ms;
  return image;
}

}  // namespace airlight::quality
