#include "frame/scene_buffers.h"

#include "frame/blocks.h"

#include <algorithm>
#include <atomic>

#include <epoxy/gl.h>

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

}  // namespace

SceneBuffers::SceneBuffers(const gpu::Context& context, const scene::Geometry& geometry)
    : geometry_(&geometry),
      id_(next_id()),
      box_(scene::bounds(geometry)),
      clusters_(make_clusters(geometry)) {
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

  if (Looks::are_in(geometry)) looks_.emplace(context, geometry, clusters_.order);

  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  vertex_array_ = gpu::Handle<gpu::delete_vertex_array>(name);
  glVertexArrayElementBuffer(name, triangles_.name());
  glVertexArrayVertexBuffer(name, 0, positions_.name(), 0, sizeof(glm::vec3));
  glVertexArrayAttribFormat(name, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(name, 0, 0);
  glEnableVertexArrayAttrib(name, 0);
  glVertexArrayVertexBuffer(name, 1, first_triangles_.name(), 0, sizeof(std::uint32_t));
  glVertexArrayAttribIFormat(name, 1, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(name, 1, 1);
  glVertexArrayBindingDivisor(name, 1, 1);  // one value a draw, picked by its base instance
  glEnableVertexArrayAttrib(name, 1);
}

void SceneBuffers::bind_samplers() const {
  position_texels_.bind_sampler(shaders::k_positions_unit);
  triangle_texels_.bind_sampler(shaders::k_triangles_unit);
  albedo_texels_.bind_sampler(shaders::k_albedos_unit);
  material_texels_.bind_sampler(shaders::k_materials_unit);
}

void SceneBuffers::draw_triangles(std::uint32_t first, std::uint32_t end) const {
  if (first == end) return;
  const auto offset = static_cast<std::uintptr_t>(first) * sizeof(glm::uvec3);
  glDisableVertexArrayAttrib(vertex_array_.get(), 1);
  glVertexAttribI1ui(1, first);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * (end - first)), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(offset));
  glEnableVertexArrayAttrib(vertex_array_.get(), 1);
}

void SceneBuffers::draw(const Pyramid& pyramid, std::span<const std::uint32_t> left_out) const {
  draw([&](const scene::Box& box) { return may_touch(pyramid, box); }, left_out);
}

void SceneBuffers::draw(const std::function<bool(const scene::Box&)>& may_touch,
                        std::span<const std::uint32_t> left_out) const {
  glBindVertexArray(vertex_array_.get());
  const auto& clusters = clusters_.clusters;
  for (std::size_t i = 0; i < clusters.size();) {
    if (!may_touch(clusters[i].box)) {
      ++i;
      continue;
    }
    const std::size_t first = i;
    std::uint32_t triangles = 0;
    for (; i < clusters.size() && may_touch(clusters[i].box); ++i) triangles += clusters[i].triangle_count;
    std::uint32_t begin = clusters[first].first_triangle;
    const std::uint32_t end = begin + triangles;
    const auto skipped = std::lower_bound(left_out.begin(), left_out.end(), begin);
    if (skipped != left_out.end() && *skipped < end) {
      for (auto hole = skipped; hole != left_out.end() && *hole < end; ++hole) {
        draw_triangles(begin, *hole);
        begin = *hole + 1;
      }
      draw_triangles(begin, end);
      continue;
    }
    const auto offset = static_cast<std::uintptr_t>(begin) * sizeof(glm::uvec3);
    glDrawElementsInstancedBaseInstance(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles), GL_UNSIGNED_INT,
                                        reinterpret_cast<const void*>(offset), 1, static_cast<GLuint>(first));
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
         (looks_ ? looks_->bytes() : 0);
}

}  // namespace airlight::frame
