#pragma once

#include <stdexcept>
#include <string>

namespace airlight::scene {

/// Exit codes of the command line; each error carries the one it leads to.
enum class ExitCode : int {
  done = 0,
  threshold_missed = 1,  ///< an accuracy or time asked for was not reached
  usage = 2,             ///< the command line is wrong, an option's value that can never be right included
  bad_file = 3,          ///< bad input or output: a file, or the scene that it describes
  driver = 4,            ///< the driver cannot; the message names its limit
};

/// Bad input, a driver's limit, or failed I/O. Broken promises between our own functions are asserts instead.
///
/// `what()` reads "where: what happened; what to do".
class Error : public std::runtime_error {
 public:
  /// @param where   the culprit: a file, line, element or option
  /// @param problem what is wrong with it
  /// @param remedy  what the user can do; may be empty
  Error(ExitCode code, const std::string& where, const std::string& problem, const std::string& remedy = {})
      : std::runtime_error(where + ": " + problem + (remedy.empty() ? "" : "; " + remedy)), exit_code(code) {}

  ExitCode exit_code;
};

}  // namespace airlight::scene
