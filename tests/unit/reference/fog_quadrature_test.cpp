#include "reference/fog_quadrature.h"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "support/random.h"

namespace airlight::reference {
namespace {

/// A view ray up to a random end, or endless.
ViewRay random_ray(airlight::tests::Random& random) {
  const double D = random.logarithmic(0.1, 100.0);
  const double alpha =
      random.uniform() < 0.5 ? random.uniform(1e-3, std::numbers::pi - 1e-3) : random.logarithmic(1e-4, 1.0);
  const double end = random.uniform() < 0.5 ? 0.0 : D * random.logarithmic(0.01, 100.0);
  return make_view_ray({0.0, 0.0, -D}, {std::sin(alpha), 0.0, std::cos(alpha)}, {1.0, 0.0, 0.0}, end, 1e-6);
}

/// The same in a layer whose top is anywhere near, the rays at any slope.
ViewRay random_ray_in_layer(airlight::tests::Random& random) {
  const double D = random.logarithmic(0.1, 100.0);
  const glm::dvec3 eye = D * random.direction();
  const double end = random.uniform() < 0.5 ? 0.0 : D * random.logarithmic(0.01, 100.0);
  glm::dvec3 w = random.direction();
  if (random.uniform() < 0.3) w = glm::normalize(glm::dvec3(w.x, 1e-3 * w.y, w.z));
  const double top = (random.uniform() < 0.5 ? -1.0 : 1.0) * D * random.logarithmic(1e-4, 10.0);
  return make_view_ray(eye, w, {1.0, 0.0, 0.0}, end, 1e-6, top);
}

void expect_unchanged_by_more_nodes(ViewRay (*make_ray)(airlight::tests::Random&)) {
  airlight::tests::Random random(1);
  int integrated = 0;
  for (int i = 0; i < 20000; ++i) {
    const ViewRay ray = make_ray(random);
    scene::Medium medium;
    medium.phase = static_cast<scene::PhaseFunction>(random.bits() % 4);
    const double sharpness = random.logarithmic(0.01, 1.0);
    medium.g = static_cast<float>(random.uniform() < 0.5 ? 1.0 - sharpness : sharpness - 1.0);
    const double sigma_t = random.uniform() < 0.1 ? 0.0 : random.logarithmic(1e-4, 30.0) / ray.D;
    const double s = random.uniform(), length = random.logarithmic(1e-4, 1.0);
    if (ray.phi_d == 0.0) continue;  // it misses the layer
    FogQuadrature fog(ray, sigma_t, medium);
    const double from = ray.psi(s), to = std::max(ray.psi(s + length), ray.psi_end);
    const double usual = fog.integral(from, to, nullptr).r;
    fog.refine(4);
    const double fine = fog.integral(from, to, nullptr).r;
    EXPECT_NEAR(usual, fine, FogQuadrature::k_error * fine + 1e-300)
        << "D " << ray.D << " height " << ray.light_height << " psi " << ray.psi_start << " to "
        << ray.psi_end << " phase " << static_cast<int>(medium.phase) << " g " << medium.g << " sigma D "
        << sigma_t * ray.D << " from " << from << " to " << to;
    ++integrated;
  }
  EXPECT_GT(integrated, 10000);
}

TEST(FogQuadrature, FourTimesTheNodesChangeNothingBeyondTheBound) {
  expect_unchanged_by_more_nodes(random_ray);
}

TEST(FogQuadrature, FourTimesTheNodesChangeNothingInALayerEither) {
  expect_unchanged_by_more_nodes(random_ray_in_layer);
}

}  // namespace
}  // namespace airlight::reference
