#include "quality/report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "embedded/page.h"
#include "quality/joined_runs.h"
#include "quality/page_images.h"
#include "quality/page_pictures.h"
#include "quality/report_tables.h"
#include "quality/results_json.h"
#include "scene/error.h"

namespace airlight::quality {
namespace {

using Json = nlohmann::ordered_json;

/// Numbers with six digits: what a page shows of them.
Json rounded(const Json& json) {
  if (json.is_number_float()) {
    const double value = json.get<double>();
    return std::isfinite(value) ? Json(std::stod(fmt::format("{:.6g}", value))) : Json(nullptr);
  }
  if (!json.is_structured()) return json;
  Json copy = json;
  for (Json& part : copy) part = rounded(part);
  return copy;
}

Json figures_json(const Figures& figures) {
  return {{"ms", number_json(figures.ms)},
          {"ms_low", number_json(figures.ms_low)},
          {"ms_high", number_json(figures.ms_high)},
          {"ratio", number_json(figures.ratio)},
          {"ratio_low", number_json(figures.ratio_low)},
          {"ratio_high", number_json(figures.ratio_high)},
          {"rrmse", number_json(figures.rrmse)},
          {"p99", number_json(figures.p99)},
          {"flip", number_json(figures.flip)},
          {"flicker", number_json(figures.flicker)},
          {"wrong", number_json(figures.wrong)},
          {"bytes", figures.bytes}};
}

/// Whether the runs differ in their surface shadows alone, so that those are what they are told apart by.
bool compares_surfaces(const JoinedRuns& joined) {
  const auto has_first = [&](const std::string JoinedRun::*spec) {
    return [&joined, spec](const JoinedRun& run) { return run.*spec == joined.runs[0].*spec; };
  };
  return std::all_of(joined.runs.begin(), joined.runs.end(), has_first(&JoinedRun::volume)) &&
         !std::all_of(joined.runs.begin(), joined.runs.end(), has_first(&JoinedRun::surface));
}

/// What the page's scripts read of a run.
Json run_data(const JoinedRun& run, bool is_of_surfaces) {
  const std::string& spec = is_of_surfaces ? run.surface : run.volume;
  Json data = {{"volume", run.volume},
               {"surface", run.surface},
               {"method", spec.substr(0, spec.find(':'))},
               {"device", run.device},
               {"figures", figures_json(run.figures)}};
  if (run.shadow_map) data["shadow_map"] = *run.shadow_map;
  for (const char* name :
       {"settings", "surface_settings", "command", "stages_ms", "bytes", "counters", "frames"})
    if (run.json.contains(name)) data[name] = run.json[name];
  if (run.json.contains("timing")) {
    const Json& baseline = run.json["timing"]["baseline"];
    data["baseline"] = fmt::format("{} × {}", baseline.value("volume", ""), baseline.value("surface", ""));
    data["baseline_key"] = baseline.value("key", "");
  }
  // Along a path, columns of its frames.
  Json along;
  for (const char* column : {"frame_ms", "rrmse", "same_surface_rrmse", "flip", "flicker"}) {
    const std::vector<double> values = over_views(run.json, column);
    if (values.size() < 2) continue;
    for (const double value : values) along[column].push_back(number_json(value));
  }
  if (!along.is_null()) data["along"] = std::move(along);
  return rounded(data);
}

/// JSON that may stand within a <script> element: no name in it ends that.
std::string script_text(const Json& json) {
  std::string text;
  for (const char c : text_of_json(json)) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

/// The text with each {{name}} replaced; what stands there instead is not looked through.
std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& values) {
  std::string result;
  while (true) {
    const std::size_t begin = text.find("{{");
    if (begin == std::string_view::npos) return result.append(text);
    const std::size_t end = text.find("}}", begin);
    result.append(text.substr(0, begin)).append(values.find(text.substr(begin + 2, end - begin - 2))->second);
    text.remove_prefix(end + 2);
  }
}

std::string page_of(const JoinedRuns& joined, const ReportOptions& options) {
  Json data = {{"scene", joined.scene}, {"size", {joined.size.x, joined.size.y}},
               {"views", joined.views}, {"devices", joined.devices},
               {"bound", 0.0},          {"exposure", 1.0},
               {"runs", Json::array()}};
  if (!joined.comparison.is_null()) {
    data["bound"] = joined.comparison.value(Json::json_pointer("/reference/bound"), Json());
    data["exposure"] = joined.comparison.value(Json::json_pointer("/exposure/value"), Json());
  }
  const bool is_of_surfaces = compares_surfaces(joined);
  data["compares_surfaces"] = is_of_surfaces;
  for (const JoinedRun& run : joined.runs) data["runs"].push_back(run_data(run, is_of_surfaces));
  data["pixel"] = number_json(joined.runs[0].figures.pixel);

  std::string scripts;
  for (const std::string_view script : {k_format_js, k_chart_js, k_details_js, k_stages_js, k_along_js,
                                        k_table_js, k_images_js, k_viewer_js, k_page_js})
    scripts += script;
  std::map<std::string, std::string, std::less<>> parts = {{"title", escape_html(joined.scene)},
                                                           {"style", std::string(k_page_css)},
                                                           {"facts", facts_html(joined)},
                                                           {"warnings", warnings_html(joined)},
                                                           {"tables", tables_html(joined)},
                                                           {"commands", commands_html(joined)},
                                                           {"script", scripts},
                                                           {"pictures", ""},
                                                           {"images", ""},
                                                           {"data", script_text(data)}};
  // What the rest leaves is the images', a quarter of it the pictures'.
  constexpr std::size_t k_of_descriptions = 20'000,
                        k_of_description = 300;  ///< bytes of JSON, of a run, and to spare
  const std::size_t text =
      filled(k_page_html, parts).size() + k_of_descriptions + k_of_description * joined.runs.size();
  std::size_t room = text < options.most_bytes ? options.most_bytes - text : 0;
  parts["pictures"] = pictures_html(joined, room / 4);
  room -= std::min(room, parts["pictures"].size());
  const PageImages images = page_images(joined, options.images, room);
  data["images"] = images.json;
  data["no_images"] = images.problem;
  parts["images"] = images.html;
  parts["data"] = script_text(data);
  return filled(k_page_html, parts);
}

}  // namespace

std::string report_html(std::span<const std::filesystem::path> places, const ReportOptions& options) {
  const JoinedRuns joined = join_runs(places);
  try {
    return page_of(joined, options);
  } catch (const Json::exception& error) {
    throw scene::Error(scene::ExitCode::bad_file, places[0].string(),
                       fmt::format("a value in its results is not what it should be: {}", error.what()));
  }
}

}  // namespace airlight::quality
