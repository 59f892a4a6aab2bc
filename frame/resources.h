#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "frame/long_work.h"
#include "frame/scene_buffers.h"
#include "frame/shadow_map.h"
#include "frame/shadow_plane.h"
#include "frame/surface_points.h"
#include "gpu/texture.h"
#include "gpu/timer.h"
#include "scene/components.h"
#include "scene/edges.h"

namespace airlight::frame {

/// What becomes, in the next frame, of what is made for a light and has not changed.
enum class Resting {
  redrawn,  ///< it is made anew, so that each frame costs what a frame costs
  kept,     ///< it is used again: the same image for less
};

/// What the steps of a frame may ask for beside what they are always given. Each thing is made when it is
/// first asked for: of the scene once, of a light once a frame, or once while it rests. The time of making it
/// is a stage of its own, whoever asks, and its memory counts in the frames that used it.
class Resources {
 public:
  /// @param geometry kept by reference
  /// @param shadow_map_size side of a cube face [texels]
  /// @param scene of the same geometry; frames of several sizes may share it. Made here without.
  Resources(gpu::Context& context, const scene::Geometry& geometry, int shadow_map_size,
            std::shared_ptr<const SceneBuffers> scene = {}, LongWork long_work = {});

  /// Where the frame's view has it.
  const scene::Geometry& geometry() const { return posed_ ? *posed_ : geometry_; }
  /// Where the scene has it.
  const scene::Geometry& geometry_at_rest() const { return geometry_; }
  const SceneBuffers& scene() const { return *scene_; }
  int shadow_map_size() const { return shadow_map_size_; }

  const LongWork& long_work() const { return long_work_; }

  void begin_frame(Resting resting);

  /// Puts the scene's objects where the frame's view has them. Stage `pose`, where that is elsewhere than
  /// before: all that was made of the scene then goes, but for what SceneBuffers::id_at_rest keeps.
  void pose(const scene::Pose& pose, gpu::StageTimer& timer);

  /// Whether what rests is to be used again in this frame.
  bool keeps() const { return resting_ == Resting::kept; }

  /// To be told of what was made in this frame for a light: "shadow_map", "volume".
  void note_redrawn(const std::string& what) { redrawn_.insert(what); }
  const std::set<std::string>& redrawn() const { return redrawn_; }

  /// What is asked for from now on is this light's. Its block is bound.
  /// @throws scene::Error (driver) for a texture over the driver's limit
  void begin_light(const scene::Light& light, const scene::CameraFrame& camera);

  /// Of the light: see frame::near_depth; 0 where its shadow map is drawn on a plane.
  float light_near() const { return light_near_; }

  /// Where the light's shadow map lies, if it is drawn on a plane: else it is a cube.
  const std::optional<ShadowPlane>& shadow_plane() const { return shadow_plane_; }

  /// The triangles on which the light lies, which cast no shadow: see SceneBuffers::triangles_at.
  const std::vector<std::uint32_t>& triangles_at_light() const { return triangles_at_light_; }

  /// With at least what the camera needs drawn (FrameInputs::shadow_map). Stage `shadow_map`.
  /// @throws scene::Error (driver) for one over the driver's limit
  const gpu::Texture& shadow_map(double reach, gpu::StageTimer& timer);

  /// What each pixel shades: see SurfacePointPass. Stage `surface_points`.
  /// @param triangles the frame's
  const gpu::Texture& surface_points(const gpu::Texture& triangles, gpu::StageTimer& timer);

  /// r32ui: in which plane each triangle lies (scene::planes_of), in the order of the scene's buffers. Stage
  /// `triangle_planes`, once a scene.
  const gpu::TexelView& triangle_planes(gpu::StageTimer& timer);

  /// Where positions relative to the light start.
  LightOrigin origin() const { return light_origin(*light_, camera_.eye); }

  /// rgba32f, by direction (light_texture.glsl); nullptr where the light has none.
  const gpu::Texture* light_texture() const {
    return light_->texture ? &light_textures_.at(light_->texture).texels : nullptr;
  }

  /// Stage `edges`.
  const scene::Edges& edges(gpu::StageTimer& timer);

  /// Stage `components`.
  const scene::Components& components(gpu::StageTimer& timer);

  /// GPU memory of what the last frame used, by name.
  std::map<std::string, std::int64_t> bytes() const;

 private:
  gpu::Context& context_;
  const scene::Geometry& geometry_;
  std::shared_ptr<const SceneBuffers> at_rest_, scene_;  ///< the same, unless posed
  std::unique_ptr<scene::Geometry> posed_;               ///< none at rest
  scene::Pose pose_;
  int shadow_map_size_;
  LongWork long_work_;

  std::optional<ShadowMap> shadow_map_;
  std::optional<ShadowPlaneMap> shadow_plane_map_;
  const scene::Light* light_ = nullptr;  ///< whose things are asked for
  scene::CameraFrame camera_{};          ///< that sees what it lights
  std::vector<std::uint32_t> triangles_at_light_;
  std::optional<ShadowPlane> shadow_plane_;
  float light_near_ = 0.0f;
  Resting resting_ = Resting::redrawn;
  std::set<std::string> redrawn_;

  /// What the shadow map depends on, beside the scene: that on a plane on the view, too.
  struct OfMap {
    scene::Light light;
    std::optional<ShadowPlane> plane;
    float near;                           ///< of a cube
    std::vector<std::uint32_t> left_out;  ///< of a cube: see triangles_at_light
    bool operator==(const OfMap& other) const;
  };
  OfMap of_map() const { return {*light_, shadow_plane_, light_near_, triangles_at_light_}; }
  std::optional<OfMap> drawn_plane_map_, drawn_cube_;  ///< none where there is nothing that could be kept
  std::int64_t shadow_map_bytes_ = 0;                  ///< of those used in this frame

  gpu::Buffer triangle_planes_;
  std::optional<gpu::TexelView> triangle_plane_texels_;
  bool used_triangle_planes_ = false;  ///< in this frame
  std::optional<SurfacePointPass> surface_point_pass_;
  gpu::Texture surface_points_;
  bool has_surface_points_ = false;   ///< of this light
  bool used_surface_points_ = false;  ///< in this frame

  struct LightTexels {
    gpu::Texture texels;
    bool is_used = false;  ///< in this frame
  };
  std::map<std::shared_ptr<const scene::LightTexture>, LightTexels> light_textures_;

  std::optional<scene::Edges> edges_;
  std::optional<scene::Components> components_;
};

}  // namespace airlight::frame
