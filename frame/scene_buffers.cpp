#include "frame/scene_buffers.h"

#include "frame/blocks.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include <epoxy/gl.h>

#include "scene/transmission.h"

namespace airlight::frame {
namespace {

template <typename T>
gpu::Buffer upload(const std::vector<T>& values) {
  return gpu::Buffer::from(std::span<const T>(values));
}

std::uint64_t next_id() {
  static std::atomic<std::uint64_t> next = 1;
  return next++;
}

Clusters fitted(Clusters clusters, const scene::Geometry& geometry) {
  fit_boxes(clusters, geometry);
  return clusters;
}

}  // namespace

SceneBuffers::SceneBuffers(const gpu::Context& context, const scene::Geometry& geometry)
    : SceneBuffers(context, geometry, make_clusters(geometry), nullptr) {}

SceneBuffers::SceneBuffers(const gpu::Context& context, const scene::Geometry& posed,
                           const SceneBuffers& at_rest)
    : SceneBuffers(context, posed, fitted(at_rest.clusters_, posed), &at_rest) {}

SceneBuffers::SceneBuffers(const gpu::Context& context, const scene::Geometry& geometry, Clusters clusters,
                           const SceneBuffers* at_rest)
    : geometry_(&geometry),
      id_(next_id()),
      id_at_rest_(at_rest ? at_rest->id_at_rest_ : id_),
      box_(scene::bounds(geometry)),
      clusters_(std::move(clusters)) {
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> materials;
  triangles.reserve(clusters_.order.size());
  materials.reserve(clusters_.order.size());
  for (const std::uint32_t triangle : clusters_.order) {
    triangles.push_back(geometry.triangles[triangle]);
    materials.push_back(geometry.material_of_triangle[triangle]);
  }
  std::vector<glm::vec4> albedos;
  for (const scene::Material& material : geometry.materials) albedos.emplace_back(material.albedo, 0.0f);
  std::vector<std::uint32_t> first_triangles;
  for (const Cluster& cluster : clusters_.clusters) first_triangles.push_back(cluster.first_triangle);

  positions_ = upload(geometry.positions);
  triangles_ = upload(triangles);
  albedos_ = upload(albedos);
  material_of_triangle_ = upload(materials);
  first_triangles_ = upload(first_triangles);
  position_texels_ = {context.limits(), positions_, gpu::Format::rgb32f, "the model's vertices"};
  triangle_texels_ = {context.limits(), triangles_, gpu::Format::rgb32ui, "the model's triangles"};
  albedo_texels_ = {context.limits(), albedos_, gpu::Format::rgba32f, "the model's materials"};
  material_texels_ = {context.limits(), material_of_triangle_, gpu::Format::r32ui, "the model's triangles"};

  if (at_rest && at_rest->looks_)
    looks_.emplace(context, geometry, clusters_.order, *at_rest->looks_);
  else if (Looks::are_in(geometry))
    looks_.emplace(context, geometry, clusters_.order);

  if (has_cut_outs()) {
    std::vector<glm::vec3> positions;
    positions.reserve(3 * std::size_t{triangle_count() - clusters_.first_cut_out});
    for (std::uint32_t i = clusters_.first_cut_out; i < triangle_count(); ++i)
      for (int corner = 0; corner < 3; ++corner)
        positions.push_back(geometry.positions[triangles[i][corner]]);
    cut_out_positions_ = upload(positions);
  }
  if (scene::transmits(geometry)) {
    const std::vector<scene::Attenuation> of_triangle = scene::attenuations_of(geometry);
    std::vector<scene::Attenuation> attenuations;
    attenuations.reserve(triangle_count());
    for (const std::uint32_t triangle : clusters_.order) attenuations.push_back(of_triangle[triangle]);
    attenuations_ = upload(attenuations);
    attenuation_texels_ = {context.limits(), attenuations_, gpu::Format::rgba32ui, "the model's triangles"};
  }
  make_vertex_arrays();
}

void SceneBuffers::make_vertex_arrays() {
  const auto make = [&](const gpu::Buffer& positions) {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    glVertexArrayVertexBuffer(name, 0, positions.name(), 0, sizeof(glm::vec3));
    glVertexArrayAttribFormat(name, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(name, 0, 0);
    glEnableVertexArrayAttrib(name, 0);
    glVertexArrayVertexBuffer(name, 1, first_triangles_.name(), 0, sizeof(std::uint32_t));
    glVertexArrayAttribIFormat(name, 1, 1, GL_UNSIGNED_INT, 0);
    glVertexArrayAttribBinding(name, 1, 1);
    glVertexArrayBindingDivisor(name, 1, 1);  // one value a draw, picked by its base instance
    glEnableVertexArrayAttrib(name, 1);
    return gpu::Handle<gpu::delete_vertex_array>(name);
  };
  vertex_array_ = make(positions_);
  glVertexArrayElementBuffer(vertex_array_.get(), triangles_.name());
  if (!has_cut_outs()) return;

  // Corners that triangles share may lie at several places of a texture: these are drawn without indices.
  cut_out_vertex_array_ = make(cut_out_positions_);
  const GLuint name = cut_out_vertex_array_.get();
  glVertexArrayVertexBuffer(name, 2, looks_->texture_places().name(),
                            static_cast<GLintptr>(clusters_.first_cut_out * sizeof(std::array<glm::vec2, 3>)),
                            sizeof(glm::vec2));
  glVertexArrayAttribFormat(name, 2, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(name, 2, 2);
  glEnableVertexArrayAttrib(name, 2);
}

void SceneBuffers::bind_samplers() const {
  position_texels_.bind_sampler(shaders::k_positions_unit);
  triangle_texels_.bind_sampler(shaders::k_triangles_unit);
  albedo_texels_.bind_sampler(shaders::k_albedos_unit);
  material_texels_.bind_sampler(shaders::k_materials_unit);
}

void SceneBuffers::draw_triangles(std::uint32_t first, std::uint32_t end, Drawn drawn,
                                  std::optional<std::size_t> cluster) const {
  if (first == end) return;
  const GLuint vertex_array = drawn == Drawn::cut_outs ? cut_out_vertex_array_.get() : vertex_array_.get();
  if (!cluster) {
    glDisableVertexArrayAttrib(vertex_array, 1);
    glVertexAttribI1ui(1, first);
  }
  const auto count = static_cast<GLsizei>(3 * (end - first));
  const auto instance = static_cast<GLuint>(cluster.value_or(0));
  if (drawn == Drawn::cut_outs) {
    const auto first_corner = static_cast<GLint>(3 * (first - clusters_.first_cut_out));
    glDrawArraysInstancedBaseInstance(GL_TRIANGLES, first_corner, count, 1, instance);
  } else {
    const auto offset = static_cast<std::uintptr_t>(first) * sizeof(glm::uvec3);
    glDrawElementsInstancedBaseInstance(GL_TRIANGLES, count, GL_UNSIGNED_INT,
                                        reinterpret_cast<const void*>(offset), 1, instance);
  }
  if (!cluster) glEnableVertexArrayAttrib(vertex_array, 1);
}

void SceneBuffers::draw(const Pyramid& pyramid, std::span<const std::uint32_t> left_out, Drawn drawn) const {
  draw([&](const scene::Box& box) { return may_touch(pyramid, box); }, left_out, drawn);
}

void SceneBuffers::draw(const std::function<bool(const scene::Box&)>& may_touch,
                        std::span<const std::uint32_t> left_out, Drawn drawn) const {
  if (drawn == Drawn::cut_outs) {
    if (!has_cut_outs()) return;
    bind_samplers();
    looks_->bind_textures();
  }
  glBindVertexArray(drawn == Drawn::cut_outs ? cut_out_vertex_array_.get() : vertex_array_.get());
  const auto& clusters = clusters_.clusters;
  const auto is_drawn = [&](const Cluster& cluster) {
    const bool is_cut_out = cluster.first_triangle >= clusters_.first_cut_out;
    return (drawn == Drawn::all || (drawn == Drawn::cut_outs) == is_cut_out) && may_touch(cluster.box);
  };
  for (std::size_t i = 0; i < clusters.size();) {
    if (!is_drawn(clusters[i])) {
      ++i;
      continue;
    }
    const std::size_t first = i;
    std::uint32_t triangles = 0;
    for (; i < clusters.size() && is_drawn(clusters[i]); ++i) triangles += clusters[i].triangle_count;
    std::uint32_t begin = clusters[first].first_triangle;
    const std::uint32_t end = begin + triangles;
    const auto skipped = std::lower_bound(left_out.begin(), left_out.end(), begin);
    if (skipped != left_out.end() && *skipped < end) {
      for (auto hole = skipped; hole != left_out.end() && *hole < end; ++hole) {
        draw_triangles(begin, *hole, drawn);
        begin = *hole + 1;
      }
      draw_triangles(begin, end, drawn);
      continue;
    }
    draw_triangles(begin, end, drawn, first);
  }
}

double SceneBuffers::distance_to(glm::dvec3 point) const {
  return distance_to_geometry(*geometry_, clusters_, point);
}

std::vector<std::uint32_t> SceneBuffers::triangles_at(glm::dvec3 apex, double eye_light_distance) const {
  return triangles_within(*geometry_, clusters_, apex, k_touch * eye_light_distance);
}

std::int64_t SceneBuffers::bytes() const {
  return positions_.bytes() + triangles_.bytes() + albedos_.bytes() + material_of_triangle_.bytes() +
         cut_out_positions_.bytes() + attenuations_.bytes() + (looks_ ? looks_->bytes() : 0);
}

}  // namespace airlight::frame
