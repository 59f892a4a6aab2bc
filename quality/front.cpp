#include "quality/front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "frame/option.h"
#include "quality/results.h"
#include "quality/results_json.h"
#include "quality/run_file.h"
#include "scene/error.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;
using Json = nlohmann::ordered_json;

constexpr double k_none = std::numeric_limits<double>::quiet_NaN();

double number_of(const Json& json) {
  return json.is_null() ? k_none : json.get<double>();
}

MedianInterval interval_of(const Json& json) {
  return {number_of(json.at("median")), number_of(json.at("low")), number_of(json.at("high"))};
}

/// The mean over every `step`th value from `first` on, dark ones left out.
double mean_of(const Json& values, std::size_t first, std::size_t step) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = first; i < values.size(); i += step) {
    const double value = number_of(values[i]);
    if (std::isnan(value)) continue;
    sum += value;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : k_none;
}

SweptRun run_of(const Json& line, const FrontError& error) {
  SweptRun run;
  run.key = line.at("key");
  run.volume = line.at("volume");
  run.surface = line.at("surface");
  run.method = run.volume.substr(0, run.volume.find(':'));
  if (!line.at("shadow_map").is_null()) run.shadow_map = line.at("shadow_map").get<int>();
  for (const auto& [name, bytes] : line.at("bytes").items()) run.bytes += bytes.get<std::int64_t>();
  run.frame_ms = line.at("frame_ms");
  const Json &errors = line.at("views").at(error.column), &timing = line.at("timing");
  if (errors.size() > 1) {
    run.chosen = {mean_of(errors, 1, 2), interval_of(timing.at("odd_ratio"))};
    run.judged = {mean_of(errors, 0, 2), interval_of(timing.at("even_ratio"))};
  } else {
    run.chosen = run.judged = {mean_of(errors, 0, 1), interval_of(timing.at("ratio"))};
  }
  return run;
}

/// What the runs of a front have in common.
std::string common_of(const Json& line) {
  return Json({line.at("subject"), line.at("device"), line.at("timing").at("baseline").at("key"),
               line.at("surface"), line.at("surface_settings")})
      .dump();
}

Front front_of(const Json& line, const FrontError& error) {
  Front front;
  front.error = error;
  front.scene = line.at("scene");
  const Json &device = line.at("device"), &baseline = line.at("timing").at("baseline");
  front.device =
      fmt::format("{}, {} cores", device.at("renderer").get<std::string>(), device.at("cores").get<int>());
  front.baseline = fmt::format("{} × {}{}, {:.4g} ms", baseline.at("volume").get<std::string>(),
                               baseline.at("surface").get<std::string>(),
                               baseline.at("shadow_map").is_null()
                                   ? ""
                                   : fmt::format(", shadow map {}", baseline["shadow_map"].dump()),
                               baseline.at("frame_ms").get<double>());
  front.surface = line.at("surface");
  front.width = line.at("size").at(0);
  front.height = line.at("size").at(1);
  front.views = line.at("views").at(error.column).size();
  return front;
}

FrontLevel level_of(double error, const std::vector<SweptRun>& runs) {
  std::map<std::string, const SweptRun*> best;
  for (const SweptRun& run : runs) {
    if (!(run.chosen.error <= error) || std::isnan(run.chosen.ratio.median)) continue;
    const SweptRun*& of_method = best[run.method];
    if (!of_method || run.chosen.ratio.median < of_method->chosen.ratio.median) of_method = &run;
  }
  FrontLevel level{error, {}};
  for (const auto& [method, run] : best) level.methods.push_back({*run, run->judged.error <= error});
  std::sort(level.methods.begin(), level.methods.end(), [](const FrontEntry& a, const FrontEntry& b) {
    return std::tuple(!a.holds, a.run.chosen.ratio.median) < std::tuple(!b.holds, b.run.chosen.ratio.median);
  });
  return level;
}

Json over_views_json(const SweptRun::OverViews& over) {
  return {{"error", number_json(over.error)}, {"ratio", interval_json(over.ratio)}};
}

/// "0.82 (0.79 to 0.86)"
std::string interval_text(const MedianInterval& interval) {
  if (std::isnan(interval.median)) return "-";
  if (std::isnan(interval.low)) return fmt::format("{:.3g}", interval.median);
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", interval.median, interval.low, interval.high);
}

std::vector<std::string> row_of(const FrontLevel& level, double shown) {
  const std::string error = fmt::format("{:g}", shown * level.error);
  const SweptRun *best = level.best(), *rival = level.rival();
  if (!best) return {error, "-", "-", "-", "-", "-", "-", "-", "-", "-"};
  return {error,
          best->volume,
          best->shadow_map ? fmt::format("{}", *best->shadow_map) : "-",
          fmt::format("{:.3g}", shown * best->judged.error),
          fmt::format("{:.2f}", best->frame_ms),
          interval_text(best->judged.ratio),
          fmt::format("{:.1f}", static_cast<double>(best->bytes) / (1024.0 * 1024.0)),
          rival ? interval_text(level.lead()) : "-",
          !rival          ? "alone"
          : level.leads() ? "leads"
                          : "does not lead",
          rival ? rival->volume : "-"};
}

}  // namespace

MedianInterval FrontLevel::lead() const {
  if (!best() || !rival()) return {k_none, k_none, k_none};
  const MedianInterval &of_best = best()->judged.ratio, &of_rival = rival()->judged.ratio;
  return {of_rival.median / of_best.median, of_rival.low / of_best.high, of_rival.high / of_best.low};
}

const FrontError& parse_front_error(std::string_view name) {
  frame::Words words;
  for (const FrontError& error : k_front_errors) words.push_back({error.name});
  return k_front_errors[frame::parse_word("--error", name, words)];
}

std::vector<Front> read_fronts(std::span<const std::filesystem::path> places, const FrontError& error) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& place : places) {
    if (place.extension() == ".jsonl") {
      files.push_back(place);
      continue;
    }
    const std::vector<std::filesystem::path> found = run_files(place);
    if (found.empty())
      throw Error(ExitCode::bad_file, place.string(), "it holds no runs",
                  "name a folder that airlight sweep has written");
    files.insert(files.end(), found.begin(), found.end());
  }

  struct Group {
    Front front;
    std::vector<SweptRun> runs;
  };
  std::vector<std::pair<std::string, Group>> groups;
  for (const std::filesystem::path& file : files) {
    const std::vector<std::string> lines = whole_lines(file);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      try {
        const Json line = Json::parse(lines[i]);
        const std::string common = common_of(line);
        auto group = std::find_if(groups.begin(), groups.end(),
                                  [&](const auto& entry) { return entry.first == common; });
        if (group == groups.end()) group = groups.insert(group, {common, {front_of(line, error), {}}});
        std::vector<SweptRun>& runs = group->second.runs;
        SweptRun run = run_of(line, error);
        if (std::none_of(runs.begin(), runs.end(), [&](const SweptRun& r) { return r.key == run.key; }))
          runs.push_back(std::move(run));
      } catch (const Json::exception&) {
        throw Error(ExitCode::bad_file, fmt::format("{}, line {}", file.string(), i + 1),
                    "it is no run of airlight sweep");
      }
    }
  }
  if (groups.empty()) throw Error(ExitCode::bad_file, places[0].string(), "it holds no runs");

  std::vector<Front> fronts;
  for (auto& [common, group] : groups) {
    group.front.runs = group.runs.size();
    for (const double level : error.levels) group.front.levels.push_back(level_of(level, group.runs));
    fronts.push_back(std::move(group.front));
  }
  return fronts;
}

std::string front_json(std::span<const Front> fronts) {
  Json json = {{"airlight", version()}, {"fronts", Json::array()}};
  for (const Front& front : fronts) {
    Json levels = Json::array();
    for (const FrontLevel& level : front.levels) {
      Json methods = Json::array();
      for (const FrontEntry& entry : level.methods) {
        const SweptRun& run = entry.run;
        methods.push_back({{"method", run.method},
                           {"key", run.key},
                           {"volume", run.volume},
                           {"shadow_map", run.shadow_map ? Json(*run.shadow_map) : Json(nullptr)},
                           {"bytes", run.bytes},
                           {"frame_ms", run.frame_ms},
                           {"holds", entry.holds},
                           {"chosen", over_views_json(run.chosen)},
                           {"judged", over_views_json(run.judged)}});
      }
      levels.push_back({{"error", level.error},
                        {"leads", level.leads()},
                        {"lead", interval_json(level.lead())},
                        {"methods", methods}});
    }
    json["fronts"].push_back({{"scene", front.scene},
                              {"size", {front.width, front.height}},
                              {"views", front.views},
                              {"device", front.device},
                              {"surface", front.surface},
                              {"baseline", front.baseline},
                              {"runs", front.runs},
                              {"error", front.error.name},
                              {"levels", levels}});
  }
  return text_of_json(json, 2) + "\n";
}

std::string front_tables(std::span<const Front> fronts) {
  std::string text;
  for (const Front& front : fronts) {
    text += fmt::format("{}, {}x{} pixels, {} {}, {} runs; {}; surface {}\nbaseline: {}\n", front.scene,
                        front.width, front.height, front.views, front.views == 1 ? "view" : "views",
                        front.runs, front.device, front.surface, front.baseline);
    const std::string_view unit = front.error.shown == 100.0 ? " %" : "";
    std::vector<std::vector<std::string>> rows = {{fmt::format("error{}", unit), "cheapest", "shadow map",
                                                   fmt::format("its error{}", unit), "frame ms",
                                                   "time/baseline", "MiB", "lead", "", "over"}};
    for (const FrontLevel& level : front.levels) rows.push_back(row_of(level, front.error.shown));
    text += layout(rows, 2) + '\n';
  }
  text +=
      fmt::format("error: {}.", fronts.empty() ? "" : fronts[0].error.meaning) +
      " cheapest: of all methods and settings whose error is not above it, with the least time.\n"
      "Of several views settings are chosen by those with odd numbers; error, time and lead are those of the "
      "even ones, and\n"
      "what is above the error there is not shown. time/baseline: median over rounds (95 % interval). lead: "
      "the time of the best\n"
      "other method over this one's (interval of 90 % at least); it leads where that excludes 1.\n";
  return text;
}

}  // namespace airlight::quality
