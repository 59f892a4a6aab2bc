#pragma once

#include <cmath>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace airlight::bench {

/// Of growth: the slope of log(ms) over log(count), by least squares.
template <typename Count>
double exponent(const std::vector<Count>& counts, const std::vector<double>& ms) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double a = std::log(static_cast<double>(counts[i])), b = std::log(ms[i]);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

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
