#include "frame/frame.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "frame/view_block.h"
#include "scene/error.h"
#include "scene/light_texture.h"

#include "spirv/frame/composite_comp.h"

#include <epoxy/gl.h>

namespace airlight::frame {
namespace {

using scene::Error;
using scene::ExitCode;

/// The depth at which a pyramid at `apex` starts to order surfaces. As large as the scene allows, because
/// depth is interpolated on triangles that reach up to it; not smaller than 1e-4 of the distance between eye
/// and light, where single precision on a triangle that passes the apex would leave no digits.
float near_depth(const SceneBuffers& scene, glm::dvec3 apex, double eye_light_distance) {
  // The nearest point may lie in the corner of a cube face, where depth is 1/√3 of distance.
  const double nearest = 0.5 * scene.distance_to(apex);
  return static_cast<float>(std::clamp(nearest, 1e-4 * eye_light_distance, eye_light_distance));
}

shaders::ViewBlock view_block(const SceneBuffers& scene, const scene::View& view,
                              const scene::CameraFrame& camera, int shadow_map_size) {
  const glm::dvec3 to_light = view.light.position - camera.eye;
  const double eye_light_distance = glm::length(to_light);
  const glm::vec3 eye_high(camera.eye);
  shaders::ViewBlock block{};
  block.eye_high = eye_high;
  block.eye_low = glm::vec3(camera.eye - glm::dvec3(eye_high));
  block.half_width = static_cast<float>(camera.half_width);
  block.half_height = static_cast<float>(camera.half_height);
  block.right = glm::vec3(camera.right);
  block.up = glm::vec3(camera.up);
  block.forward = glm::vec3(camera.forward);
  block.image_width = static_cast<float>(view.size.x);
  block.image_height = static_cast<float>(view.size.y);
  block.eye_near = near_depth(scene, camera.eye, eye_light_distance);
  block.light = glm::vec3(to_light);
  block.light_near = near_depth(scene, view.light.position, eye_light_distance);
  block.intensity = view.light.intensity;
  block.shadow_map_size = static_cast<float>(shadow_map_size);
  block.sigma_t = view.medium.sigma_s + view.medium.sigma_a;
  return block;
}

void require_finite(const std::vector<glm::vec3>& image, glm::ivec2 size, const char* name) {
  const auto bad = std::find_if(image.begin(), image.end(), [](const glm::vec3& value) {
    return !std::isfinite(value.x) || !std::isfinite(value.y) || !std::isfinite(value.z);
  });
  if (bad == image.end()) return;
  const auto index = static_cast<int>(bad - image.begin());
  throw Error(ExitCode::driver, name,
              fmt::format("pixel ({}, {}) is not finite", index % size.x, index / size.x),
              "this is a fault of the program: please report the command");
}

std::vector<glm::vec3> read_rgb(const gpu::Texture& texture, const char* name) {
  const std::vector<glm::vec4> rgba = texture.read<glm::vec4>();
  std::vector<glm::vec3> rgb(rgba.begin(), rgba.end());
  require_finite(rgb, texture.size(), name);
  return rgb;
}

gpu::Program compositor(bool is_light_textured) {
  return gpu::Program::compute(k_composite_comp, std::array{gpu::Constant(0, is_light_textured)});
}

}  // namespace

void NoShadow::query(const FrameInputs& inputs, const gpu::Texture& visibility) {
  inputs.timer.time("surface_query", [&] {
    const float lit = 1.0f;
    glClearTexImage(visibility.name(), 0, GL_RED, GL_FLOAT, &lit);
  });
}

void NoAirlight::integrate(const FrameInputs&, const gpu::Texture& radiance) {
  glClearTexImage(radiance.name(), 0, GL_RGBA, GL_FLOAT, nullptr);
}

Frame::Frame(gpu::Context& context, const scene::Geometry& geometry, int shadow_map_size)
    : context_(context),
      scene_(context, geometry),
      shadow_map_size_(shadow_map_size),
      view_block_(sizeof(shaders::ViewBlock)),
      composite_(compositor(false)) {}

void Frame::load_light_texture(const std::shared_ptr<const scene::LightTexture>& texture) {
  if (texture == light_texture_) return;
  if (texture) {
    const glm::ivec2 size = texture->size();
    const int limit = context_.limits().max_texture_size;
    if (std::max(size.x, size.y) > limit) {
      throw Error(ExitCode::driver, texture->name(),
                  fmt::format("{}x{} texels are more than this driver's {} (GL_MAX_TEXTURE_SIZE)", size.x,
                              size.y, limit),
                  "scale the image down");
    }
    std::vector<glm::vec4> texels;
    texels.reserve(texture->texels().size());
    for (const glm::vec3& texel : texture->texels()) texels.emplace_back(texel, 0.0f);
    light_texture_texels_ = gpu::Texture(gpu::Format::rgba32f, size);
    light_texture_texels_.write(texels.data());
  } else {
    light_texture_texels_ = {};
  }
  if ((texture == nullptr) != (light_texture_ == nullptr)) composite_ = compositor(texture != nullptr);
  light_texture_ = texture;
}

void Frame::render(const scene::View& view, SurfaceShadow& surface_shadow, Airlight& airlight,
                   gpu::StageTimer& timer) {
  scene::validate(view);
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);

  // Make what this frame needs and the last one did not have.
  load_light_texture(view.light.texture);
  if (!gbuffer_ || radiance_.size() != view.size) {
    const int limit = std::min(context_.limits().max_texture_size, context_.limits().max_viewport);
    if (std::max(view.size.x, view.size.y) > limit) {
      throw Error(ExitCode::driver, "--size",
                  fmt::format("{}x{} pixels are more than this driver's {} (GL_MAX_TEXTURE_SIZE)",
                              view.size.x, view.size.y, limit),
                  "ask for a smaller image");
    }
    gbuffer_.emplace(view.size);
    visibility_ = gpu::Texture(gpu::Format::r32f, view.size);
    airlight_ = gpu::Texture(gpu::Format::rgba32f, view.size);
    radiance_ = gpu::Texture(gpu::Format::rgba32f, view.size);
  }
  const bool needs_shadow_map = surface_shadow.needs_shadow_map() || airlight.needs_shadow_map();
  if (needs_shadow_map && !shadow_map_) shadow_map_.emplace(context_, shadow_map_size_);

  timer.time("surfaces", [&] {
    const shaders::ViewBlock block = view_block(scene_, view, camera, shadow_map_size_);
    view_block_.write(&block, sizeof block);
    view_block_.bind_uniform(0);
    gbuffer_->draw(scene_, camera);
  });
  if (needs_shadow_map) {
    timer.time("shadow_map", [&] { shadow_map_->draw(scene_, view.light.position); });
  }
  const FrameInputs inputs{.context = context_,
                           .view = view,
                           .scene = scene_,
                           .triangles = gbuffer_->triangles(),
                           .surfaces = gbuffer_->surfaces(),
                           .shadow_map = needs_shadow_map ? &*shadow_map_ : nullptr,
                           .light_texture = light_texture_ ? &light_texture_texels_ : nullptr,
                           .timer = timer};
  surface_shadow.query(inputs, visibility_);  // times its own stages, …
  airlight.integrate(inputs, airlight_);      // … and so does airlight
  timer.time("composite", [&] {
    scene_.bind_samplers();
    gbuffer_->triangles().bind_sampler(0);
    gbuffer_->surfaces().bind_sampler(1);
    visibility_.bind_sampler(2);
    airlight_.bind_sampler(3);
    if (light_texture_) light_texture_texels_.bind_sampler(14);
    radiance_.bind_image(0);
    composite_.dispatch({view.size, 1}, {8, 8, 1});
  });
  context_.check();
}

FrameImages Frame::read() const {
  FrameImages images;
  images.size = radiance_.size();
  images.radiance = read_rgb(radiance_, "radiance");
  images.airlight = read_rgb(airlight_, "airlight");
  for (const glm::vec4& surface : gbuffer_->surfaces().read<glm::vec4>())
    images.distance.push_back(surface.w);
  images.visibility = visibility_.read<float>();
  for (std::size_t i = 0; i < images.visibility.size(); ++i) {
    if (images.distance[i] == 0.0f) images.visibility[i] = 0.0f;
  }
  context_.check();
  return images;
}

std::map<std::string, std::int64_t> Frame::bytes() const {
  std::map<std::string, std::int64_t> bytes = {{"scene", scene_.bytes()}};
  if (shadow_map_) bytes["shadow_map"] = shadow_map_->depth().bytes();
  if (light_texture_) bytes["light_texture"] = light_texture_texels_.bytes();
  return bytes;
}

}  // namespace airlight::frame
