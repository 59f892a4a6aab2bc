#include "scene/catmull_rom.h"

#include <algorithm>
#include <cassert>

namespace airlight::scene {

void CatmullRom::add(double time, glm::dvec3 value) {
  assert(keys_.empty() || time > keys_.back().time);
  keys_.push_back({time, value});
}

glm::dvec3 CatmullRom::slope(std::size_t after) const {
  const Key &from = keys_[after], &to = keys_[after + 1];
  return (to.value - from.value) / (to.time - from.time);
}

glm::dvec3 CatmullRom::velocity(std::size_t key) const {
  if (key == 0 || key + 1 == keys_.size()) return glm::dvec3(0.0);
  const glm::dvec3 &before = keys_[key - 1].value, &here = keys_[key].value, &after = keys_[key + 1].value;
  if (before == here || here == after) return glm::dvec3(0.0);
  const double since = keys_[key].time - keys_[key - 1].time, until = keys_[key + 1].time - keys_[key].time;
  return (slope(key - 1) * until + slope(key) * since) / (since + until);
}

glm::dvec3 CatmullRom::at(double time) const {
  assert(!keys_.empty());
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), time,
                                     [](double t, const Key& key) { return t < key.time; });
  if (next == keys_.begin()) return keys_.front().value;
  if (next == keys_.end()) return keys_.back().value;

  // Hermite's cubic between two keys.
  const auto key = static_cast<std::size_t>(next - keys_.begin()) - 1;
  const double length = keys_[key + 1].time - keys_[key].time;
  const double s = (time - keys_[key].time) / length, rest = 1.0 - s;
  const double share = s * s * (3.0 - 2.0 * s);
  return keys_[key].value + share * (keys_[key + 1].value - keys_[key].value) +
         length * s * rest * (rest * velocity(key) - s * velocity(key + 1));
}

}  // namespace airlight::scene
