#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "quality/joined_runs.h"
#include "quality/packed_image.h"

namespace airlight::quality {

/// What a page holds of the airlight's images, for its viewer.
struct PageImages {
  /// null, or: {"size", "reduced": a pixel of a whole image is the mean of as many squared, "unit": of the
  /// packed values [W/(m² sr)], "mean": of the truth, "crops": [[x, y, width, height]], "truth": SOURCE,
  /// "runs":
  /// {"NUMBER OF THE RUN": SOURCE}, "without": how many runs have none for want of room}. A SOURCE is
  /// {"whole", "flip", "crops": [...], "flip_crops": [...]}, each {"id": of the element, "width", "height"};
  /// it has whole or, where a page holds whole images of other runs, crops alone; it has crops where the
  /// whole image is none or reduced, and each in flip and flip_crops too, but the truth and where that is
  /// dark.
  nlohmann::ordered_json json;
  std::string html;     ///< the elements
  std::string problem;  ///< why there are none
};

/// Packs the images that `airlight compare` has written: those of the truth and of the first runs that have
/// some are whole, of means over pixels where the budget asks for it, and beside them, of all others too, are
/// crops of all pixels: the parts of the image that are farthest from the truth, the same of all.
/// @param whole images, the truth's included
/// @param budget [bytes] of the text
/// @throws scene::Error (bad_file) for an image that cannot be read, or has another size than the truth
PageImages page_images(const JoinedRuns& joined, std::size_t whole, std::size_t budget);

/// The parts of an image with the most error, the first with most of all, which do not overlap.
/// @param error of each pixel, none negative
/// @param side of each, at most the image's [pixels]
std::vector<Crop> worst_crops(const GreyPixels& error, glm::ivec2 side, std::size_t count);

}  // namespace airlight::quality
