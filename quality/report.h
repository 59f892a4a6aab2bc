#pragma once

#include <string>

#include "quality/results.h"

namespace airlight::quality {

/// The comparison as one HTML page, for the folder where its images lie: what was compared with what, the
/// definition and unit of each number, and for each run its images, its error map and the command that
/// repeats it.
std::string report_html(const Comparison& comparison);

}  // namespace airlight::quality
