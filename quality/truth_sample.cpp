#include "quality/truth_sample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "quality/metrics.h"
#include "reference/reference.h"

namespace airlight::quality {
namespace {

constexpr int k_tile = reference::Reference::k_tile;
/// What tiles in which the images are alike are given of the mean.
constexpr double k_least_part = 0.2;

/// Calls f with the index of each of a tile's pixels.
template <typename Function>
void for_each_pixel(glm::ivec2 size, glm::ivec2 tile, const Function& f) {
  const glm::ivec2 from = k_tile * tile, to = glm::min(from + k_tile, size);
  for (int y = from.y; y < to.y; ++y)
    for (int x = from.x; x < to.x; ++x)
      f(static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x));
}

/// Of each pixel and channel.
std::vector<glm::vec3> median_of(std::span<const std::vector<glm::vec3>> images) {
  std::vector<glm::vec3> median(images[0].size());
  std::vector<float> values(images.size());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  for (std::size_t i = 0; i < median.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      for (std::size_t k = 0; k < images.size(); ++k) values[k] = images[k][i][channel];
      std::nth_element(values.begin(), middle, values.end());
      median[i][channel] = *middle;
    }
  }
  return median;
}

}  // namespace

std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> numbers;
  const std::size_t wanted = std::min(count, most);
  for (std::size_t i = 0; i < wanted; ++i)
    numbers.push_back(wanted == 1 ? 0 : i * (count - 1) / (wanted - 1));
  return numbers;
}

TileDraw::TileDraw(glm::ivec2 size, std::span<const std::vector<glm::vec3>> images)
    : columns_rows_((size + k_tile - 1) / k_tile),
      probability_(static_cast<std::size_t>(columns_rows_.x) * static_cast<std::size_t>(columns_rows_.y)) {
  const std::vector<glm::vec3> median = median_of(images);
  for (const std::vector<glm::vec3>& image : images) {
    std::vector<double> differences;
    for (int row = 0; row < columns_rows_.y; ++row) {
      for (int column = 0; column < columns_rows_.x; ++column) {
        double squares = 0.0;
        for_each_pixel(size, {column, row}, [&](std::size_t i) {
          const glm::dvec3 difference = glm::dvec3(image[i]) - glm::dvec3(median[i]);
          squares += glm::dot(difference, difference);
        });
        differences.push_back(std::sqrt(squares));
      }
    }
    const double all = std::accumulate(differences.begin(), differences.end(), 0.0);
    for (std::size_t i = 0; all > 0.0 && i < differences.size(); ++i) probability_[i] += differences[i] / all;
  }
  double sum = std::accumulate(probability_.begin(), probability_.end(), 0.0);
  const double least = sum > 0.0 ? k_least_part * sum / static_cast<double>(tiles()) : 1.0;
  sum += least * static_cast<double>(tiles());
  for (double& probability : probability_) probability = (probability + least) / sum;
}

std::vector<DrawnTile> TileDraw::drawn(std::size_t count, std::uint32_t seed) const {
  std::mt19937 random(seed);
  const double n = static_cast<double>(count);
  double next = (static_cast<double>(random()) + 0.5) / 4294967296.0 / n, sum = 0.0;
  std::vector<DrawnTile> tiles;
  for (std::size_t i = 0; i < probability_.size(); ++i) {
    sum += probability_[i];
    const auto number = static_cast<int>(i);
    for (; next < sum && tiles.size() < count; next += 1.0 / n)
      tiles.push_back({{number % columns_rows_.x, number / columns_rows_.x}, 1.0 / (n * probability_[i])});
  }
  return tiles;
}

TruthOfTiles::TruthOfTiles(const scene::Geometry& geometry, const scene::View& view,
                           std::vector<DrawnTile> tiles)
    : size_(view.size), airlight_(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y)) {
  std::vector<glm::ivec2> distinct;
  std::sort(tiles.begin(), tiles.end(), [](const DrawnTile& a, const DrawnTile& b) {
    return std::pair(a.tile.y, a.tile.x) < std::pair(b.tile.y, b.tile.x);
  });
  for (const DrawnTile& drawn : tiles)
    if (distinct.empty() || distinct.back() != drawn.tile) distinct.push_back(drawn.tile);
  for (const glm::ivec2& tile : distinct) for_each_pixel(size_, tile, [&](std::size_t) { ++pixels_; });

  std::optional<scene::Geometry> posed;
  if (!view.pose.is_at_rest()) posed = scene::posed(geometry, view.pose);
  for (std::size_t light = 0; light < view.lights.size(); ++light) {
    const reference::Reference reference(posed ? *posed : geometry, view, light);
    if (light == 0) distance_ = reference.surfaces().distance;
    const std::vector<glm::vec3> radiance = reference.exact_in(distinct).radiance;
    for (std::size_t i = 0; i < airlight_.size(); ++i) airlight_[i] += radiance[i];
  }
}

double ErrorOfTiles::Sums::rrmse() const {
  if (!(truth > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(squares * channels) / truth;
}

void ErrorOfTiles::add(const TruthOfTiles& truth, std::span<const DrawnTile> drawn,
                       const frame::FrameImages& images) {
  std::vector<Sums>& view = views_.emplace_back();
  for (const auto& [tile, weight] : drawn) {
    Sums& sums = view.emplace_back();
    for_each_pixel(truth.size(), tile, [&, weight = weight](std::size_t i) {
      if (!is_same_surface(images.distance[i], truth.distance()[i])) return;
      const glm::dvec3 x(images.airlight[i]), r(truth.airlight()[i]);
      sums.squares += weight * glm::dot(x - r, x - r);
      sums.truth += weight * (r.r + r.g + r.b);
      sums.channels += 3.0 * weight;
    });
  }
}

double ErrorOfTiles::rrmse() const {
  double sum = 0.0;
  for (const std::vector<Sums>& view : views_) {
    Sums of_view;
    for (const Sums& tile : view) of_view += tile;
    sum += of_view.rrmse();
  }
  return sum / static_cast<double>(views_.size());
}

double ErrorOfTiles::part_not_above(double limit) const {
  constexpr int k_draws = 1000;
  std::mt19937 random(1);
  int within = 0;
  for (int draw = 0; draw < k_draws; ++draw) {
    double sum = 0.0;
    for (const std::vector<Sums>& view : views_) {
      Sums of_view;
      for (std::size_t i = 0; i < view.size(); ++i) of_view += view[random() % view.size()];
      sum += of_view.rrmse();
    }
    within += sum / static_cast<double>(views_.size()) <= limit;
  }
  return static_cast<double>(within) / k_draws;
}

}  // namespace airlight::quality
