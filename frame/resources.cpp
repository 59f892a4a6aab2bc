#include "frame/resources.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "scene/error.h"
#include "scene/light_texture.h"

namespace airlight::frame {

Resources::Resources(gpu::Context& context, const scene::Geometry& geometry, int shadow_map_size)
    : context_(context), geometry_(geometry), scene_(context, geometry), shadow_map_size_(shadow_map_size) {}

void Resources::begin_frame() {
  shadow_map_bytes_ = 0;
  std::erase_if(light_textures_, [](const auto& texture) { return !texture.second.is_used; });
  for (auto& texture : light_textures_) texture.second.is_used = false;
}

void Resources::begin_light(const scene::Light& light, const scene::CameraFrame& camera) {
  light_ = &light;
  camera_ = camera;
  shadow_plane_ = fit_shadow_plane(light, camera, scene_.box(), shadow_map_size_);
  shadow_plane_is_drawn_ = false;
  triangles_at_light_.clear();
  if (!shadow_plane_)
    triangles_at_light_ = scene_.triangles_at(light.position, glm::distance(light.position, camera.eye));
  if (shadow_map_) shadow_map_->reset();
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
    if (!shadow_plane_is_drawn_) {
      timer.time("shadow_map", [&] { shadow_plane_map_->draw(scene_, *shadow_plane_); });
      shadow_plane_is_drawn_ = true;
    }
    shadow_map_bytes_ = std::max(shadow_map_bytes_, shadow_plane_map_->depth().bytes());
    return shadow_plane_map_->depth();
  }
  if (!shadow_map_) shadow_map_.emplace(context_, shadow_map_size_);
  const CubeFaces faces = needed_faces(camera_, light_->position, reach);
  if (!shadow_map_->has(faces)) {
    timer.time("shadow_map",
               [&] { shadow_map_->draw(scene_, light_->position, triangles_at_light_, faces); });
  }
  shadow_map_bytes_ = std::max(shadow_map_bytes_, shadow_map_->depth().bytes());
  return shadow_map_->depth();
}

const scene::Edges& Resources::edges(gpu::StageTimer& timer) {
  if (!edges_) timer.time("edges", [&] { edges_ = scene::find_edges(geometry_); });
  return *edges_;
}

const scene::Components& Resources::components(gpu::StageTimer& timer) {
  if (!components_) {
    const scene::Edges& of_scene = edges(timer);
    timer.time("components", [&] { components_ = scene::find_components(geometry_, of_scene); });
  }
  return *components_;
}

std::map<std::string, std::int64_t> Resources::bytes() const {
  std::map<std::string, std::int64_t> bytes = {{"scene", scene_.bytes()}};
  if (shadow_map_bytes_ > 0) bytes["shadow_map"] = shadow_map_bytes_;
  for (const auto& [texture, on_gpu] : light_textures_)
    if (on_gpu.is_used) bytes["light_texture"] += on_gpu.texels.bytes();
  return bytes;
}

}  // namespace airlight::frame
