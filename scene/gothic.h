#pragma once

#include <span>

#include "scene/builtin_internal.h"

/// What the built-in scenes that are churches are made of. Every part is a closed solid.
namespace airlight::scene {

/// A pointed arch over the span from −half_width to +half_width, from its left foot to its right one.
Path pointed_arch(glm::dvec2 middle, double half_width, double height, int steps);

/// `lobes` arcs inside a circle, which they touch, meeting in cusps.
/// @param reach distance of the lobes' centres from the middle, as a part of the radius
Path foil(glm::dvec2 middle, double radius, int lobes, double reach, double turn, int steps);

/// A wall [m].
struct Wall {
  Plane plane;  ///< its inner face; w points into the hall
  double left, right, bottom, top;
  double thickness = 1.0;
  /// Across the wall, from its inner face: up to here openings are straight, and from here on they widen
  /// towards the hall, by `widening` to each side.
  double splay = -0.4, widening = 0.45;
};

/// An opening of a wall under an equilateral arch [m].
struct Opening {
  double x, half_width, sill, spring;
};

/// A wall with openings: a closed manifold, its two faces cut into upright strips that share their corners.
/// @param openings from left to right
void pierced_wall(Modeller& model, const Wall& wall, std::span<const Opening> openings);

/// An equilateral arch of bars, divided `levels` times, over `middle` on the springing line.
void tracery(Modeller& model, const Plane& plane, glm::dvec2 middle, double half_width, double sill,
             int levels, double width);

/// A column of eight clustered shafts on a plinth, with a capital, 5.8 m high.
/// @param girth factor of its radius
/// @param rise  what its shafts are longer by [m]
void column(Modeller& model, double x, double z, double girth = 1.0, double rise = 0.0);

/// A pew across the hall, from x to x + width, facing −Z.
void pew(Modeller& model, double x, double z, double width);

}  // namespace airlight::scene
