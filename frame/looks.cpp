#include "frame/looks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "frame/blocks.h"
#include "frame/scene_buffers.h"
#include "frame/texture_levels.h"
#include "scene/error.h"

#include "spirv/frame/looks_frag.h"

namespace airlight::shaders {
#include "frame/octahedron.glsl"
#include "frame/texture_filter.glsl"
}  // namespace airlight::shaders

namespace airlight::frame {
namespace {

constexpr std::uint64_t k_row = shaders::k_store_side;
constexpr std::uint64_t k_image = k_row * k_row;

std::uint64_t texels_with_levels(glm::ivec2 size) {
  const int last = shaders::last_level(size);
  const shaders::TextureLevel level = shaders::texture_level(0, size, last);
  return std::uint64_t{level.first} + 1;
}

/// The textures with their levels, one after the other.
gpu::Texture store(const gpu::Context& context, std::span<const scene::TextureImage> textures) {
  std::uint64_t texels = 0;
  for (const scene::TextureImage& texture : textures) texels += texels_with_levels(texture.size);
  const std::uint64_t images = (texels + k_image - 1) / k_image;
  const auto most = std::min<std::uint64_t>(static_cast<std::uint64_t>(context.limits().max_array_layers),
                                            (std::uint64_t{1} << 32) / k_image);
  if (images > most)
    throw scene::Error(scene::ExitCode::driver, "the model's textures",
                       fmt::format("{} texels are more than this driver's {} (GL_MAX_ARRAY_TEXTURE_LAYERS)",
                                   texels, most * k_image),
                       "show the model by --looks flat");
  const std::uint64_t rows = std::min((texels + k_row - 1) / k_row, k_row);
  std::vector<glm::u8vec4> values;
  values.reserve(images * rows * k_row);
  for (const scene::TextureImage& texture : textures) {
    values.insert(values.end(), texture.texels.begin(), texture.texels.end());
    scene::TextureImage level;
    const scene::TextureImage* finer = &texture;
    for (; std::max(finer->size.x, finer->size.y) > 1; finer = &level) {
      level = next_level(*finer);
      values.insert(values.end(), level.texels.begin(), level.texels.end());
    }
  }
  values.resize(images * rows * k_row);
  gpu::Texture texture = gpu::Texture::array(
      gpu::Format::srgb8_alpha8, {static_cast<int>(k_row), static_cast<int>(rows)}, static_cast<int>(images));
  texture.write(values.data());
  return texture;
}

}  // namespace

Looks::Textures::Textures(const gpu::Context& context, const scene::Geometry& geometry,
                          std::span<const std::uint32_t> order) {
  texels = store(context, geometry.textures);
  std::vector<std::uint32_t> first_texels;
  std::uint64_t first = 0;
  for (const scene::TextureImage& texture : geometry.textures) {
    first_texels.push_back(static_cast<std::uint32_t>(first));
    first += texels_with_levels(texture.size);
  }
  std::vector<glm::uvec4> infos;
  for (const scene::Material& material : geometry.materials) {
    const auto add = [&](std::optional<std::uint32_t> texture, float least_alpha) {
      glm::uvec4& info = infos.emplace_back(0u);
      if (!texture) return;
      const glm::uvec2 size(geometry.textures[*texture].size);
      info = {first_texels[*texture], size.x | size.y << 16,
              static_cast<std::uint32_t>(material.wrap[0]) | static_cast<std::uint32_t>(material.wrap[1])
                                                                 << 4,
              std::bit_cast<std::uint32_t>(least_alpha)};
    };
    add(material.texture, 0.0f);
    if (const std::optional<scene::CutOut>& mask = material.cut_out)
      add(mask->texture, mask->least_alpha);
    else
      add({}, 0.0f);
  }
  std::vector<std::array<glm::vec2, 3>> texture_places;
  texture_places.reserve(order.size());
  for (const std::uint32_t triangle : order) texture_places.push_back(geometry.texture_places[triangle]);
  of_materials = gpu::Buffer::from(std::span<const glm::uvec4>(infos));
  places = gpu::Buffer::from(std::span<const std::array<glm::vec2, 3>>(texture_places));
  of_material_texels = {context.limits(), of_materials, gpu::Format::rgba32ui, "the model's materials"};
  place_texels = {context.limits(), places, gpu::Format::rg32f, "the model's texture coordinates"};
}

Looks::Looks(const gpu::Context& context, const scene::Geometry& geometry,
             std::span<const std::uint32_t> order)
    : Looks(context, geometry, order,
            geometry.textures.empty() ? nullptr : std::make_shared<const Textures>(context, geometry, order),
            std::make_shared<const ScreenPass>(k_looks_frag,
                                               std::array{gpu::Constant(0, !geometry.textures.empty()),
                                                          gpu::Constant(1, !geometry.normals.empty())})) {}

Looks::Looks(const gpu::Context& context, const scene::Geometry& posed, std::span<const std::uint32_t> order,
             const Looks& at_rest)
    : Looks(context, posed, order, at_rest.textures_, at_rest.pass_) {
  owns_textures_ = false;
}

Looks::Looks(const gpu::Context& context, const scene::Geometry& geometry,
             std::span<const std::uint32_t> order, std::shared_ptr<const Textures> textures,
             std::shared_ptr<const ScreenPass> pass)
    : textures_(std::move(textures)), has_normals_(!geometry.normals.empty()), pass_(std::move(pass)) {
  if (!has_normals_) return;
  std::vector<glm::uvec3> normals;
  normals.reserve(order.size());
  for (const std::uint32_t triangle : order) {
    const std::array<glm::vec3, 3>& n = geometry.normals[triangle];
    normals.emplace_back(shaders::octahedron_of(n[0]), shaders::octahedron_of(n[1]),
                         shaders::octahedron_of(n[2]));
  }
  normals_ = gpu::Buffer::from(std::span<const glm::uvec3>(normals));
  normal_texels_ = {context.limits(), normals_, gpu::Format::rgb32ui, "the model's normals"};
}

void Looks::draw(const SceneBuffers& scene, const gpu::Texture& triangles, LookImages& images) const {
  for (gpu::Texture* image : {&images.base_colours, &images.shading_normals})
    if (image->size() != triangles.size()) *image = gpu::Texture(gpu::Format::rgba16f, triangles.size());
  scene.bind_samplers();
  triangles.bind_sampler(shaders::k_triangle_unit);
  bind_textures();
  if (textures_) textures_->place_texels.bind_sampler(shaders::k_texture_places_unit);
  if (has_normals_) normal_texels_.bind_sampler(shaders::k_normals_unit);
  pass_->run({images.base_colours, images.shading_normals});
}

void Looks::bind_textures() const {
  if (!textures_) return;
  textures_->texels.bind_sampler(shaders::k_texels_unit);
  textures_->of_material_texels.bind_sampler(shaders::k_material_textures_unit);
}

std::int64_t Looks::bytes() const {
  return (textures_ && owns_textures_
              ? textures_->texels.bytes() + textures_->of_materials.bytes() + textures_->places.bytes()
              : 0) +
         normals_.bytes();
}

}  // namespace airlight::frame
