#include "quality/flip.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "scene/error.h"
#include "scene/parallel.h"

namespace airlight::quality {
namespace {

using flip::Taps;

constexpr double k_pixels_per_degree = 67.0;
constexpr double k_feature_width = 0.082;  ///< of the filter that finds edges and points [degrees]

constexpr float k_compression = 0.7f;                  ///< exponent of distances of colours, q_c
constexpr float k_knee = 0.4f, k_knee_height = 0.95f;  ///< p_c and p_t

constexpr float k_white_of_exposures = 0.85f;

// Narkowicz' curve is (a x² + b x) / (c x² + d x + e).
constexpr float k_a = 2.51f, k_b = 0.03f, k_c = 2.43f, k_d = 0.59f, k_e = 0.14f;

constexpr int k_band = 128;  ///< rows that a thread works on at a time

/// sRGB's primaries and D65, IEC 61966-2-1; columns are what red, green and blue give.
constexpr glm::mat3 k_xyz_from_rgb(0.4124564f, 0.2126729f, 0.0193339f,  //
                                   0.3575761f, 0.7151522f, 0.1191920f,  //
                                   0.1804375f, 0.0721750f, 0.9503041f);

/// White is (1, 1, 1).
const glm::mat3 k_relative_xyz_from_rgb = [] {
  const glm::vec3 white = k_xyz_from_rgb * glm::vec3(1.0f);
  return glm::mat3(k_xyz_from_rgb[0] / white, k_xyz_from_rgb[1] / white, k_xyz_from_rgb[2] / white);
}();
const glm::mat3 k_rgb_from_relative_xyz(glm::inverse(glm::dmat3(k_relative_xyz_from_rgb)));

float luminance(const glm::vec3& rgb) {
  return k_xyz_from_rgb[0].y * rgb.r + k_xyz_from_rgb[1].y * rgb.g + k_xyz_from_rgb[2].y * rgb.b;
}

/// Of 0 to 1, within 1e-6 of it: Halley's iteration, from a third of the exponent.
float cube_root(float x) {
  constexpr std::uint32_t k_start = 0x2a5137a0;  // two thirds of the exponent's bias, and the least error
  float y = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) / 3 + k_start);
  for (int i = 0; i < 2; ++i) {
    const float cube = y * y * y;
    y *= (cube + 2.0f * x) / (2.0f * cube + x);
  }
  return y;
}

/// Of L*a*b*. @param t X, Y or Z over white's
float lab_curve(float t) {
  constexpr float k_delta = 6.0f / 29.0f;
  return t > k_delta * k_delta * k_delta ? cube_root(t) : t / (3.0f * k_delta * k_delta) + 4.0f / 29.0f;
}

/// The sum over both sides.
double sum_of(const Taps& taps) {
  return 2.0 * std::accumulate(taps.begin() + 1, taps.end(), 0.0) + static_cast<double>(taps[0]);
}

/// Taps of exp(−x²/(2 σ²)), of which those that single precision would lose are left out. @param sigma
/// [pixels]
Taps gaussian(double sigma, int radius) {
  Taps taps;
  for (int x = 0; x <= radius; ++x) {
    const double value = std::exp(-0.5 * x * x / (sigma * sigma));
    if (value > 1e-8) taps.push_back(static_cast<float>(value));
  }
  return taps;
}

void scale(Taps& taps, double factor) {
  for (float& tap : taps) tap = static_cast<float>(static_cast<double>(tap) * factor);
}

/// A filter's values at `width` places.
/// @param in the first one's centre
/// @param step from a tap's value to the next one's
/// @param mirror 1, or −1 for a filter that changes its sign
void convolve(const float* in, std::ptrdiff_t step, int width, const Taps& taps, float mirror, float* out) {
  for (int i = 0; i < width; ++i) out[i] = taps[0] * in[i];
  // Two taps at a time: it is a matter of loads and stores.
  std::size_t k = 1;
  for (; k + 1 < taps.size(); k += 2) {
    const float near = taps[k], far = taps[k + 1], mirrored_near = mirror * near, mirrored_far = mirror * far;
    const std::ptrdiff_t offset = static_cast<std::ptrdiff_t>(k) * step;
    const float *a = in - offset - step, *b = in - offset, *c = in + offset, *d = in + offset + step;
    for (int i = 0; i < width; ++i)
      out[i] += near * c[i] + mirrored_near * b[i] + far * d[i] + mirrored_far * a[i];
  }
  if (k < taps.size()) {
    const std::ptrdiff_t offset = static_cast<std::ptrdiff_t>(k) * step;
    const float *b = in - offset, *c = in + offset;
    for (int i = 0; i < width; ++i) out[i] += taps[k] * (c[i] + mirror * b[i]);
  }
}

/// The colours and features of an image's band of rows, filtered.
class FilteredBand {
 public:
  explicit FilteredBand(int width)
      : width_(width),
        reach_(static_cast<int>(std::max({spatial_.luminance.taps.size(), spatial_.red_green.taps.size(),
                                          spatial_.blue_yellow[0].taps.size(),
                                          spatial_.blue_yellow[1].taps.size(), feature_.smooth.size()})) -
               1) {
    const auto padded = static_cast<std::size_t>(width + 2 * reach_);
    for (std::vector<float>& row : opponents_) row.resize(padded);
    for (std::vector<float>& plane : planes_)
      plane.resize((static_cast<std::size_t>(k_band) + 2 * static_cast<std::size_t>(reach_)) *
                   static_cast<std::size_t>(width));
    for (std::vector<float>& row : rows_) row.resize(static_cast<std::size_t>(width));
  }

  /// Filters along rows. Beyond its ends an image goes on as it ends.
  /// @param colour of a pixel of the image, in [0, 1]
  template <typename Colour>
  void begin(int first, int count, int height, const Colour& colour) {
    for (int row = first - reach_; row < first + count + reach_; ++row) {
      const auto pixel =
          static_cast<std::size_t>(std::clamp(row, 0, height - 1)) * static_cast<std::size_t>(width_);
      float *y_row = opponents_[0].data() + reach_, *red = opponents_[1].data() + reach_,
            *blue = opponents_[2].data() + reach_;
      for (int x = 0; x < width_; ++x) {
        const glm::vec3 opponents = flip::opponents(colour(pixel + static_cast<std::size_t>(x)));
        y_row[x] = opponents.x;
        red[x] = opponents.y;
        blue[x] = opponents.z;
      }
      for (float* of_row : {y_row, red, blue}) {
        std::fill(of_row - reach_, of_row, of_row[0]);
        std::fill(of_row + width_, of_row + width_ + reach_, of_row[width_ - 1]);
      }
      const auto out = [&](Plane plane) {
        return planes_[plane].data() + static_cast<std::ptrdiff_t>(row - first + reach_) * width_;
      };
      convolve(y_row, 1, width_, spatial_.luminance.taps, 1.0f, out(luminance));
      convolve(red, 1, width_, spatial_.red_green.taps, 1.0f, out(red_green));
      convolve(blue, 1, width_, spatial_.blue_yellow[0].taps, 1.0f, out(blue_yellow));
      convolve(blue, 1, width_, spatial_.blue_yellow[1].taps, 1.0f, out(blue_yellow_2));
      convolve(y_row, 1, width_, feature_.smooth, 1.0f, out(smooth));
      convolve(y_row, 1, width_, feature_.edge, -1.0f, out(edge));
      convolve(y_row, 1, width_, feature_.point, 1.0f, out(point));
    }
  }

  /// Filters a row of the band across rows.
  void filter(int row) {
    const auto across = [&](Plane plane, const Taps& taps, float mirror, Row out) {
      convolve(planes_[plane].data() + static_cast<std::ptrdiff_t>(row + reach_) * width_, width_, width_,
               taps, mirror, rows_[out].data());
    };
    across(luminance, spatial_.luminance.taps, 1.0f, row_y);
    across(red_green, spatial_.red_green.taps, 1.0f, row_cx);
    across(blue_yellow, spatial_.blue_yellow[0].taps, 1.0f, row_cz);
    across(blue_yellow_2, spatial_.blue_yellow[1].taps, 1.0f, row_cz_2);
    across(edge, feature_.smooth, 1.0f, edge_x);
    across(smooth, feature_.edge, -1.0f, edge_y);
    across(point, feature_.smooth, 1.0f, point_x);
    across(smooth, feature_.point, 1.0f, point_y);
  }

  /// Of the row that was filtered last.
  glm::vec3 colour(std::size_t x) const {
    const glm::vec3 opponents(rows_[row_y][x], rows_[row_cx][x],
                              spatial_.blue_yellow[0].weight * rows_[row_cz][x] +
                                  spatial_.blue_yellow[1].weight * rows_[row_cz_2][x]);
    return flip::hunt_lab(glm::clamp(flip::rgb_of_opponents(opponents), 0.0f, 1.0f));
  }
  float edges(std::size_t x) const { return length(rows_[edge_x][x], rows_[edge_y][x]); }
  float points(std::size_t x) const { return length(rows_[point_x][x], rows_[point_y][x]); }

 private:
  enum Plane { luminance, red_green, blue_yellow, blue_yellow_2, smooth, edge, point, k_planes };
  enum Row { row_y, row_cx, row_cz, row_cz_2, edge_x, edge_y, point_x, point_y, k_rows };

  static float length(float x, float y) { return std::sqrt(x * x + y * y); }

  const flip::SpatialFilters& spatial_ = flip::spatial_filters();
  const flip::FeatureFilters& feature_ = flip::feature_filters();
  int width_, reach_;
  std::vector<float> opponents_[3], planes_[k_planes], rows_[k_rows];
};

/// Raises `worst` to the ꟻLIP of each pixel, over all the ways that colours are shown.
/// @param shown glm::vec3(const glm::vec3& radiance, float exposure), in [0, 1]
template <typename Shown>
std::vector<float> worst_map(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size,
                             std::span<const float> exposures, const Shown& shown) {
  std::vector<float> worst(r.size(), 0.0f);
  const auto make_worker = [&] {
    return [&, of_x = FilteredBand(size.x), of_r = FilteredBand(size.x)](int part) mutable {
      const int first = part * k_band, count = std::min(k_band, size.y - first);
      for (const float exposure : exposures) {
        of_x.begin(first, count, size.y, [&](std::size_t i) { return shown(x[i], exposure); });
        of_r.begin(first, count, size.y, [&](std::size_t i) { return shown(r[i], exposure); });
        for (int row = 0; row < count; ++row) {
          of_x.filter(row);
          of_r.filter(row);
          float* out = worst.data() + static_cast<std::ptrdiff_t>(first + row) * size.x;
          for (std::size_t i = 0; i < static_cast<std::size_t>(size.x); ++i) {
            const float colours = flip::redistributed(flip::hyab(of_x.colour(i), of_r.colour(i)));
            // 2020, feature pipeline: features that one image has and the other has not, exponent q_f = ½.
            const float features = std::sqrt(
                std::max(std::abs(of_x.edges(i) - of_r.edges(i)), std::abs(of_x.points(i) - of_r.points(i))) *
                static_cast<float>(1.0 / std::numbers::sqrt2));
            // 2020, final difference.
            if (colours > 0.0f) out[i] = std::max(out[i], std::pow(colours, 1.0f - std::min(features, 1.0f)));
          }
        }
      }
    };
  };
  scene::parallel((size.y + k_band - 1) / k_band, make_worker, {});
  return worst;
}

void require_images(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size) {
  const auto pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  if (x.size() != pixels || r.size() != pixels || pixels == 0)
    throw scene::Error(scene::ExitCode::bad_file, "images to compare",
                       fmt::format("{} and {} pixels of {}x{}", x.size(), r.size(), size.x, size.y),
                       "give both the same size");
  for (const auto& image : {x, r})
    for (const glm::vec3& value : image)
      if (!std::isfinite(value.x) || !std::isfinite(value.y) || !std::isfinite(value.z))
        throw scene::Error(scene::ExitCode::bad_file, "images to compare", "a value is no finite number");
}

}  // namespace

namespace flip {

glm::vec3 opponents(const glm::vec3& rgb) {
  const glm::vec3 xyz = k_relative_xyz_from_rgb * rgb;
  return {xyz.y, xyz.x - xyz.y, xyz.y - xyz.z};
}

glm::vec3 rgb_of_opponents(const glm::vec3& opponents) {
  return k_rgb_from_relative_xyz *
         glm::vec3(opponents.x + opponents.y, opponents.x, opponents.x - opponents.z);
}

glm::vec3 hunt_lab(const glm::vec3& rgb) {
  const glm::vec3 xyz = k_relative_xyz_from_rgb * rgb;
  const float x = lab_curve(xyz.x), y = lab_curve(xyz.y), z = lab_curve(xyz.z);
  const float lightness = 116.0f * y - 16.0f;
  return {lightness, 0.01f * lightness * 500.0f * (x - y), 0.01f * lightness * 200.0f * (y - z)};
}

float hyab(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

float redistributed(float hyab) {
  // The largest distance of colours is taken to be that of green and blue.
  static const float most =
      std::pow(flip::hyab(hunt_lab({0.0f, 1.0f, 0.0f}), hunt_lab({0.0f, 0.0f, 1.0f})), k_compression);
  if (hyab <= 0.0f) return 0.0f;
  const float distance = std::pow(hyab, k_compression), knee = k_knee * most;
  return distance < knee ? k_knee_height / knee * distance
                         : k_knee_height + (distance - knee) / (most - knee) * (1.0f - k_knee_height);
}

const SpatialFilters& spatial_filters() {
  static const SpatialFilters filters = [] {
    // 2020, spatial filtering: a √(π/b) exp(−π² x²/b), x in degrees; a and b of its table. All are as wide as
    // three σ of the widest.
    struct Term {
      double a, b;
    };
    constexpr Term k_luminance{1.0, 0.0047}, k_red_green{1.0, 0.0053},
        k_blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};
    constexpr double k_pi = std::numbers::pi;
    const auto sigma_of = [](const Term& term) {
      return std::sqrt(term.b / (2.0 * k_pi * k_pi)) * k_pixels_per_degree;
    };
    const int radius = static_cast<int>(std::ceil(3.0 * sigma_of(k_blue_yellow[0])));
    const auto part = [&](const Term& term) {
      Gaussian gaussian_of{gaussian(sigma_of(term), radius), 1.0f};
      const double sum = sum_of(gaussian_of.taps);
      scale(gaussian_of.taps, 1.0 / sum);
      // Of the sum over x and y.
      gaussian_of.weight = static_cast<float>(term.a * std::sqrt(k_pi / term.b) * sum * sum);
      return gaussian_of;
    };
    SpatialFilters made{
        part(k_luminance), part(k_red_green), {part(k_blue_yellow[0]), part(k_blue_yellow[1])}};
    made.luminance.weight = made.red_green.weight = 1.0f;
    const float sum = made.blue_yellow[0].weight + made.blue_yellow[1].weight;
    for (Gaussian& of_two : made.blue_yellow) of_two.weight /= sum;
    return made;
  }();
  return filters;
}

const FeatureFilters& feature_filters() {
  static const FeatureFilters filters = [] {
    // 2020, feature pipeline: a Gaussian whose σ is half of the feature's width, and its derivatives.
    const double sigma = 0.5 * k_feature_width * k_pixels_per_degree;
    FeatureFilters made;
    made.smooth = gaussian(sigma, static_cast<int>(std::ceil(3.0 * sigma)));
    double positive = 0.0, negative = 0.0, edge_sum = 0.0;
    for (std::size_t i = 0; i < made.smooth.size(); ++i) {
      const auto x = static_cast<double>(i), g = static_cast<double>(made.smooth[i]);
      const double edge = x * g, point = (x * x / (sigma * sigma) - 1.0) * g;
      made.edge.push_back(static_cast<float>(edge));
      made.point.push_back(static_cast<float>(point));
      edge_sum += edge;
      (point > 0.0 ? positive : negative) += std::abs(point) * (i == 0 ? 1.0 : 2.0);
    }
    scale(made.smooth, 1.0 / sum_of(made.smooth));
    scale(made.edge, 1.0 / edge_sum);
    for (float& tap : made.point)
      tap = static_cast<float>(static_cast<double>(tap) / (tap > 0.0f ? positive : negative));
    return made;
  }();
  return filters;
}

float tone_mapped(float radiance) {
  const float x = std::clamp(radiance, 0.0f, 1e6f);  // beyond, all is white, and squares overflow
  return std::min((x * (k_a * x + k_b)) / (x * (k_c * x + k_d) + k_e), 1.0f);
}

double mean(const std::vector<float>& map) {
  return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

std::vector<float> map(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size) {
  const float exposure = 1.0f;
  return worst_map(x, r, size, {&exposure, 1}, [](const glm::vec3& colour, float) { return colour; });
}

}  // namespace flip

std::vector<float> ldr_flip_map(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size,
                                float exposure) {
  require_images(x, r, size);
  return worst_map(x, r, size, {&exposure, 1}, [](const glm::vec3& radiance, float factor) {
    return glm::clamp(factor * radiance, 0.0f, 1.0f);
  });
}

double ldr_flip(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size, float exposure) {
  return flip::mean(ldr_flip_map(x, r, size, exposure));
}

std::vector<float> flip_exposures(std::span<const glm::vec3> r, double floor) {
  std::vector<float> lit;
  for (const glm::vec3& radiance : r) {
    const float value = luminance(radiance);
    if (value > 0.0f && static_cast<double>(value) > floor) lit.push_back(value);
  }
  if (lit.empty()) return {};
  const auto middle = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
  std::nth_element(lit.begin(), middle, lit.end());
  const double median = static_cast<double>(*middle),
               most = static_cast<double>(*std::max_element(lit.begin(), lit.end()));

  // What the curve maps to 0.85: (a − 0.85 c) x² + (b − 0.85 d) x − 0.85 e = 0.
  constexpr double t = k_white_of_exposures;
  const double a = k_a - t * k_c, b = k_b - t * k_d, c = -t * k_e;
  const double white = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);

  // 2021, exposures.
  const double start = std::log2(white / most), stop = std::log2(white / median);
  const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
  std::vector<float> factors(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    factors[static_cast<std::size_t>(i)] =
        static_cast<float>(std::exp2(start + (stop - start) * i / (count - 1)));
  return factors;
}

std::vector<float> hdr_flip_map(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size,
                                double floor) {
  require_images(x, r, size);
  const std::vector<float> exposures = flip_exposures(r, floor);
  if (exposures.empty()) return {};
  return worst_map(x, r, size, exposures, [](const glm::vec3& radiance, float exposure) {
    const glm::vec3 shown = exposure * radiance;
    return glm::vec3(flip::tone_mapped(shown.r), flip::tone_mapped(shown.g), flip::tone_mapped(shown.b));
  });
}

double hdr_flip(std::span<const glm::vec3> x, std::span<const glm::vec3> r, glm::ivec2 size, double floor) {
  const std::vector<float> map = hdr_flip_map(x, r, size, floor);
  return map.empty() ? std::numeric_limits<double>::quiet_NaN() : flip::mean(map);
}

}  // namespace airlight::quality
