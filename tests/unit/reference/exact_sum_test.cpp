#include "reference/exact_sum.h"

#include <gtest/gtest.h>

#include "unit/reference/fixtures.h"

namespace airlight::reference {
namespace {

int sign_of_volume(const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z) {
  ExactSum sum;
  sum.add_volume(glm::vec3(x), glm::vec3(y), z);
  return sum.sign();
}

TEST(ExactSum, TellsAVolumeOf1FromNoneAmongTermsOf2ToThe60) {
  airlight::tests::Random random(3);
  int wrong_in_doubles = 0;
  for (int i = 0; i < 200; ++i) {
    const auto [x, y, z] = tests::unit_volume(random);
    EXPECT_EQ(sign_of_volume(x, y, z), 1);
    EXPECT_EQ(sign_of_volume(y, x, z), -1);
    EXPECT_EQ(sign_of_volume(x, y, x + y), 0);
    EXPECT_EQ(sign_of_volume(x, y, x + y - z), -1);
    if (glm::dot(glm::cross(x, y), z) <= 0.0) ++wrong_in_doubles;
  }
  EXPECT_GT(wrong_in_doubles, 20) << "doubles would do";
}

TEST(ExactSum, TakesAllTheDigitsOfDoubles) {
  const glm::dvec3 x(1, 0, 0), y(3, 1, 0);
  const glm::dvec3 z(1.0 / 3.0, 0.1, 0x1p-200);
  EXPECT_EQ(sign_of_volume(x, y, z), 1);
  EXPECT_EQ(sign_of_volume(x, y, {z.x, z.y, -z.z}), -1);
  EXPECT_EQ(sign_of_volume(x, y, {z.x, z.y, 0.0}), 0);
}

TEST(ExactSum, VolumesThatCancelLeaveNone) {
  airlight::tests::Random random(4);
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 x(random.in_box(7.0)), y(random.in_box(0.01));
    const glm::dvec3 z = random.in_box(1e6);
    ExactSum sum;
    EXPECT_EQ(sum.sign(), 0);
    sum.add_volume(x, y, z);
    EXPECT_NE(sum.sign(), 0);
    sum.add_volume(x, y, z, -1);
    EXPECT_EQ(sum.sign(), 0);
    sum.add_volume(x, y, z);
    sum.add_volume(y, x, z);
    EXPECT_EQ(sum.sign(), 0);
  }
}

}  // namespace
}  // namespace airlight::reference
