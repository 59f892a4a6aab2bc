// How methods of airlight grow with the image, the triangles, the lights and the fog.
//
// `airlight_growth [--axis size|triangles|lights|sigma] [VOLUMES]`: of each value along an axis (all four by
// default), the time that each method's own stages take, without what all share: surfaces, shadow map and
// composite. Below, the exponent of its growth: the slope of log time over log value, by least squares.
// `size`: the side of `window` [pixels]. `triangles`: of `spheres`. `lights`: of `window`, 1.5 m apart, that
// share the power of one. `sigma`: σ_s of `spheres` [1/m]. All but the first of 512×512 pixels.
#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "gpu/context.h"
#include "quality/measure.h"
#include "report.h"
#include "scene/builtin.h"
#include "support/scenes.h"

namespace {

using namespace airlight;

struct Scene {
  scene::Geometry geometry;
  scene::View view;
};

struct Axis {
  std::vector<double> values;
  std::function<Scene(double value)> make;
};

Scene builtin(const char* name, glm::ivec2 size, std::size_t triangles = 0) {
  const scene::BuiltinScene& builtin = *scene::find_builtin(name);
  scene::Scene made = triangles > 0 ? builtin.make(triangles) : builtin.make();
  const scene::View view = tests::view_of(made, size);
  return {std::move(made.geometry), view};
}

const std::map<std::string, Axis> k_axes = {
    {"size",
     {{256, 512, 1024, 2048, 4096},
      [](double side) { return builtin("window", glm::ivec2(static_cast<int>(side))); }}},
    {"triangles",
     {{1e4, 1e5, 1e6},
      [](double count) {
        return builtin("spheres", {512, 512}, static_cast<std::size_t>(count));
      }}},
    {"lights",
     {{1, 2, 4, 8},
      [](double count) {
        Scene made = builtin("window", {512, 512});
        scene::Light light = made.view.lights.at(0);
        light.intensity /= static_cast<float>(count);
        made.view.lights.clear();
        for (int i = 0; i < static_cast<int>(count); ++i, light.position.x -= 1.5)
          made.view.lights.push_back(light);
        return made;
      }}},
    {"sigma", {{0.01, 0.1, 1, 10}, [](double sigma) {
                 Scene made = builtin("spheres", {512, 512});
                 made.view.medium.sigma_s = glm::vec3(static_cast<float>(sigma));
                 return made;
               }}}};

void measure(gpu::Context& context, const std::string& name, const Axis& axis, const std::string& volumes) {
  const std::set<std::string> shared = {"surfaces", "shadow_map", "composite", "surface_query"};
  const auto choices = quality::parse_volumes(volumes);
  const auto surfaces = quality::parse_surfaces("none");
  std::map<std::string, std::vector<double>> times;
  fmt::print("{:<10}", name);
  for (const auto& choice : choices) fmt::print(" {:>28}", choice.spec);
  fmt::print(" [ms]\n");
  for (const double value : axis.values) {
    const Scene made = axis.make(value);
    quality::Measurer measurer(context, made.geometry, made.view, 2048, {}, {});
    fmt::print("{:<10g}", value);
    for (quality::VolumeChoice choice : choices) {
      choice.fit(made.view);
      double ms = 0;
      for (const auto& [stage, of_stage] : measurer.measure(choice, surfaces[0], 5).cost.stages_ms)
        if (!shared.contains(stage)) ms += of_stage;
      times[choice.spec].push_back(ms);
      fmt::print(" {:>28.2f}", ms);
      std::fflush(stdout);
    }
    fmt::print("\n");
  }
  fmt::print("{:<10}", "exponent");
  for (const auto& choice : choices)
    fmt::print(" {:>28.2f}", bench::exponent(axis.values, times.at(choice.spec)));
  fmt::print("\n\n");
}

void run(const std::vector<std::string>& words) {
  std::string only;
  std::string volumes = "vsv,vsv:query=tree,march:steps=64,froxel";
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--axis")
      only = words.at(++i);
    else
      volumes = words[i];
  }
  if (!only.empty() && !k_axes.contains(only))
    throw std::runtime_error("no axis " + only + ": size, triangles, lights, sigma");
  gpu::Context context;
  for (const auto& [name, axis] : k_axes)
    if (only.empty() || name == only) measure(context, name, axis, volumes);
}

}  // namespace

int main(int count, char** words) {
  return bench::run_and_report("airlight_growth", run, count, words);
}
