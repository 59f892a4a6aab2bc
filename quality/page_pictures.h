#pragma once

#include <cstddef>
#include <string>

#include "quality/joined_runs.h"

namespace airlight::quality {

/// Previews that `airlight compare` has written, small, within the page: of each run its radiance, its
/// surface shadow and what --debug shows of its volume; along a path of the worst frame, and its error. They
/// are made smaller until they fit, and where that does not do those of the last runs are left out, and said
/// to be.
/// @param budget [bytes] of the text
/// @returns nothing where there are none
/// @throws scene::Error (bad_file) for one that cannot be read
std::string pictures_html(const JoinedRuns& joined, std::size_t budget);

}  // namespace airlight::quality
