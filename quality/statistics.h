#pragma once

#include <vector>

namespace airlight::quality {

/// The mean of the middle two of an even number. NaN where a value is.
double median(std::vector<double> values);

/// A median and the interval that holds that of the distribution which the values are drawn from, with a
/// probability of 95 % at least. NaN where there are too few values for one.
struct MedianInterval {
  double median, low, high;
};

/// Distribution-free, between two of the values by their order: with B the number of heads in n throws of a
/// coin, [x_(k), x_(n+1−k)] holds the median but for the probability 2 P(B < k). H. A. David, H. N. Nagaraja,
/// Order Statistics, 3rd edition, 2003, section 7.1. From six values on there is one.
MedianInterval median_interval(std::vector<double> values);

}  // namespace airlight::quality
