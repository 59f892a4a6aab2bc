#include "quality/compare.h"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include "quality/darkness.h"
#include "quality/judge.h"
#include "quality/measure.h"
#include "quality/pictures.h"
#include "quality/truth.h"

namespace airlight::quality {
namespace {

/// A spec as a part of a file name: "vsv:integral=riemann" becomes "vsv_integral-riemann".
std::string file_stem(std::string spec) {
  for (char& c : spec) {
    if (c == ':') c = '_';
    if (c == '=') c = '-';
  }
  return spec;
}

/// The command that repeats one run, into a folder of its own.
std::string command_of(const CompareRequest& request, const std::string& name, const VolumeChoice& volume,
                       const SurfaceChoice& surface) {
  return fmt::format("{} -o {}", request.command(volume, surface),
                     shell_quote((request.directory / name).string()));
}

std::map<std::string, std::string> metadata_of(const CompareRequest& request, const std::string& volume,
                                               const std::string& surface, const std::string& command) {
  std::map<std::string, std::string> metadata = {
      {"airlight.version", version()},
      {"airlight.command", command},
      {"airlight.scene", request.scene_name},
      {"airlight.volume", volume},
      {"airlight.surface", surface},
      {"airlight.shadow-map", fmt::format("{}", request.shadow_map_size)},
  };
  for (const auto& [option, value] : view_options(request.view)) metadata["airlight." + option] = value;
  return metadata;
}

/// @returns the exposure of all previews
Exposure write_truth(const CompareRequest& request, Measurer& measurer, const Truth& truth) {
  // The colour of surfaces is the compositor's, the rest the rays'.
  const VolumeChoice volume = parse_volumes("reference")[0];
  const SurfaceChoice surface = parse_surfaces("reference")[0];
  frame::FrameImages images = measurer.render(volume, surface);
  images.distance = truth.distance;
  images.visibility = truth.visibility;
  const Exposure exposure =
      request.exposure ? Exposure{*request.exposure, false, is_black(images.radiance)}
                       : Exposure{automatic_exposure(images.radiance), true, is_black(images.radiance)};
  auto metadata =
      metadata_of(request, volume.spec, surface.spec, command_of(request, "reference", volume, surface));
  metadata["airlight.bound"] = fmt::format("{}", truth.figures.bound);
  write_frame(request.directory / "reference.exr", images, metadata);
  write_png(request.directory / "reference.png", images.radiance, images.size, exposure.value);
  return exposure;
}

void write_images(const CompareRequest& request, const Run& run, const frame::FrameImages& images,
                  const Truth& truth, const Exposure& exposure) {
  const auto file = [&](const char* ending) { return request.directory / (run.name + ending); };
  write_frame(file(".exr"), images, metadata_of(request, run.volume, run.surface, run.command));
  write_png(file(".png"), images.radiance, images.size, exposure.value);
  write_png(file("_error.png"), error_colours(images.airlight, truth.airlight), images.size, 1.0f);
}

std::vector<Run::DebugImage> write_debug_images(const CompareRequest& request, const Run& run,
                                                const std::vector<frame::DebugImage>& images) {
  auto metadata = metadata_of(request, run.volume, run.surface, run.command);
  std::vector<Run::DebugImage> written;
  for (const frame::DebugImage& image : images) {
    const std::string name = run.name + "_" + image.name;
    const float largest = *std::max_element(image.values.begin(), image.values.end());
    const float white = largest > 0.0f ? largest : 1.0f;
    metadata["airlight.caption"] = image.caption;
    write_exr(request.directory / (name + ".exr"), {image.size, {{"Y", image.values}}, metadata});
    const std::vector<glm::vec3> grey(image.values.begin(), image.values.end());
    write_png(request.directory / (name + ".png"), grey, image.size, 1.0f / white);
    written.push_back({name, image.caption, white});
  }
  return written;
}

/// Gives each run the ratio of the fastest yardstick's time to its own.
void compare_times(std::vector<Run>& runs) {
  double fastest_ms = 0.0;
  for (const Run& run : runs) {
    if (run.is_yardstick && (fastest_ms == 0.0 || run.cost.frame_ms < fastest_ms))
      fastest_ms = run.cost.frame_ms;
  }
  for (Run& run : runs) run.march_ratio = fastest_ms / run.cost.frame_ms;
}

}  // namespace

Comparison compare(gpu::Context& context, const CompareRequest& request) {
  Comparison comparison;
  comparison.scene = request.scene_name;
  comparison.triangles = request.scene.geometry.triangles.size();
  comparison.report = request.scene.report;
  comparison.view = request.view;
  comparison.shadow_map_size = request.shadow_map_size;
  comparison.device = context.device();
  comparison.cores = std::max(1u, std::thread::hardware_concurrency());

  // The truth, once nothing else can fail.
  Measurer measurer(context, request.scene.geometry, request.view, request.shadow_map_size, request.progress,
                    request.cache);
  measurer.try_out(request.volumes, request.surfaces);
  const Truth truth = trace_truth(measurer.reference(), request.view);
  comparison.truth = truth.figures;
  comparison.exposure = write_truth(request, measurer, truth);
  if (comparison.exposure.is_of_black)
    comparison.report.warnings.push_back("the reference is black: " +
                                         why_black(request.scene.geometry, request.view));

  // Every pair: measure, judge, write.
  for (const VolumeChoice& volume : request.volumes) {
    for (const SurfaceChoice& surface : request.surfaces) {
      Run run;
      run.volume = volume.spec;
      run.surface = surface.spec;
      run.name = file_stem(volume.spec) + "+" + file_stem(surface.spec);
      run.is_judged = volume.method->traits.is_judged();
      run.is_yardstick = volume.method->traits.is_yardstick;
      run.settings = volume.values();
      run.surface_settings = surface.values();
      run.command = command_of(request, run.name, volume, surface);
      const Measurer::Measurement measured = measurer.measure(volume, surface, request.frames);
      run.cost = measured.cost;
      run.errors = judge(measured.images, truth);
      write_images(request, run, measured.images, truth, comparison.exposure);
      if (request.debug) run.debug_images = write_debug_images(request, run, measurer.debug_images(volume));
      comparison.runs.push_back(std::move(run));
    }
  }
  compare_times(comparison.runs);
  return comparison;
}

}  // namespace airlight::quality
