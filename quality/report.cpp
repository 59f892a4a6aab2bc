#include "quality/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "quality/pictures.h"
#include "scene/view_fields.h"

namespace airlight::quality {
namespace {

std::string escape(const std::string& text) {
  std::string escaped;
  for (char c : text) {
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

/// A file name as a link: names hold what the user typed.
std::string link(const std::string& file) {
  std::string url;
  for (char c : file) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) ||
                          std::string_view("-_.").find(c) != std::string_view::npos;
    url += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return url;
}

std::string cell(const std::string& text) {
  return "<td>" + escape(text) + "</td>";
}

std::string percent(double value, const char* sign = "") {
  if (std::isnan(value)) return "dark";
  return *sign ? fmt::format("{:+.3f}", 100.0 * value) : fmt::format("{:.3g}", 100.0 * value);
}

constexpr const char* k_style = R"(<style>
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 1200px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { font-size: 1.2em; margin-top: 2em; } h3 { font-size: 1em; margin: 0 0 .3em; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; }
th, td { padding: .25em .8em; border-bottom: 1px solid #ddd; text-align: right; white-space: nowrap; }
th.name, td:nth-child(1), td:nth-child(2), .stages td:nth-child(3) { text-align: left; }
thead th { border-bottom: 2px solid #888; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .2em 1em; } dt { font-weight: 600; } dd { margin: 0; }
.run { border-top: 1px solid #ddd; padding: 1.2em 0; }
.images { display: flex; flex-wrap: wrap; gap: 1em; }
figure { margin: 0; flex: 1 1 300px; max-width: 560px; } figure img { width: 100%; image-rendering: pixelated; background: #000; }
figcaption { font-size: .85em; color: #555; }
code { display: block; overflow-x: auto; background: #f4f4f4; padding: .4em .7em; font-size: .85em; white-space: pre; }
.scale { height: .8em; max-width: 560px; background: linear-gradient(90deg, rgb(0,63,188), #fff 50%, rgb(188,0,0)); border: 1px solid #ccc; }
.ends { display: flex; justify-content: space-between; max-width: 560px; font-size: .85em; color: #555; }
</style>
)";

constexpr const char* k_definitions = R"(<dl>
<dt>frame [ms]</dt><dd>Wall-clock time of a whole frame from the first draw until the GPU is done, file writing left out: median over the
frames in the next column, after one frame of warm-up, on a GPU 0.3 s of them. Where the first frame took more than 2 s it is the only one.</dd>
<dt>march/frame</dt><dd>Frame time of the fastest <em>reference-march</em> row, divided by this row's frame time.</dd>
<dt>Mrays/s</dt><dd>Occlusion rays for airlight, in millions, per second of tracing and integrating on all cores.</dd>
<dt>same-surface rrmse [%], left out [pixels]</dt><dd>The same without the pixels where rasterisation, which snaps corners to 1/256
pixel, shows another surface than the reference's ray hits, and how many those are.</dd>
<dt>rrmse [%]</dt><dd>sqrt(mean((x − r)²)) / mean(r), over all channels of all pixels of the airlight: x this run's, r the reference's.
“&lt;” marks an error that is not above the bound of the reference's own error.</dd>
<dt>flicker [%]</dt><dd>sqrt(mean((e₁ − e₀)²)) / mean(r), e = x − r of a path's frame and of the one before, pixel by pixel, over those of
same-surface rrmse in both: how much the airlight changes where the reference does not. “–” where there is no frame before.</dd>
<dt>rmse</dt><dd>sqrt(mean((x − r)²)), of the same.</dd>
<dt>dark</dt><dd>The reference's mean airlight is not above a millionth of what the same light and medium would give if nothing stood
in them, or 1e-30 W/(m² sr): an error relative to it would be one of rounding, and is not told.</dd>
<dt>bias [%]</dt><dd>mean(x) / mean(r) − 1.</dd>
<dt>mae, p99, max [%]</dt><dd>Mean, 99th percentile and largest value of |x − r|, divided by mean(r).</dd>
<dt>relmse</dt><dd>mean((x − r)² / (r² + ε)), ε = 0.01 · mean(r)²; no unit.</dd>
<dt>ꟻLIP</dt><dd>Mean of HDR-ꟻLIP (Andersson et al. 2021), from 0 to 1: how much the airlight seems to change to one who flips between
both images at 67 pixels a degree, at the worst of exposures a stop apart that show the reference's brightest pixel and its median.</dd>
<dt>leaked, spurious shadow [%]</dt><dd>Σ max(0, x − r) / Σ r and Σ max(0, r − x) / Σ r, over the pixels of same-surface rrmse:
light, and shadow, where there is none.</dd>
<dt>wrong pixels, undecided</dt><dd>Surface shadow: pixels lit where a triangle hides the point that the frame shades, or dark where none
does, of all pixels that show a surface, of several lights together. That is decided without rounding about the frame's own numbers; where the
rounding of the point itself decides, the pixel is undecided, and not wrong.</dd>
<dt>memory [MiB]</dt><dd>GPU memory of scene, shadow map and method.</dd>
<dt>stages [ms]</dt><dd>Medians over frames in which the GPU is finished around each stage; their sum can exceed the frame time.
A light is skipped where it cannot reach the view: nothing that the image shows is in its cone or range, or the medium lets
through less than single precision holds.</dd>
</dl>
)";

std::string results_rows(const Comparison& comparison) {
  std::string html;
  for (const Run& run : comparison.runs) {
    const AirlightError& error = run.errors.airlight;
    std::int64_t bytes = 0;
    for (const auto& entry : run.cost.bytes) bytes += entry.second;
    html += "<tr>" + cell(run.volume) + cell(run.surface) + cell(fmt::format("{:.2f}", run.cost.frame_ms)) +
            cell(fmt::format("{}", run.cost.frames)) +
            cell(run.march_ratio > 0.0 ? fmt::format("{:.2f}", run.march_ratio) : "–") +
            cell(run.cost.rays > 0 ? fmt::format("{:.2f}", run.cost.mrays_per_s) : "–") +
            cell(fmt::format("{:.3g}", error.rmse)) + cell(error_text(error.rrmse, comparison.truth.bound)) +
            cell(error_text(run.errors.same_surface.rrmse, comparison.truth.bound)) +
            cell(fmt::format("{}", run.errors.same_surface.left_out_pixels)) +
            cell(percent(error.bias, "+")) + cell(percent(error.mae)) + cell(percent(error.p99)) +
            cell(percent(error.max)) + cell(error.is_dark ? "dark" : fmt::format("{:.3g}", error.relmse)) +
            cell(error.is_dark ? "dark" : fmt::format("{:.3g}", run.errors.flip)) +
            cell(percent(run.errors.same_surface.leaked)) + cell(percent(run.errors.same_surface.spurious)) +
            cell(fmt::format("{} / {}", run.errors.surface.wrong_pixels, run.errors.surface.pixels)) +
            cell(fmt::format("{}", run.errors.surface.undecided_pixels)) +
            cell(fmt::format("{:.1f}", static_cast<double>(bytes) / (1 << 20))) + "</tr>\n";
  }
  return html;
}

std::string stages_table(const Comparison& comparison) {
  const std::set<std::string> stages = stages_of(comparison);
  std::string html =
      "<table class=\"stages\"><thead><tr><th class=\"name\">volume</th><th class=\"name\">surface</th>"
      "<th class=\"name\">light</th>";
  for (const std::string& stage : stages) html += "<th>" + escape(stage) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const StagesRow& row : stages_rows(comparison)) {
    html += "<tr>" + cell(row.run.volume) + cell(row.run.surface) + cell(row.light);
    for (const std::string& stage : stages) {
      const auto found = row.stages_ms.find(stage);
      html += cell(found == row.stages_ms.end() ? "–" : fmt::format("{:.2f}", found->second));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string figure(const std::string& file, const std::string& caption) {
  return fmt::format(
      "<figure><a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\"></a><figcaption>{1}</figcaption></figure>\n",
      link(file), escape(caption));
}

/// A curve of each run over the frames of a path; a frame that has no value leaves a gap.
template <typename Value>
std::string chart(const Comparison& comparison, const char* title, const Value& value_of) {
  static constexpr std::array k_colours = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf"};
  constexpr double k_width = 520.0, k_height = 180.0, k_left = 60.0, k_top = 10.0;
  double most = 0.0;
  for (const Run& run : comparison.runs)
    for (const Run::Frame& frame : run.path)
      if (const double value = value_of(frame); !std::isnan(value)) most = std::max(most, value);
  if (most == 0.0) most = 1.0;
  const auto frames = static_cast<double>(std::max<std::size_t>(comparison.path->frames.size(), 2) - 1);
  std::string curves, legend;
  for (std::size_t r = 0; r < comparison.runs.size(); ++r) {
    const Run& run = comparison.runs[r];
    const char* colour = k_colours[r % k_colours.size()];
    std::string points;
    const auto end_of_curve = [&] {
      if (!points.empty())
        curves += fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" points=\"{}\"/>\n",
                              colour, points);
      points.clear();
    };
    for (std::size_t i = 0; i < run.path.size(); ++i) {
      const double value = value_of(run.path[i]);
      if (std::isnan(value)) {
        end_of_curve();
        continue;
      }
      points += fmt::format("{:.1f},{:.1f} ", k_left + k_width * static_cast<double>(i) / frames,
                            k_top + k_height * (1.0 - value / most));
    }
    end_of_curve();
    legend += fmt::format("<span style=\"color:{}\">■ {} × {}</span> ", colour, escape(run.volume),
                          escape(run.surface));
  }
  return fmt::format(
      "<figure><svg viewBox=\"0 0 {} {}\" font-size=\"11\" fill=\"#555\">\n"
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#bbb\"/>\n"
      "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.3g}</text><text x=\"{}\" y=\"{}\" "
      "text-anchor=\"end\">0</text>\n"
      "<text x=\"{}\" y=\"{}\">0</text><text x=\"{}\" y=\"{}\" text-anchor=\"end\">frame {}</text>\n"
      "{}</svg><figcaption>{}: {}</figcaption></figure>\n",
      k_left + k_width + 10.0, k_top + k_height + 20.0, k_left, k_top, k_width, k_height, k_left - 6.0,
      k_top + 8.0, most, k_left - 6.0, k_top + k_height, k_left, k_top + k_height + 15.0, k_left + k_width,
      k_top + k_height + 15.0, comparison.path->frames.size() - 1, curves, escape(title), legend);
}

std::string rows_of(const std::vector<std::vector<std::string>>& rows) {
  std::string html;
  for (const std::vector<std::string>& row : rows) {
    html += "<tr>";
    for (const std::string& text : row) html += cell(text);
    html += "</tr>\n";
  }
  return html;
}

/// Time and error along the path.
std::string path_section(const Comparison& comparison) {
  const ComparedPath& path = *comparison.path;
  std::string html = fmt::format(
      "<h2>Along the path</h2>\n<p>{} frames in {:g} s. What rests from a frame to the next, a shadow map or "
      "a "
      "volume, is not drawn anew.</p>\n<div class=\"images\">\n",
      path.frames.size(), path.seconds);
  html += chart(comparison, "frame [ms]", [](const Run::Frame& frame) { return frame.cost.ms; });
  html += chart(comparison, "rrmse [%]",
                [](const Run::Frame& frame) { return 100.0 * frame.errors.airlight.rrmse; });
  html += chart(comparison, "flicker [%]", [](const Run::Frame& frame) { return 100.0 * frame.flicker; });
  html +=
      "</div>\n<div class=\"scroll\"><table><thead><tr><th class=\"name\">volume</th><th "
      "class=\"name\">surface</th><th>frame [ms]</th><th>worst</th><th>rrmse [%]</th><th>worst</th>"
      "<th>same-surface rrmse [%]</th><th>worst</th><th>flicker [%]</th><th>worst</th><th>worst "
      "frame</th></tr></thead><tbody>\n";
  html += rows_of(spread_rows(comparison));
  html +=
      "</tbody></table></div>\n<div class=\"scroll\"><table><thead><tr><th class=\"name\">volume</th><th "
      "class=\"name\">surface</th><th>what moves</th><th>frames</th><th>shadow map redrawn in</th><th>volume "
      "redrawn in</th><th>frame [ms]</th></tr></thead><tbody>\n";
  html += rows_of(motion_rows(comparison));
  return html +
         "</tbody></table></div>\n<p>Mean and worst over frames. What moves, since the frame before; of the "
         "first, "
         "all. Below, times are means over the frames, errors those of the worst frame, which the images "
         "show.</p>\n";
}

std::string run_section(const Run& run) {
  std::string settings, debug_images;
  const auto add_settings = [&](const char* prefix, const std::map<std::string, frame::OptionValue>& values) {
    for (const auto& [name, value] : values)
      settings += fmt::format("{}{}{}={}", settings.empty() ? "" : ", ", prefix, name, frame::text_of(value));
  };
  add_settings("", run.settings);
  add_settings("surface ", run.surface_settings);
  const std::string frame = run.path.empty() ? "" : scene::frame_ending(run.worst_frame);
  const std::string which = run.path.empty() ? "" : fmt::format(", frame {}, the worst", run.worst_frame);
  for (const Run::DebugImage& image : run.debug_images) {
    debug_images += figure(image.name + ".png", fmt::format("{}; white is {:.3g} %", image.caption,
                                                            100.0 * static_cast<double>(image.white)));
  }
  return fmt::format("<section class=\"run\"><h3>{} × {}</h3>\n<p>{}</p><div class=\"images\">\n",
                     escape(run.volume), escape(run.surface), escape(settings)) +
         figure(run.name + frame + ".png", "radiance" + which) +
         figure("reference" + frame + ".png", "radiance, reference" + which) +
         figure(run.name + "_error" + frame + ".png", "airlight error, scale as above" + which) +
         figure(run.name + "_surface" + frame + ".png",
                "surface shadow: wrong pixels red, undecided ones yellow" + which) +
         debug_images + fmt::format("</div>\n<code>{}</code></section>\n", escape(run.command));
}

/// The fields of a part of the view.
template <typename Thing>
std::string definition(const std::string& term, const Thing& thing) {
  std::string text;
  scene::for_each_value(thing, [&](const scene::FieldInfo& field, const scene::FieldValue& value) {
    text += fmt::format("{}{} {}{}{}", text.empty() ? "" : ", ", field.label, scene::text_of(value),
                        field.unit.empty() ? "" : " ", field.unit);
  });
  return fmt::format("<dt>{}</dt><dd>{}</dd>\n", term, escape(text));
}

}  // namespace

std::string report_html(const Comparison& comparison) {
  const TruthFigures& truth = comparison.truth;
  const scene::View& view = comparison.view;
  std::string fields = definition("image", view) + definition("camera", view.camera);
  for (const scene::Light& light : view.lights)
    fields += definition(view.lights.size() > 1 ? "light " + escape(light.name) : "light", light);
  fields += definition("medium", view.medium);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>Airlight: "
      "{0}</title>\n{1}</head><body>\n"
      "<h1>Airlight: {0}</h1>\n",
      escape(comparison.scene), k_style);

  // What was compared, where, and with what.
  html += fmt::format(
      "<dl><dt>scene</dt><dd>{}, {} triangles, {} of zero area dropped</dd>\n{}"
      "<dt>device</dt><dd>{}, OpenGL {}, {} CPU cores; airlight {}</dd>\n"
      "<dt>reference</dt><dd>exact: the intervals of every view ray that triangles hide, {:.1f} triangles "
      "and "
      "{:.1f} lit runs a ray on average, in {:.0f} ms; own rrmse below {:.2g} %; mean airlight {:.4g} W/(m² "
      "sr)</dd>\n"
      "<dt>exposure</dt><dd>{} of the PNG images{}; the EXR images hold radiance</dd>\n</dl>\n",
      escape(comparison.scene), comparison.triangles, comparison.report.degenerate_triangles, fields,
      escape(comparison.device.renderer), escape(comparison.device.version), comparison.cores, version(),
      truth.shadows_per_pixel, truth.lit_runs_per_pixel, truth.ms, 100.0 * truth.bound, truth.mean_airlight,
      comparison.exposure.value,
      comparison.exposure.is_of_black ? ", whose reference is black"
      : comparison.exposure.is_automatic
          ? ", chosen so that the 95th percentile of the reference maps to 0.8 of white, linear"
          : "");
  for (const std::string& warning : comparison.report.warnings) {
    html += "<p>Warning: " + escape(warning) + "</p>\n";
  }

  if (truth.is_dark()) html += "<p>" + escape(dark_text(truth)) + "</p>\n";

  if (comparison.path) html += path_section(comparison);
  html +=
      "<h2>Time and error</h2>\n<div class=\"scroll\"><table><thead><tr><th class=\"name\">volume</th>"
      "<th class=\"name\">surface</th><th>frame [ms]</th><th>frames</th><th>march/frame</th><th>Mrays/s</th>"
      "<th>rmse [W/(m² sr)]</th><th>rrmse [%]</th><th>same-surface rrmse [%]</th><th>left out "
      "[pixels]</th><th>bias [%]</th><th>mae "
      "[%]</th><th>p99 [%]</th><th>max [%]</th><th>relmse</th><th>ꟻLIP</th><th>leaked [%]</th><th>spurious "
      "shadow [%]</th>"
      "<th>wrong pixels</th><th>undecided</th><th>memory [MiB]</th></tr></thead><tbody>\n" +
      results_rows(comparison) + "</tbody></table></div>\n";
  html += "<h2>Stages [ms]</h2>\n<div class=\"scroll\">" + stages_table(comparison) + "</div>\n";
  html += std::string("<h2>What the numbers mean</h2>\n") + k_definitions;

  html += fmt::format(
      "<h2>Images</h2>\n<p>Error maps: (x − r) / mean(r) of the airlight, averaged over RGB; blue where it "
      "is too dark, red where it is "
      "too bright, logarithmic, white below {0:g} %.</p>\n<div class=\"scale\"></div>"
      "<div class=\"ends\"><span>−{1:g} %</span><span>±{0:g} %</span><span>+{1:g} %</span></div>\n",
      100.0 * k_error_white, 100.0 * k_error_full);
  for (const Run& run : comparison.runs) html += run_section(run);
  return html + "</body></html>\n";
}

}  // namespace airlight::quality
