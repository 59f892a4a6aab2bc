#include "quality/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace airlight::quality {

double median(std::vector<double> values) {
  constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
  if (values.empty() || std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); }))
    return k_none;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

MedianInterval median_interval(std::vector<double> values) {
  constexpr double k_none = std::numeric_limits<double>::quiet_NaN(), k_missed = 0.05;
  MedianInterval interval{median(values), k_none, k_none};
  if (std::isnan(interval.median)) return interval;
  std::sort(values.begin(), values.end());

  // The largest k = heads + 1 whose interval misses the median seldom enough.
  const auto count = static_cast<double>(values.size());
  const auto probability = [count](double heads) {  // P(B = heads)
    return std::exp(std::lgamma(count + 1.0) - std::lgamma(heads + 1.0) - std::lgamma(count - heads + 1.0) -
                    count * std::numbers::ln2);
  };
  double below = probability(0.0);  // P(B <= heads)
  for (std::size_t heads = 0; 2.0 * below <= k_missed; below += probability(static_cast<double>(++heads))) {
    interval.low = values[heads];
    interval.high = values[values.size() - 1 - heads];
  }
  return interval;
}

}  // namespace airlight::quality
