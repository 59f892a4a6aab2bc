#include "quality/report_tables.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "quality/results.h"
#include "scene/path.h"
#include "scene/view_fields.h"

namespace airlight::quality {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* k_lacking = "–";

/// A number, list or word of the results, as an option takes it.
std::string text_of(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  if (json.is_array()) {
    std::string text;
    for (const Json& part : json) text += fmt::format("{}{}", text.empty() ? "" : ",", text_of(part));
    return text;
  }
  return json.is_number_float() ? fmt::format("{}", json.get<double>()) : json.dump();
}

/// A name of the results, as "shadow_map".
std::string words_of(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

// Tables.

struct Cell {
  std::string text = k_lacking;
  double value = Figures::k_none;  ///< what it is sorted by, and written as in CSV, unless it is a name
};

Cell number_cell(double value, const char* format = "{:.3g}") {
  return std::isnan(value) ? Cell{} : Cell{fmt::format(fmt::runtime(format), value), value};
}

Cell percent_cell(double value, const char* format = "{:.3g}") {
  return number_cell(100.0 * value, format);
}

struct Column {
  std::string heading, unit;  ///< the unit may be empty
  std::vector<Cell> cells;    ///< one a row
  bool is_name = false;
};

std::string heading_of(const Column& column) {
  return escape_html(column.heading) +
         (column.unit.empty() ? ""
                              : fmt::format(" <span class=\"unit\">{}</span>", escape_html(column.unit)));
}

/// A specification may be broken at its colons.
std::string name_html(const std::string& name) {
  std::string html;
  for (const char c : escape_html(name)) html += c == ':' ? std::string(":<wbr>") : std::string(1, c);
  return html;
}

/// Columns in which nothing stands are left out.
/// @param rows the number of the run of each row
std::string table(const std::string& id, const std::string& caption, std::vector<Column> columns,
                  const std::vector<std::size_t>& rows) {
  std::erase_if(columns, [](const Column& column) {
    return std::all_of(column.cells.begin(), column.cells.end(),
                       [](const Cell& cell) { return cell.text == k_lacking; });
  });
  std::string html =
      fmt::format("<table id=\"{}\" class=\"figures\"><caption>{}</caption>\n<thead><tr>", id, caption);
  for (const Column& column : columns)
    html += fmt::format("<th scope=\"col\"{}>{}</th>", column.is_name ? " class=\"name\"" : "",
                        heading_of(column));
  html += "</tr></thead>\n<tbody>\n";
  for (std::size_t row = 0; row < rows.size(); ++row) {
    html += fmt::format("<tr data-run=\"{}\">", rows[row]);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const Cell& cell = columns[c].cells[row];
      const std::string value = std::isnan(cell.value) || columns[c].is_name
                                    ? ""
                                    : fmt::format(" data-value=\"{:.6g}\"", cell.value);
      html += c == 0 ? fmt::format("<th scope=\"row\" class=\"name\">{}</th>", name_html(cell.text))
                     : fmt::format("<td{}{}>{}</td>", columns[c].is_name ? " class=\"name\"" : "", value,
                                   columns[c].is_name ? name_html(cell.text) : escape_html(cell.text));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

/// Columns that grow row by row.
class Rows {
 public:
  explicit Rows(const JoinedRuns& joined) : joined_(joined) {}

  void add(std::size_t run) {
    runs_.push_back(run);
    next_ = 0;
    const JoinedRun& of_row = joined_.runs[run];
    name("volume", of_row.volume);
    name("surface", of_row.surface);
    put("shadow map", "texels",
        of_row.shadow_map ? number_cell(static_cast<double>(*of_row.shadow_map), "{:.0f}") : Cell{});
    if (joined_.devices.size() > 1) name("device", joined_.devices[of_row.device]);
  }
  void name(const std::string& heading, const std::string& text) {
    put(heading, "", {text, Figures::k_none});
    columns_[next_ - 1].is_name = true;
  }
  void put(const std::string& heading, const std::string& unit, Cell cell) {
    if (next_ == columns_.size()) columns_.push_back({heading, unit, {}});
    columns_[next_++].cells.push_back(std::move(cell));
  }
  std::string html(const std::string& id, const std::string& caption) && {
    return table(id, caption, std::move(columns_), runs_);
  }

 private:
  const JoinedRuns& joined_;
  std::vector<std::size_t> runs_;
  std::vector<Column> columns_;
  std::size_t next_ = 0;
};

std::string section(const std::string& heading, const std::string& html) {
  return fmt::format("<section><h2>{}</h2>\n{}</section>\n", heading, html);
}

double bound_of(const JoinedRuns& joined) {
  const double bound = number_at(joined.comparison, "/reference/bound");
  return std::isnan(bound) ? 0.0 : bound;
}

bool is_dark(const Json& run, const char* error) {
  return run.value(Json::json_pointer(fmt::format("/error/{}/dark", error)), false);
}

Cell error_cell(double rrmse, double bound, bool dark) {
  if (dark) return {"dark", Figures::k_none};
  return std::isnan(rrmse) ? Cell{} : Cell{error_text(rrmse, bound), 100.0 * rrmse};
}

/// What is relative to a dark truth is none.
Cell unless_dark(bool dark, Cell cell) {
  return dark ? Cell{"dark", Figures::k_none} : cell;
}

std::string interval_text(double low, double high, const char* format) {
  if (std::isnan(low) || std::isnan(high)) return k_lacking;
  return fmt::format("{} to {}", fmt::format(fmt::runtime(format), low),
                     fmt::format(fmt::runtime(format), high));
}

/// Of each run whether another one on its device is at once as fast and as near the truth, but not the same.
std::vector<bool> on_front(const std::vector<JoinedRun>& runs) {
  std::vector<bool> is_on_front;
  for (const JoinedRun& run : runs) {
    const Figures& a = run.figures;
    is_on_front.push_back(!std::isnan(a.rrmse) &&
                          std::none_of(runs.begin(), runs.end(), [&](const JoinedRun& other) {
                            const Figures& b = other.figures;
                            return other.device == run.device && b.ms <= a.ms && b.rrmse <= a.rrmse &&
                                   (b.ms < a.ms || b.rrmse < a.rrmse);
                          }));
  }
  return is_on_front;
}

std::string overview(const JoinedRuns& joined) {
  const double bound = bound_of(joined);
  const std::vector<bool> front = on_front(joined.runs);
  Rows rows(joined);
  for (std::size_t i = 0; i < joined.runs.size(); ++i) {
    const JoinedRun& run = joined.runs[i];
    const Figures& figures = run.figures;
    const bool dark = is_dark(run.json, "airlight");
    rows.add(i);
    rows.put("frame", "ms", number_cell(figures.ms, "{:.2f}"));
    rows.put("95 %", "ms", {interval_text(figures.ms_low, figures.ms_high, "{:.2f}"), Figures::k_none});
    rows.put("frames", "", number_cell(number_at(run.json, "/frames"), "{:.0f}"));
    rows.put("time / baseline", "", number_cell(figures.ratio));
    rows.put("95 %", "", {interval_text(figures.ratio_low, figures.ratio_high, "{:.3g}"), Figures::k_none});
    rows.put("march/frame", "", number_cell(number_at(run.json, "/march_ratio"), "{:.2f}"));
    rows.put("rays", "M/s", number_cell(number_at(run.json, "/mrays_per_s"), "{:.2f}"));
    rows.put("memory", "MiB", number_cell(figures.bytes / (1 << 20), "{:.1f}"));
    rows.put("same-surface rrmse", "%",
             error_cell(figures.rrmse, bound, is_dark(run.json, "airlight_same_surface")));
    rows.put("p99", "%", unless_dark(dark, percent_cell(figures.p99)));
    rows.put("ꟻLIP", "", unless_dark(dark, number_cell(figures.flip)));
    rows.put("flicker", "%", error_cell(figures.flicker, 2.0 * bound, false));
    rows.put("front", "", front[i] ? Cell{"●", 1.0} : Cell{});
  }
  return section(
      "Time and error",
      std::move(rows).html("overview", joined.views > 1 ? "Means over the path’s frames"
                                                        : "What a run costs and how far off it is"));
}

std::string errors(const JoinedRuns& joined) {
  const double bound = bound_of(joined);
  Rows rows(joined);
  for (std::size_t i = 0; i < joined.runs.size(); ++i) {
    const Json& run = joined.runs[i].json;
    const bool dark = is_dark(run, "airlight"), dark_surface = is_dark(run, "airlight_same_surface");
    const auto all = [&](const char* name) {
      return number_at(run, fmt::format("/error/airlight/{}", name));
    };
    const auto same = [&](const char* name) {
      return number_at(run, fmt::format("/error/airlight_same_surface/{}", name));
    };
    rows.add(i);
    rows.put("rmse", "W/(m² sr)", number_cell(all("rmse")));
    rows.put("rrmse", "%", error_cell(all("rrmse"), bound, dark));
    rows.put("same-surface rrmse", "%", error_cell(same("rrmse"), bound, dark_surface));
    rows.put("left out", "pixels", number_cell(same("left_out_pixels"), "{:.0f}"));
    rows.put("bias", "%", unless_dark(dark, percent_cell(all("bias"), "{:+.3f}")));
    rows.put("mae", "%", unless_dark(dark, percent_cell(all("mae"))));
    rows.put("p99", "%", unless_dark(dark, percent_cell(all("p99"))));
    rows.put("max", "%", unless_dark(dark, percent_cell(all("max"))));
    rows.put("relmse", "", unless_dark(dark, number_cell(all("relmse"))));
    rows.put("ꟻLIP", "", unless_dark(dark, number_cell(all("flip"))));
    rows.put("leaked", "%", unless_dark(dark_surface, percent_cell(same("leaked"))));
    rows.put("spurious shadow", "%", unless_dark(dark_surface, percent_cell(same("spurious"))));
    rows.put("wrong surfaces", "pixels",
             number_cell(number_at(run, "/error/surface/wrong_pixels"), "{:.0f}"));
    rows.put("undecided", "pixels", number_cell(number_at(run, "/error/surface/undecided_pixels"), "{:.0f}"));
    rows.put("of", "pixels", number_cell(number_at(run, "/error/surface/pixels"), "{:.0f}"));
  }
  return section("Every error",
                 std::move(rows).html(
                     "errors", joined.views > 1 ? "Of the worst frame of the path" : "Against the truth"));
}

std::string stages(const JoinedRuns& joined) {
  std::set<std::string> names;
  for (const JoinedRun& run : joined.runs)
    for (const auto& [stage, ms] : run.json.at("stages_ms").items()) names.insert(stage);
  Rows rows(joined);
  const auto add = [&](std::size_t run, const std::string& light, const Json& stages_ms) {
    rows.add(run);
    rows.name("light", light);
    for (const std::string& stage : names)
      rows.put(words_of(stage), "", number_cell(number_at(stages_ms, "/" + stage), "{:.2f}"));
  };
  for (std::size_t i = 0; i < joined.runs.size(); ++i) {
    const Json& run = joined.runs[i].json;
    const Json lights = run.value("lights", Json::array());
    add(i, lights.size() > 1 ? "all" : k_lacking, run.at("stages_ms"));
    if (lights.size() < 2) continue;
    for (const Json& light : lights)
      add(i, light.value("name", "") + (light.value("skipped", false) ? " (skipped)" : ""),
          light.value("stages_ms", Json::object()));
  }
  return section("Stages", std::move(rows).html("stages", "Time of each stage [ms]"));
}

std::string counters(const JoinedRuns& joined) {
  std::set<std::string> names;
  for (const JoinedRun& run : joined.runs)
    if (run.json.contains("counters"))
      for (const auto& [counter, value] : run.json["counters"].items()) names.insert(counter);
  if (names.empty()) return {};
  Rows rows(joined);
  for (std::size_t i = 0; i < joined.runs.size(); ++i) {
    rows.add(i);
    const Json of_run = joined.runs[i].json.value("counters", Json::object());
    for (const std::string& name : names)
      rows.put(words_of(name), "", number_cell(number_at(of_run, "/" + name), "{:.4g}"));
  }
  return section("Counters", std::move(rows).html("counters", "What no machine bends, a pixel"));
}

/// The largest of those that are numbers; NaN where none is.
double worst_of(const std::vector<double>& values) {
  double worst = Figures::k_none;
  for (const double value : values) worst = std::fmax(worst, value);
  return worst;
}

/// Mean and worst of each run over the frames.
std::string spreads(const JoinedRuns& joined) {
  const double bound = bound_of(joined);
  Rows rows(joined);
  for (std::size_t i = 0; i < joined.runs.size(); ++i) {
    const Json& run = joined.runs[i].json;
    rows.add(i);
    const auto add = [&](const char* column, const char* heading, const char* unit,
                         const std::function<Cell(double)>& cell) {
      const std::vector<double> values = over_views(run, column);
      rows.put(heading, unit, cell(mean_of(values)));
      rows.put("worst", unit, cell(worst_of(values)));
    };
    const auto error = [&](double value) { return error_cell(value, bound, std::isnan(value)); };
    add("frame_ms", "frame", "ms", [](double ms) { return number_cell(ms, "{:.2f}"); });
    add("rrmse", "rrmse", "%", error);
    add("same_surface_rrmse", "same-surface rrmse", "%", error);
    // The difference of two errors, each known to the truth's own.
    add("flicker", "flicker", "%", [&](double value) { return error_cell(value, 2.0 * bound, false); });
    rows.put("worst frame", "", number_cell(number_at(run, "/path/worst_frame"), "{:.0f}"));
  }
  return std::move(rows).html("spreads", "Mean and worst over the frames");
}

/// Each run's frames apart by what moves since the frame before.
std::string motions(const JoinedRuns& joined) {
  const Json path = joined.comparison.is_object() ? joined.comparison.value("path", Json()) : Json();
  const Json frames = path.is_object() ? path.value("frames", Json::array()) : Json::array();
  Rows rows(joined);
  for (std::size_t i = 0; i < joined.runs.size(); ++i) {
    const Json& run = joined.runs[i].json;
    if (!run.contains("path")) continue;
    const Json of_run = run["path"].value("frames", Json::array());
    for (const scene::Motion of_rows : scene::k_motions) {
      const std::string motion(scene::motion_name(of_rows));
      double count = 0.0, maps = 0.0, volumes = 0.0, ms = 0.0;
      for (std::size_t f = 0; f < std::min(frames.size(), of_run.size()); ++f) {
        if (frames[f].value("moves", "") != motion) continue;
        const Json redrawn = of_run[f].value("redrawn", Json::array());
        const auto has = [&](const char* what) {
          return static_cast<double>(std::find(redrawn.begin(), redrawn.end(), what) != redrawn.end());
        };
        count += 1.0;
        maps += has("shadow_map");
        volumes += has("volume");
        ms += of_run[f].value("frame_ms", 0.0);
      }
      if (count == 0.0) continue;
      rows.add(i);
      rows.name("what moves", motion);
      rows.put("frames", "", number_cell(count, "{:.0f}"));
      rows.put("shadow map redrawn in", "", number_cell(maps, "{:.0f}"));
      rows.put("volume redrawn in", "", number_cell(volumes, "{:.0f}"));
      rows.put("frame", "ms", number_cell(ms / count, "{:.2f}"));
    }
  }
  return std::move(rows).html("motions", "What moves, since the frame before; of the first, all");
}

std::string along_path(const JoinedRuns& joined) {
  if (joined.views < 2) return {};
  const double seconds = number_at(joined.comparison, "/path/seconds");
  const std::string length = std::isnan(seconds) ? "" : fmt::format(" in {:g} s", seconds);
  const bool has_motions = joined.comparison.is_object() && joined.comparison.contains("path");
  return section(
      "Along the path",
      fmt::format("<p>{} frames{}. What rests from a frame to the next, a shadow map or a volume, is not "
                  "drawn anew.</p>\n<div id=\"along\"></div>\n",
                  joined.views, length) +
          spreads(joined) + (has_motions ? motions(joined) : ""));
}

// Facts.

std::string term(const std::string& name, const std::string& text) {
  return fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_html(name), escape_html(text));
}

/// The fields of a part of the view.
template <typename Thing>
std::string fields_of(const std::string& name, const Json& json) {
  std::string text;
  for (const scene::Field<Thing>& field : scene::fields<Thing>()) {
    const std::string key = field.key();
    if (!json.contains(key)) continue;
    std::string value = text_of(json[key]);
    if (field.kind == scene::FieldKind::size) std::replace(value.begin(), value.end(), ',', 'x');
    text += fmt::format("{}{}{}{}{}{}", text.empty() ? "" : ", ", field.label, field.label.empty() ? "" : " ",
                        value, field.unit.empty() ? "" : " ", field.unit);
  }
  return text.empty() ? "" : term(name, text);
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string facts_html(const JoinedRuns& joined) {
  std::string devices;
  for (const std::string& device : joined.devices) devices += (devices.empty() ? "" : "; ") + device;
  const Json& comparison = joined.comparison;
  if (comparison.is_null()) {
    return term("scene", fmt::format("{}, {}x{} pixels, {} {}", joined.scene, joined.size.x, joined.size.y,
                                     joined.views, joined.views == 1 ? "view" : "views of a path")) +
           term("device", fmt::format("{}; airlight {}", devices, joined.runs[0].json.value("airlight", "")));
  }
  const Json &view = comparison.at("view"), &truth = comparison.at("reference"),
             &geometry = comparison.at("scene");
  std::string html = term(
      "scene", fmt::format("{}, {} triangles, {} of zero area dropped", joined.scene,
                           number_at(geometry, "/triangles"), number_at(geometry, "/degenerate_triangles")));
  html += fields_of<scene::View>("image", view);
  html += fields_of<scene::Camera>("camera", view.value("camera", Json::object()));
  const Json lights = view.value("lights", Json::array());
  for (const Json& light : lights)
    html += fields_of<scene::Light>(lights.size() > 1 ? "light " + light.value("name", "") : "light", light);
  html += fields_of<scene::Medium>("medium", view.value("medium", Json::object()));
  html += term("device",
               fmt::format("{}, OpenGL {}; airlight {}", devices,
                           comparison.at("device").value("version", ""), comparison.value("airlight", "")));
  html += term(
      "truth",
      fmt::format(
          "exact: the intervals of every view ray that triangles hide, {:.1f} triangles and {:.1f} lit "
          "runs a ray on average, in {:.0f} ms; own rrmse below {:.2g} %; mean airlight {:.4g} W/(m² sr)",
          number_at(truth, "/shadows_per_pixel"), number_at(truth, "/lit_runs_per_pixel"),
          number_at(truth, "/ms"), 100.0 * bound_of(joined), number_at(truth, "/mean_airlight")));
  const bool is_automatic = comparison.value(Json::json_pointer("/exposure/automatic"), false);
  return html +
         term("exposure",
              fmt::format("{} of the PNG images{}; the EXR images hold radiance",
                          number_at(comparison, "/exposure/value"),
                          is_automatic ? ", chosen so that the 95th percentile of the truth maps to 0.8 "
                                         "of white, linear"
                                       : ""));
}

std::string warnings_html(const JoinedRuns& joined) {
  if (joined.comparison.is_null()) return {};
  std::string html;
  for (const Json& warning : joined.comparison.at("scene").value("warnings", Json::array()))
    html += fmt::format("<p class=\"warning\">Warning: {}</p>\n", escape_html(text_of(warning)));
  const Json& truth = joined.comparison.at("reference");
  TruthFigures figures{};
  figures.mean_airlight = number_at(truth, "/mean_airlight");
  figures.floor = number_at(truth, "/floor");
  if (truth.value("dark", false))
    html += fmt::format("<p class=\"warning\">{}</p>\n", escape_html(dark_text(figures)));
  return html;
}

std::string tables_html(const JoinedRuns& joined) {
  return overview(joined) + errors(joined) + along_path(joined) + stages(joined) + counters(joined);
}

std::string commands_html(const JoinedRuns& joined) {
  std::string html;
  for (const JoinedRun& run : joined.runs) {
    std::string settings;
    const auto add = [&](const char* prefix, const Json& values) {
      for (const auto& [name, value] : values.items())
        settings += fmt::format("{}{}{}={}", settings.empty() ? "" : ", ", prefix, name, text_of(value));
    };
    add("", run.json.at("settings"));
    add("surface ", run.json.at("surface_settings"));
    html += fmt::format("<li><strong>{} × {}</strong> <span>{}</span><code>{}</code></li>\n",
                        name_html(run.volume), name_html(run.surface), escape_html(settings),
                        escape_html(run.json.at("command").get<std::string>()));
  }
  return html;
}

}  // namespace airlight::quality
