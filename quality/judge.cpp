#include "quality/judge.h"

#include <limits>
#include <span>

#include "quality/flip.h"

namespace airlight::quality {

Errors judge(const frame::FrameImages& images, const Truth& truth, const Truth& of_surfaces) {
  Errors errors;
  errors.airlight =
      airlight_error(channels_of(images.airlight), channels_of(truth.airlight), truth.figures.floor);
  constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
  errors.flip = errors.airlight.is_dark
                    ? k_none
                    : hdr_flip(images.airlight, truth.airlight, images.size, truth.figures.floor);
  errors.same_surface = same_surface_error(channels_of(images.airlight), images.distance,
                                           channels_of(truth.airlight), truth.distance, truth.figures.floor);
  for (std::size_t light = 0; light < of_surfaces.verdicts.size(); ++light) {
    if (images.is_skipped[light]) continue;  // whether it is seen changes nothing
    const SurfaceVerdicts& verdicts = of_surfaces.verdicts[light];
    const SurfaceError error = images.transmittance.empty()
                                   ? surface_error(images.visibility[light], verdicts)
                                   : surface_error(images.transmittance[light], verdicts);
    errors.surface.wrong_pixels += error.wrong_pixels;
    errors.surface.undecided_pixels += error.undecided_pixels;
    errors.surface.pixels += error.pixels;
  }
  return errors;
}

ErrorImage error_image(const frame::FrameImages& images, const Truth& truth) {
  return error_image(channels_of(images.airlight), images.distance, channels_of(truth.airlight),
                     truth.distance, truth.figures.floor);
}

}  // namespace airlight::quality
