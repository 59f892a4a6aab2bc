#include "reference/cut_outs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scene/error.h"

namespace airlight::reference {

namespace {

/// How many texels of a mask a triangle may reach across, or reach to from its first one: farther, places in
/// single precision tell no texels apart.
constexpr double k_most_texels = 0x1p24;

/// The number of a texel that an image shows beyond its sides.
std::int64_t wrapped(std::int64_t texel, std::int64_t n, scene::TextureWrap wrap) {
  if (wrap == scene::TextureWrap::clamp) return std::clamp<std::int64_t>(texel, 0, n - 1);
  const std::int64_t period = wrap == scene::TextureWrap::mirror ? 2 * n : n;
  const std::int64_t inside = ((texel % period) + period) % period;
  return inside < n ? inside : 2 * n - 1 - inside;
}

}  // namespace

double CutOuts::Mask::alpha(std::int64_t column, std::int64_t row) const {
  const auto x = static_cast<std::size_t>(wrapped(column, size.x, wrap[0]));
  const auto y = static_cast<std::size_t>(wrapped(row, size.y, wrap[1]));
  return alphas[y * static_cast<std::size_t>(size.x) + x];
}

struct CutOuts::Cell {
  glm::dvec2 first;
  std::array<double, 4>
      excess;  ///< of alpha over the least one: upper left, upper right, lower left, lower right

  Cell(const Mask& mask, const glm::dvec2& place) : first(glm::floor(place)) {
    const auto column = static_cast<std::int64_t>(first.x), row = static_cast<std::int64_t>(first.y);
    excess = {mask.alpha(column, row) - mask.least, mask.alpha(column + 1, row) - mask.least,
              mask.alpha(column, row + 1) - mask.least, mask.alpha(column + 1, row + 1) - mask.least};
  }

  bool is_whole() const {
    return std::all_of(excess.begin(), excess.end(), [](double e) { return e >= 0.0; });
  }
  bool is_empty() const {
    return std::all_of(excess.begin(), excess.end(), [](double e) { return e < 0.0; });
  }

  double at(const glm::dvec2& place) const {
    const glm::dvec2 weight = place - first;
    return (1.0 - weight.y) * ((1.0 - weight.x) * excess[0] + weight.x * excess[1]) +
           weight.y * ((1.0 - weight.x) * excess[2] + weight.x * excess[3]);
  }

  /// Where the excess is 0 along from + s·way, 0 < s < 1: at most two, sorted.
  struct Roots {
    std::array<double, 2> s;
    std::size_t count = 0;
  };
  Roots zeros(const glm::dvec2& from, const glm::dvec2& way) const {
    const glm::dvec2 weight = from - first;
    const double right = excess[1] - excess[0], down = excess[2] - excess[0],
                 twist = excess[3] - excess[2] - right;
    // a s² + 2 b s + c
    const double a = twist * way.x * way.y;
    const double b = 0.5 * (way.x * (right + twist * weight.y) + way.y * (down + twist * weight.x));
    const double c = at(from);
    Roots roots;
    const auto add = [&](double s) {
      if (s > 0.0 && s < 1.0) roots.s[roots.count++] = s;
    };
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) return roots;
    const double sum = -(b + std::copysign(std::sqrt(discriminant), b));
    if (sum != 0.0) add(c / sum);
    if (a != 0.0) add(sum / a);
    if (roots.count == 2 && roots.s[0] > roots.s[1]) std::swap(roots.s[0], roots.s[1]);
    return roots;
  }
};

CutOuts::CutOuts(const scene::Geometry& geometry) {
  if (!scene::has_cut_outs(geometry)) return;
  std::vector<std::uint32_t> mask_of_material;
  for (const scene::Material& material : geometry.materials) {
    mask_of_material.push_back(material.cut_out ? static_cast<std::uint32_t>(masks_.size()) : k_none);
    if (!material.cut_out) continue;
    const scene::TextureImage& image = geometry.textures[material.cut_out->texture];
    Mask& mask = masks_.emplace_back(
        Mask{image.size, material.wrap, 255.0 * static_cast<double>(material.cut_out->least_alpha), {}});
    mask.alphas.reserve(image.texels.size());
    for (const glm::u8vec4& texel : image.texels) mask.alphas.push_back(texel.a);
  }
  places_ = geometry.texture_places;
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const std::uint32_t of_triangle =
        mask_of_triangle_.emplace_back(mask_of_material[geometry.material_of_triangle[i]]);
    if (of_triangle == k_none) continue;
    const auto& [a, b, c] = places_[i];
    const glm::dvec2 farthest = glm::dvec2(glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c))) *
                                glm::dvec2(masks_[of_triangle].size);
    if (const double texels = std::max(farthest.x, farthest.y); texels > k_most_texels)
      throw scene::Error(scene::ExitCode::bad_file, "the model's cut-outs",
                         fmt::format("a triangle lies {:g} texels from the first one of its mask: the limit "
                                     "is {:g}",
                                     texels, k_most_texels),
                         "repeat the texture less often, or show the model by --looks flat");
  }
}

glm::dvec2 CutOuts::place(std::uint32_t triangle, const glm::dvec3& weights) const {
  const auto& [a, b, c] = places_[triangle];
  return (weights.x * glm::dvec2(a) + weights.y * glm::dvec2(b) + weights.z * glm::dvec2(c)) *
             glm::dvec2(masks_[mask_of_triangle_[triangle]].size) -
         0.5;
}

bool CutOuts::is_there(std::uint32_t triangle, const glm::dvec3& weights) const {
  const glm::dvec2 at = place(triangle, weights);
  return Cell(masks_[mask_of_triangle_[triangle]], at).at(at) >= 0.0;
}

void CutOuts::find_parts(std::uint32_t triangle, const glm::dvec3& from, const glm::dvec3& to,
                         std::vector<Part>& parts) const {
  parts.clear();
  const Mask& mask = masks_[mask_of_triangle_[triangle]];
  const glm::dvec2 begin = place(triangle, from), way = place(triangle, to) - begin;
  const auto add = [&](double first, double last) {
    if (first >= last) return;
    if (!parts.empty() && parts.back().to == first)
      parts.back().to = last;
    else
      parts.push_back({first, last});
  };

  // From one line between texels' middles to the next: where each axis meets its next one.
  const auto next_of = [&](int axis, double line) {
    return way[axis] == 0.0 ? 2.0 : std::max((line - begin[axis]) / way[axis], 0.0);
  };
  glm::dvec2 line, next;
  for (int axis = 0; axis < 2; ++axis) {
    line[axis] = way[axis] > 0.0 ? std::floor(begin[axis]) + 1.0 : std::ceil(begin[axis]) - 1.0;
    next[axis] = next_of(axis, line[axis]);
  }
  for (double at = 0.0; at < 1.0;) {
    const double end = std::min({next.x, next.y, 1.0});
    const glm::dvec2 first = begin + at * way, last = begin + end * way;
    const Cell cell(mask, 0.5 * (first + last));
    if (cell.is_whole()) {
      add(at, end);
    } else if (!cell.is_empty()) {
      // Between zeros, the middle tells.
      const auto zeros = cell.zeros(first, last - first);
      double start = 0.0;
      for (std::size_t i = 0; i <= zeros.count; ++i) {
        const double stop = i < zeros.count ? zeros.s[i] : 1.0;
        if (cell.at(first + 0.5 * (start + stop) * (last - first)) >= 0.0)
          add(start == 0.0 ? at : at + start * (end - at), stop == 1.0 ? end : at + stop * (end - at));
        start = stop;
      }
    }
    for (int axis = 0; axis < 2; ++axis) {
      if (next[axis] > end) continue;
      line[axis] += way[axis] > 0.0 ? 1.0 : -1.0;
      next[axis] = next_of(axis, line[axis]);
    }
    at = end;
  }
}

}  // namespace airlight::reference
