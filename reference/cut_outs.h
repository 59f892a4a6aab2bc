#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace airlight::reference {

/// Where of triangles there is a surface, as their materials' textures say (scene::CutOut): by the texels of
/// their finest level, between four of which alpha is bilinear.
class CutOuts {
 public:
  CutOuts() = default;

  /// What it needs is copied.
  /// @throws scene::Error (bad file) where a texture lies too often on a triangle
  explicit CutOuts(const scene::Geometry& geometry);

  /// Of a triangle; no other one is asked for below.
  bool has(std::uint32_t triangle) const { return !places_.empty() && mask_of_triangle_[triangle] != k_none; }
  bool empty() const { return places_.empty(); }

  /// @param weights of the triangle's corners, of sum 1
  bool is_there(std::uint32_t triangle, const glm::dvec3& weights) const;

  /// From where to where along a segment, as parts of its length.
  struct Part {
    double from, to;
  };
  /// The parts of a segment in a triangle where there is a surface, in their order, disjoint. Between four
  /// texels alpha along a segment is quadratic, so that its edges are found without steps.
  /// @param from, to weights of its ends
  void find_parts(std::uint32_t triangle, const glm::dvec3& from, const glm::dvec3& to,
                  std::vector<Part>& parts) const;

 private:
  static constexpr std::uint32_t k_none = ~0u;
  struct Mask {
    glm::ivec2 size;
    std::array<scene::TextureWrap, 2> wrap;
    double least;                      ///< of alpha, as of `alphas`
    std::vector<std::uint8_t> alphas;  ///< row 0 at the top

    double alpha(std::int64_t column, std::int64_t row) const;
  };
  /// The four texels between whose middles a place lies, by the first's column and row.
  struct Cell;

  /// In texels, from the middle of the first one.
  glm::dvec2 place(std::uint32_t triangle, const glm::dvec3& weights) const;

  std::vector<Mask> masks_;                      ///< of materials that have one
  std::vector<std::uint32_t> mask_of_triangle_;  ///< k_none of those that are whole
  std::vector<std::array<glm::vec2, 3>> places_;
};

}  // namespace airlight::reference
