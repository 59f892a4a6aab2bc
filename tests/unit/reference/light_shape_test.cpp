#include "reference/light_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reference/fog_quadrature.h"
#include "scene/light_texture.h"
#include "support/random.h"
#include "unit/reference/fixtures.h"

/// Spots and ranges: the shares themselves, their closed forms in empty fog, and against an integral over
/// the distance that knows nothing of half-planes.
namespace airlight::reference {
namespace {

using airlight::tests::Random;
using std::numbers::pi;
using tests::one_pixel_view;

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// glTF's formulas at a point relative to the light [m].
double share_at(const scene::Light& light, const glm::dvec3& point) {
  const double r = glm::length(point);
  double share = light.range ? std::max(1.0 - std::pow(r / *light.range, 4.0), 0.0) : 1.0;
  if (light.cone) {
    const double cosine = glm::dot(point, light.cone->axis) / r;
    const double inner = std::cos(light.cone->inner), outer = std::cos(light.cone->outer);
    const double ramp = inner == outer ? (cosine >= outer ? 1.0 : 0.0)
                                       : std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    share *= ramp * ramp;
  }
  return share;
}

scene::Cone random_cone(Random& random) {
  const double outer = random.uniform() < 0.2 ? 0.5 * pi : 0.5 * pi * random.logarithmic(0.01, 1.0);
  const double part = random.uniform();
  return {.axis = random.direction(),
          .inner = part < 0.3   ? 0.0
                   : part < 0.6 ? outer
                                : part * outer,
          .outer = outer};
}

/// With a cone, a range, or both.
scene::Light random_light(Random& random, double D) {
  scene::Light light;
  const std::uint32_t kind = random.bits() % 3;
  if (kind != 0) light.cone = random_cone(random);
  if (kind != 1) light.range = D * random.logarithmic(0.1, 10.0);
  return light;
}

ViewRay random_ray(Random& random) {
  const double D = random.logarithmic(0.1, 100.0);
  const double end = random.uniform() < 0.5 ? 0.0 : D * random.logarithmic(0.1, 10.0);
  const glm::dvec3 l = random.direction(), m = glm::normalize(glm::cross(l, random.direction()));
  const double alpha =
      random.uniform() < 0.5 ? random.uniform(1e-3, pi - 1e-3) : random.logarithmic(1e-4, 1.0);
  return make_view_ray(-D * l, std::cos(alpha) * l + std::sin(alpha) * m, {1.0, 0.0, 0.0}, end, 1e-6);
}

TEST(LightShape, IsGltfsFormulaInPiecesThatHoldAllThatIsLit) {
  Random random(1);
  int lit = 0, even = 0;
  for (int i = 0; i < 2000; ++i) {
    const ViewRay ray = random_ray(random);
    const scene::Light light = random_light(random, ray.D);
    LightShape shape(light);
    ASSERT_TRUE(shape.is_shaped());
    shape.aim(ray);
    double last = k_infinity;
    shape.for_each_piece(ray.psi_start, ray.psi_end, [&](double from, double to, bool) {
      EXPECT_LE(from, last);
      EXPECT_LT(to, from);
      last = to;
    });
    for (int sample = 0; sample < 50; ++sample) {
      const double psi = ray.psi(random.uniform());
      const glm::dvec3 point =
          ray.D * ray.sin_alpha / std::sin(psi) * (std::cos(psi) * ray.w + std::sin(psi) * ray.q);
      const double expected = share_at(light, point);
      const double share = shape.at(psi);
      // The ramp is as steep as it is narrow; the half-plane of a ray straight to the light has fewer digits.
      const double slope =
          light.cone ? 1.0 / std::max(std::cos(light.cone->inner) - std::cos(light.cone->outer), 1e-3) : 1.0;
      const bool is_step = light.cone && light.cone->inner == light.cone->outer;
      if (!is_step || (share > 0.0) == (expected > 0.0)) {
        EXPECT_NEAR(share, expected, 1e-10 * slope);
      }
      int pieces = 0;
      shape.for_each_piece(ray.psi_start, ray.psi_end, [&](double from, double to, bool is_even) {
        if (psi > from || psi < to) return;
        ++pieces;
        if (is_even) {
          EXPECT_NEAR(expected, 1.0, 1e-9);
        }
        even += is_even ? 1 : 0;
      });
      EXPECT_LE(pieces, 1);
      if (expected > 1e-9) {
        EXPECT_EQ(pieces, 1);
      }
      if (pieces == 0) {
        EXPECT_NEAR(expected, 0.0, 1e-9);
      }
      lit += pieces;
    }
  }
  EXPECT_GT(lit, 10000);
  EXPECT_GT(even, 1000);
}

TEST(LightShape, OfALampIsNone) {
  EXPECT_FALSE(LightShape(scene::Light{}).is_shaped());
}

TEST(LightShape, FourTimesTheNodesChangeNothingBeyondTheBound) {
  Random random(2);
  int integrated = 0;
  for (int i = 0; i < 20000; ++i) {
    const ViewRay ray = random_ray(random);
    const scene::Light light = random_light(random, ray.D);
    scene::Medium medium;
    medium.phase = static_cast<scene::PhaseFunction>(random.bits() % 4);
    medium.g = static_cast<float>(random.uniform(-0.99, 0.99));
    const double sigma_t = random.uniform() < 0.1 ? 0.0 : random.logarithmic(1e-4, 30.0) / ray.D;
    const double s = random.uniform(), length = random.logarithmic(1e-4, 1.0);
    LightShape shape(light);
    shape.aim(ray);
    FogQuadrature fog(ray, sigma_t, medium);
    const double from = ray.psi(s), to = std::max(ray.psi(s + length), ray.psi_end);
    const double usual = fog.integral(from, to, nullptr, &shape).r;
    fog.refine(4);
    const double fine = fog.integral(from, to, nullptr, &shape).r;
    EXPECT_NEAR(usual, fine, FogQuadrature::k_error * fine + 1e-300)
        << "D " << ray.D << " range " << light.range.value_or(0.0) << " psi " << ray.psi_start << " to "
        << ray.psi_end << " from " << from << " to " << to;
    integrated += usual > 0.0 ? 1 : 0;
  }
  EXPECT_GT(integrated, 3000);
}

/// Of a view of one pixel.
glm::dvec3 exact_airlight(const scene::View& view) {
  return glm::dvec3(Reference({}, view).exact().radiance[0]);
}

void expect_near(const glm::dvec3& value, const glm::dvec3& expected, double tolerance = 1e-6) {
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(value[channel], expected[channel], tolerance * expected[channel]) << "channel " << channel;
}

/// Coloured fog with a lobe.
scene::Medium hazy() {
  return {.sigma_s = {0.1f, 0.3f, 0.6f},
          .sigma_a = {0.0f, 0.1f, 0.0f},
          .phase = scene::PhaseFunction::hoffman_preetham,
          .g = 0.6f};
}

const double k_angles[] = {0.01, 0.3, 1.0, 2.0, 3.0};

TEST(Spot, OfARightAngleIsALampInTheHalfSpaceBeforeIt) {
  Random random(3);
  for (double alpha : k_angles) {
    for (int i = 0; i < 10; ++i) {
      scene::View view = one_pixel_view(3.0, alpha, hazy());
      const glm::dvec3 axis = random.direction(), light = view.lights[0].position;
      view.lights[0].cone = {.axis = axis, .inner = 0.5 * pi, .outer = 0.5 * pi};
      // The view ray goes through the half-space's face once, along +Z.
      const double face = glm::dot(light, axis) / axis.z;
      const bool is_before = axis.z > 0.0;  // what lies beyond the face
      const double from = is_before ? std::max(face, 0.0) : 0.0;
      const double to = is_before ? k_infinity : std::max(face, 0.0);
      expect_near(exact_airlight(view), tests::airlight_over_distance(view, alpha, from, to), 2e-6);
    }
  }
}

TEST(Spot, WithAStepLightsTheFogBetweenItsTwoRoots) {
  Random random(4);
  int between = 0, beyond = 0;
  for (double alpha : k_angles) {
    for (int i = 0; i < 40; ++i) {
      scene::View view = one_pixel_view(3.0, alpha, hazy());
      const glm::dvec3 light = view.lights[0].position;
      const double half_angle = random.uniform(0.05, 1.5), square = std::pow(std::cos(half_angle), 2.0);
      const glm::dvec3 axis =
          i % 2 == 0 ? random.direction() : glm::normalize(glm::dvec3(0, 0, random.uniform(0, 5)) - light);
      view.lights[0].cone = {.axis = axis, .inner = half_angle, .outer = half_angle};
      // ((P − L) · a)² = cos² γ |P − L|² with P = (0, 0, t).
      const double a = axis.z * axis.z - square;
      const double b = -2 * axis.z * glm::dot(light, axis) + 2 * square * light.z;
      const double c = std::pow(glm::dot(light, axis), 2.0) - square * glm::dot(light, light);
      std::vector<double> ends{0.0};
      if (const double discriminant = b * b - 4 * a * c; discriminant > 0.0) {
        double lower = (-b - std::sqrt(discriminant)) / (2 * a),
               upper = (-b + std::sqrt(discriminant)) / (2 * a);
        if (lower > upper) std::swap(lower, upper);
        for (double t : {lower, upper})
          if (t > 0.0) ends.push_back(t);
      }
      ends.push_back(k_infinity);
      glm::dvec3 expected(0.0);
      for (std::size_t end = 0; end + 1 < ends.size(); ++end) {
        const bool is_last = std::isinf(ends[end + 1]);
        const double inside = is_last ? ends[end] + 1.0 : 0.5 * (ends[end] + ends[end + 1]);
        if (share_at(view.lights[0], glm::dvec3(0, 0, inside) - light) == 0.0) continue;
        expected += tests::airlight_over_distance(view, alpha, ends[end], ends[end + 1]);
        ++(is_last ? beyond : between);
      }
      expect_near(exact_airlight(view), expected, 2e-6);
    }
  }
  EXPECT_GT(between, 20);
  EXPECT_GT(beyond, 20);
}

/// The integral over the distance, the light's share taken at each point: many short intervals, because it
/// has kinks.
glm::dvec3 by_brute_force(const scene::View& view) {
  const scene::Light& light = view.lights[0];
  glm::dvec3 radiance(0.0);
  for (int channel = 0; channel < 3; ++channel) {
    const auto sigma_s = static_cast<double>(view.medium.sigma_s[channel]);
    const double sigma_t = sigma_s + static_cast<double>(view.medium.sigma_a[channel]);
    const auto integrand = [&](double t) {
      const glm::dvec3 from_light = glm::dvec3(0, 0, t) - light.position;
      const double r = glm::length(from_light);
      return sigma_s * std::exp(-sigma_t * (t + r)) * phase(view.medium, -from_light.z / r) *
             static_cast<double>(light.intensity[channel]) / (r * r) * share_at(light, from_light);
    };
    const int intervals = 400;
    const auto place = [&](int n) {
      return (30 / sigma_t + 6) * std::pow(static_cast<double>(n) / intervals, 3);
    };
    for (int i = 0; i < intervals; ++i)
      radiance[channel] += tests::integrate(integrand, place(i), place(i + 1), 1e-12);
  }
  return radiance;
}

TEST(Spot, WithARampAndARangeMatchesBruteForce) {
  Random random(5);
  int lit = 0;
  for (double alpha : {0.05, 0.3, 1.0, 2.0, 3.0}) {
    for (int i = 0; i < 12; ++i) {
      scene::View view = one_pixel_view(3.0, alpha, hazy());
      scene::Light& light = view.lights[0];
      const glm::dvec3 aim(0, 0, random.uniform(0, 6));
      const double outer = random.uniform(0.1, 0.5 * pi);
      if (i % 3 != 0)
        light.cone = {.axis = glm::normalize(aim - light.position),
                      .inner = random.uniform(0, 0.95) * outer,
                      .outer = outer};
      if (i % 3 != 1) light.range = random.uniform(0.5, 8.0);
      const glm::dvec3 expected = by_brute_force(view);
      expect_near(exact_airlight(view), expected, 2e-6);
      // The midpoint rule over kinks.
      const glm::dvec3 march(Reference({}, view).march(8192, RayMode::packet).radiance[0]);
      expect_near(march, expected, 1e-4);
      lit += expected.x > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(lit, 40);
}

/// The clutter, a spot and a range that end in the midst of what is seen.
scene::View clutter_with_spot(int size, double inner) {
  scene::View view = tests::clutter_view(size);
  view.lights[0].cone = {.axis = glm::normalize(glm::dvec3(0.3, -0.2, 1)), .inner = inner, .outer = 0.7};
  view.lights[0].range = 4.0;
  return view;
}

TEST(Spot, AmongOccludersIsAlikeForEveryWayToTraceIt) {
  for (double inner : {0.3, 0.7}) {
    const scene::View view = clutter_with_spot(12, inner);
    const Reference reference(tests::clutter(40), view);
    const AirlightImage exact = reference.exact();
    EXPECT_LT(tests::rrmse(reference.exact(4), exact), exact.bound);
    EXPECT_LT(tests::rrmse(reference.sampled(2048), exact), 2e-4);
    // Its error is of the order of a step: of each shadow's edge, and of a cone's that is one.
    EXPECT_LT(tests::rrmse(reference.march(256, RayMode::packet), exact), 2e-2);
    EXPECT_LT(tests::rrmse(reference.march(4096, RayMode::packet), exact), 2e-3);
  }
}

TEST(Spot, WithATextureIsTheProductOfBoth) {
  scene::View view = clutter_with_spot(8, 0.3);
  scene::View scaled = view;
  const glm::vec3 colour(0.5f, 2.0f, 0.0f);
  scaled.lights[0].intensity *= colour;
  view.lights[0].texture =
      std::make_shared<scene::LightTexture>("", glm::ivec2(7, 4), std::vector<glm::vec3>(28, colour));
  const scene::Geometry geometry = tests::clutter(40);
  const Reference textured(geometry, view), plain(geometry, scaled);
  EXPECT_LT(tests::rrmse(textured.exact(), plain.exact()), 1e-6);
  EXPECT_LT(tests::rrmse(textured.march(64, RayMode::packet), plain.march(64, RayMode::packet)), 1e-6);
}

TEST(Spot, LeavesTheShadowsOnSurfacesAsTheyAre) {
  const scene::Geometry geometry = tests::clutter(40);
  EXPECT_EQ(Reference(geometry, clutter_with_spot(24, 0.3)).surfaces().visibility,
            Reference(geometry, tests::clutter_view(24)).surfaces().visibility);
}

}  // namespace
}  // namespace airlight::reference
