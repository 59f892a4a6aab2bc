#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "frame/frame.h"
#include "frame/none.h"
#include "media/froxel.h"
#include "media/march.h"
#include "media/vsv.h"
#include "quality/metrics.h"
#include "reference/reference.h"
#include "support/gpu_context.h"
#include "surface_shadows/shadow_map_lookup.h"

namespace airlight::tests {

/// What an image by voxelized shadow volumes depends on, beside the view.
struct VsvSettings {
  epipolar::Resolution resolution{256, 1024, 512};
  media::VsvIntegral integral = media::VsvIntegral::automatic;
  int shadow_map = 1024;
  std::optional<epipolar::Scan> scan = {};
  epipolar::Populate populate = epipolar::Populate::shadow_map;
  epipolar::Ranges ranges = epipolar::Ranges::frame;
  media::PhiCells phi_cells = media::PhiCells::growing;
  epipolar::ThetaCells theta_cells = epipolar::ThetaCells::fitted;
  epipolar::Query query = epipolar::Query::bits;
  bool surface_shadows = false;  ///< by the shadow map; else every surface is lit
};

/// An image by a method of airlight, every surface lit.
inline frame::FrameImages render_airlight(const scene::Geometry& geometry, const scene::View& view,
                                          frame::Airlight& airlight, int shadow_map) {
  frame::Frame frame(gpu_context(), geometry, shadow_map);
  frame::NoShadow no_shadow;
  gpu::StageTimer timer(nullptr);
  frame.render(view, no_shadow, airlight, timer);
  return frame.read();
}

inline frame::FrameImages render_march(const scene::Geometry& geometry, const scene::View& view,
                                       const media::MarchOptions& options, int shadow_map = 1024) {
  media::March march(gpu_context(), options);
  return render_airlight(geometry, view, march, shadow_map);
}

inline frame::FrameImages render_froxel(const scene::Geometry& geometry, const scene::View& view,
                                        const media::FroxelOptions& options, int shadow_map = 1024) {
  media::Froxel froxel(options);
  return render_airlight(geometry, view, froxel, shadow_map);
}

inline frame::FrameImages render_vsv(const scene::Geometry& geometry, const scene::View& view,
                                     const VsvSettings& settings = {}) {
  media::Vsv vsv(gpu_context(), {.integral = settings.integral,
                                 .phi_cells = settings.phi_cells,
                                 .volume = {.resolution = settings.resolution,
                                            .populate = settings.populate,
                                            .scan = settings.scan,
                                            .ranges = settings.ranges,
                                            .theta_cells = settings.theta_cells,
                                            .query = settings.query}});
  if (!settings.surface_shadows) return render_airlight(geometry, view, vsv, settings.shadow_map);
  frame::Frame frame(gpu_context(), geometry, settings.shadow_map);
  surface_shadows::ShadowMapLookup lookup;
  gpu::StageTimer timer(nullptr);
  frame.render(view, lookup, vsv, timer);
  return frame.read();
}

/// For messages and names of tests.
inline std::string name_of(media::VsvIntegral integral) {
  constexpr std::array<const char*, 5> k_names = {"automatic", "table", "quadrature", "riemann", "factored"};
  return k_names.at(static_cast<std::size_t>(integral));
}

/// See quality::airlight_error, which refuses NaN and infinity.
inline quality::AirlightError error_of(const std::vector<glm::vec3>& image,
                                       const std::vector<glm::vec3>& reference) {
  return quality::airlight_error(quality::channels_of(image), quality::channels_of(reference));
}

/// The truth of a view.
struct Truth {
  reference::SurfaceImage surfaces;
  reference::AirlightImage airlight;
};

inline Truth trace(const scene::Geometry& geometry, const scene::View& view) {
  const reference::Reference reference(geometry, view);
  return {.surfaces = reference.surfaces(), .airlight = reference.exact()};
}

/// The error over the pixels where both see the same surface: rasterisation snaps corners to 1/256 pixel, so
/// that a pixel centre that near to a silhouette may see past it, or not, and all the airlight behind. Those
/// pixels must be few.
/// @param few how many, as a part of all
inline quality::AirlightError error_of(const frame::FrameImages& images, const Truth& truth,
                                       double few = 0.002) {
  std::vector<glm::vec3> image, reference;
  for (std::size_t i = 0; i < images.airlight.size(); ++i) {
    const float expected = truth.surfaces.distance[i];
    if (std::abs(images.distance[i] - expected) > 1e-3f * expected) continue;
    image.push_back(images.airlight[i]);
    reference.push_back(truth.airlight.radiance[i]);
  }
  EXPECT_LE(static_cast<double>(images.airlight.size() - image.size()),
            1.0 + few * static_cast<double>(images.airlight.size()));
  return error_of(image, reference);
}

}  // namespace airlight::tests
