#pragma once

#include <compare>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "epipolar/volume.h"
#include "frame/method.h"
#include "frame/screen_pass.h"
#include "frame/view_rays.h"
#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "media/lighting.h"
#include "surface_shadows/shadow_tree.h"

namespace airlight::media {

/// How a lamp's view rays are cut into steps; a sun's are cut by distance.
enum class MarchSpacing {
  distance,  ///< equally long in the distance from the eye
  angle,     ///< equally long in φ, the angle at the light
};

/// Where in its step a look-up lies.
enum class MarchJitter {
  off,          ///< in the middle
  interleaved,  ///< elsewhere for each pixel of a square of 4 × 4
  gathered,     ///< so, and a pixel is the mean of such a square of one surface
};

/// What is looked up.
enum class MarchLookUp {
  map,   ///< the shadow map
  rows,  ///< the first occluders of light rays in half-planes, to which the shadow map is resampled
  tree,  ///< a tree of triangles
};

/// Of surface_shadows::Psv, of surface_shadows::MetricTree.
enum class MarchTree { psv, metric_tree };

struct MarchOptions {
  int steps = 32;
  MarchLookUp look_up = MarchLookUp::map;
  MarchTree tree = MarchTree::psv;
  epipolar::VolumeOptions volume = {.query = epipolar::Query::light_rays};  ///< of rows
  MarchSpacing spacing = MarchSpacing::distance;
  MarchJitter jitter = MarchJitter::off;
  frame::ViewRays rays = {};

  /// @throws scene::Error (usage) where a volume cannot be of these counts.
  void validate() const { volume.validate(); }
  void fit(const scene::View& view) { volume.fit(view); }
  bool asks_tree() const { return look_up == MarchLookUp::tree; }
  bool needs_shadow_map() const { return !asks_tree(); }
  bool ignores_cut_outs() const { return asks_tree(); }
  /// A phase function whose lobe is too narrow. And a mean over neighbours where rays are listed, which have
  /// none.
  std::optional<frame::Refusal> refusal(const scene::View& view) const;
};

/// `march`: airlight by look-ups of the shadow map along each view ray, or of its rows along the ray's
/// half-plane. `tree-march`: the same by asking a tree of triangles what lies between a point and the light,
/// and how much of it that lets through.
/// Based on: Tóth and Umenhoffer, "Real-time Volumetric Lighting in Participating Media", Eurographics 2009
/// short papers, section 3. By angle: Kulla and Fajardo, "Importance Sampling Techniques for Path Tracing in
/// Participating Media", EGSR 2012, section 4.1 (equi-angular sampling). Rows: the first step of Baran, Chen,
/// Ragan-Kelley, Durand and Lehtinen, "A Hierarchical Volumetric Shadow Algorithm for Single Scattering",
/// SIGGRAPH Asia 2010, section 3 (rectification). Deviation: the light of a step is integrated over φ, as
/// shaders/media/march.frag says, where they take its value at a point.
class March : public frame::Airlight {
 public:
  /// @throws scene::Error as epipolar::ShadowVolume.
  March(const gpu::Context& context, const MarchOptions& options);

  /// The options must not refuse the view.
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override;
  frame::ViewRays rays() const override { return options_.rays; }
  std::map<std::string, std::int64_t> bytes() const override;
  /// "look_ups" of the map or of rows.
  std::map<std::string, double> counters(const frame::FrameInputs& inputs) override;

 private:
  /// What the shader is specialised for.
  struct Variant {
    std::uint32_t phase, layer, reach;
    bool light_textured, plane, rough, sun, transmits;
    bool adds;  ///< to what passes before it have found
    auto operator<=>(const Variant&) const = default;
  };
  const frame::ScreenPass& load(const Variant& variant, const frame::SceneBuffers& scene);

  MarchOptions options_;
  gpu::Buffer space_;  ///< EpipolarBlock of look-ups of the map
  // Or what is looked up instead:
  std::optional<epipolar::ShadowVolume> rows_;
  std::unique_ptr<surface_shadows::ShadowTree> tree_;
  std::map<Variant, frame::ScreenPass> passes_;
  std::optional<frame::ScreenPass> gather_;
  gpu::Texture scattered_;  ///< of the size of the image, before it is gathered
};

frame::AirlightMethod march_method();
frame::AirlightMethod tree_march_method();

}  // namespace airlight::media
