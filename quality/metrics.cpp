#include "quality/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "scene/error.h"

namespace airlight::quality {

namespace {

void require_finite(std::span<const float> image, std::string_view name) {
  const auto culprit =
      std::find_if(image.begin(), image.end(), [](float value) { return !std::isfinite(value); });
  if (culprit == image.end()) return;
  throw scene::Error(scene::ExitCode::bad_file, fmt::format("{}, value {}", name, culprit - image.begin()),
                     fmt::format("it is {}", *culprit));
}

void require_same_length(std::size_t x, std::size_t r) {
  if (x == r) return;
  throw scene::Error(scene::ExitCode::bad_file, "images to compare",
                     fmt::format("{} values against {}", x, r), "give both the same size and channels");
}

/// The smallest value that at least 99 % of the values do not exceed (nearest rank). Reorders the values.
double percentile_99(std::vector<double>& values) {
  const std::size_t rank = (99 * values.size() + 99) / 100;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

std::span<const float> channels_of(const std::vector<glm::vec3>& image) {
  return {image.empty() ? nullptr : &image[0].x, 3 * image.size()};
}

AirlightError airlight_error(std::span<const float> x, std::span<const float> r, double floor) {
  require_same_length(x.size(), r.size());
  require_finite(x, "image to judge");
  require_finite(r, "reference image");
  if (x.empty()) throw scene::Error(scene::ExitCode::bad_file, "images to compare", "they have no pixels");

  const auto count = static_cast<double>(x.size());
  double sum_x = 0.0, sum_r = 0.0, sum_squares = 0.0, sum_absolute = 0.0;
  std::vector<double> differences(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double difference = static_cast<double>(x[i]) - static_cast<double>(r[i]);
    differences[i] = std::abs(difference);
    sum_x += static_cast<double>(x[i]);
    sum_r += static_cast<double>(r[i]);
    sum_squares += difference * difference;
    sum_absolute += std::abs(difference);
  }
  const double mean_r = sum_r / count;
  const bool is_dark = !(mean_r > floor);
  const auto relative = [&](double error) {
    return is_dark ? std::numeric_limits<double>::quiet_NaN() : error / mean_r;
  };

  const double epsilon = 1e-2 * mean_r * mean_r;
  double sum_relative_squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (is_dark || differences[i] == 0.0) continue;
    const auto reference = static_cast<double>(r[i]);
    sum_relative_squares += differences[i] * differences[i] / (reference * reference + epsilon);
  }

  AirlightError error{};
  error.is_dark = is_dark;
  error.bias = relative((sum_x - sum_r) / count);
  error.rmse = std::sqrt(sum_squares / count);
  error.rrmse = relative(error.rmse);
  error.mae = relative(sum_absolute / count);
  error.p99 = relative(percentile_99(differences));
  error.max = relative(*std::max_element(differences.begin(), differences.end()));
  error.relmse = is_dark ? std::numeric_limits<double>::quiet_NaN() : sum_relative_squares / count;
  error.leaked = relative(0.5 * (sum_absolute + (sum_x - sum_r)) / count);
  error.spurious = relative(0.5 * (sum_absolute - (sum_x - sum_r)) / count);
  return error;
}

SameSurfaceError same_surface_error(std::span<const float> x, std::span<const float> distance,
                                    std::span<const float> r, std::span<const float> reference_distance,
                                    double floor) {
  require_same_length(x.size(), r.size());
  require_same_length(distance.size(), reference_distance.size());
  const std::size_t channels = distance.empty() ? 0 : x.size() / distance.size();
  std::vector<float> kept_x, kept_r;
  SameSurfaceError error{};
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (!is_same_surface(distance[i], reference_distance[i])) {
      ++error.left_out_pixels;
      continue;
    }
    for (std::size_t c = i * channels; c < (i + 1) * channels; ++c) {
      kept_x.push_back(x[c]);
      kept_r.push_back(r[c]);
    }
  }
  if (kept_x.empty()) return error;
  const AirlightError kept = airlight_error(kept_x, kept_r, floor);
  error.is_dark = kept.is_dark;
  error.bias = kept.bias;
  error.rrmse = kept.rrmse;
  error.leaked = kept.leaked;
  error.spurious = kept.spurious;
  return error;
}

ErrorImage error_image(std::span<const float> x, std::span<const float> distance, std::span<const float> r,
                       std::span<const float> reference_distance, double floor) {
  require_same_length(x.size(), r.size());
  require_same_length(distance.size(), reference_distance.size());
  require_finite(x, "image to judge");
  require_finite(r, "reference image");
  const std::size_t channels = distance.empty() ? 1 : x.size() / distance.size();
  ErrorImage error{std::vector<float>(x.size(), std::numeric_limits<float>::quiet_NaN()), 0.0};
  double sum_r = 0.0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!is_same_surface(distance[i / channels], reference_distance[i / channels])) continue;
    error.values[i] = x[i] - r[i];
    sum_r += static_cast<double>(r[i]);
    ++kept;
  }
  error.mean = sum_r / static_cast<double>(kept);
  if (!(error.mean > floor)) error.mean = std::numeric_limits<double>::quiet_NaN();
  return error;
}

double flicker(const ErrorImage& before, const ErrorImage& after) {
  require_same_length(before.values.size(), after.values.size());
  double sum_squares = 0.0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < after.values.size(); ++i) {
    const double change = static_cast<double>(after.values[i]) - static_cast<double>(before.values[i]);
    if (std::isnan(change)) continue;
    sum_squares += change * change;
    ++kept;
  }
  return std::sqrt(sum_squares / static_cast<double>(kept)) / (0.5 * (before.mean + after.mean));
}

namespace {

/// @param image whether a pixel of it is wrong by `is_wrong`
template <typename Pixel>
SurfaceError surface_error_of(std::span<const Pixel> visibility, const SurfaceVerdicts& verdicts) {
  require_same_length(visibility.size(), verdicts.size());
  SurfaceError error{};
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    if (!verdicts[i]) continue;
    ++error.pixels;
    if (!verdicts[i]->is_decided) ++error.undecided_pixels;
    if (is_wrong(visibility[i], *verdicts[i])) ++error.wrong_pixels;
  }
  return error;
}

}  // namespace

SurfaceError surface_error(std::span<const float> visibility, const SurfaceVerdicts& verdicts) {
  require_finite(visibility, "visibility to judge");
  return surface_error_of(visibility, verdicts);
}

SurfaceError surface_error(std::span<const glm::vec3> shares, const SurfaceVerdicts& verdicts) {
  require_finite(std::span(shares.empty() ? nullptr : &shares[0].x, 3 * shares.size()),
                 "visibility to judge");
  return surface_error_of(shares, verdicts);
}

}  // namespace airlight::quality
