#pragma once

#include <span>

#include "scene/builtin_internal.h"

/// What the built-in scenes by the sea are made of. Every part is a closed solid.
namespace airlight::scene {

/// The sea about the level y = 0, in waves that fade with the distance from the origin.
/// @param reach half the side of the square that it fills [m]
/// @param swell height of the waves [m]
void sea(Modeller& model, double reach, double swell);

/// A craggy rock that stands in what is below it.
/// @param size half its width, its height, half its depth [m]
void rock(Modeller& model, Random& random, glm::dvec3 foot, glm::dvec3 size);

/// A straight round rod.
void pole(Modeller& model, glm::dvec3 from, glm::dvec3 to, double radius, std::uint32_t sides = 6);

/// A rope that hangs through between its ends.
/// @param sag how much its middle lies below the straight line [m]
void rope(Modeller& model, glm::dvec3 from, glm::dvec3 to, double radius, double sag = 0.0);

/// A round hoop that lies level.
void hoop(Modeller& model, glm::dvec3 middle, double radius, double width, int steps = 32);

/// A ship with masts, yards and furled sails, shrouds and stays.
struct Ship {
  glm::dvec3 at;       ///< of the middle of its water line [m]
  double heading;      ///< from +X towards −Z [degrees]
  double length;       ///< of its hull [m]
  double mast_height;  ///< of the highest above the water [m]
  int masts;           ///< one to three
  int yards;           ///< on each mast; without, a gaff and a boom
};
void ship(Modeller& model, const Ship& ship);

}  // namespace airlight::scene
