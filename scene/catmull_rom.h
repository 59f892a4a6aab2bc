#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace airlight::scene {

/// A smooth curve in time through points that need not be equally far apart in time.
///
/// Cubic in time between two keys, with a continuous velocity. At a key it is that of the parabola through
/// the key and its two neighbours: the curve of Catmull and Rom with the keys' own times as knots.
/// Based on: Catmull and Rom, "A Class of Local Interpolating Splines", 1974; for knots at uneven times Barry
/// and Goldman, "A Recursive Evaluation Algorithm for a Class of Catmull-Rom Splines", SIGGRAPH 1988.
///
/// Deviations, so that what is to rest does: the curve rests before its first key and after its last, where
/// its velocity is 0, and between two neighbouring keys that are equal.
class CatmullRom {
 public:
  /// @param time later than that of the key before
  void add(double time, glm::dvec3 value);

  /// There is a key. Exact at the keys, and where the curve rests.
  glm::dvec3 at(double time) const;

 private:
  struct Key {
    double time;
    glm::dvec3 value;
  };
  glm::dvec3 slope(std::size_t after) const;  ///< mean velocity from a key to the next
  glm::dvec3 velocity(std::size_t key) const;

  std::vector<Key> keys_;
};

}  // namespace airlight::scene
