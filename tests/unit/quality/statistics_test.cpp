#include "quality/statistics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace airlight::quality {
namespace {

std::vector<double> up_to(int count) {
  std::vector<double> values;
  for (int i = count; i > 0; --i) values.push_back(i);
  return values;
}

TEST(Median, IsTheMiddle) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_TRUE(std::isnan(median({})));
  EXPECT_TRUE(std::isnan(median({1, std::numeric_limits<double>::quiet_NaN(), 2})));
}

TEST(MedianInterval, IsThatOfTheTables) {
  // The order statistics of published tables of the sign test: k of n values at 95 %.
  for (const auto& [count, k] : {std::pair{6, 1},
                                {8, 1},
                                {9, 2},
                                {11, 2},
                                {12, 3},
                                {15, 4},
                                {20, 6},
                                {25, 8},
                                {30, 10},
                                {50, 18},
                                {100, 40}}) {
    const MedianInterval interval = median_interval(up_to(count));
    EXPECT_EQ(interval.low, k) << count;
    EXPECT_EQ(interval.high, count + 1 - k) << count;
    EXPECT_EQ(interval.median, 0.5 * (count + 1)) << count;
  }
}

TEST(MedianInterval, IsNoneOfFewValues) {
  const MedianInterval interval = median_interval(up_to(5));
  EXPECT_EQ(interval.median, 3);
  EXPECT_TRUE(std::isnan(interval.low) && std::isnan(interval.high));
}

TEST(MedianInterval, OfManyValuesIsNarrow) {
  const MedianInterval interval = median_interval(up_to(10000));
  EXPECT_NEAR(interval.low, 5000 - 98, 1);  // 1.96 · √10000 / 2
  EXPECT_NEAR(interval.high, 5001 + 98, 1);
}

}  // namespace
}  // namespace airlight::quality
