#include "frame/resources.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "frame/blocks.h"
#include "scene/coplanar.h"
#include "scene/error.h"
#include "scene/light_texture.h"

namespace airlight::frame {

Resources::Resources(gpu::Context& context, const scene::Geometry& geometry, int shadow_map_size,
                     std::shared_ptr<const SceneBuffers> scene, LongWork long_work)
    : context_(context),
      geometry_(geometry),
      at_rest_(scene ? std::move(scene) : std::make_shared<const SceneBuffers>(context, geometry)),
      scene_(at_rest_),
      shadow_map_size_(shadow_map_size),
      long_work_(std::move(long_work)) {}

bool Resources::OfMap::operator==(const OfMap& other) const {
  return scene::shine_alike(light, other.light) && plane == other.plane && near == other.near &&
         left_out == other.left_out;
}

void Resources::begin_frame(Resting resting) {
  shadow_map_bytes_ = 0;
  used_surface_points_ = false;
  used_triangle_planes_ = false;
  std::erase_if(light_textures_, [](const auto& texture) { return !texture.second.is_used; });
  for (auto& texture : light_textures_) texture.second.is_used = false;
  resting_ = resting;
  redrawn_.clear();
}

void Resources::pose(const scene::Pose& pose, gpu::StageTimer& timer) {
  if (pose == pose_) return;
  if (pose.is_at_rest() && !posed_) {
    pose_ = pose;
    return;
  }
  timer.time("pose", [&] {
    if (pose.is_at_rest() || pose.objects != pose_.objects) {
      scene_ = at_rest_;
      posed_.reset();
    }
    if (!pose.is_at_rest()) {
      if (!posed_) posed_ = std::make_unique<scene::Geometry>(geometry_);
      scene::set_pose(*posed_, geometry_, pose);
      scene_ = std::make_shared<const SceneBuffers>(context_, *posed_, *at_rest_);
    }
  });
  pose_ = pose;
  triangle_plane_texels_.reset();
  edges_.reset();
  components_.reset();
  drawn_plane_map_.reset();
  drawn_cube_.reset();
}

void Resources::begin_light(const scene::Light& light, const scene::CameraFrame& camera) {
  light_ = &light;
  camera_ = camera;
  has_surface_points_ = false;
  shadow_plane_ = fit_shadow_plane(light, camera, scene_->box(), shadow_map_size_);
  triangles_at_light_.clear();
  light_near_ = 0.0f;
  if (!shadow_plane_) {
    const double distance = glm::distance(light.position, camera.eye);
    triangles_at_light_ = scene_->triangles_at(light.position, distance);
    light_near_ = near_depth(*scene_, light.position, distance);
  }

  // What there is of a shadow map serves this light, or goes.
  std::optional<OfMap>& drawn = shadow_plane_ ? drawn_plane_map_ : drawn_cube_;
  if (!keeps() || drawn != of_map()) {
    drawn.reset();
    if (!shadow_plane_ && shadow_map_) shadow_map_->reset();
  }
  if (!light.texture) return;
  LightTexels& on_gpu = light_textures_[light.texture];
  on_gpu.is_used = true;
  const glm::ivec2 size = light.texture->size();
  if (on_gpu.texels.size() == size) return;
  const int limit = context_.limits().max_texture_size;
  if (std::max(size.x, size.y) > limit) {
    throw scene::Error(scene::ExitCode::driver, light.texture->name(),
                       fmt::format("{}x{} texels are more than this driver's {} (GL_MAX_TEXTURE_SIZE)",
                                   size.x, size.y, limit),
                       "scale the image down");
  }
  std::vector<glm::vec4> texels;
  texels.reserve(light.texture->texels().size());
  for (const glm::vec3& texel : light.texture->texels()) texels.emplace_back(texel, 0.0f);
  on_gpu.texels = gpu::Texture(gpu::Format::rgba32f, size);
  on_gpu.texels.write(texels.data());
}

const gpu::Texture& Resources::shadow_map(double reach, gpu::StageTimer& timer) {
  if (shadow_plane_) {
    if (!shadow_plane_map_) shadow_plane_map_.emplace(context_, shadow_map_size_);
    if (!drawn_plane_map_) {
      timer.time("shadow_map", [&] { shadow_plane_map_->draw(*scene_, *shadow_plane_); });
      drawn_plane_map_ = of_map();
      note_redrawn("shadow_map");
    }
    shadow_map_bytes_ = std::max(shadow_map_bytes_, shadow_plane_map_->depth().bytes());
    return shadow_plane_map_->depth();
  }
  if (!shadow_map_) shadow_map_.emplace(context_, shadow_map_size_);
  const CubeFaces faces = needed_faces(camera_, light_->position, reach);
  if (!shadow_map_->has(faces)) {
    timer.time("shadow_map",
               [&] { shadow_map_->draw(*scene_, light_->position, triangles_at_light_, faces); });
    drawn_cube_ = of_map();
    note_redrawn("shadow_map");
  }
  shadow_map_bytes_ = std::max(shadow_map_bytes_, shadow_map_->depth().bytes());
  return shadow_map_->depth();
}

const gpu::Texture& Resources::surface_points(const gpu::Texture& triangles, gpu::StageTimer& timer) {
  if (has_surface_points_) return surface_points_;
  if (!surface_point_pass_) surface_point_pass_.emplace();
  if (surface_points_.size() != triangles.size())
    surface_points_ = gpu::Texture(gpu::Format::rgba32f, triangles.size());
  timer.time("surface_points",
             [&] { surface_point_pass_->run(*scene_, triangles, origin(), surface_points_); });
  has_surface_points_ = true;
  used_surface_points_ = true;
  return surface_points_;
}

const gpu::TexelView& Resources::triangle_planes(gpu::StageTimer& timer) {
  used_triangle_planes_ = true;
  if (triangle_plane_texels_) return *triangle_plane_texels_;
  timer.time("triangle_planes", [&] {
    const std::vector<std::uint32_t> of_geometry = scene::planes_of(geometry());
    std::vector<std::uint32_t> planes;
    planes.reserve(of_geometry.size());
    for (const std::uint32_t triangle : scene_->order()) planes.push_back(of_geometry[triangle]);
    triangle_planes_ = gpu::Buffer::from(std::span<const std::uint32_t>(planes));
    triangle_plane_texels_.emplace(context_.limits(), triangle_planes_, gpu::Format::r32ui,
                                   "the model's triangles");
  });
  return *triangle_plane_texels_;
}

const scene::Edges& Resources::edges(gpu::StageTimer& timer) {
  if (!edges_) timer.time("edges", [&] { edges_ = scene::find_edges(geometry()); });
  return *edges_;
}

const scene::Components& Resources::components(gpu::StageTimer& timer) {
  if (!components_) {
    const scene::Edges& of_scene = edges(timer);
    timer.time("components", [&] { components_ = scene::find_components(geometry(), of_scene); });
  }
  return *components_;
}

std::map<std::string, std::int64_t> Resources::bytes() const {
  std::map<std::string, std::int64_t> bytes = {{"scene", at_rest_->bytes()}};
  if (posed_) bytes["scene"] += scene_->bytes();
  if (shadow_map_bytes_ > 0) bytes["shadow_map"] = shadow_map_bytes_;
  if (used_triangle_planes_) bytes["triangle_planes"] = triangle_planes_.bytes();
  if (used_surface_points_) bytes["surface_points"] = surface_points_.bytes();
  for (const auto& [texture, on_gpu] : light_textures_)
    if (on_gpu.is_used) bytes["light_texture"] += on_gpu.texels.bytes();
  return bytes;
}

}  // namespace airlight::frame
