#pragma once

#include <string>
#include <string_view>

#include "quality/joined_runs.h"

/// The parts of a report that read without scripts.
namespace airlight::quality {

/// Text within an element or an attribute's quotes.
std::string escape_html(std::string_view text);

/// What was compared, where, and with what: the terms of a <dl>.
std::string facts_html(const JoinedRuns& joined);

/// Warnings of the comparison, a paragraph each.
std::string warnings_html(const JoinedRuns& joined);

/// Tables, each within a <section> with a heading: time and error, every error, stages, along the path.
std::string tables_html(const JoinedRuns& joined);

/// Of each run its settings and the command that repeats it.
std::string commands_html(const JoinedRuns& joined);

}  // namespace airlight::quality
