#include "frame/frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "frame/blocks.h"
#include "scene/error.h"

#include "spirv/frame/composite_frag.h"

namespace airlight::frame {
namespace {

using scene::Error;
using scene::ExitCode;

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

std::vector<float> read_visibility(const gpu::Texture& texture) {
  if (texture.format() == gpu::Format::r32f) return texture.read<float>();
  std::vector<float> means;
  for (const glm::vec4& rgba : texture.read<glm::vec4>()) means.push_back((rgba.r + rgba.g + rgba.b) / 3.0f);
  return means;
}

double distance_to_nearest_light(const scene::View& view) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const scene::Light& light : view.lights)
    nearest = std::min(nearest, glm::distance(light.position, view.camera.eye));
  return nearest;
}

template <typename Block>
void write_block(const gpu::Buffer& buffer, const Block& block, unsigned binding) {
  buffer.write(&block, sizeof block);
  buffer.bind_uniform(binding);
}

}  // namespace

Frame::Frame(gpu::Context& context, const scene::Geometry& geometry, int shadow_map_size)
    : context_(context),
      resources_(context, geometry, shadow_map_size),
      camera_block_(sizeof(shaders::CameraBlock)),
      light_block_(sizeof(shaders::LightBlock)),
      medium_block_(sizeof(shaders::MediumBlock)) {}

void Frame::require_images(const scene::View& view, gpu::Format visibility_format) {
  if (!gbuffer_ || radiance_.size() != view.size) {
    const int limit = std::min(context_.limits().max_texture_size, context_.limits().max_viewport);
    if (std::max(view.size.x, view.size.y) > limit) {
      throw Error(ExitCode::driver, "--size",
                  fmt::format("{}x{} pixels are more than this driver's {} (GL_MAX_TEXTURE_SIZE)",
                              view.size.x, view.size.y, limit),
                  "ask for a smaller image");
    }
    gbuffer_.emplace(view.size);
    visibility_.clear();
    light_airlight_ = {};
    airlight_ = gpu::Texture(gpu::Format::rgba32f, view.size);
    radiance_ = gpu::Texture(gpu::Format::rgba32f, view.size);
  }
  visibility_.resize(view.lights.size());
  for (gpu::Texture& visibility : visibility_) {
    if (visibility.size() == view.size && visibility.format() == visibility_format) continue;
    visibility = gpu::Texture(visibility_format, view.size);
    // The compositor multiplies with RGB.
    if (visibility_format == gpu::Format::r32f) visibility.sample_as_grey();
  }
  if (view.lights.size() > 1 && light_airlight_.size() != view.size)
    light_airlight_ = gpu::Texture(gpu::Format::rgba32f, view.size);
}

void Frame::render(const scene::View& view, SurfaceShadow& surface_shadow, Airlight& airlight,
                   gpu::StageTimer& timer) {
  scene::validate(view);
  require_images(view, surface_shadow.visibility_format());
  resources_.begin_frame();
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const SceneBuffers& scene = resources_.scene();

  // What the camera sees.
  timer.time("surfaces", [&] {
    const double distance = distance_to_nearest_light(view);
    const float near = near_depth(scene, camera.eye, distance);
    write_block(camera_block_, camera_block(camera, view.size, near), shaders::k_camera_block);
    write_block(medium_block_, medium_block(view.medium), shaders::k_medium_block);
    gbuffer_->draw(scene, camera, scene.triangles_at(camera.eye, distance));
  });

  // What each light adds.
  for (std::size_t i = 0; i < view.lights.size(); ++i) {
    const scene::Light& light = view.lights[i];
    resources_.begin_light(light, camera.eye);
    const float near = near_depth(scene, light.position, glm::distance(light.position, camera.eye));
    write_block(light_block_, light_block(light, camera.eye, near, resources_.shadow_map_size()),
                shaders::k_light_block);
    const FrameInputs inputs{.context = context_,
                             .view = view,
                             .light_index = i,
                             .scene = scene,
                             .triangles = gbuffer_->triangles(),
                             .surfaces = gbuffer_->surfaces(),
                             .resources = resources_,
                             .timer = timer};
    const gpu::Texture& light_airlight = i == 0 ? airlight_ : light_airlight_;
    surface_shadow.query(inputs, visibility_[i]);  // times its own stages, …
    airlight.integrate(inputs, light_airlight);    // … and so does airlight
    timer.time("composite", [&] { composite(visibility_[i], light_airlight, i > 0); });
  }
  context_.check();
}

void Frame::composite(const gpu::Texture& visibility, const gpu::Texture& airlight, bool adds) {
  const gpu::Texture* light_texture = resources_.light_texture();
  const bool is_textured = light_texture != nullptr;
  auto& pass = composite_[{is_textured, adds}];
  if (!pass) {
    pass.emplace(k_composite_frag, std::array{gpu::Constant(0, is_textured)},
                 adds ? gpu::Blend::add : gpu::Blend::replace);
  }
  resources_.scene().bind_samplers();
  gbuffer_->triangles().bind_sampler(shaders::k_triangle_unit);
  gbuffer_->surfaces().bind_sampler(shaders::k_surface_unit);
  visibility.bind_sampler(shaders::k_visibility_unit);
  airlight.bind_sampler(shaders::k_airlight_unit);
  if (light_texture) light_texture->bind_sampler(shaders::k_light_texture_unit);
  if (adds) {
    pass->run({radiance_, airlight_});
  } else {
    pass->run({radiance_});
  }
}

FrameImages Frame::read() const {
  FrameImages images;
  images.size = radiance_.size();
  images.radiance = read_rgb(radiance_, "radiance");
  images.airlight = read_rgb(airlight_, "airlight");
  for (const glm::vec4& surface : gbuffer_->surfaces().read<glm::vec4>())
    images.distance.push_back(surface.w);
  for (const gpu::Texture& texture : visibility_) {
    std::vector<float>& visibility = images.visibility.emplace_back(read_visibility(texture));
    for (std::size_t i = 0; i < visibility.size(); ++i) {
      if (images.distance[i] == 0.0f) visibility[i] = 0.0f;
    }
  }
  context_.check();
  return images;
}

}  // namespace airlight::frame
