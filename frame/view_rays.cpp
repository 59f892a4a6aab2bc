#include "frame/view_rays.h"

namespace airlight::frame {

std::vector<Option> view_rays_options() {
  return {
      word_option<ViewRays, Where>(
          {.name = "where",
           .meaning = "for which view rays airlight is computed",
           .quality = "half and quarter lose shadows' edges, and what thin things hide; epipolar softens "
                      "edges of shafts",
           .cost = "half asks a quarter of the rays, quarter a sixteenth, epipolar more where depth breaks",
           .sweep = {"pixel", "half", "quarter", "epipolar"},
           .is_common = true},
          {{"pixel", "each pixel's"},
           {"half", "those of an image of half the width and height; pixels take from those as deep as they"},
           {"quarter", "the same of a quarter"},
           {"epipolar",
            "those of samples on lines through the light, and of pixels that none is as deep as"}},
          &ViewRays::where),
      count_option({.name = "epipolar-slices",
                    .meaning = "lines through the light on which where=epipolar samples airlight",
                    .quality = "too few soften shafts' edges",
                    .cost = "rays",
                    .sweep = {"256", "512", "1024"}},
                   Counts{.least = 16, .most = 4096}, &ViewRays::slices),
      count_option(
          {.name = "epipolar-samples",
           .meaning =
               "samples on each of them, of which every sixteenth has a ray, and those about breaks of depth",
           .quality = "too few leave pixels without a sample beside them",
           .cost = "none to speak of",
           .sweep = {"128", "256", "512"}},
          Counts{.least = 32, .most = 4096, .multiple_of = 16}, &ViewRays::samples)};
}

}  // namespace airlight::frame
