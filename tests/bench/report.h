#pragma once

#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace airlight::bench {

/// Runs a program with the words of its command line, and says what went wrong. @returns its exit code
template <class Run>
int run_and_report(const char* name, const Run& run, int count, char** words) {
  try {
    run(std::vector<std::string>(words + 1, words + count));
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return EXIT_FAILURE;
  }
}

}  // namespace airlight::bench
