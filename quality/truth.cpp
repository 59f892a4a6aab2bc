#include "quality/truth.h"

#include <algorithm>

namespace airlight::quality {
namespace {

double mean(const std::vector<glm::vec3>& image) {
  double sum = 0.0;
  for (const glm::vec3& value : image) {
    const glm::dvec3 wide(value);
    sum += wide.r + wide.g + wide.b;
  }
  return sum / static_cast<double>(3 * image.size());
}

/// Mean airlight of the view without anything in it, on a coarse image: only its magnitude matters.
double unshadowed_airlight(scene::View view) {
  constexpr int k_side = 32;  // pixels
  view.size = glm::max(view.size * k_side / std::max(view.size.x, view.size.y), glm::ivec2(1));
  double sum = 0.0;
  for (std::size_t light = 0; light < view.lights.size(); ++light)
    sum += mean(reference::Reference({}, view, light).exact().radiance);
  return sum;
}

}  // namespace

Truth trace_truth(SharedReference& reference, const scene::View& view, const frame::SurfacePoints& points) {
  Truth truth;
  truth.distance = reference.distance();
  TruthFigures& figures = truth.figures;
  double error = 0.0;  // rmse, in the unit of the image
  for (std::size_t light = 0; light < view.lights.size(); ++light) {
    const reference::AirlightImage& airlight = reference.exact(light, 1);
    if (light == 0) {
      truth.airlight = airlight.radiance;
    } else {
      for (std::size_t i = 0; i < truth.airlight.size(); ++i) truth.airlight[i] += airlight.radiance[i];
    }
    truth.verdicts.push_back(reference.verdicts(light, points));
    error += airlight.bound * mean(airlight.radiance);  // a sum's rmse is at most the sum of rmse
    figures.ms += airlight.ms;
    figures.shadows_per_pixel += airlight.shadows_per_pixel;
    figures.lit_runs_per_pixel += airlight.lit_runs_per_pixel;
  }
  figures.mean_airlight = mean(truth.airlight);
  figures.floor = std::max(k_dark * unshadowed_airlight(view), k_least);
  figures.bound = figures.mean_airlight > 0.0 ? error / figures.mean_airlight : 0.0;
  if (SharedReference* opaque = reference.taken_opaque())
    truth.opaque = std::make_shared<const Truth>(trace_truth(*opaque, view, points));
  return truth;
}

}  // namespace airlight::quality
