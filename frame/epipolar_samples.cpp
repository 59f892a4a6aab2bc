#include "frame/epipolar_samples.h"

#include <cmath>

#include "frame/blocks.h"

#include "spirv/frame/epipolar_upsample_frag.h"
#include "spirv/frame/list_pixels_comp.h"
#include "spirv/frame/list_samples_comp.h"
#include "spirv/frame/listed_surfaces_frag.h"
#include "spirv/frame/sample_airlight_frag.h"
#include "spirv/frame/sample_depths_frag.h"

namespace airlight::frame {
namespace {

/// What is listed together: shaders/frame/ray_list_block.glsl.
constexpr int k_group = 16;

/// Every so many samples of a slice are marked, whatever they see: the paper's. What a light's own shape does
/// along a slice no depth tells.
std::uint32_t step_of(const scene::Light& light) {
  return light.cone || light.texture || light.range ? 4 : 16;
}

}  // namespace

EpipolarSamples::Programs::Programs()
    : sample_depths(k_sample_depths_frag),
      surfaces(k_listed_surfaces_frag, {}, gpu::Blend::replace, Texels::listed),
      sample_airlight(k_sample_airlight_frag),
      upsample(k_epipolar_upsample_frag),
      list_samples(gpu::Pipeline::compute(k_list_samples_comp)),
      list_pixels(gpu::Pipeline::compute(k_list_pixels_comp)) {}

void EpipolarSamples::begin(const gpu::Limits& limits, const scene::View& view) {
  if (size_ != view.size) {
    size_ = view.size;
    const std::int64_t samples = std::int64_t{rays_.slices} * rays_.samples;
    const std::int64_t most = samples + std::int64_t{size_.x} * size_.y;
    // A square, which no driver's limit of textures' sides is too small for.
    const auto side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(most))));
    const glm::ivec2 of_list(4 * ((side + 3) / 4));
    const glm::ivec2 of_slices(rays_.samples, rays_.slices);
    const glm::ivec2 squares = (size_ + 3) / 4;
    most_ = static_cast<std::uint32_t>(most);
    sample_depths_ = gpu::Texture(gpu::Format::rg32f, of_slices);
    sample_airlight_ = gpu::Texture(gpu::Format::rgba32f, of_slices);
    places_ = gpu::Texture(gpu::Format::rg32f, of_list);
    surfaces_ = gpu::Texture(gpu::Format::rgba32f, of_list);
    ray_airlight_ = gpu::Texture(gpu::Format::rgba32f, of_list);
    list_ = gpu::Buffer(sizeof(shaders::RayListBlock));
    members_ = gpu::Buffer(most * 4);
    groups_ = gpu::Buffer((samples / k_group + std::int64_t{squares.x} * squares.y) *
                          static_cast<std::int64_t>(sizeof(shaders::RayGroup)));
    member_texels_ = gpu::TexelView(limits, members_, gpu::Format::r32ui, "the list of view rays");
    group_texels_ = gpu::TexelView(limits, groups_, gpu::Format::r32ui, "the list of view rays");
  }
}

void EpipolarSamples::list_rays(const scene::Light& light, const GBuffer& gbuffer,
                                const SceneBuffers& scene) {
  shaders::RayListBlock block{};
  block.width = static_cast<std::uint32_t>(places_.size().x);
  block.height = static_cast<std::uint32_t>(places_.size().y);
  block.slices = static_cast<std::uint32_t>(rays_.slices);
  block.samples = static_cast<std::uint32_t>(rays_.samples);
  block.step = step_of(light);
  list_.write(&block, sizeof block);
  list_.bind_uniform(shaders::k_rays_block);

  // What samples see.
  gbuffer.surfaces().bind_sampler(shaders::k_surface_unit);
  programs_.sample_depths.run({sample_depths_});

  // Which samples and which pixels are asked.
  list_.bind_storage(shaders::k_ray_list_storage);
  members_.bind_storage(shaders::k_ray_members_storage);
  groups_.bind_storage(shaders::k_ray_groups_storage);
  sample_depths_.bind_sampler(shaders::k_sample_depths_unit);
  const glm::uvec2 squares = (size_ + 3) / 4;
  programs_.list_samples.dispatch({block.slices * block.samples / k_group, 1, 1});
  programs_.list_pixels.dispatch({squares, 1});

  // Where they pass through the image, and what they see.
  scene.bind_samplers();
  gbuffer.triangles().bind_sampler(shaders::k_triangle_unit);
  member_texels_.bind_sampler(shaders::k_ray_members_unit);
  programs_.surfaces.run({places_, surfaces_});
  places_.bind_sampler(shaders::k_places_unit);
}

void EpipolarSamples::upsample(const gpu::Texture& surfaces, const gpu::Texture& airlight) const {
  surfaces.bind_sampler(shaders::k_surface_unit);
  ray_airlight_.bind_sampler(shaders::k_airlight_unit);
  sample_depths_.bind_sampler(shaders::k_sample_depths_unit);
  group_texels_.bind_sampler(shaders::k_ray_groups_unit);
  programs_.sample_airlight.run({sample_airlight_});
  sample_airlight_.bind_sampler(shaders::k_sample_airlight_unit);
  programs_.upsample.run({airlight});
}

std::uint32_t ListedRays::count() const {
  return list.read<shaders::RayListBlock>().at(0).count;
}

std::int64_t EpipolarSamples::bytes() const {
  return sample_depths_.bytes() + sample_airlight_.bytes() + places_.bytes() + surfaces_.bytes() +
         ray_airlight_.bytes() + list_.bytes() + members_.bytes() + groups_.bytes();
}

}  // namespace airlight::frame
