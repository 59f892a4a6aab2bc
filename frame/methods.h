#pragma once

#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "frame/epipolar_samples.h"
#include "frame/resources.h"
#include "frame/view_rays.h"
#include "gpu/context.h"
#include "gpu/texture.h"
#include "gpu/timer.h"
#include "scene/scene.h"

namespace airlight::frame {

/// What the methods of a frame read, for one of its lights. The blocks of camera, light and medium are bound
/// (shaders/frame/uniforms.glsl).
struct FrameInputs {
  gpu::Context& context;
  const scene::View& view;
  std::size_t light_index;  ///< in view.lights
  const SceneBuffers& scene;
  const gpu::Texture& triangles;  ///< r32ui: number of the triangle seen + 1, 0 for none; of all pixels
  const gpu::Texture& surfaces;   ///< rgba32f: unit normal towards the eye, distance along the unit view ray
                                  ///< [m]; 0 for none
  Resources& resources;
  gpu::StageTimer& timer;
  std::optional<ListedRays> listed = {};  ///< airlight is asked for along these rays, not along the pixels'

  /// Of the rays along which airlight is asked for.
  const gpu::Texture& ray_surfaces() const { return listed ? listed->surfaces : surfaces; }

  /// How many these are. Waits for the GPU where they are listed.
  double ray_count() const {
    return listed ? listed->count() : static_cast<double>(view.size.x) * view.size.y;
  }

  const scene::Light& light() const { return view.lights[light_index]; }
  const scene::Geometry& geometry() const { return resources.geometry(); }

  // What is made when it is first asked for: see Resources.
  /// @param reach of the directions that are looked up, how far they lie beside any from the light to what
  /// the camera may see [rad]; all directions by default. Beyond, the map need not know of occluders.
  /// @returns sampler2DArray: a cube's faces, or one image
  const gpu::Texture& shadow_map(double reach = std::numbers::pi) const {
    return resources.shadow_map(reach, timer);
  }
  /// Whether it is one image on a plane, not a cube.
  bool shadow_map_is_plane() const { return resources.shadow_plane().has_value(); }
  /// rgba32f: what each pixel shades (surface_points.h).
  const gpu::Texture& surface_points() const { return resources.surface_points(triangles, timer); }
  /// r32ui: in which plane each triangle lies.
  const gpu::TexelView& triangle_planes() const { return resources.triangle_planes(timer); }
  const std::vector<std::uint32_t>& triangles_at_light() const { return resources.triangles_at_light(); }
  const gpu::Texture* light_texture() const { return resources.light_texture(); }
  const scene::Components& components() const { return resources.components(timer); }
};

/// A method of surface shadow: one of the two places where a method plugs into the frame.
class SurfaceShadow {
 public:
  virtual ~SurfaceShadow() = default;

  /// Of the image that `query` writes: r32f, or rgba32f of a method whose occluders let colours through. Such
  /// a method then also says what a transparent surface lets through that is seen from the side away from
  /// the light: it glows.
  virtual gpu::Format visibility_format(const SceneBuffers&) const { return gpu::Format::r32f; }

  /// Writes the part of the light that arrives at each surface: 1 where it sees the light, 0 where it does
  /// not. Times its stages, `surface_query` among them.
  /// @param visibility of the image's size; what it holds where no surface is seen does not matter
  virtual void query(const FrameInputs& inputs, const gpu::Texture& visibility) = 0;

  /// Whether it is asked of lights, too, that cannot reach the view (may_reach).
  virtual bool sees_every_light() const { return false; }

  /// Memory of its own on the GPU, by name.
  virtual std::map<std::string, std::int64_t> bytes() const { return {}; }

  /// What the `query` just before, with the same inputs, has cost, whatever the machine, by name, summed over
  /// all pixels. It may cost more itself: the next call is to `query`.
  virtual std::map<std::string, double> counters(const FrameInputs&) { return {}; }
};

/// A picture of what a method holds.
struct DebugImage {
  std::string name;     ///< fit for a file name
  std::string caption;  ///< what is shown, in one line
  glm::ivec2 size{0};
  std::vector<float> values;  ///< fractions of 1, row 0 at the top
};

/// A method of airlight: the other place.
class Airlight {
 public:
  virtual ~Airlight() = default;

  /// Writes the light scattered once towards the eye along each view ray, RGB [W/(m² sr)]. Times its stages.
  /// @param radiance rgba32f, of the size of the image of their surfaces; of listed rays it need be written
  /// where these are
  virtual void integrate(const FrameInputs& inputs, const gpu::Texture& radiance) = 0;

  /// Along which rays `integrate` is asked. Its inputs and its image are then those of a coarse image, or its
  /// inputs list rays.
  virtual ViewRays rays() const { return {}; }

  /// As of a SurfaceShadow.
  virtual bool sees_every_light() const { return false; }

  /// Memory of its own on the GPU, by name.
  virtual std::map<std::string, std::int64_t> bytes() const { return {}; }

  /// As of a SurfaceShadow, summed over the rays that `integrate` was asked of.
  virtual std::map<std::string, double> counters(const FrameInputs&) { return {}; }

  /// Pictures of what `integrate`, called just before with the same inputs, left on the GPU. They may cost
  /// it: the next call is to `integrate`.
  virtual std::vector<DebugImage> debug_images(const FrameInputs&) { return {}; }

  /// A picture of what `integrate` left of its last light along the view ray through a place of the image, in
  /// pixels; none where a method has nothing to show, or the place is none of its own.
  /// @param view of that frame
  virtual std::optional<DebugImage> debug_slice(const scene::View&, glm::dvec2) { return {}; }
};

}  // namespace airlight::frame
