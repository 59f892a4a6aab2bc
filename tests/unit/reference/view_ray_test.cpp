#include "reference/view_ray.h"

#include <numbers>

#include <gtest/gtest.h>

namespace airlight::reference {
namespace {

const glm::dvec3 k_eye(0, 0, -2);  // looks along +Z at a light 2 m away
const glm::dvec3 k_right(1, 0, 0);

glm::dvec3 towards(double alpha) {
  return {0, std::sin(alpha), std::cos(alpha)};
}

TEST(ViewRay, LightRaysMeetTheViewRay) {
  for (double alpha : {1e-3, 0.3, 1.5, 2.5, std::numbers::pi - 1e-3}) {
    for (double distance : {0.0, 0.1, 5.0}) {
      const ViewRay ray = make_view_ray(k_eye, towards(alpha), k_right, distance, 1e-6);
      EXPECT_NEAR(ray.psi_start, std::numbers::pi - alpha, 1e-12);
      EXPECT_NEAR(ray.phi_d + ray.psi_end, ray.psi_start, 1e-12);
      for (double s : {0.0, 0.25, 0.9}) {
        const double psi = ray.psi(s);
        const double r = ray.D * ray.sin_alpha / std::sin(psi);
        const glm::dvec3 point = r * (ray.w * std::cos(psi) + ray.q * std::sin(psi));
        const double t = glm::dot(point - k_eye, towards(alpha));
        EXPECT_LT(glm::length(point - (k_eye + t * towards(alpha))), 1e-9 * r) << alpha << " " << s;
        EXPECT_NEAR((t + r) / (ray.D * (ray.cos_alpha + ray.sin_alpha / std::tan(psi / 2))), 1.0, 1e-9);
        EXPECT_NEAR(glm::dot(point, -towards(alpha)) / r, -std::cos(psi), 1e-9);
      }
      const double r = ray.D * ray.sin_alpha / std::sin(ray.psi(1.0));
      if (distance > 0) {
        EXPECT_NEAR(r, glm::length(k_eye + distance * towards(alpha)), 1e-9);
      }
    }
  }
}

TEST(ViewRay, StraightAtTheLightIsMovedByAQuarterPixel) {
  const ViewRay exact = make_view_ray(k_eye, towards(0), k_right, 0.0, 1e-3);
  EXPECT_NEAR(std::atan2(exact.sin_alpha, exact.cos_alpha), 1e-3, 1e-15);
  EXPECT_GT(exact.w.x, 0.0) << "towards the camera's right";
  const ViewRay near = make_view_ray(k_eye, towards(2e-4), k_right, 0.0, 1e-3);
  EXPECT_NEAR(glm::length(near.w - towards(1e-3)), 0.0, 1e-12) << "in its own plane with the light";
  const ViewRay beyond = make_view_ray(k_eye, towards(2e-3), k_right, 0.0, 1e-3);
  EXPECT_EQ(beyond.w, towards(2e-3));
}

TEST(ViewRay, StraightAwayFromTheLightKeepsADirectionAcross) {
  const ViewRay ray = make_view_ray(k_eye, towards(std::numbers::pi), k_right, 0.0, 1e-3);
  EXPECT_NEAR(ray.psi_start, k_smallest_psi_eye, 1e-12);
  EXPECT_NEAR(glm::length(ray.q), 1.0, 1e-12);
  EXPECT_NEAR(glm::dot(ray.q, ray.w), 0.0, 1e-12);
}

}  // namespace
}  // namespace airlight::reference
