#include "quality/report.h"

#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/output.h"
#include "quality/results.h"
#include "scene/numbers.h"

namespace airlight::app {

void report(const Options& options) {
  using scene::Error;
  using scene::ExitCode;
  if (options.places.empty())
    throw Error(ExitCode::usage, "DIR", "it is missing",
                "name folders that airlight compare and airlight sweep have written");
  if (options.output.empty())
    throw Error(ExitCode::usage, "-o", "it is missing", "name the page, as in -o report.html");
  const std::filesystem::path file(options.output);
  if (file.extension() != ".html")
    throw Error(ExitCode::usage, "-o", fmt::format("'{}' does not end in .html", options.output));
  quality::ReportOptions of_report;
  if (const auto text = options.get("images"))
    of_report.images = static_cast<std::size_t>(scene::parse_count("--images", *text));
  if (file.has_parent_path()) require_folder(file.parent_path());
  require_writable(file);
  const std::vector<std::filesystem::path> places(options.places.begin(), options.places.end());
  quality::write_text(file, quality::report_html(places, of_report));
  if (!options.quiet) say_page(file);
}

}  // namespace airlight::app
