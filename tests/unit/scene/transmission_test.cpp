#include "scene/transmission.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models.h"
#include "support/panes.h"

namespace airlight::scene {
namespace {

using testing::IsEmpty;

constexpr glm::vec3 k_glass(0.5f, 0.25f, 0.0f);

TEST(Transmission, IsThatOfTheMaterialUnlessAskedOtherwise) {
  Geometry geometry = tests::of_glass(tests::panes_over_floor(1), k_glass);
  EXPECT_TRUE(transmits(geometry));
  EXPECT_EQ(attenuation_of(geometry, 0),
            (Attenuation{{Attenuation::k_halving, 2 * Attenuation::k_halving, Attenuation::k_nothing_left}}));
  EXPECT_TRUE(attenuation_of(geometry, 2).is_opaque()) << "the floor";
  geometry.transmission = Transmission::opaque;
  EXPECT_FALSE(transmits(geometry));
  EXPECT_TRUE(attenuation_of(geometry, 0).is_opaque());
  EXPECT_FALSE(transmits(tests::panes_over_floor(1)));
}

TEST(Transmission, OfXRaysFallsWithTheAngleOfIncidence) {
  Geometry geometry = tests::panes_over_floor(1);
  geometry.transmission = Transmission::x_ray;
  EXPECT_TRUE(transmits(geometry) && transmits_by_incidence(geometry));
  const Attenuation grey = attenuation_of(geometry, 2);
  EXPECT_EQ(grey, attenuation_of(geometry, 0)) << "all alike";
  const glm::dvec3 straight = share_left(attenuation_at(grey, 1.0)),
                   slanted = share_left(attenuation_at(grey, 0.5));
  EXPECT_EQ(straight.r, straight.b);
  EXPECT_NEAR(slanted.r, straight.r * straight.r, 1e-5) << "twice the way through the layer";
  EXPECT_EQ(share_left(attenuation_at(grey, 0.0)), glm::dvec3(0.0));

  geometry.transmission = Transmission::x_ray_coloured;
  std::vector<glm::dvec3> shares;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const glm::dvec3 share = share_left(attenuation_at(attenuation_of(geometry, i), 1.0));
    EXPECT_GT(std::max({share.r, share.g, share.b}), 1.3 * std::min({share.r, share.g, share.b})) << i;
    for (const glm::dvec3& other : shares) EXPECT_GT(glm::distance(share, other), 0.05) << i;
    shares.push_back(share);
  }
}

TEST(Transmission, OfManyLayersMultipliesAndComesToNothing) {
  const Attenuation halves{glm::uvec3(Attenuation::k_halving)};
  glm::uvec3 sum(0);
  for (int i = 0; i < 3; ++i) sum = add_attenuation(sum, attenuation_at(halves, 0.3));
  EXPECT_EQ(share_left(sum), glm::dvec3(0.125));
  for (int i = 0; i < 100000; ++i) sum = add_attenuation(sum, halves.of_channel);
  EXPECT_EQ(share_left(sum), glm::dvec3(0.0));
  EXPECT_EQ(add_attenuation(sum, glm::uvec3(Attenuation::k_nothing_left)), sum);
  EXPECT_EQ(share_left(glm::uvec3(0)), glm::dvec3(1.0));
}

class Blended : public tests::ImportFolder {};

TEST_F(Blended, MaterialsOfGltfReflectWhatTheyCoverAndLetTheRestThroughInTheirColour) {
  nlohmann::json document = tests::triangle();
  document["materials"] = {
      {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.4, 0.0, 0.25}}}}}};
  tests::primitive(document)["material"] = 0;
  const Scene scene = load(document);
  EXPECT_THAT(scene.report.warnings, IsEmpty());
  const Material& material = scene.geometry.materials[scene.geometry.material_of_triangle[0]];
  EXPECT_EQ(material.transmittance, glm::vec3(0.75f * 0.8f, 0.75f * 0.4f, 0.0f));
  EXPECT_EQ(material.albedo, glm::vec3(0.25f * 0.8f, 0.25f * 0.4f, 0.0f));
}

}  // namespace
}  // namespace airlight::scene
