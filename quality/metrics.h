#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/surface_judge.h"

namespace airlight::quality {

/// An image's channels, one after the other.
std::span<const float> channels_of(const std::vector<glm::vec3>& image);

/// How far an image is from the reference, over all channels of all pixels. See `airlight_error`.
///
/// Where the reference is dark, what is relative to its mean says nothing and is NaN: all but `rmse`.
struct AirlightError {
  bool is_dark;  ///< mean(r) is not above the floor
  double bias;   ///< mean(x) / mean(r) − 1
  double rmse;   ///< sqrt(mean((x − r)²)), in the images' unit
  double rrmse;  ///< rmse / mean(r)
  double mae;    ///< mean |x − r| / mean(r)
  double p99;  ///< the smallest value that at least 99 % of |x − r| / mean(r) do not exceed (nearest rank)
  double max;  ///< largest |x − r| / mean(r)
  double relmse;    ///< mean((x − r)² / (r² + ε)), ε = 1e-2 · mean(r)²
  double leaked;    ///< Σ max(0, x − r) / Σ r: light where there is none
  double spurious;  ///< Σ max(0, r − x) / Σ r: shadow where there is none
};

/// Compares two images of the same length, any channel layout.
/// @param x the image that is judged; @param r the reference
/// @param floor the mean of r up to which the reference is dark, in the images' unit
/// @throws scene::Error (bad_file) when a value is NaN or infinite, or the lengths differ
AirlightError airlight_error(std::span<const float> x, std::span<const float> r, double floor = 0.0);

/// The airlight's error where both images see the same surface, or both none: distances within 0.1 %. A
/// rasteriser snaps corners to 1/256 pixel, so a few pixels at silhouettes show another surface than the ray
/// through their centre hits; their error is not the airlight's, and where a bright background meets a dark
/// edge it outweighs all others.
struct SameSurfaceError {
  bool is_dark;                          ///< as in AirlightError, and
  double bias, rrmse, leaked, spurious;  ///< as in AirlightError, over the pixels that are kept
  std::size_t left_out_pixels;           ///< those that see different surfaces
};

/// @param x, r images of as many channels a pixel as their lengths tell; @param distance, reference_distance
/// one a pixel; @param floor as of airlight_error, which it throws as
SameSurfaceError same_surface_error(std::span<const float> x, std::span<const float> distance,
                                    std::span<const float> r, std::span<const float> reference_distance,
                                    double floor = 0.0);

/// Whether two distances along a view ray [m], 0 for none, are of one surface.
inline bool is_same_surface(float distance, float reference_distance) {
  return !(std::abs(distance - reference_distance) > 1e-3f * reference_distance);
}

/// What the flicker of a path's next frame asks of a frame.
struct ErrorImage {
  /// x − r of each channel of each pixel that same_surface_error keeps; NaN of the others
  std::vector<float> values;
  double mean;  ///< of r over the pixels that are kept; NaN where r is dark there
};

/// @param x, distance, r, reference_distance, floor as of same_surface_error, which it throws as
ErrorImage error_image(std::span<const float> x, std::span<const float> distance, std::span<const float> r,
                       std::span<const float> reference_distance, double floor = 0.0);

/// How much the airlight changes from one frame to the next where the reference does not, and the other way
/// round: sqrt(mean((e₁ − e₀)²)) / mean(r), e = x − r of each frame at one pixel of the image, over the
/// channels of the pixels that both frames keep; mean(r) is that of both. An error that stays has none; one
/// of ±a in turns has 2a / mean(r).
///
/// Pixels are kept as by same_surface_error, since a pixel at a silhouette that the rasteriser snaps one way
/// in one frame and the other way in the next says nothing of the airlight. What a moving edge uncovers
/// counts: its error comes and goes before the eye, and how far surfaces may move to be the same would be
/// another number to choose.
/// @returns NaN where a frame is dark, or no pixel is kept by both
double flicker(const ErrorImage& before, const ErrorImage& after);

/// What the pixels of an image are judged by: nothing where no surface is seen.
using SurfaceVerdicts = std::vector<std::optional<reference::SurfaceVerdict>>;

/// Surface shadows, of the pixels that show a surface.
struct SurfaceError {
  std::size_t wrong_pixels;      ///< lit where the verdict is dark or the other way round, and decided
  std::size_t undecided_pixels;  ///< whose verdict the frame's rounding of the point may change
  std::size_t pixels;

  /// The part of the pixels that is undecided; 0 where there are none.
  double undecided() const {
    return pixels == 0 ? 0.0 : static_cast<double>(undecided_pixels) / static_cast<double>(pixels);
  }
};

/// Whether a surface counts as lit.
inline bool is_lit(float visibility) {
  return visibility >= 0.5f;
}

/// How far what an image says of a share of light may be from the verdict's. Panes that let more than this
/// less than all through are told from none; what sums in fixed point and the angle of incidence are rounded
/// by is a thousandth of it for each of them.
constexpr float k_share_error = 1e-3f;

/// The same of what arrives of the light, RGB.
inline bool is_wrong(const glm::vec3& share, const reference::SurfaceVerdict& verdict) {
  const glm::vec3 error = glm::abs(share - verdict.share);
  return verdict.is_decided && std::max({error.r, error.g, error.b}) > k_share_error;
}

/// Whether a decided verdict contradicts an image.
inline bool is_wrong(float visibility, const reference::SurfaceVerdict& verdict) {
  return verdict.is_decided && is_lit(visibility) != (verdict.verdict == reference::Verdict::lit);
}

/// @param visibility, verdicts one a pixel
/// @throws scene::Error (bad_file) when a value is NaN or infinite, or the lengths differ
SurfaceError surface_error(std::span<const float> visibility, const SurfaceVerdicts& verdicts);
SurfaceError surface_error(std::span<const glm::vec3> shares, const SurfaceVerdicts& verdicts);

}  // namespace airlight::quality
