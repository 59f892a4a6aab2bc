// Every method of airlight against images by an independent renderer: truth/README.md of the shared data, of
// which AIRLIGHT_SHARED is the folder.
//
// `airlight_truths [VOLUMES]`: of each image and method the ratio of means, and the median and the 85th
// percentile of pixels' relative differences, which the noise of the images is part of (0.5 % rms). Surfaces
// are shadowed by the shadow map of 2048².
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "gpu/context.h"
#include "quality/image_io.h"
#include "quality/measure.h"
#include "report.h"
#include "scene/import.h"
#include "support/truth.h"

namespace {

using namespace airlight;

void compare(gpu::Context& context, const tests::CyclesImage& truth, const std::string& volumes) {
  const std::vector<float> expected = quality::read_exr(truth.image_file()).channels.at("R");
  scene::Scene scene = scene::import_scene(truth.scene_file());
  scene::override_albedo(scene.geometry, glm::vec3(truth.albedo));
  const scene::View view = truth.view();
  quality::Measurer measurer(context, scene.geometry, view, 2048, {}, {});
  const auto surface = quality::parse_surfaces("shadow-map");
  for (quality::VolumeChoice& choice : quality::parse_volumes(volumes)) {
    choice.fit(view);
    std::vector<float> red, differences;
    for (const glm::vec3& radiance : measurer.render(choice, surface[0]).radiance) red.push_back(radiance.r);
    for (std::size_t i = 0; i < red.size(); ++i) {
      const float difference = std::abs(red[i] - expected[i]);
      differences.push_back(difference == 0 ? 0 : difference / expected[i]);
    }
    fmt::print("{:<22} {:<36} {:>10.4f} {:>10.2f} {:>10.2f}\n", truth.image, choice.spec,
               tests::mean(red) / tests::mean(expected), 100 * tests::percentile(differences, 50),
               100 * tests::percentile(differences, 85));
    std::fflush(stdout);
  }
}

void run(const std::vector<std::string>& words) {
  const std::string volumes = words.empty() ? "vsv,vsv:query=tree,vsv:populate=conservative,vsv:populate="
                                              "screen-space,vsv:where=half,vsv:where=epipolar,"
                                              "march:steps=64,march:steps=512,froxel,reference"
                                            : words[0];
  gpu::Context context;
  fmt::print("{:<22} {:<36} {:>10} {:>10} {:>10}\n", "image", "volume", "mean ratio", "median %", "p85 %");
  for (const tests::CyclesImage& truth : tests::all_cycles_images()) compare(context, truth, volumes);
}

}  // namespace

int main(int count, char** words) {
  return bench::run_and_report("airlight_truths", run, count, words);
}
