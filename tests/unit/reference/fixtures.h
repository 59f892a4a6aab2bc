#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <glm/glm.hpp>

#include "quality/metrics.h"
#include "reference/phase.h"
#include "reference/reference.h"
#include "reference/triangles.h"
#include "scene/scene.h"
#include "support/random.h"
#include "support/scenes.h"

/// What the tests of the reference share: geometry made by code, views of one pixel, and the airlight
/// integrated over the distance t instead of over φ, by a quadrature of its own.
namespace airlight::reference::tests {

using airlight::tests::add_box, airlight::tests::add_quad, airlight::tests::add_triangle;

/// A sphere of 2·`rings` × `rings` quads, its vertices on the sphere.
inline void add_sphere(scene::Geometry& geometry, glm::vec3 centre, float radius, int rings) {
  const auto vertex = [&](int ring, int segment) {
    const double polar = std::numbers::pi * ring / rings;
    const double azimuth = std::numbers::pi * (segment % (2 * rings)) / rings;  // closed to the last bit
    const double parallel = ring % rings == 0 ? 0.0 : std::sin(polar);
    return centre +
           radius * glm::vec3(parallel * std::cos(azimuth), std::cos(polar), parallel * std::sin(azimuth));
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int segment = 0; segment < 2 * rings; ++segment) {
      const glm::vec3 a = vertex(ring, segment), b = vertex(ring + 1, segment);
      const glm::vec3 c = vertex(ring + 1, segment + 1), d = vertex(ring, segment + 1);
      if (ring + 1 < rings) add_triangle(geometry, a, b, c);
      if (ring > 0) add_triangle(geometry, a, c, d);
    }
  }
}

/// A floor of many triangles that slants, from the origin to both sides of it; `normal` is its upper side's.
struct SlantedFloor {
  glm::dvec3 u{0.8, 0.31, 0.1}, v{-0.2, 0.17, 0.9};
  glm::dvec3 normal = -glm::normalize(glm::cross(u, v));

  scene::Geometry geometry() const {
    scene::Geometry geometry;
    for (int i = -10; i < 10; ++i) {
      for (int j = -10; j < 10; ++j)
        add_quad(geometry, glm::vec3(0.3 * i * u + 0.3 * j * v), glm::vec3(0.3 * u), glm::vec3(0.3 * v));
    }
    return geometry;
  }
};

/// Pixels that see a surface, and of those the lit ones.
struct SurfaceCount {
  std::size_t hits = 0, lit = 0;
};

inline SurfaceCount count_surfaces(const SurfaceImage& image) {
  SurfaceCount count;
  for (std::size_t i = 0; i < image.distance.size(); ++i) {
    count.hits += image.distance[i] > 0.0f ? 1u : 0u;
    count.lit += image.visibility[i] > 0.0f ? 1u : 0u;
  }
  return count;
}

/// The rrmse of an image against the truth. Refuses NaN and infinity.
inline double rrmse(const std::vector<glm::vec3>& image, const std::vector<glm::vec3>& truth) {
  return quality::airlight_error(quality::channels_of(image), quality::channels_of(truth)).rrmse;
}

inline double rrmse(const AirlightImage& image, const AirlightImage& truth) {
  return rrmse(image.radiance, truth.radiance);
}

/// Whether a triangle hides a point from the light, decided by volumes of tetrahedra: no formula is shared
/// with the intervals.
struct Crossing {
  bool hides;
  double margin;  ///< how far it is from being otherwise, relative to the volumes' factors
};

/// Whether the line through the origin along `line` passes the triangle's edges on one side of all, with the
/// least of the volumes' margins.
inline Crossing passes_inside(const Corners& c, const glm::dvec3& line) {
  const auto volume = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& d) {
    return glm::dot(a, glm::cross(b, d)) / (glm::length(a) * glm::length(b) * glm::length(d) + 1e-300);
  };
  const double edges[3] = {volume(line, c[0], c[1]), volume(line, c[1], c[2]), volume(line, c[2], c[0])};
  const bool inside =
      (edges[0] > 0 && edges[1] > 0 && edges[2] > 0) || (edges[0] < 0 && edges[1] < 0 && edges[2] < 0);
  return {inside, std::min({std::abs(edges[0]), std::abs(edges[1]), std::abs(edges[2])})};
}

/// Of all triangles: whether one hides the point, and the least margin.
/// @param crossing Crossing(corners)
template <class Find>
Crossing crossing_of_all(const std::vector<Corners>& triangles, const Find& crossing) {
  Crossing all{false, std::numeric_limits<double>::infinity()};
  for (const Corners& corners : triangles) {
    const Crossing one = crossing(corners);
    all.hides |= one.hides;
    all.margin = std::min(all.margin, one.margin);
  }
  return all;
}

/// Thirty triangles of many sizes, their middles within `reach` of the origin in each axis.
inline std::vector<Corners> random_triangles(airlight::tests::Random& random, double reach) {
  std::vector<Corners> triangles;
  for (int i = 0; i < 30; ++i) {
    const glm::dvec3 centre = random.in_box(reach);
    const double size = random.logarithmic(0.01, 3.0);
    triangles.push_back(
        {centre + random.in_box(size), centre + random.in_box(size), centre + random.in_box(size)});
  }
  return triangles;
}

/// Three vectors of whole coordinates below 2²² that span a volume of exactly 1, in that order, of terms of
/// about 2⁶⁰: rows of a product of triangular matrices with a unit diagonal.
inline Corners unit_volume(airlight::tests::Random& random) {
  const auto whole = [&] { return std::floor(random.uniform(512, 1024)); };
  const double p = whole(), q = whole(), r = whole(), u = whole(), v = whole(), w = whole();
  const glm::dvec3 first(1, u, v), second(p, p * u + 1, p * v + w), third(q, q * u + r, q * v + r * w + 1);
  const auto sheared = [](const glm::dvec3& row) { return glm::dvec3(row.x + row.y, row.y, row.z); };
  return {sheared(second), sheared(third), sheared(first + second)};
}

/// Slats of several widths at many angles, the same at every call: a view ray crosses the shadow of dozens.
inline scene::Geometry clutter(int slats) {
  scene::Geometry geometry;
  std::uint32_t state = 1;
  const auto random = [&] {  // Numerical Recipes' linear congruential generator
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 16777216.0f;
  };
  for (int i = 0; i < slats; ++i) {
    const glm::vec3 centre(4 * random() - 2, 4 * random() - 2, 4 * random() - 2);
    const glm::vec3 along = glm::normalize(glm::vec3(random(), random(), random()) - 0.5f);
    const glm::vec3 across =
        glm::normalize(glm::cross(along, glm::vec3(random(), random(), random()) - 0.5f));
    const float length = 0.3f + random(), width = 0.01f + 0.1f * random();
    add_quad(geometry, centre - 0.5f * (length * along + width * across), length * along, width * across);
  }
  return geometry;
}

/// A view of one pixel, 0.01° high, from the eye at the origin along +Z; the light at a distance D and an
/// angle α.
inline scene::View one_pixel_view(double D, double alpha, const scene::Medium& medium = {}) {
  scene::View view;
  view.camera.target = {0, 0, 1};
  view.camera.vertical_fov_degrees = 0.01;
  view.lights[0].position = D * glm::dvec3(0, std::sin(alpha), std::cos(alpha));
  view.lights[0].intensity = {2, 3, 5};
  view.medium = medium;
  view.size = {1, 1};
  return view;
}

/// A small image of the clutter around the origin, the light in its midst.
inline scene::View clutter_view(int size) {
  scene::View view;
  view.camera.eye = {0.5, 1, 6};
  view.camera.target = {0, 0, 0};
  view.lights[0].position = {0.3, 0.2, -0.4};
  view.lights[0].intensity = {2, 3, 5};
  view.medium.sigma_s = {0.1f, 0.2f, 0.3f};
  view.size = {size, size};
  return view;
}

/// ∫ f over [a, b] by Simpson's rule, halved until it settles; NaN settles at once.
template <class Function>
double integrate(const Function& f, double a, double b, double tolerance, int depth = 30) {
  const auto simpson = [](double fa, double fm, double fb, double width) {
    return width / 6 * (fa + 4 * fm + fb);
  };
  const auto refine = [&](const auto& self, double from, double to, double fa, double fm, double fb,
                          double whole, double limit, int left) -> double {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    const double fl = f(from + 0.5 * half), fr = f(middle + 0.5 * half);
    const double lower = simpson(fa, fl, fm, half), upper = simpson(fm, fr, fb, half);
    const double change = lower + upper - whole;
    if (left == 0 || !(std::abs(change) > 15 * limit + 1e-14 * std::abs(whole)))
      return lower + upper + change / 15;
    return self(self, from, middle, fa, fl, fm, lower, 0.5 * limit, left - 1) +
           self(self, middle, to, fm, fr, fb, upper, 0.5 * limit, left - 1);
  };
  const double fa = f(a), fb = f(b), fm = f(0.5 * (a + b));
  return refine(refine, a, b, fa, fm, fb, simpson(fa, fm, fb, b - a), tolerance, depth);
}

/// The airlight of the part [t_from, t_to] of a view ray, every point of it lit: the integral over t of
/// σ_s e^{−σ(t+r)} p I/r², to 1e-9. An infinite t_to ends where e^{−σt} is e^{−60}.
inline glm::dvec3 airlight_over_distance(const scene::View& view, double alpha, double t_from, double t_to) {
  const double D = glm::length(view.lights[0].position - view.camera.eye);
  const double nearest_t = D * std::cos(alpha), nearest_r = D * std::sin(alpha);
  glm::dvec3 radiance(0.0);
  for (int channel = 0; channel < 3; ++channel) {
    const auto sigma_s = static_cast<double>(view.medium.sigma_s[channel]);
    const double sigma_t = sigma_s + static_cast<double>(view.medium.sigma_a[channel]);
    if (sigma_s == 0.0) continue;
    const auto integrand = [&](double t) {
      const double r = std::hypot(t - nearest_t, nearest_r);
      const double cosine = (nearest_t - t) / r;
      return sigma_s * std::exp(-sigma_t * (t + r)) * phase(view.medium, cosine) *
             static_cast<double>(view.lights[0].intensity[channel]) / (r * r);
    };
    const double end = std::min(t_to, t_from + 60 / sigma_t + 2 * D);
    // Split around the point nearest to the light, where the integrand may be a narrow peak.
    std::vector<double> ends{t_from};
    for (double offset : {-1000.0, -100.0, -10.0, -1.0, 0.0, 1.0, 10.0, 100.0, 1000.0}) {
      const double t = nearest_t + offset * nearest_r;
      if (t > ends.back() && t < end) ends.push_back(t);
    }
    ends.push_back(end);
    double estimate = 0.0;
    for (double tolerance : {1e-3, 0.0}) {  // first for the magnitude, then to a tolerance relative to it
      double sum = 0.0;
      for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        sum += integrate(integrand, ends[i], ends[i + 1],
                         tolerance > 0 ? tolerance * sigma_s : 1e-11 * estimate);
      }
      estimate = sum;
    }
    radiance[channel] = estimate;
  }
  return radiance;
}

/// Expects the march to come to the truth as its steps grow.
inline void expect_march_converges(const Reference& reference, const AirlightImage& exact) {
  double coarser = 1.0;
  for (int samples : {16, 64, 256, 1024}) {
    const double error = rrmse(reference.march(samples, RayMode::packet), exact);
    // Each shadow edge is off by up to half a step, at random: four times the steps leave a quarter of the
    // error.
    EXPECT_LT(error, 0.45 * coarser) << samples;
    coarser = error;
  }
  EXPECT_LT(coarser, 2e-3);
}

}  // namespace airlight::reference::tests
