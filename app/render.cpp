#include <cstdlib>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/memory.h"
#include "app/output.h"
#include "frame/frame.h"
#include "quality/darkness.h"
#include "quality/first_look.h"
#include "quality/pictures.h"
#include "quality/results.h"
#include "quality/traced.h"
#include "scene/numbers.h"

namespace airlight::app {
namespace {

using scene::Error;
using scene::ExitCode;

/// The preview of an image.
std::filesystem::path beside(std::filesystem::path image) {
  return image.replace_extension(".png");
}

/// The image of one of a path's frames.
std::filesystem::path numbered(std::filesystem::path output, std::size_t frame) {
  return output.replace_filename(fmt::format("{}{}.exr", output.stem().string(), scene::frame_ending(frame)));
}

/// Writes images, all with the exposure of the first.
struct Images {
  const Options& options;
  const Subject& subject;
  const quality::VolumeChoice& volume;
  const quality::SurfaceChoice& surface;
  int shadow_map;
  std::optional<float> exposure;  ///< automatic until the first image
  quality::Tev* tev = nullptr;    ///< that shows them, if there is one
  std::string renderer = {};
  bool first_is_black = false;
  std::string first_skipped = {};  ///< quality::skipped_lights
  bool is_first = true;

  void write(const std::filesystem::path& file, const scene::View& view, const frame::FrameImages& images) {
    if (is_first) {
      first_is_black = quality::is_black(images.radiance);
      first_skipped = quality::skipped_lights(images);
    }
    is_first = false;
    if (tev) tev->show(file.stem().string(), images);
    if (!exposure) exposure = quality::automatic_exposure(images.radiance);
    auto preview_is_written = std::async(std::launch::async, [&] {
      quality::write_png(beside(file), images.radiance, images.size, *exposure, subject.scene.tone_map);
    });
    quality::write_frame(file, images, metadata_of(view));
    preview_is_written.get();
  }

  std::map<std::string, std::string> metadata_of(const scene::View& view) const {
    quality::Making making{
        .scene = options.scene,
        .model_options = {},
        .volume = volume,
        .surface = surface,
        .shadow_map = shadow_map,
        .exposure = *exposure,
        .tone_map = subject.scene.tone_map,
        .renderer = renderer,
        .command = fmt::format("{} -o {}", options.command_line({}), quality::shell_quote(options.output))};
    for (const char* name : {"albedo", "looks", "occluders", "triangles"})
      if (const auto text = options.get(name)) making.model_options[name] = *text;
    return quality::metadata_of(making, view);
  }
};

/// What --video asks for. @throws scene::Error (usage) where it cannot be
std::optional<std::filesystem::path> video_of(const Options& options) {
  const auto video = options.get("video");
  if (!video) return {};
  if (!options.get("path"))
    throw Error(ExitCode::usage, "--video", "an image does not move", "give a --path");
  if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0)
    throw Error(ExitCode::driver, "--video", "ffmpeg, which makes it, is not installed",
                "install it, or leave out --video: the images are written anyway");
  return *video;
}

/// Makes the video of the previews of a path's images.
/// @throws scene::Error (bad_file)
void write_video(const std::filesystem::path& video, const std::filesystem::path& output,
                 const scene::Path& path) {
  // ffmpeg's numbers, as scene::frame_ending has them.
  std::string images = std::filesystem::path(output).replace_extension().string();
  for (std::size_t at = 0; (at = images.find('%', at)) != std::string::npos; at += 2) images.insert(at, "%");
  const double moves = static_cast<double>(path.views.size() - 1);
  const double rate = path.seconds > 0.0 && moves > 0.0 ? moves / path.seconds : 25.0;
  // Players want even sides, and colours at half the resolution.
  const std::string command = fmt::format(
      "ffmpeg -loglevel error -y -framerate {} -start_number 0 -i {} -vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2' "
      "-pix_fmt yuv420p -crf 18 {}",
      rate, quality::shell_quote(images + "_%04d.png"), quality::shell_quote(video.string()));
  if (std::system(command.c_str()) != 0)
    throw Error(ExitCode::bad_file, video.string(), "ffmpeg could not write it", "its own words stand above");
}

/// The rrmse that automatic counts are to be enough for.
double automatic_limit(const Options& options, const quality::AutomaticCounts& automatic) {
  const auto text = options.get("max-error");
  if (!text) return quality::k_first_look_error;
  if (automatic[0].empty())
    throw Error(ExitCode::usage, "--max-error", "no count of the method is auto",
                "write auto for some, as in vsv:alpha=auto:theta=auto:phi=auto");
  const double limit = scene::parse_number("--max-error", *text);
  if (!(limit > 0.0)) throw Error(ExitCode::usage, "--max-error", fmt::format("'{}' is not above 0", *text));
  return limit;
}

}  // namespace

void render(const Options& options) {
  // Everything that can be wrong with the command is found before the driver is woken.
  const std::filesystem::path output = options.output;
  if (options.output.empty())
    throw Error(ExitCode::usage, "-o", "it is missing", "name the image to write, as in -o out.exr");
  if (output.extension() != ".exr")
    throw Error(ExitCode::usage, "-o", fmt::format("'{}' does not end in .exr", options.output),
                "images are OpenEXR, with a PNG preview beside");
  auto volumes = parse_volumes(options, "vsv");
  auto surfaces = parse_surfaces(options);
  require_read(options, volumes, surfaces);
  int shadow_map = shadow_map_size(options);
  const auto require_one = [&] {
    if (volumes.size() != 1)
      throw Error(ExitCode::usage, "--volume", "render takes one method", "compare takes several");
    if (surfaces.size() != 1)
      throw Error(ExitCode::usage, "--surface", "render takes one method", "compare takes several");
  };
  require_one();
  Subject subject = make_subject(options);
  take_usual_methods(options, subject, volumes, surfaces, shadow_map);
  require_one();
  const quality::AutomaticCounts automatic = fit_to_view(volumes, surfaces, subject);
  const double limit = automatic_limit(options, automatic);
  const quality::VolumeChoice& volume = volumes[0];
  const quality::SurfaceChoice& surface = surfaces[0];
  const std::optional<std::filesystem::path> video = video_of(options);
  if (output.has_parent_path()) require_folder(output.parent_path());
  const std::filesystem::path first = subject.path ? numbered(output, 0) : output;
  require_writable(first);
  require_writable(beside(first));
  if (video) {
    if (video->has_parent_path()) require_folder(video->parent_path());
    require_writable(*video);
  }
  const std::unique_ptr<quality::Tev> tev = open_tev(options.tev);
  if (!options.quiet) say_warnings(subject.scene.report);

  require_memory({.size = subject.view.size,
                  .bytes_per_pixel = (subject.path ? k_bytes_of_path : k_bytes_of_render) +
                                     k_bytes_of_rendered_light * (subject.view.lights.size() - 1),
                  .shadow_map = quality::is_read("shadow-map", volumes, surfaces) ? shadow_map : 0,
                  .triangles = subject.scene.geometry.triangles.size(),
                  .looks = bytes_of_looks(subject.scene.geometry),
                  .scenes = subject.scenes()});
  Images images{.options = options,
                .subject = subject,
                .volume = volume,
                .surface = surface,
                .shadow_map = shadow_map,
                .exposure = subject.exposure,
                .tev = tev.get()};
  const std::span<const scene::View> views = subject.views();
  {
    ProgressLine progress(options.quiet);
    const quality::Progress follow = progress.follower();
    gpu::Context context;
    quality::take_first_looks(context, subject.scene.geometry, subject.views(), volumes, automatic,
                              shadow_map, limit, follow);
    images.renderer = context.device().renderer;
    frame::Frame frame(context, subject.scene.geometry, shadow_map, {},
                       {options.get("cache").value_or(""), follow});
    auto airlight = volume.method->make(context, volume.options);
    auto shadow = surface.method->make(context, surface.options);
    for (std::size_t i = 0; i < views.size(); ++i) {
      quality::SharedReference reference(subject.scene.geometry, views[i], follow,
                                         options.get("cache").value_or(""));
      quality::lend(reference, *airlight);
      quality::lend(reference, *shadow);
      gpu::StageTimer off(nullptr);
      frame.render(views[i], *shadow, *airlight, off, frame::Resting::kept);
      if (subject.path) {
        images.write(numbered(output, i), views[i], frame.read());
        if (follow) follow("frames", static_cast<double>(i + 1) / static_cast<double>(views.size()));
        continue;
      }
      airlight.reset();
      shadow.reset();
      images.write(output, views[i], frame.take());
    }
  }
  if (video) write_video(*video, output, *subject.path);
  if (options.quiet) return;
  say_of_tev(tev.get());
  if (images.first_is_black)
    say("airlight: warning: the image is black: " + quality::why_black(subject.scene.geometry, subject.view));
  if (!images.first_skipped.empty())
    say(fmt::format("skipped{}, because they cannot reach the view: {}",
                    subject.path ? " in the first image" : "", images.first_skipped));
  const std::string last =
      subject.path ? fmt::format(" to {}", numbered(output, views.size() - 1).string()) : "";
  say(fmt::format("{}{} and {} written, exposure {:.4g}{}", first.string(), last, beside(first).string(),
                  *images.exposure,
                  subject.exposure || images.first_is_black
                      ? ""
                      : fmt::format(" (automatic: the 95th percentile{} maps to 0.8)",
                                    subject.path ? " of the first" : "")));
}

}  // namespace airlight::app
