#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace airlight::quality {

struct ReportOptions {
  std::size_t images = 8;              ///< kept whole, the truth's included
  std::size_t most_bytes = 5'000'000;  ///< of the page; images are reduced, and left out, to keep within it
};

/// What `airlight compare` and `airlight sweep` have written, joined (see join_runs) in one HTML page that
/// needs nothing else: what was compared with what; a chart of time against error; the airlight's images,
/// beside each other and less each other; where the time goes; tables of all figures, which read without
/// scripts, each with its definition and unit; and for each run the command that repeats it.
/// @throws scene::Error (bad_file) as join_runs and page_images
std::string report_html(std::span<const std::filesystem::path> places, const ReportOptions& options = {});

}  // namespace airlight::quality
