#include "frame/frame.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "frame/blocks.h"
#include "frame/light_reach.h"
#include "scene/error.h"

#include "spirv/frame/composite_frag.h"
#include "spirv/frame/idle_comp.h"
#include "spirv/frame/idle_frag.h"
#include "spirv/frame/surroundings_frag.h"

namespace airlight::frame {
namespace {

using scene::Error;
using scene::ExitCode;

/// Reads an image a few rows at a time, so that no second copy of it is ever held.
/// @param take called with each pixel's index and texel
template <typename T, typename Take>
void read_pixels(const gpu::Texture& texture, const Take& take) {
  constexpr int k_rows = 64;
  const glm::ivec2 size = texture.size();
  const auto width = static_cast<std::size_t>(size.x);
  std::vector<T> rows(k_rows * width);
  for (int first = 0; first < size.y; first += k_rows) {
    const int count = std::min(k_rows, size.y - first);
    texture.read_rows(first, count, rows.data());
    const std::size_t offset = static_cast<std::size_t>(first) * width;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count) * width; ++i) take(offset + i, rows[i]);
  }
}

std::size_t pixel_count(const gpu::Texture& texture) {
  return static_cast<std::size_t>(texture.size().x) * static_cast<std::size_t>(texture.size().y);
}

std::vector<glm::vec3> read_rgb(const gpu::Texture& texture, const char* name) {
  std::vector<glm::vec3> rgb;
  rgb.reserve(pixel_count(texture));
  read_pixels<glm::vec4>(texture, [&](std::size_t pixel, const glm::vec4& rgba) {
    // Infinity and NaN times 0 are NaN.
    if (!(0.0f * rgba.r + 0.0f * rgba.g + 0.0f * rgba.b == 0.0f)) {
      const auto index = static_cast<int>(pixel);
      throw Error(
          ExitCode::driver, name,
          fmt::format("pixel ({}, {}) is not finite", index % texture.size().x, index / texture.size().x),
          "this is a fault of the program: please report the command");
    }
    rgb.emplace_back(rgba);
  });
  return rgb;
}

std::vector<float> read_distance(const gpu::Texture& surfaces) {
  std::vector<float> distance;
  distance.reserve(pixel_count(surfaces));
  read_pixels<glm::vec4>(surfaces,
                         [&](std::size_t, const glm::vec4& surface) { distance.push_back(surface.w); });
  return distance;
}

/// Of one light; 0 where no surface is seen.
void read_visibility(const gpu::Texture& texture, FrameImages& images) {
  std::vector<float>& visibility = images.visibility.emplace_back();
  visibility.reserve(images.distance.size());
  const auto is_surface = [&](std::size_t pixel) { return images.distance[pixel] != 0.0f; };
  if (texture.format() == gpu::Format::r32f) {
    read_pixels<float>(texture, [&](std::size_t pixel, float value) {
      visibility.push_back(is_surface(pixel) ? value : 0.0f);
    });
    return;
  }
  std::vector<glm::vec3>& transmittance = images.transmittance.emplace_back();
  transmittance.reserve(images.distance.size());
  read_pixels<glm::vec4>(texture, [&](std::size_t pixel, const glm::vec4& rgba) {
    const glm::vec3 share = is_surface(pixel) ? glm::vec3(rgba) : glm::vec3(0.0f);
    transmittance.push_back(share);
    visibility.push_back((share.r + share.g + share.b) / 3.0f);
  });
}

/// The length that single precision around the eye is relative to: how far it is to the light, or as far as
/// the scene reaches where the light is farther, a sun among them.
double length_scale(const scene::Light& light, glm::dvec3 eye, const scene::Box& scene) {
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  const double to_light = scene::is_sun(light) ? k_infinity : glm::distance(light.position, eye);
  if (scene.empty()) return std::min(to_light, 1e30);
  return std::min(to_light, scene::reach_from(eye, scene));
}

template <typename Block>
void write_block(const gpu::Buffer& buffer, const Block& block, unsigned binding) {
  buffer.write(&block, sizeof block);
  buffer.bind_uniform(binding);
}

}  // namespace

Frame::Frame(gpu::Context& context, const scene::Geometry& geometry, int shadow_map_size,
             std::shared_ptr<const SceneBuffers> scene, LongWork long_work)
    : context_(context),
      resources_(context, geometry, shadow_map_size, std::move(scene), std::move(long_work)),
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
    airlight_of_light_.clear();
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
  airlight_of_light_.resize(view.lights.size() > 1 ? view.lights.size() : 0);
  for (gpu::Texture& airlight : airlight_of_light_)
    if (airlight.size() != view.size) airlight = gpu::Texture(gpu::Format::rgba32f, view.size);
}

void Frame::render(const scene::View& view, SurfaceShadow& surface_shadow, Airlight& airlight,
                   gpu::StageTimer& timer, Resting resting) {
  scene::validate(view);
  require_images(view, surface_shadow.visibility_format(resources_.scene()));
  resources_.begin_frame(resting);
  timer.begin_part({});
  resources_.pose(view.pose, timer);
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const SceneBuffers& scene = resources_.scene();

  // What the camera sees.
  float near = 0.0f;
  timer.time("surfaces", [&] {
    double distance = std::numeric_limits<double>::infinity();
    for (const scene::Light& light : view.lights)
      distance = std::min(distance, length_scale(light, camera.eye, scene.box()));
    near = near_depth(scene, camera.eye, distance, camera.half_width, camera.half_height);
    write_block(camera_block_, camera_block(camera, view.size, near), shaders::k_camera_block);
    write_block(medium_block_, medium_block(view.medium, camera.eye), shaders::k_medium_block);
    gbuffer_->draw(scene, camera, scene.triangles_at(camera.eye, distance));
    if (scene.looks()) scene.looks()->draw(scene, gbuffer_->triangles(), look_images_);
  });

  const ViewRays rays = airlight.rays();
  coarse_image_ = nullptr;
  samples_ = nullptr;
  if (rays.are_listed()) {
    samples_ = &epipolar_samples_.try_emplace(rays, rays).first->second;
    samples_->begin(context_.limits(), view);
  } else if (rays.where != Where::pixel) {
    coarse_image_ = &coarse_images_.try_emplace(rays.where, rays.where).first->second;
    timer.time("surfaces", [&] { coarse_image_->begin(view, *gbuffer_, scene, near); });
    camera_block_.bind_uniform(shaders::k_camera_block);
  }

  // What each light adds.
  lights_.clear();
  is_skipped_.clear();
  const bool sees_every_light = surface_shadow.sees_every_light() || airlight.sees_every_light();
  bool is_empty = true;
  for (std::size_t i = 0; i < view.lights.size(); ++i) {
    const scene::Light& light = view.lights[i];
    lights_.push_back(light.name);
    is_skipped_.push_back(!sees_every_light && !may_reach(view, light));
    if (is_skipped_[i]) {
      visibility_[i].clear();
      airlight_of(i).clear();
      continue;
    }
    timer.begin_part(i);
    resources_.begin_light(light, camera);
    const std::optional<ShadowPlane>& plane = resources_.shadow_plane();
    write_block(light_block_,
                light_block(light, camera.eye, resources_.light_near(), resources_.shadow_map_size(), plane),
                shaders::k_light_block);
    const auto inputs = [&](const scene::View& seen, const gpu::Texture& surfaces) {
      return FrameInputs{.context = context_,
                         .view = seen,
                         .light_index = i,
                         .scene = scene,
                         .triangles = gbuffer_->triangles(),
                         .surfaces = surfaces,
                         .resources = resources_,
                         .timer = timer};
    };
    const FrameInputs of_pixels = inputs(view, gbuffer_->surfaces());
    surface_shadow.query(of_pixels, visibility_[i]);  // times its own stages, and so does airlight
    if (coarse_image_) {
      coarse_image_->bind_camera();
      airlight.integrate(inputs(coarse_image_->view(), coarse_image_->surfaces()), coarse_image_->airlight());
      camera_block_.bind_uniform(shaders::k_camera_block);
      timer.time("upsample", [&] { coarse_image_->upsample(gbuffer_->surfaces(), airlight_of(i)); });
    } else if (samples_) {
      timer.time("rays", [&] { samples_->list_rays(light, *gbuffer_, scene); });
      FrameInputs of_list = of_pixels;
      of_list.listed.emplace(samples_->listed());
      airlight.integrate(of_list, samples_->airlight());
      timer.time("upsample", [&] { samples_->upsample(gbuffer_->surfaces(), airlight_of(i)); });
    } else {
      airlight.integrate(of_pixels, airlight_of(i));
    }
    timer.time("composite", [&] { composite(i, !is_empty); });
    is_empty = false;
  }
  if (is_empty) {
    radiance_.clear();
    airlight_.clear();
  }
  timer.begin_part({});
  if (view.surroundings != scene::Surroundings{})
    timer.time("composite", [&] { add_surroundings(view.surroundings); });
  context_.check();
}

void Frame::add_surroundings(const scene::Surroundings& surroundings) {
  const Looks* looks = resources_.scene().looks();
  const bool has_textures = looks && looks->has_textures();
  if (!surroundings_)
    surroundings_.emplace(k_surroundings_frag, std::array{gpu::Constant(1, has_textures)}, gpu::Blend::add);
  resources_.scene().bind_samplers();
  gbuffer_->triangles().bind_sampler(shaders::k_triangle_unit);
  gbuffer_->surfaces().bind_sampler(shaders::k_surface_unit);
  if (has_textures) look_images_.base_colours.bind_sampler(shaders::k_base_colour_unit);
  surroundings_->pipeline().set(0, surroundings.ambient);
  surroundings_->pipeline().set(1, surroundings.background);
  surroundings_->run({radiance_});
}

void Frame::composite(std::size_t light, bool adds) {
  const gpu::Texture* light_texture = resources_.light_texture();
  const bool is_textured = light_texture != nullptr;
  const Looks* looks = resources_.scene().looks();
  const bool has_textures = looks && looks->has_textures(), has_normals = looks && looks->has_normals();
  const bool glows = visibility_[light].format() != gpu::Format::r32f;
  auto& pass = composite_[{is_textured, adds, glows}];
  if (!pass) {
    pass.emplace(k_composite_frag,
                 std::array{gpu::Constant(0, is_textured), gpu::Constant(1, has_textures),
                            gpu::Constant(2, has_normals), gpu::Constant(3, glows)},
                 adds ? gpu::Blend::add : gpu::Blend::replace);
  }
  resources_.scene().bind_samplers();
  gbuffer_->triangles().bind_sampler(shaders::k_triangle_unit);
  gbuffer_->surfaces().bind_sampler(shaders::k_surface_unit);
  visibility_[light].bind_sampler(shaders::k_visibility_unit);
  airlight_of(light).bind_sampler(shaders::k_airlight_unit);
  if (light_texture) light_texture->bind_sampler(shaders::k_light_texture_unit);
  if (has_textures) look_images_.base_colours.bind_sampler(shaders::k_base_colour_unit);
  if (has_normals) look_images_.shading_normals.bind_sampler(shaders::k_shading_normal_unit);
  if (airlight_of_light_.empty()) {
    pass->run({radiance_});
  } else {
    pass->run({radiance_, airlight_});
  }
}

std::map<std::string, std::int64_t> Frame::bytes() const {
  std::map<std::string, std::int64_t> bytes = resources_.bytes();
  if (coarse_image_) bytes["coarse_image"] = coarse_image_->bytes();
  if (samples_) bytes["epipolar_samples"] = samples_->bytes();
  return bytes;
}

FrameImages Frame::read() const {
  FrameImages images;
  images.size = radiance_.size();
  images.radiance = read_rgb(radiance_, "radiance");
  images.airlight = read_rgb(airlight_, "airlight");
  images.lights = lights_;
  images.is_skipped = is_skipped_;
  for (const gpu::Texture& texture : airlight_of_light_)
    images.airlight_of_light.push_back(read_rgb(texture, "airlight"));
  images.distance = read_distance(gbuffer_->surfaces());
  for (const gpu::Texture& texture : visibility_) read_visibility(texture, images);
  context_.check();
  return images;
}

FrameImages Frame::take() {
  FrameImages images;
  images.size = radiance_.size();
  // Drivers keep what is bound, until something runs without it.
  gpu::unbind_textures();
  gpu::Pipeline::compute(k_idle_comp).dispatch({1, 1, 1});
  const gpu::Texture texel(gpu::Format::r32f, {1, 1});
  ScreenPass(k_idle_frag).run({texel});
  // What frees the most goes first.
  images.distance = read_distance(gbuffer_->surfaces());
  gbuffer_.reset();
  look_images_ = {};
  coarse_image_ = nullptr;
  coarse_images_.clear();
  samples_ = nullptr;
  epipolar_samples_.clear();
  images.lights = lights_;
  images.is_skipped = is_skipped_;
  for (gpu::Texture& texture : airlight_of_light_) {
    images.airlight_of_light.push_back(read_rgb(texture, "airlight"));
    texture = {};
  }
  for (gpu::Texture& texture : visibility_) {
    read_visibility(texture, images);
    texture = {};
  }
  images.radiance = read_rgb(radiance_, "radiance");
  radiance_ = {};
  images.airlight = read_rgb(airlight_, "airlight");
  airlight_ = {};
  context_.check();
  return images;
}

}  // namespace airlight::frame
