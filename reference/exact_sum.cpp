#include "reference/exact_sum.h"

#include <cfloat>
#include <cmath>

namespace airlight::reference {

static_assert(FLT_EVAL_METHOD == 0, "what a sum loses is known only where each operation is rounded once");

void ExactSum::add(double value) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    // The sum of two, rounded, and what the rounding lost of either.
    const double part = parts_[i], sum = value + part;
    const double of_part = sum - value, of_value = sum - of_part;
    const double lost = (value - of_value) + (part - of_part);
    if (lost != 0.0) parts_[kept++] = lost;
    value = sum;
  }
  if (value != 0.0) parts_[kept++] = value;
  count_ = kept;
}

void ExactSum::add_volume(const glm::vec3& x, const glm::vec3& y, const glm::dvec3& z, int sign) {
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    // A product of two floats has no more digits than a double.
    const double minors[2] = {static_cast<double>(x[next]) * static_cast<double>(y[last]),
                              -static_cast<double>(x[last]) * static_cast<double>(y[next])};
    for (const double minor : minors) {
      const double factor = sign * minor, product = factor * z[axis];
      add(std::fma(factor, z[axis], -product));
      add(product);
    }
  }
}

int ExactSum::sign() const {
  if (count_ == 0) return 0;
  return parts_[count_ - 1] > 0.0 ? 1 : -1;
}

}  // namespace airlight::reference
