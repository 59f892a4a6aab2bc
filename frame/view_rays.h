#pragma once

#include <compare>
#include <vector>

#include "frame/option.h"

namespace airlight::frame {

/// For which view rays airlight is computed.
enum class Where {
  pixel,     ///< of each pixel
  half,      ///< of an image of half the width and height
  quarter,   ///< of a quarter of them
  epipolar,  ///< of samples on epipolar lines, and of pixels that these do not serve
};

struct ViewRays {
  Where where = Where::pixel;
  // Of Where::epipolar; the others do not read them:
  int slices = 512;   ///< epipolar lines
  int samples = 256;  ///< on each of them; a multiple of 16

  bool are_listed() const { return where == Where::epipolar; }
  auto operator<=>(const ViewRays&) const = default;
};

/// What there is to choose, for the methods that go along view rays.
std::vector<Option> view_rays_options();

}  // namespace airlight::frame
