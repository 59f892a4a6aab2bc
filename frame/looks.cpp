#include "frame/looks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
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

Looks::Looks(const gpu::Context& context, const scene::Geometry& geometry,
             std::span<const std::uint32_t> order)
    : has_textures_(!geometry.textures.empty()),
      has_normals_(!geometry.normals.empty()),
      pass_(k_looks_frag, std::array{gpu::Constant(0, has_textures_), gpu::Constant(1, has_normals_)}) {
  if (has_textures_) {
    texels_ = store(context, geometry.textures);
    std::vector<std::uint32_t> first_texels;
    std::uint64_t first = 0;
    for (const scene::TextureImage& texture : geometry.textures) {
      first_texels.push_back(static_cast<std::uint32_t>(first));
      first += texels_with_levels(texture.size);
    }
    std::vector<glm::uvec4> of_materials;
    for (const scene::Material& material : geometry.materials) {
      const auto add = [&](std::optional<std::uint32_t> texture, float least_alpha) {
        glm::uvec4& info = of_materials.emplace_back(0u);
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
    std::vector<std::array<glm::vec2, 3>> places;
    places.reserve(order.size());
    for (const std::uint32_t triangle : order) places.push_back(geometry.texture_places[triangle]);
    material_textures_ = gpu::Buffer::from(std::span<const glm::uvec4>(of_materials));
    texture_places_ = gpu::Buffer::from(std::span<const std::array<glm::vec2, 3>>(places));
    material_texture_texels_ = {context.limits(), material_textures_, gpu::Format::rgba32ui,
                                "the model's materials"};
    texture_place_texels_ = {context.limits(), texture_places_, gpu::Format::rg32f,
                             "the model's texture coordinates"};
  }
  if (has_normals_) {
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
}

void Looks::draw(const SceneBuffers& scene, const gpu::Texture& triangles, LookImages& images) const {
  for (gpu::Texture* image : {&images.base_colours, &images.shading_normals})
    if (image->size() != triangles.size()) *image = gpu::Texture(gpu::Format::rgba16f, triangles.size());
  scene.bind_samplers();
  triangles.bind_sampler(shaders::k_triangle_unit);
  bind_textures();
  if (has_textures_) texture_place_texels_.bind_sampler(shaders::k_texture_places_unit);
  if (has_normals_) normal_texels_.bind_sampler(shaders::k_normals_unit);
  pass_.run({images.base_colours, images.shading_normals});
}

void Looks::bind_textures() const {
  if (!has_textures_) return;
  texels_.bind_sampler(shaders::k_texels_unit);
  material_texture_texels_.bind_sampler(shaders::k_material_textures_unit);
}

std::int64_t Looks::bytes() const {
  return (has_textures_ ? texels_.bytes() : 0) + material_textures_.bytes() + texture_places_.bytes() +
         normals_.bytes();
}

}  // namespace airlight::frame
