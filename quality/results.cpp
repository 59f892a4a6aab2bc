#include "quality/results.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "quality/results_json.h"
#include "scene/error.h"
#include "scene/view_fields.h"

namespace airlight::quality {
namespace {

using Json = nlohmann::ordered_json;

Json single(float value) {
  return std::stod(fmt::format("{}", value));
}

struct JsonOfField {
  Json operator()(double v) const { return v; }
  Json operator()(glm::dvec2 v) const { return {v.x, v.y}; }
  Json operator()(glm::dvec3 v) const { return {v.x, v.y, v.z}; }
  Json operator()(const std::string& v) const { return v; }
  Json operator()(glm::ivec2 v) const { return {v.x, v.y}; }
  Json operator()(const std::shared_ptr<const scene::LightTexture>& v) const { return v->name(); }
};

Json view_json(const scene::View& view) {
  Json json = {{"camera", {{"name", view.camera.name}}}};
  for (const scene::Light& light : view.lights) {
    Json of_light = {{"name", light.name}};
    for_each_value(light, [&](const scene::FieldInfo& field, const scene::FieldValue& value) {
      of_light[field.key()] = std::visit(JsonOfField(), value);
    });
    json["lights"].push_back(of_light);
  }
  for_each_value_of_view(
      view, [&](std::string_view part, const scene::FieldInfo& field, const scene::FieldValue& value) {
        (part.empty() ? json : json[part])[field.key()] = std::visit(JsonOfField(), value);
      });
  return json;
}

Json settings_json(const std::map<std::string, frame::OptionValue>& settings) {
  Json json = Json::object();
  for (const auto& [name, value] : settings) {
    std::visit([&, &key = name](const auto& v) { json[key] = v; }, value);
  }
  return json;
}

/// What each of the view's lights cost.
Json lights_json(const Run& run, const scene::View& view) {
  Json json = Json::array();
  for (std::size_t i = 0; i < run.cost.lights.size(); ++i) {
    const Cost::OfLight& light = run.cost.lights[i];
    json.push_back(
        {{"name", view.lights[i].name}, {"skipped", light.is_skipped}, {"stages_ms", light.stages_ms}});
  }
  return json;
}

Json spread_json(const Spread& spread) {
  return {{"mean", number_json(spread.mean)}, {"worst", number_json(spread.worst)}};
}

Json path_json(const Run& run) {
  Json frames = Json::array();
  for (const Run::Frame& frame : run.path) {
    frames.push_back({{"frame_ms", frame.cost.ms},
                      {"stages_ms", frame.cost.stages_ms},
                      {"redrawn", frame.cost.redrawn},
                      {"rmse", frame.errors.airlight.rmse},
                      {"rrmse", number_json(frame.errors.airlight.rrmse)},
                      {"bias", number_json(frame.errors.airlight.bias)},
                      {"same_surface_rrmse", number_json(frame.errors.same_surface.rrmse)},
                      {"flicker", number_json(frame.flicker)},
                      {"flip", number_json(frame.errors.flip)},
                      {"wrong_pixels", frame.errors.surface.wrong_pixels},
                      {"undecided_pixels", frame.errors.surface.undecided_pixels},
                      {"pixels", frame.errors.surface.pixels}});
  }
  const PathSpreads spreads = path_spreads(run);
  return {{"frame_ms", spread_json(spreads.ms)},
          {"rrmse", spread_json(spreads.rrmse)},
          {"same_surface_rrmse", spread_json(spreads.same_surface_rrmse)},
          {"flicker", spread_json(spreads.flicker)},
          {"worst_frame", run.worst_frame},
          {"frames", frames}};
}

Json surface_json(const SurfaceError& error) {
  return {{"wrong_pixels", error.wrong_pixels},
          {"undecided_pixels", error.undecided_pixels},
          {"pixels", error.pixels}};
}

}  // namespace

Json number_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json airlight_json(const AirlightError& error, double flip) {
  return {{"dark", error.is_dark},
          {"bias", number_json(error.bias)},
          {"rmse", error.rmse},
          {"rrmse", number_json(error.rrmse)},
          {"mae", number_json(error.mae)},
          {"p99", number_json(error.p99)},
          {"max", number_json(error.max)},
          {"relmse", number_json(error.relmse)},
          {"flip", number_json(flip)},
          {"leaked", number_json(error.leaked)},
          {"spurious", number_json(error.spurious)}};
}

Json same_surface_json(const SameSurfaceError& error) {
  return {{"dark", error.is_dark},
          {"bias", number_json(error.bias)},
          {"rrmse", number_json(error.rrmse)},
          {"leaked", number_json(error.leaked)},
          {"spurious", number_json(error.spurious)},
          {"left_out_pixels", error.left_out_pixels}};
}

Json interval_json(const MedianInterval& interval) {
  return {{"median", number_json(interval.median)},
          {"low", number_json(interval.low)},
          {"high", number_json(interval.high)}};
}

Json device_json(const gpu::Device& device, unsigned cores) {
  return {{"renderer", device.renderer}, {"version", device.version}, {"cores", cores}};
}

std::string text_of_json(const Json& json, int indentation) {
  return json.dump(indentation, ' ', false, Json::error_handler_t::replace);
}

Json run_json(const Run& run, const scene::View& view) {
  Json json = {{"volume", run.volume},
               {"surface", run.surface},
               {"name", run.name},
               {"settings", settings_json(run.settings)},
               {"surface_settings", settings_json(run.surface_settings)},
               {"command", run.command},
               {"stages_ms", run.cost.stages_ms},
               {"lights", lights_json(run, view)},
               {"skipped_lights", run.cost.skipped_lights()},
               {"frame_ms", run.cost.frame_ms},
               {"cpu_ms", number_json(run.cost.cpu_ms)},
               {"frames", run.cost.frames},
               {"bytes", run.cost.bytes},
               {"counters", run.cost.counters},
               {"error",
                {{"airlight", airlight_json(run.errors.airlight, run.errors.flip)},
                 {"airlight_same_surface", same_surface_json(run.errors.same_surface)},
                 {"surface", surface_json(run.errors.surface)}}}};
  if (run.cost.rays > 0) {
    json["rays"] = run.cost.rays;
    json["mrays_per_s"] = run.cost.mrays_per_s;
  }
  if (run.cost.self_error > 0.0) json["self_error"] = run.cost.self_error;
  if (run.march_ratio > 0.0) json["march_ratio"] = run.march_ratio;
  if (!run.path.empty()) json["path"] = path_json(run);
  for (const Run::DebugImage& image : run.debug_images)
    json["debug_images"].push_back(
        {{"name", image.name}, {"caption", image.caption}, {"white", single(image.white)}});
  return json;
}

std::string layout(const std::vector<std::vector<std::string>>& rows, std::size_t left) {
  std::vector<std::size_t> widths(rows[0].size());
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) line += "  ";
      line += c < left ? fmt::format("{:<{}}", row[c], widths[c]) : fmt::format("{:>{}}", row[c], widths[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

namespace {

/// The names of all stages of all runs.
std::set<std::string> stages_of(const Comparison& comparison) {
  std::set<std::string> stages;
  for (const Run& run : comparison.runs)
    for (const auto& [stage, ms] : run.cost.stages_ms) stages.insert(stage);
  return stages;
}

/// A row of the table of stages.
struct StagesRow {
  const Run& run;
  std::string light;  ///< its name; "all" for all lights, and what is no light's
  const std::map<std::string, double>& stages_ms;
};

/// Each run's, followed, where there are several lights, by one for each.
std::vector<StagesRow> stages_rows(const Comparison& comparison) {
  std::vector<StagesRow> rows;
  for (const Run& run : comparison.runs) {
    rows.push_back({run, "all", run.cost.stages_ms});
    if (comparison.view.lights.size() == 1) continue;
    for (std::size_t i = 0; i < run.cost.lights.size(); ++i) {
      const Cost::OfLight& light = run.cost.lights[i];
      rows.push_back(
          {run, comparison.view.lights[i].name + (light.is_skipped ? " (skipped)" : ""), light.stages_ms});
    }
  }
  return rows;
}

/// Time and error of each run along the path, mean and worst over its frames: volume, surface, frame [ms],
/// worst, rrmse [%], worst, same-surface rrmse [%], worst, flicker [%], worst, worst frame.
std::vector<std::vector<std::string>> spread_rows(const Comparison& comparison) {
  const auto error = [&](double value) { return error_text(value, comparison.truth.bound); };
  // It is the difference of two errors, each known to the reference's own.
  const auto change = [&](double value) {
    return std::isnan(value) ? "-" : error_text(value, 2.0 * comparison.truth.bound);
  };
  std::vector<std::vector<std::string>> rows;
  for (const Run& run : comparison.runs) {
    const PathSpreads spreads = path_spreads(run);
    rows.push_back({run.volume, run.surface, fmt::format("{:.2f}", spreads.ms.mean),
                    fmt::format("{:.2f}", spreads.ms.worst), error(spreads.rrmse.mean),
                    error(spreads.rrmse.worst), error(spreads.same_surface_rrmse.mean),
                    error(spreads.same_surface_rrmse.worst), change(spreads.flicker.mean),
                    change(spreads.flicker.worst), fmt::format("{}", run.worst_frame)});
  }
  return rows;
}

/// Each run's frames apart by what moves (shares_of_motion): volume, surface, what moves, frames, shadow maps
/// redrawn, volumes redrawn, frame [ms].
std::vector<std::vector<std::string>> motion_rows(const Comparison& comparison) {
  std::vector<std::vector<std::string>> rows;
  for (const Run& run : comparison.runs) {
    for (const MotionShare& share : shares_of_motion(*comparison.path, run)) {
      rows.push_back({run.volume, run.surface, std::string(scene::motion_name(share.motion)),
                      fmt::format("{}", share.frames), fmt::format("{}", share.shadow_maps),
                      fmt::format("{}", share.volumes), fmt::format("{:.2f}", share.ms)});
    }
  }
  return rows;
}

/// Time and error of each run along a path, and apart for each motion from frame to frame.
std::string path_tables(const Comparison& comparison) {
  const ComparedPath& path = *comparison.path;
  const auto table = [](std::vector<std::string> headings, std::vector<std::vector<std::string>> rows,
                        std::size_t names) {
    rows.insert(rows.begin(), std::move(headings));
    return layout(rows, names);
  };
  return fmt::format("path: {} frames in {:g} s, mean and worst\n", path.frames.size(), path.seconds) +
         table({"volume", "surface", "frame ms", "worst", "rrmse %", "worst", "same-surface rrmse %", "worst",
                "flicker %", "worst", "worst frame"},
               spread_rows(comparison), 2) +
         '\n' +
         table({"volume", "surface", "what moves", "frames", "shadow map", "volume redrawn", "frame ms"},
               motion_rows(comparison), 3) +
         "flicker: rms of what the error changes by since the frame before, in % of the reference's mean; on "
         "the same surface.\n"
         "what moves: since the frame before; of the first, all. shadow map, volume redrawn: in how many of "
         "these frames.\n\n";
}

}  // namespace

bool is_worse(const AirlightError& a, const AirlightError& b) {
  if (a.is_dark != b.is_dark) return b.is_dark;
  return a.is_dark ? a.rmse > b.rmse : a.rrmse > b.rrmse;
}

PathSpreads path_spreads(const Run& run) {
  const auto spread = [&](const auto& value_of) {
    Spread over{0.0, 0.0};
    int frames = 0;
    for (const Run::Frame& frame : run.path) {
      const double value = value_of(frame);
      if (std::isnan(value)) continue;
      over.mean += value;
      over.worst = std::max(over.worst, value);
      ++frames;
    }
    constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
    return frames == 0 ? Spread{k_none, k_none} : Spread{over.mean / frames, over.worst};
  };
  return {
      .ms = spread([](const Run::Frame& frame) { return frame.cost.ms; }),
      .rrmse = spread([](const Run::Frame& frame) { return frame.errors.airlight.rrmse; }),
      .same_surface_rrmse = spread([](const Run::Frame& frame) { return frame.errors.same_surface.rrmse; }),
      .flicker = spread([](const Run::Frame& frame) { return frame.flicker; })};
}

std::vector<MotionShare> shares_of_motion(const ComparedPath& path, const Run& run) {
  std::vector<MotionShare> shares;
  for (const scene::Motion motion : scene::k_motions) {
    MotionShare share{.motion = motion};
    for (std::size_t i = 0; i < run.path.size(); ++i) {
      if (path.frames[i].motion != motion) continue;
      const FrameCost& cost = run.path[i].cost;
      ++share.frames;
      share.shadow_maps += cost.redrawn.contains("shadow_map");
      share.volumes += cost.redrawn.contains("volume");
      share.ms += cost.ms;
    }
    share.ms /= std::max(share.frames, 1);
    if (share.frames > 0) shares.push_back(share);
  }
  return shares;
}

std::string version() {
  return AIRLIGHT_VERSION;
}

std::map<std::string, std::string> view_options(const scene::View& view) {
  std::map<std::string, std::string> options;
  for_each_value_of_view(
      view, [&](std::string_view, const scene::FieldInfo& field, const scene::FieldValue& value) {
        options.emplace(field.name, scene::text_of(value));
      });
  for (const scene::Light& light : view.lights) {
    const std::string prefix = view.lights.size() > 1 ? fmt::format("light.{}.", light.name) : "";
    for_each_value(light, [&](const scene::FieldInfo& field, const scene::FieldValue& value) {
      options.emplace(fmt::format("{}{}", prefix, field.name), scene::text_of(value));
    });
  }
  return options;
}

std::string dark_text(const TruthFigures& truth) {
  return fmt::format(
      "dark: the reference's mean airlight, {:.2g} W/(m2 sr), is not above the floor of {:.2g}, a millionth "
      "of "
      "what the light would give if nothing stood in it (or 1e-30); no error is told relative to it",
      truth.mean_airlight, truth.floor);
}

std::string error_text(double rrmse, double bound) {
  if (std::isnan(rrmse)) return "dark";
  if (rrmse == 0.0 && bound == 0.0) return "0";
  if (rrmse <= bound) return fmt::format("< {:.3g}", 100.0 * bound);
  return fmt::format("{:.3g}", 100.0 * rrmse);
}

std::string results_json(const Comparison& comparison) {
  Json runs = Json::array();
  for (const Run& run : comparison.runs) {
    Json json = {{"key", run.key}, {"shadow_map", run.shadow_map ? Json(*run.shadow_map) : Json(nullptr)}};
    json.update(run_json(run, comparison.view));
    runs.push_back(std::move(json));
  }
  Json json = {
      {"airlight", version()},
      {"subject", comparison.subject},
      {"scene",
       {{"name", comparison.scene},
        {"triangles", comparison.triangles},
        {"degenerate_triangles", comparison.report.degenerate_triangles},
        {"warnings", comparison.report.warnings}}},
      {"view", view_json(comparison.view)},
      {"shadow_map", comparison.shadow_map_size},
      {"exposure",
       {{"value", single(comparison.exposure.value)}, {"automatic", comparison.exposure.is_automatic}}},
      {"device", device_json(comparison.device, comparison.cores)},
      {"reference",
       {{"bound", number_json(comparison.truth.bound)},
        {"ms", comparison.truth.ms},
        {"shadows_per_pixel", comparison.truth.shadows_per_pixel},
        {"lit_runs_per_pixel", comparison.truth.lit_runs_per_pixel},
        {"mean_airlight", comparison.truth.mean_airlight},
        {"floor", comparison.truth.floor},
        {"dark", comparison.truth.is_dark()}}},
      {"runs", runs}};
  if (comparison.path) {
    Json frames = Json::array();
    for (const ComparedPath::Frame& frame : comparison.path->frames)
      frames.push_back({{"time", frame.time},
                        {"moves", scene::motion_name(frame.motion)},
                        {"bound", number_json(frame.truth.bound)},
                        {"mean_airlight", frame.truth.mean_airlight},
                        {"dark", frame.truth.is_dark()}});
    json["path"] = {{"seconds", comparison.path->seconds}, {"frames", frames}};
  }
  return text_of_json(json, 2) + "\n";
}

std::string results_table(const Comparison& comparison) {
  const TruthFigures& truth = comparison.truth;
  std::string text =
      fmt::format("{}, {}x{} pixels, {} triangles; {}, {} cores\n", comparison.scene, comparison.view.size.x,
                  comparison.view.size.y, comparison.triangles, comparison.device.renderer, comparison.cores);
  text += fmt::format(
      "reference: {:.1f} shadows and {:.1f} lit runs a view ray in {:.0f} ms, own rrmse below "
      "{:.2g} %\n\n",
      truth.shadows_per_pixel, truth.lit_runs_per_pixel, truth.ms, 100.0 * truth.bound);

  if (comparison.path) text += path_tables(comparison);

  // What each run cost and how far off it is.
  std::vector<std::vector<std::string>> rows = {
      {"volume", "surface", "frame ms", "march/frame", "Mrays/s", "rmse", "rrmse %", "bias %", "p99 %",
       "flip", "same-surface rrmse %", "left out px", "wrong px", "undecided px"}};
  for (const Run& run : comparison.runs) {
    const AirlightError& error = run.errors.airlight;
    rows.push_back({run.volume, run.surface, fmt::format("{:.2f}", run.cost.frame_ms),
                    run.march_ratio > 0.0 ? fmt::format("{:.2f}", run.march_ratio) : "-",
                    run.cost.rays > 0 ? fmt::format("{:.2f}", run.cost.mrays_per_s) : "-",
                    fmt::format("{:.3g}", error.rmse), error_text(error.rrmse, truth.bound),
                    error.is_dark ? "dark" : fmt::format("{:+.3f}", 100.0 * error.bias),
                    error.is_dark ? "dark" : fmt::format("{:.3g}", 100.0 * error.p99),
                    error.is_dark ? "dark" : fmt::format("{:.3g}", run.errors.flip),
                    error_text(run.errors.same_surface.rrmse, truth.bound),
                    fmt::format("{}", run.errors.same_surface.left_out_pixels),
                    fmt::format("{}", run.errors.surface.wrong_pixels),
                    fmt::format("{}", run.errors.surface.undecided_pixels)});
  }
  text += layout(rows, 2);

  // Where the time of each goes.
  const std::set<std::string> stages = stages_of(comparison);
  rows.assign(1, std::vector<std::string>{"volume", "surface", "light"});
  for (const std::string& stage : stages) rows[0].push_back(stage + " ms");
  for (const StagesRow& row : stages_rows(comparison)) {
    rows.push_back({row.run.volume, row.run.surface, row.light});
    for (const std::string& stage : stages) {
      const auto found = row.stages_ms.find(stage);
      rows.back().push_back(found == row.stages_ms.end() ? "-" : fmt::format("{:.2f}", found->second));
    }
  }
  text += '\n';
  text += layout(rows, 3);

  const std::size_t pixels = comparison.runs.empty() ? 0 : comparison.runs[0].errors.surface.pixels;
  text += fmt::format(
      "\n"
      "frame ms: median of whole frames, GPU finished. Stages: medians, the GPU finished around each.\n"
      "march/frame: frame time of the fastest reference-march / this frame time. Mrays/s: shadow rays for "
      "airlight.\n"
      "rmse: airlight against the reference [W/(m2 sr)]. rrmse, bias, p99: airlight against the reference, "
      "in % of its mean ({:.4g} W/(m2 sr)). < marks what "
      "is not\n"
      "above the bound of the reference's own error. same-surface: without the pixels where rasterisation "
      "shows "
      "another\n"
      "surface than the ray hits (left out). flip: mean of HDR-FLIP, 0 to 1, at 67 pixels a degree. wrong "
      "px: surfaces lit where any triangle hides the frame's own "
      "point,\n"
      "or dark where none does, of {}. undecided px: where the rounding of the point decides; they are not "
      "wrong.\n",
      truth.mean_airlight, pixels);
  if (comparison.path)
    text += "Along a path: frame ms and stages are means over its frames, errors those of the worst frame.\n";
  if (truth.is_dark()) text += dark_text(truth) + "\n";
  return text;
}

std::string shell_quote(const std::string& word) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("_-+=:,./@%").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string quoted = "'";
  for (char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text << std::flush;
  if (!stream) throw scene::Error(scene::ExitCode::bad_file, file.string(), "it cannot be written");
}

}  // namespace airlight::quality
