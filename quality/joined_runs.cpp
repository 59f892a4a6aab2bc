#include "quality/joined_runs.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "quality/run_file.h"
#include "scene/error.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;
using Json = nlohmann::ordered_json;

Figures figures_of(const Json& run) {
  Figures figures;
  figures.ms = run.at("frame_ms").get<double>();
  figures.ratio = number_at(run, "/timing/ratio/median");
  figures.ratio_low = number_at(run, "/timing/ratio/low");
  figures.ratio_high = number_at(run, "/timing/ratio/high");
  figures.ms_low = figures.ms * figures.ratio_low / figures.ratio;
  figures.ms_high = figures.ms * figures.ratio_high / figures.ratio;
  const auto mean = [&](const char* column, const char* of_image) {
    const std::vector<double> values = over_views(run, column);
    return values.empty() ? number_at(run, of_image) : mean_of(values);
  };
  figures.rrmse = mean("same_surface_rrmse", "/error/airlight_same_surface/rrmse");
  figures.p99 = mean("p99", "/error/airlight/p99");
  figures.flip = mean("flip", "/error/airlight/flip");
  figures.flicker = mean_of(over_views(run, "flicker"));
  const double pixels = mean("pixels", "/error/surface/pixels");
  if (pixels > 0.0) {
    figures.wrong = mean("wrong_pixels", "/error/surface/wrong_pixels") / pixels;
    figures.pixel = 1.0 / pixels;
  }
  for (const auto& [name, bytes] : run.at("bytes").items()) figures.bytes += bytes.get<double>();
  return figures;
}

std::string device_of(const Json& device) {
  return fmt::format("{}, {} cores", device.at("renderer").get<std::string>(), device.at("cores").get<int>());
}

class Joining {
 public:
  /// @throws scene::Error (bad_file)
  void add(const std::filesystem::path& place) {
    std::error_code error;
    if (std::filesystem::is_regular_file(place, error)) {
      add_file(place);
      return;
    }
    if (!std::filesystem::is_directory(place, error))
      throw Error(ExitCode::bad_file, place.string(), "it is not there",
                  "name a folder that airlight compare or airlight sweep has written");
    const std::filesystem::path results = place / "results.json";
    const std::vector<std::filesystem::path> swept = run_files(place);
    const bool is_comparison = std::filesystem::exists(results, error);
    if (!is_comparison && swept.empty())
      throw Error(ExitCode::bad_file, place.string(), "it holds neither results.json nor runs.jsonl",
                  "name a folder that airlight compare or airlight sweep has written");
    if (is_comparison) add_file(results);
    for (const std::filesystem::path& file : swept) add_file(file);
  }

  JoinedRuns joined() && { return std::move(joined_); }

 private:
  void add_file(const std::filesystem::path& file) {
    if (file.extension() == ".jsonl")
      add_sweep(file);
    else
      add_comparison(file);
  }

  void add_comparison(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) throw Error(ExitCode::bad_file, file.string(), "it cannot be read");
    try {
      Json results = Json::parse(text);
      const Json runs = results.at("runs");
      const Json& size = results.at("view").at("size");
      require_same(file.string(), results.at("subject"), results.at("scene").at("name"),
                   {size.at(0).get<int>(), size.at(1).get<int>()});
      require_same_truth(file.string(), results.at("reference"));
      if (results.contains("path")) joined_.views = results["path"].at("frames").size();
      const std::string device = device_of(results.at("device"));
      for (const Json& run : runs)
        add_run(run, device, file.parent_path() / run.at("name").get<std::string>());
      if (!joined_.comparison.is_null()) return;
      results.erase("runs");
      joined_.comparison = std::move(results);
      joined_.truth = file.parent_path() / "reference";
    } catch (const Json::exception&) {
      throw Error(ExitCode::bad_file, file.string(), "it is no results.json of this airlight compare",
                  "write it anew");
    }
  }

  void add_sweep(const std::filesystem::path& file) {
    const std::vector<std::string> lines = whole_lines(file);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string where = fmt::format("{}, line {}", file.string(), i + 1);
      try {
        const Json line = Json::parse(lines[i]);
        const Json& size = line.at("size");
        require_same(where, line.at("subject"), line.at("scene"),
                     {size.at(0).get<int>(), size.at(1).get<int>()});
        joined_.views = line.at("views").at("frame_ms").size();
        add_run(line, device_of(line.at("device")), {});
      } catch (const Json::exception&) {
        throw Error(ExitCode::bad_file, where, "it is no run of airlight sweep", "remove the line");
      }
    }
  }

  /// @throws scene::Error (bad_file)
  void require_same(const std::string& where, const std::string& subject, const std::string& scene,
                    glm::ivec2 size) {
    if (first_.empty()) {
      first_ = where;
      subject_ = subject;
      joined_.scene = scene;
      joined_.size = size;
    }
    if (subject == subject_) return;
    const auto named = [](const std::string& name, glm::ivec2 pixels) {
      return fmt::format("{}, {}x{} pixels", name, pixels.x, pixels.y);
    };
    const std::string ours = named(joined_.scene, joined_.size), theirs = named(scene, size);
    throw Error(ExitCode::bad_file, where,
                ours == theirs ? fmt::format("its camera, light, fog or geometry is not that of {}", first_)
                               : fmt::format("it shows another scene or view than {}: {} against {}", first_,
                                             theirs, ours),
                "write a report of each");
  }

  /// @throws scene::Error (bad_file)
  void require_same_truth(const std::string& where, const Json& truth) {
    // The same on every machine but for rounding.
    constexpr double k_same = 1e-6;
    const double mean = truth.at("mean_airlight");
    if (first_truth_.empty()) {
      first_truth_ = where;
      mean_airlight_ = mean;
    }
    if (std::abs(mean - mean_airlight_) <= k_same * std::max(mean, mean_airlight_)) return;
    throw Error(ExitCode::bad_file, where,
                fmt::format("its truth is not that of {}: a mean airlight of {:.7g} against {:.7g}",
                            first_truth_, mean, mean_airlight_),
                "compare again with one version of airlight");
  }

  void add_run(const Json& json, const std::string& device, const std::filesystem::path& image) {
    JoinedRun run;
    run.json = json;
    run.key = json.at("key");
    run.volume = json.at("volume");
    run.surface = json.at("surface");
    if (!json.at("shadow_map").is_null()) run.shadow_map = json.at("shadow_map").get<int>();
    run.figures = figures_of(json);
    run.image = image;
    for (const char* name : {"settings", "surface_settings", "stages_ms", "error"})
      static_cast<void>(json.at(name).get_ref<const Json::object_t&>());
    for (const auto& [name, ms] : json.at("stages_ms").items()) static_cast<void>(ms.get<double>());
    static_cast<void>(json.at("command").get<std::string>());

    std::vector<std::string>& devices = joined_.devices;
    const auto known = std::find(devices.begin(), devices.end(), device);
    run.device = static_cast<std::size_t>(known - devices.begin());
    if (known == devices.end()) devices.push_back(device);

    const auto same = std::find_if(joined_.runs.begin(), joined_.runs.end(), [&](const JoinedRun& other) {
      return other.key == run.key && other.device == run.device;
    });
    if (same == joined_.runs.end())
      joined_.runs.push_back(std::move(run));
    else if (same->image.empty())
      same->image = run.image;
  }

  JoinedRuns joined_;
  std::string first_, subject_;  ///< where the first run is, and what of
  std::string first_truth_;
  double mean_airlight_ = 0.0;
};

}  // namespace

double number_at(const Json& json, const std::string& pointer) {
  const Json::json_pointer place(pointer);
  return json.contains(place) && json[place].is_number() ? json[place].get<double>() : Figures::k_none;
}

std::vector<double> over_views(const Json& run, const char* column) {
  std::vector<double> values;
  const auto add = [&](const Json& value) {
    values.push_back(value.is_number() ? value.get<double>() : Figures::k_none);
  };
  if (run.contains("views"))
    for (const Json& value : run["views"].value(column, Json::array())) add(value);
  else if (run.contains("path"))
    for (const Json& frame : run["path"].at("frames")) add(frame.value(column, Json()));
  return values;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : Figures::k_none;
}

JoinedRuns join_runs(std::span<const std::filesystem::path> places) {
  Joining joining;
  for (const std::filesystem::path& place : places) joining.add(place);
  JoinedRuns joined = std::move(joining).joined();
  if (joined.runs.empty()) throw Error(ExitCode::bad_file, places[0].string(), "it holds no runs");
  return joined;
}

}  // namespace airlight::quality
