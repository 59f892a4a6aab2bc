#include "scene/import.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scene/error.h"
#include "support/models.h"
#include "support/shared.h"

namespace airlight::scene {
namespace {

using namespace tests;

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
/// Positions and intensities of the importers end in single precision.
constexpr double k_single = 1e-6;

class Import : public tests::ImportFolder {};
class ImportGltf : public Import {};
class ImportObj : public Import {};
class ImportPly : public Import {};

std::vector<glm::vec3> corners(const Scene& scene, std::size_t triangle) {
  const glm::uvec3 t = scene.geometry.triangles.at(triangle);
  return {scene.geometry.positions.at(t.x), scene.geometry.positions.at(t.y),
          scene.geometry.positions.at(t.z)};
}

glm::vec3 albedo_of(const Scene& scene, std::size_t triangle) {
  return scene.geometry.materials.at(scene.geometry.material_of_triangle.at(triangle)).albedo;
}

void expect_near(glm::dvec3 a, glm::dvec3 b) {
  EXPECT_NEAR(glm::distance(a, b), 0.0, k_single) << a.x << " " << a.y << " " << a.z;
}

using V = glm::vec3;

// ---- Any file ----

TEST_F(Import, RefusesWhatIsNoReadableFile) {
  expect_error(folder_ / "none.glb", "there is no such file");
  std::filesystem::create_directory(folder_ / "folder.obj");
  expect_error(folder_ / "folder.obj", "it is not a file");
  for (const char* name : {"empty.gltf", "empty.glb", "empty.obj", "empty.ply"})
    expect_error(name, "", "the file is empty");
}

TEST_F(Import, RefusesOtherKindsOfFileAndSaysWhichItReads) {
  for (const char* name : {"scene.stl", "scene.xml", "scene.FBX", "scene", ".obj"}) {
    expect_error(name, "v 0 0 0", "cannot be read");
    expect_error(name, "v 0 0 0", "give a .gltf, .glb, .obj or .ply file");
  }
}

TEST_F(Import, TakesExtensionsInAnyCaseAndNamesTheSceneAfterTheFile) {
  EXPECT_EQ(load("Hall.GLTF", triangle().dump()).name, "Hall");
  EXPECT_EQ(load("a.b.Glb", triangle_glb()).name, "a.b");
  EXPECT_EQ(load("x.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").name, "x");
}

TEST_F(Import, PutsNamesOfManyLinesIntoOneLineOfAMessage) {
  json document = triangle();
  document["meshes"][0]["name"] = "a\nb" + std::string(1000, 'x');
  primitive(document)["material"] = 7;
  expect_error(document, "mesh 0 'a bxx");
}

// ---- glTF: geometry ----

TEST_F(ImportGltf, ReadsATriangle) {
  const Scene scene = load(triangle());
  ASSERT_EQ(scene.geometry.triangles.size(), 1u);
  EXPECT_THAT(corners(scene, 0), ElementsAre(V(0, 0, 0), V(1, 0, 0), V(1, 1, 0)));
  EXPECT_EQ(albedo_of(scene, 0), V(1.0f)) << "glTF's default material is white";
  EXPECT_THAT(scene.report.warnings, IsEmpty());
  EXPECT_EQ(scene.report.degenerate_triangles, 0u);
  EXPECT_THAT(scene.cameras, IsEmpty());
  EXPECT_THAT(scene.lights, IsEmpty());
}

TEST_F(ImportGltf, ReadsBinaryFilesAndBuffersInOtherFiles) {
  EXPECT_THAT(corners(load("scene.glb", triangle_glb()), 0), ElementsAre(V(0, 0, 0), V(1, 0, 0), V(1, 1, 0)));

  json document = triangle();
  write("positions 1.bin", bytes_of(k_square));
  document["buffers"][0]["uri"] = "positions%201.bin";
  EXPECT_THAT(corners(load(document), 0), ElementsAre(V(0, 0, 0), V(1, 0, 0), V(1, 1, 0)));
  document["buffers"][0]["uri"] = "none.bin";
  expect_error(document, "none.bin");
}

TEST_F(ImportGltf, LooksForBuffersBesideTheFileOnly) {
  json document = triangle();
  document["buffers"][0]["uri"] = "positions.bin";
  write("positions.bin", bytes_of(k_square));
  std::filesystem::create_directory(folder_ / "inner");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  expect_error("inner/scene.gltf", document.dump(), "positions.bin");
  std::filesystem::current_path(before);
}

TEST_F(ImportGltf, ReadsIndicesOfEveryType) {
  const auto with_indices = [](auto values, int type) {
    json document = triangle();
    primitive(document)["indices"] = add_accessor(document, values, type, "SCALAR");
    return document;
  };
  const std::vector<json> documents = {with_indices(std::vector<std::uint8_t>{3, 0, 1}, k_u8),
                                       with_indices(std::vector<std::uint16_t>{3, 0, 1}, k_u16),
                                       with_indices(std::vector<std::uint32_t>{3, 0, 1}, k_u32)};
  for (const json& document : documents)
    EXPECT_THAT(corners(load(document), 0), ElementsAre(V(0, 1, 0), V(0, 0, 0), V(1, 0, 0)));
  expect_error(with_indices(std::vector<float>{0, 1, 2}, k_float), "accessor 2: indices must be scalars");
}

TEST_F(ImportGltf, ReadsStripsFansAndUnindexedTriangles) {
  json document = triangle();
  primitive(document).erase("indices");
  primitive(document)["mode"] = 5;
  Scene scene = load(document);
  ASSERT_EQ(scene.geometry.triangles.size(), 2u);
  EXPECT_THAT(corners(scene, 0), ElementsAre(V(0, 0, 0), V(1, 0, 0), V(1, 1, 0)));
  EXPECT_THAT(corners(scene, 1), ElementsAre(V(1, 0, 0), V(0, 1, 0), V(1, 1, 0)))
      << "turned to face the same way";

  primitive(document)["mode"] = 6;
  scene = load(document);
  ASSERT_EQ(scene.geometry.triangles.size(), 2u);
  EXPECT_THAT(corners(scene, 0), ElementsAre(V(1, 0, 0), V(1, 1, 0), V(0, 0, 0)));
  EXPECT_THAT(corners(scene, 1), ElementsAre(V(1, 1, 0), V(0, 1, 0), V(0, 0, 0)));

  primitive(document)["mode"] = 4;
  expect_error(document, "mesh 0, primitive 0: 4 corners do not make up triangles");
  document["accessors"][0]["count"] = 3;
  EXPECT_EQ(load(document).geometry.triangles.size(), 1u);
  document["accessors"][0]["count"] = 2;
  primitive(document)["mode"] = 5;
  expect_error(document, "2 corners do not make up triangles");
  primitive(document)["mode"] = 7;
  expect_error(document, "there is no primitive mode 7");
}

TEST_F(ImportGltf, ReadsInterleavedPositionsFromAnOffset) {
  json document = triangle();
  const std::vector<float> mixed = {9, 9, 0, 0, 0, 9, 1, 0, 0, 9, 1, 1, 0, 9};
  document["accessors"][0]["bufferView"] = add_view(document, bytes_of(mixed));
  document["bufferViews"].back()["byteStride"] = 16;
  document["bufferViews"].back()["byteOffset"] = 4;
  document["bufferViews"].back()["byteLength"] = 52;
  document["accessors"][0]["byteOffset"] = 4;
  document["accessors"][0]["count"] = 3;
  EXPECT_THAT(corners(load(document), 0), ElementsAre(V(0, 0, 0), V(1, 0, 0), V(1, 1, 0)));
}

TEST_F(ImportGltf, ReadsSparsePositions) {
  json document = triangle();
  const std::size_t indices = add_view(document, bytes_of(std::vector<std::uint8_t>{1, 2}));
  const std::size_t values = add_view(document, bytes_of(std::vector<float>{5, 0, 0, 5, 6, 7}));
  json& accessor = document["accessors"][0];
  accessor["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", indices}, {"componentType", k_u8}}},
                        {"values", {{"bufferView", values}}}};
  EXPECT_THAT(corners(load(document), 0), ElementsAre(V(0, 0, 0), V(5, 0, 0), V(5, 6, 7)));
  accessor.erase("bufferView");
  EXPECT_THAT(corners(load(document), 0), ElementsAre(V(0, 0, 0), V(5, 0, 0), V(5, 6, 7)))
      << "the rest is zero";

  accessor["sparse"]["indices"]["componentType"] = k_float;
  expect_error(document, "accessor 0: its sparse indices must be");
  accessor["sparse"]["indices"]["componentType"] = k_u16;
  expect_error(document, "accessor 0: its 2 elements reach to byte 4 of a buffer view of 2");
  accessor["sparse"]["indices"]["componentType"] = k_u8;
  accessor["sparse"]["count"] = 5;
  expect_error(document, "its sparse part is broken");
  accessor["sparse"]["count"] = 2;
  accessor["sparse"]["values"]["byteOffset"] = 4;
  expect_error(document, "its 2 elements reach to byte 28");
  accessor["sparse"]["values"]["byteOffset"] = 4'000'000'000u;
  expect_error(document, "its sparse part is broken");
  accessor["sparse"]["values"]["byteOffset"] = 0;
  accessor["count"] = 2;
  expect_error(document, "sparse index 2 is out of range: 2 elements");
  document["accessors"][1]["sparse"] = accessor["sparse"];
  accessor["count"] = 4;
  expect_error(document, "accessor 1: sparse indices are not supported");
}

TEST_F(ImportGltf, DropsAndCountsTrianglesOfZeroAreaButKeepsThinOnes) {
  json document = triangle();
  // A line, a point, a repeated index, one that is thin, and one whose area vanishes in single precision.
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 1e-30f, 0, 0, 0, 1e-30f};
  primitive(document)["attributes"]["POSITION"] = add_accessor(document, positions, k_float, "VEC3");
  primitive(document)["indices"] = add_accessor(
      document, std::vector<std::uint8_t>{0, 1, 2, 1, 1, 1, 0, 0, 2, 0, 1, 3, 0, 4, 3}, k_u8, "SCALAR");
  const Scene scene = load(document);
  EXPECT_EQ(scene.report.degenerate_triangles, 3u);
  EXPECT_EQ(scene.geometry.triangles.size(), 2u);
  EXPECT_EQ(scene.geometry.material_of_triangle.size(), 2u);
}

TEST_F(ImportGltf, DropsTrianglesWhoseCornersCoincideAfterRounding) {
  json document = triangle();
  document["nodes"][0]["translation"] = {1e9, 0, 0};  // where neighbouring floats are 64 apart
  const Scene scene = load(document);
  EXPECT_EQ(scene.report.degenerate_triangles, 1u);
  EXPECT_THAT(scene.report.warnings, ElementsAre("the file has no triangles"));
}

TEST_F(ImportGltf, RefusesPositionsThatAreNotFiniteAndSaysWhere) {
  for (float bad : {k_nan, std::numeric_limits<float>::infinity()}) {
    json document = triangle();
    document["meshes"].push_back(document["meshes"][0]);
    document["meshes"][1]["name"] = "leaf";
    document["meshes"][1]["primitives"].push_back(primitive(document));
    document["nodes"].push_back({{"mesh", 1}});
    document["scenes"][0]["nodes"] = {0, 1};
    std::vector<float> positions = k_square;
    positions[7] = bad;
    document["meshes"][1]["primitives"][1]["attributes"]["POSITION"] =
        add_accessor(document, positions, k_float, "VEC3");
    expect_error(document, "mesh 1 'leaf', primitive 1, vertex 2: the position is not finite");
  }
}

TEST_F(ImportGltf, RefusesExtentsThatOverflow) {
  json document = triangle();
  document["nodes"][0]["scale"] = {1, 1e19, 1};
  expect_error(document, "the extent of the geometry overflows single precision");
  document["nodes"][0]["scale"] = {1, 1e300, 1};
  expect_error(document, "the extent of the geometry overflows single precision");
  document["nodes"][0]["scale"] = {1, 1e17, 1};
  EXPECT_NO_THROW(load(document));
}

// ---- glTF: nodes ----

TEST_F(ImportGltf, AppliesTranslationRotationAndScaleInThatOrder) {
  json document = triangle();
  const double half = std::sqrt(0.5);  // a quarter turn about +Z takes +X to +Y
  document["nodes"][0].update(
      {{"translation", {10, 20, 30}}, {"rotation", {0, 0, half, half}}, {"scale", {2, 3, 4}}});
  const std::vector<glm::vec3> at = corners(load(document), 0);
  expect_near(at[0], {10, 20, 30});
  expect_near(at[1], {10, 22, 30});
  expect_near(at[2], {7, 22, 30});
}

TEST_F(ImportGltf, MultipliesMatricesDownTheTreeAndExpandsInstances) {
  json document = triangle();
  // Columns first: x' = 2x + 5, mirrored in z. The child moves by one along its parent's +X.
  document["nodes"] = {{{"children", {1, 2}}, {"matrix", {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 5, 0, 0, 1}}},
                       {{"mesh", 0}, {"translation", {1, 0, 3}}},
                       {{"mesh", 0}}};
  const Scene scene = load(document);
  ASSERT_EQ(scene.geometry.triangles.size(), 2u);
  EXPECT_THAT(corners(scene, 0), ElementsAre(V(7, 0, -3), V(9, 0, -3), V(9, 1, -3)));
  EXPECT_THAT(corners(scene, 1), ElementsAre(V(5, 0, 0), V(7, 0, 0), V(7, 1, 0)));
}

TEST_F(ImportGltf, AccumulatesTransformsInDoublePrecision) {
  json document = triangle();
  document["nodes"] = {{{"children", {1}}, {"translation", {1e12, 0, 0}}},
                       {{"mesh", 0}, {"translation", {-1e12, 0, 0}}}};
  EXPECT_THAT(corners(load(document), 0), ElementsAre(V(0, 0, 0), V(1, 0, 0), V(1, 1, 0)));
}

TEST_F(ImportGltf, ShowsTheDefaultSceneOrTheFirstOrAllRoots) {
  json document = triangle();
  document["nodes"] = {{{"mesh", 0}, {"translation", {1, 0, 0}}},
                       {{"children", {2}}, {"translation", {2, 0, 0}}},
                       {{"mesh", 0}, {"translation", {0, 5, 0}}}};
  document["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0}}}};
  document["scene"] = 1;
  EXPECT_EQ(corners(load(document), 0)[0], V(1, 0, 0));
  document.erase("scene");
  EXPECT_EQ(corners(load(document), 0)[0], V(2, 5, 0));
  document.erase("scenes");
  const Scene scene = load(document);
  ASSERT_EQ(scene.geometry.triangles.size(), 2u) << "a child is no root";
  EXPECT_EQ(corners(scene, 0)[0], V(1, 0, 0));
  EXPECT_EQ(corners(scene, 1)[0], V(2, 5, 0));
}

TEST_F(ImportGltf, RefusesBrokenNodes) {
  const auto expect_broken = [&](const std::string& text, auto&& change) {
    json document = triangle();
    change(document);
    expect_error(document, text);
  };
  expect_broken("two parents, or is its own ancestor", [](json& d) { d["nodes"][0]["children"] = {0}; });
  expect_broken("node 0: it has two parents", [](json& d) {
    d["nodes"][0]["children"] = {1};
    d["nodes"].push_back({{"children", {0}}});
  });
  expect_broken("two parents", [](json& d) { d["scenes"][0]["nodes"] = {0, 0}; });
  expect_broken("node 7 does not exist: there are 1", [](json& d) { d["nodes"][0]["children"] = {7}; });
  expect_broken("scene: node 7 does not exist", [](json& d) { d["scenes"][0]["nodes"] = {7}; });
  expect_broken("scene 3 does not exist", [](json& d) { d["scene"] = 3; });
  expect_broken("node 0 'a': mesh 4 does not exist", [](json& d) {
    d["nodes"][0].update({{"mesh", 4}, {"name", "a"}});
  });
  expect_broken("not a unit quaternion: its length is 0", [](json& d) {
    d["nodes"][0]["rotation"] = {0, 0, 0, 0};
  });
  expect_broken("not a unit quaternion", [](json& d) { d["nodes"][0]["rotation"] = {0, 0, 0, 2}; });
  expect_broken("the last row of its matrix",
                [](json& d) { d["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; });
}

TEST_F(ImportGltf, StandsAVeryLongChainOfNodes) {
  json document = triangle();
  document["nodes"] = json::array();
  for (int i = 0; i < 50'000; ++i) document["nodes"].push_back({{"children", {i + 1}}});
  document["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(load(document).geometry.triangles.size(), 1u);
}

// ---- glTF: materials, cameras, lights ----

TEST_F(ImportGltf, TakesTheBaseColourAsAlbedo) {
  json document = triangle();
  document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 1, 0}}}}},
                           json::object()};
  primitive(document)["material"] = 0;
  EXPECT_EQ(albedo_of(load(document), 0), V(0.25f, 0.5f, 1.0f));
  primitive(document)["material"] = 1;
  EXPECT_EQ(albedo_of(load(document), 0), V(1.0f));
  primitive(document)["material"] = 2;
  expect_error(document, "mesh 0, primitive 0: material 2 does not exist: there are 2");

  for (double bad : {1.01, -0.01}) {
    document["materials"][1] = {{"name", "brass"},
                                {"pbrMetallicRoughness", {{"baseColorFactor", {0, bad, 0, 1}}}}};
    expect_error(document, "material 1 'brass': a base colour of ");
  }
}

TEST_F(ImportGltf, ReadsPerspectiveCameras) {
  const double half = std::sqrt(0.5);
  // A quarter turn about +X takes -Z to +Y, and +Y to +Z.
  const json node = {{"translation", {1, 2, 3}}, {"rotation", {half, 0, 0, half}}, {"scale", {7, 7, 7}}};
  const Scene scene = load(with_camera(k_perspective, node));
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "camera0");
  expect_near(camera.eye, {1, 2, 3});
  expect_near(camera.target, {1, 3, 3});
  expect_near(camera.up, {0, 0, 1});
  EXPECT_NEAR(camera.vertical_fov_degrees, 0.5 * 180.0 / 3.14159265358979, k_single);

  json named = k_perspective;
  EXPECT_EQ(load(with_camera(named, {{"name", "node"}})).cameras[0].name, "node");
  named["name"] = "own";
  EXPECT_EQ(load(with_camera(named, {{"name", "node"}})).cameras[0].name, "own");
}

TEST_F(ImportGltf, RefusesCamerasThatSeeNothing) {
  expect_error(with_camera(k_perspective, {{"scale", {1, 1, 0}}}), "node 1");
  json camera = k_perspective;
  camera["perspective"]["yfov"] = 4.0;
  expect_error(with_camera(camera, {{"name", "eye"}}), "node 1 'eye': camera 'eye', fov: ");
  json document = with_camera(k_perspective);
  document["cameras"] = json::array();
  expect_error(document, "node 1: camera 0 does not exist");
}

TEST_F(ImportGltf, ReadsPointLights) {
  json node = {{"translation", {1, 2, 3}}, {"name", "lamp"}};
  Scene scene = load(with_light({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 20}}, node));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "lamp");
  expect_near(scene.lights[0].position, {1, 2, 3});
  EXPECT_EQ(scene.lights[0].intensity, V(20, 10, 0));
  EXPECT_THAT(scene.report.warnings, IsEmpty());

  scene = load(with_light({{"type", "point"}}));
  EXPECT_EQ(scene.lights[0].intensity, V(1.0f)) << "the defaults are white and one candela";
  EXPECT_EQ(scene.lights[0].name, "light0");
  EXPECT_EQ(load(with_light({{"type", "point"}, {"name", "own"}}, node)).lights[0].name, "own");
}

TEST_F(ImportGltf, PutsLightsWhereTheWholeTreeMovesThem) {
  json document = with_light({{"type", "point"}}, {{"translation", {0, 0, 1}}});
  document["nodes"].push_back({{"children", {1}}, {"scale", {1, 1, 3}}, {"translation", {4, 0, 0}}});
  document["scenes"][0]["nodes"] = {0, 2};
  expect_near(load(document).lights.at(0).position, {4, 0, 3});
}

TEST_F(ImportGltf, ReadsDirectionalLightsAsSuns) {
  // Turned by a quarter about X, −Z points up: light rises.
  const json node = {{"name", "dawn"}, {"rotation", {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}};
  const Scene scene =
      load(with_light({{"type", "directional"}, {"color", {1, 0.5, 0}}, {"intensity", 20}}, node));
  ASSERT_EQ(scene.lights.size(), 1u);
  ASSERT_TRUE(is_sun(scene.lights[0]));
  EXPECT_EQ(scene.lights[0].name, "dawn");
  expect_near(scene.lights[0].towards, {0, -1, 0});
  EXPECT_EQ(scene.lights[0].irradiance, V(20, 10, 0)) << "lux, one to one";
  EXPECT_THAT(scene.report.warnings, IsEmpty());

  const Scene plain = load(with_light({{"type", "directional"}}, {{"scale", {1, 1, 5}}}));
  expect_near(plain.lights.at(0).towards, {0, 0, 1});
  EXPECT_EQ(plain.lights.at(0).irradiance, V(1.0f));
}

TEST_F(ImportGltf, ReadsSpots) {
  // Turned by a quarter about X, −Z points up.
  const json node = {{"translation", {1, 2, 3}}, {"rotation", {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}};
  const json cone = {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}};
  const Scene scene =
      load(with_light({{"type", "spot"}, {"spot", cone}, {"intensity", 20}, {"range", 7.5}}, node));
  ASSERT_EQ(scene.lights.size(), 1u);
  const Light& spot = scene.lights[0];
  EXPECT_FALSE(is_sun(spot));
  expect_near(spot.position, {1, 2, 3});
  EXPECT_EQ(spot.intensity, V(20.0f));
  ASSERT_TRUE(spot.cone);
  EXPECT_NEAR(glm::distance(spot.cone->axis, {0, 1, 0}), 0.0, 1e-15);
  EXPECT_NEAR(spot.cone->inner, 0.2, 1e-15);
  EXPECT_NEAR(spot.cone->outer, 0.4, 1e-15);
  EXPECT_EQ(spot.range, 7.5);
  EXPECT_THAT(scene.report.warnings, IsEmpty());

  const Light plain = load(with_light({{"type", "spot"}, {"spot", json::object()}})).lights.at(0);
  ASSERT_TRUE(plain.cone);
  EXPECT_EQ(plain.cone->axis, glm::dvec3(0, 0, -1));
  EXPECT_EQ(plain.cone->inner, 0.0);
  EXPECT_NEAR(plain.cone->outer, std::atan(1.0), 1e-9);
  EXPECT_FALSE(plain.range);

  // What single precision makes of a right angle is more than one.
  const json wide = {{"outerConeAngle", 1.5707964}};
  EXPECT_EQ(load(with_light({{"type", "spot"}, {"spot", wide}})).lights.at(0).cone->outer,
            2 * std::atan(1.0));
}

TEST_F(ImportGltf, ReadsRangesOfLamps) {
  EXPECT_EQ(load(with_light({{"type", "point"}, {"range", 5}})).lights.at(0).range, 5.0);
  EXPECT_FALSE(load(with_light({{"type", "point"}, {"range", 0}})).lights.at(0).range);
  EXPECT_FALSE(load(with_light({{"type", "directional"}, {"range", 5}})).lights.at(0).range);
  expect_error(with_light({{"type", "point"}, {"range", -5}}),
               "node 1: the light's range: -5 is not positive");
  expect_error(with_light({{"type", "point"}, {"range", "far"}}), "/range: glTF does not allow");
}

TEST_F(ImportGltf, RefusesBrokenSpots) {
  const auto spot = [](const json& cone) { return with_light({{"type", "spot"}, {"spot", cone}}); };
  expect_error(spot({{"outerConeAngle", 1.6}}), "node 1: the light's cone: the half-angle 91.6");
  expect_error(spot({{"innerConeAngle", 1}, {"outerConeAngle", 0.5}}), "is more than the outer one");
  expect_error(spot({{"innerConeAngle", -0.1}}), "the light's cone: the half-angle -5.7");
  expect_error(spot({{"innerConeAngle", "wide"}}), "/spot/innerConeAngle: glTF does not allow");
  expect_error(with_light({{"type", "spot"}, {"spot", 1}}), "/spot: glTF does not allow");
  expect_error(with_light({{"type", "spot"}, {"spot", json::object()}}, {{"scale", {1, 1, 0}}}),
               "node 1: the light's direction: it has no length");
}

TEST_F(ImportGltf, RefusesBrokenLights) {
  expect_error(with_light({{"type", "directional"}}, {{"scale", {1, 1, 0}}}),
               "node 1: the light's direction: it has no length");
  expect_error(with_light({{"type", "directional"}, {"intensity", -1}}), "the light's intensity -1 is not");
  expect_error(with_light({{"type", "point"}, {"intensity", -1}}), "node 1: the light's intensity -1 is not");
  expect_error(with_light({{"type", "point"}, {"intensity", 1e300}}), "the light's intensity 1e+300 is not");
  expect_error(with_light({{"type", "point"}, {"color", {1, -2, 1}}}), "the light's intensity -2 is not");
  json document = with_light({{"type", "point"}});
  document["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 1;
  expect_error(document, "node 1: light 1 does not exist: there are 1");
  document["nodes"][1]["extensions"]["KHR_lights_punctual"] = json::object();
  expect_error(document, "names no light");
  document["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 4294967296;
  expect_error(document, "/nodes/1/extensions/KHR_lights_punctual/light");
}

// ---- glTF: what is left out ----

TEST_F(ImportGltf, WarnsOfWhatItLeavesOutWithCounts) {
  const auto expect_warning = [&](const std::string& text, const json& document) {
    EXPECT_THAT(load(document).report.warnings, Contains(HasSubstr(text)));
  };
  const auto changed = [](auto&& change) {
    json document = triangle();
    change(document);
    return document;
  };
  const auto with_material = [](json material) {
    json document = triangle();
    document["materials"] = json::array({std::move(material)});
    return document;
  };
  expect_warning("lights of unknown type ignored (1)", with_light({{"type", "laser"}}));
  expect_warning("orthographic cameras ignored (1)",
                 with_camera({{"type", "orthographic"},
                              {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 2}, {"znear", 1}}}}));
  expect_warning("textures ignored (2)", changed([](json& d) {
                   d["textures"] = {json::object(), json::object()};
                 }));
  expect_warning("light of emissive materials ignored (1)", with_material({{"emissiveFactor", {0, 1, 0}}}));
  expect_warning("alpha masks of materials ignored (1)", with_material({{"alphaMode", "MASK"}}));
  expect_warning("textures of transparent materials ignored (1)",
                 with_material({{"alphaMode", "BLEND"},
                                {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}));
  expect_warning("transmission of materials ignored (1)",
                 with_material({{"extensions", {{"KHR_materials_transmission", json::object()}}}}));
  expect_warning("morph targets of primitives ignored (1)", changed([](json& d) {
                   primitive(d)["targets"] = {{{"POSITION", 0}}};
                 }));
  expect_warning("vertex colours of primitives ignored (1)",
                 changed([](json& d) { primitive(d)["attributes"]["COLOR_0"] = 0; }));
  expect_warning("animations ignored (1)", changed([](json& d) { d["animations"] = {json::object()}; }));
  expect_warning("skins ignored (1)", changed([](json& d) {
                   d["nodes"][0]["skin"] = 0;
                   d["skins"] = {{{"joints", {0}}}};
                 }));
  for (int mode : {0, 1, 2, 3}) {
    json document = changed([&](json& d) { primitive(d)["mode"] = mode; });
    expect_warning("primitives of points or lines ignored (1)", document);
    expect_warning("the file has no triangles", document);
  }
  expect_warning("extension KHR_draco_mesh_compression ignored",
                 changed([](json& d) { d["extensionsUsed"] = {"KHR_draco_mesh_compression"}; }));
}

TEST_F(ImportGltf, CountsEachUseOfALight) {
  json document = with_light({{"type", "laser"}});
  for (int i = 0; i < 2; ++i) document = with_node(document["nodes"][1], document);
  EXPECT_THAT(
      load(document).report.warnings,
      ElementsAre("lights of unknown type ignored (3): only point lights, spots and suns are rendered"));
}

TEST_F(ImportGltf, LoadsNoImages) {
  json document = triangle();
  write("broken.png", "this is no picture");
  document["images"] = {
      {{"uri", "broken.png"}}, {{"uri", "missing.png"}}, {{"bufferView", 0}, {"mimeType", "image/png"}}};
  EXPECT_EQ(load(document).geometry.triangles.size(), 1u);
}

TEST_F(ImportGltf, RefusesExtensionsThatItMustUnderstandAndDoesNot) {
  json document = triangle();
  document["extensionsRequired"] = {"KHR_lights_punctual"};
  EXPECT_NO_THROW(load(document));
  document["extensionsRequired"] = {"KHR_lights_punctual", "KHR_draco_mesh_compression"};
  expect_error(document, "it requires the extension KHR_draco_mesh_compression, which is not supported");
  document["extensionsRequired"].push_back("EXT_meshopt_compression");
  expect_error(document, "the extensions KHR_draco_mesh_compression, EXT_meshopt_compression, which are not");

  // They are named before anything that only they can explain.
  document["meshes"][0]["primitives"][0].erase("attributes");
  document["accessors"][0].erase("bufferView");
  document["buffers"][0]["byteLength"] = -1;
  expect_error(document, "the extensions KHR_draco_mesh_compression, EXT_meshopt_compression");
}

// ---- glTF: hostile files ----

TEST_F(ImportGltf, RefusesBrokenAccessors) {
  const auto expect_broken = [&](const std::string& text, auto&& change) {
    json document = triangle();
    change(document);
    expect_error(document, text);
  };
  expect_broken("accessor 0: its 5 elements reach to byte 60 of a buffer view of 48",
                [](json& d) { d["accessors"][0]["count"] = 5; });
  expect_broken("reach to byte 49 of", [](json& d) { d["accessors"][0]["byteOffset"] = 1; });
  expect_broken("reach to byte 4294967343 of", [](json& d) { d["accessors"][0]["byteOffset"] = 4294967295; });
  expect_broken("/accessors/0/byteOffset", [](json& d) { d["accessors"][0]["byteOffset"] = 4294967296; });
  expect_broken("/accessors/0/byteOffset", [](json& d) { d["accessors"][0]["byteOffset"] = -12; });
  expect_broken("accessor 0: it is empty", [](json& d) { d["accessors"][0]["count"] = 0; });
  expect_broken("more than the limit", [](json& d) { d["accessors"][0]["count"] = 4294967295; });
  expect_broken("/accessors/0/count", [](json& d) { d["accessors"][0]["count"] = 6148914691236517206; });
  expect_broken("/accessors/0/count", [](json& d) { d["accessors"][0]["count"] = 2.5; });
  expect_broken("accessor 0: a stride of 8 bytes does not fit its elements of 12",
                [](json& d) { d["bufferViews"][0]["byteStride"] = 8; });
  expect_broken("byteStride", [](json& d) { d["bufferViews"][0]["byteStride"] = 256; });
  expect_broken("accessor 1: a stride of 4 bytes does not fit its elements of 2",
                [](json& d) { d["bufferViews"][1]["byteStride"] = 4; });
  expect_broken("buffer view 0: it reaches to byte 49 of a buffer of 48",
                [](json& d) { d["bufferViews"][0]["byteLength"] = 49; });
  expect_broken("buffer view 0: it reaches to byte 4294967343 of",
                [](json& d) { d["bufferViews"][0]["byteOffset"] = 4294967295; });
  expect_broken("buffer view 0: buffer 9 does not exist", [](json& d) { d["bufferViews"][0]["buffer"] = 9; });
  expect_broken("accessor 0: buffer view 9 does not exist",
                [](json& d) { d["accessors"][0]["bufferView"] = 9; });
  expect_broken("accessor 0: it has no data", [](json& d) { d["accessors"][0].erase("bufferView"); });
  expect_broken("positions must be vectors of three floats",
                [](json& d) { d["accessors"][0]["type"] = "VEC2"; });
  expect_broken("positions must be vectors of three floats",
                [](json& d) { d["accessors"][0]["componentType"] = k_u16; });
  expect_broken("componentType", [](json& d) { d["accessors"][0]["componentType"] = 1; });
  expect_broken("indices must be scalars", [](json& d) { d["accessors"][1]["type"] = "VEC3"; });
  expect_broken("accessor 9 does not exist", [](json& d) { primitive(d)["attributes"]["POSITION"] = 9; });
  expect_broken("out of bounds", [](json& d) { primitive(d)["indices"] = 9; });
  expect_broken("it has no positions", [](json& d) { primitive(d)["attributes"] = {{"NORMAL", 0}}; });
  expect_broken("index 3 is out of range: 3 vertices", [](json& d) {
    d["accessors"][0]["count"] = 3;
    primitive(d)["indices"] = add_accessor(d, std::vector<std::uint8_t>{0, 1, 3}, k_u8, "SCALAR");
  });
  expect_broken("byteLength", [](json& d) { d["buffers"][0].erase("byteLength"); });
  expect_broken("Failed to decode", [](json& d) { d["buffers"][0]["byteLength"] = 47; });
  expect_broken("attributes", [](json& d) { primitive(d).erase("attributes"); });
}

TEST_F(ImportGltf, RefusesValuesOfAWrongKindAndNamesTheirPlace) {
  const auto expect_broken = [&](const std::string& place, auto&& change) {
    json document = triangle();
    change(document);
    expect_error(document, place + ": glTF does not allow the value");
  };
  expect_broken("/nodes/0/mesh", [](json& d) { d["nodes"][0]["mesh"] = "0"; });
  expect_broken("/nodes/0/mesh", [](json& d) { d["nodes"][0]["mesh"] = 4294967296; });
  expect_broken("/nodes/0/translation", [](json& d) { d["nodes"][0]["translation"] = {1, 2}; });
  expect_broken("/nodes/0/scale", [](json& d) { d["nodes"][0]["scale"] = {1, 2, "3"}; });
  expect_broken("/nodes/0/matrix", [](json& d) { d["nodes"][0]["matrix"] = {1, 2, 3}; });
  expect_broken("/nodes/0/rotation", [](json& d) { d["nodes"][0]["rotation"] = nullptr; });
  expect_broken("/nodes/0/children", [](json& d) { d["nodes"][0]["children"] = {-1}; });
  expect_broken("/meshes", [](json& d) { d["meshes"] = 3; });
  expect_broken("/meshes/0/primitives", [](json& d) { d["meshes"][0]["primitives"] = {1}; });
  expect_broken("/extensionsRequired", [](json& d) { d["extensionsRequired"] = {1}; });
  expect_broken("/materials/0/pbrMetallicRoughness/baseColorFactor", [](json& d) {
    d["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1}}}}}};
  });
  json document = triangle();
  primitive(document)["attributes"]["POSITION"] = -1;
  expect_error(document, "/meshes/0/primitives/0/attributes: attribute POSITION names no accessor");
  document = triangle();
  document["nodes"][0]["extras"] = {{"mesh", "anything"}};
  EXPECT_NO_THROW(load(document)) << "extras are the file's own";
}

TEST_F(ImportGltf, RefusesBrokenText) {
  expect_error("a.gltf", "{\"asset\":", "its JSON is broken");
  expect_error("a.gltf", "no json", "its JSON is broken");
  expect_error("a.gltf", "[1, 2]", "its JSON is not an object");
  expect_error("a.gltf", R"({"scene": 0})", "asset");
  expect_error("a.gltf", R"({"nodes": [{"translation": [1e999, 0, 0]}]})", "its JSON is broken");
  std::string deep = R"({"asset": {"version": "2.0"}, "extras": )";
  for (int i = 0; i < 100'000; ++i) deep += '[';
  expect_error("a.gltf", deep, "nested more than 100 levels deep");
  json document = triangle();
  document["asset"]["generator"] = "\"" + std::string(1000, '[');
  EXPECT_NO_THROW(load(document)) << "brackets in strings nest nothing";
}

TEST_F(ImportGltf, RefusesMoreVerticesThanMemoryHolds) {
  // A sparse array costs the file nothing.
  json document = triangle();
  json& accessor = document["accessors"][0];
  accessor.erase("bufferView");
  accessor["count"] = 300'000'000;
  accessor["sparse"] = {{"count", 3},
                        {"indices", {{"bufferView", 1}, {"componentType", k_u16}}},
                        {"values", {{"bufferView", 0}}}};
  expect_error(document, "more than the limit of");
}

TEST_F(ImportGltf, RefusesBinaryFilesThatAreCutOff) {
  const std::string whole = triangle_glb();
  ASSERT_NO_THROW(load("whole.glb", whole));
  for (std::size_t size = 1; size < whole.size(); ++size)
    EXPECT_THROW(load("cut.glb", whole.substr(0, size)), Error) << size << " of " << whole.size() << " bytes";
  expect_error("cut.glb", whole.substr(0, whole.size() - 4), "the file is cut off: ");
}

TEST_F(ImportGltf, RefusesBinaryFilesWithBrokenChunks) {
  const std::string whole = triangle_glb();
  const auto with_word = [&](std::size_t at, std::uint32_t word) {
    std::string bytes = whole;
    return bytes.replace(at, 4, little_endian(word));
  };
  const std::size_t binary = whole.size() - 48 - 8;
  expect_error("a.glb", with_word(4, 1), "glTF version 1 is not supported");
  expect_error("a.glb", with_word(12, 0xFFFFFFF0u), "the JSON chunk is longer than the file");
  expect_error("a.glb", with_word(binary, 56), "the binary chunk is longer than the file");
  expect_error("a.glb", with_word(binary, 0xFFFFFFF8u), "the binary chunk is longer than the file");
  expect_error("a.glb", "glTF", "the file ends inside a header");
  expect_error("a.glb", std::string(64, 'x'), "JSON");
}

TEST_F(ImportGltf, SurvivesRandomDamage) {
  // Files that differ from a good one in a few bytes: they load or are refused, and nothing else happens.
  std::mt19937 random(1);
  json document = with_light({{"type", "point"}}, {{"children", {2}}});
  document["nodes"].push_back({{"camera", 0}});
  document["cameras"] = json::array({k_perspective});
  for (const auto& [name, whole] : {std::pair<std::string, std::string>{"damaged.glb", triangle_glb()},
                                    {"damaged.gltf", document.dump()}}) {
    for (int i = 0; i < 300; ++i) {
      std::string bytes = whole;
      for (int k = 0; k < 3; ++k) {
        char& byte = bytes[random() % bytes.size()];
        byte = i % 2 ? static_cast<char>(random()) : "0123456789-{}[],:\""[random() % 18];
      }
      try {
        load(name, bytes);
      } catch (const Error&) {
      }
    }
  }
}

// ---- OBJ ----

const std::string k_obj_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(ImportObj, ReadsTrianglesWithTheDefaultMaterial) {
  const Scene scene = load(
      "a.obj", "# a comment\n" + k_obj_square + "vt 0 0\nvn 0 0 1\no part\nf 1/1/1 2//1 3\nf -4 -2 -1\n");
  ASSERT_EQ(scene.geometry.triangles.size(), 2u);
  EXPECT_THAT(corners(scene, 0), ElementsAre(V(0, 0, 0), V(1, 0, 0), V(1, 1, 0)));
  EXPECT_THAT(corners(scene, 1), ElementsAre(V(0, 0, 0), V(1, 1, 0), V(0, 1, 0)));
  EXPECT_EQ(albedo_of(scene, 0), Material{}.albedo);
  EXPECT_THAT(scene.report.warnings, IsEmpty());
  EXPECT_THAT(scene.cameras, IsEmpty());
  EXPECT_THAT(scene.lights, IsEmpty());
}

TEST_F(ImportObj, ReadsEveryEndOfLineAndFormOfNumber) {
  const Scene scene = load("a.obj", "v 0 .5 -0.\r\nv +1e0 0 0\r\n\r\nv 1E0 10.0e-1 0\rf 1 2 3");
  ASSERT_EQ(scene.geometry.triangles.size(), 1u);
  EXPECT_THAT(corners(scene, 0), ElementsAre(V(0, 0.5f, 0), V(1, 0, 0), V(1, 1, 0)));
}

TEST_F(ImportObj, CutsPolygons) {
  EXPECT_EQ(load("a.obj", k_obj_square + "f 1 2 3 4\n").geometry.triangles.size(), 2u);
  // An L of six corners.
  const Scene scene = load("a.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
  ASSERT_EQ(scene.geometry.triangles.size(), 4u);
  double area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<glm::vec3> c = corners(scene, i);
    area += 0.5 * glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
  }
  EXPECT_NEAR(area, 3.0, k_single);
}

TEST_F(ImportObj, TakesDiffuseColoursFromTheMaterialFile) {
  write("a.mtl", "newmtl red\nKd 0.9 0.1 0\nnewmtl blue\nKd 0 0 1\n");
  const std::string text = "mtllib a.mtl\n" + k_obj_square + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\n";
  const Scene scene = load("a.obj", text);
  EXPECT_EQ(albedo_of(scene, 0), V(0.9f, 0.1f, 0.0f));
  EXPECT_EQ(albedo_of(scene, 1), V(0, 0, 1));
  EXPECT_THAT(scene.report.warnings, IsEmpty());

  write("a.mtl", "newmtl red\nKd 1.5 0 0\nnewmtl blue\nKd 0 0 1\n");
  expect_error("a.obj", text, "material 'red': a base colour of 1.5 is not between 0 and 1");
}

TEST_F(ImportObj, FindsMaterialsInAFolderWithAColon) {
  std::filesystem::create_directory(folder_ / "a:b");
  write("a:b/m.mtl", "newmtl red\nKd 1 0 0\n");
  EXPECT_EQ(albedo_of(load("a:b/m.obj", "mtllib m.mtl\n" + k_obj_square + "usemtl red\nf 1 2 3\n"), 0),
            V(1, 0, 0));
}

TEST_F(ImportObj, WarnsOfMissingMaterials) {
  const Scene scene =
      load("a.obj", "mtllib none.mtl\n" + k_obj_square + "usemtl red\nf 1 2 3\nusemtl red\nf 1 3 4\n");
  EXPECT_EQ(scene.geometry.triangles.size(), 2u);
  EXPECT_EQ(albedo_of(scene, 0), Material{}.albedo);
  EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("material file 'none.mtl' not found")));
  EXPECT_THAT(scene.report.warnings, Contains(testing::AllOf(HasSubstr("red"), HasSubstr("(2 times)"))));
}

TEST_F(ImportObj, WarnsOfWhatItLeavesOutWithCounts) {
  const auto warnings = [&](const std::string& text) { return load("a.obj", text).report.warnings; };
  const std::string face = k_obj_square + "f 1 2 3\n";
  EXPECT_THAT(warnings(face + "l 1 2\np 1\n"), ElementsAre(HasSubstr("2 lines and point sets ignored")));
  EXPECT_THAT(warnings(face + "v 0 0 0 1 0 0\n"), ElementsAre(HasSubstr("vertex colours ignored")));
  EXPECT_THAT(warnings(face + "curv 0 1\nsurf\n"),
              ElementsAre("2 lines not understood, first line 6: 'curv'"));
  EXPECT_THAT(warnings(face + "f 1 2\n"), ElementsAre(HasSubstr("Degenerated face")));
  EXPECT_THAT(warnings(k_obj_square), ElementsAre("the file has no triangles"));
  EXPECT_THAT(warnings("# nothing\n"), ElementsAre("the file has no triangles"));

  write("m.mtl", "newmtl m\nKd 1 1 1\nKe 1 0 0\nd 0.5\nmap_Kd picture.png\n");
  EXPECT_THAT(warnings("mtllib m.mtl\nusemtl m\n" + face),
              ElementsAre(HasSubstr("1 materials' textures"), HasSubstr("1 materials' emission"),
                          HasSubstr("1 transparent materials")));
}

TEST_F(ImportObj, DropsAndCountsTrianglesOfZeroArea) {
  const Scene scene = load("a.obj", k_obj_square + "v 2 0 0\nf 1 2 3\nf 1 2 5\nf 1 1 2\n");
  EXPECT_EQ(scene.report.degenerate_triangles, 2u);
  EXPECT_EQ(scene.geometry.triangles.size(), 1u);
}

TEST_F(ImportObj, RefusesCoordinatesThatAreNoFiniteNumbers) {
  for (const char* bad : {"nan", "inf", "-inf", "1e999", "x", "1.2.3", "0x10", "1e", "--1"})
    expect_error("a.obj", "v 0 0 0\nv 1 " + std::string(bad) + " 0\n",
                 "line 2: vertex 2: '" + std::string(bad) + "' is not a finite number");
  expect_error("a.obj", "v 0 0\n", "line 1: a vertex needs three coordinates");
  expect_error("a.obj", "v 0 0 0e999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite");
}

TEST_F(ImportObj, RefusesFacesOfVerticesThatDoNotExist) {
  expect_error("a.obj", k_obj_square + "f 1 2 5\n", "line 5: vertex 5 is out of range: 4 vertices");
  expect_error("a.obj", k_obj_square + "f 1 2 3 9\n", "line 5: vertex 9 is out of range: 4 vertices");
  expect_error("a.obj", k_obj_square + "f 1 2 -5\n", "line 5: vertex -5 is out of range: 4 vertices so far");
  expect_error("a.obj", k_obj_square + "f 1 2 -2147483648\n", "vertex -2147483648 is out of range");
  expect_error("a.obj", k_obj_square + "f 1 2 0\n", "line 5: '0' is not a vertex");
  expect_error("a.obj", k_obj_square + "f 1 2 x/1\n", "line 5: 'x/1' is not a vertex");
  expect_error("a.obj", k_obj_square + "f 1 2 99999999999\n", "is not a vertex");
  EXPECT_EQ(load("a.obj", "f 1 2 3\n" + k_obj_square).geometry.triangles.size(), 1u)
      << "vertices may come later";
}

TEST_F(ImportObj, RefusesPolygonsOfVeryManyCorners) {
  std::string face = "f";
  for (int i = 0; i < 1001; ++i) face += " 1";
  expect_error("a.obj", k_obj_square + face, "line 5: a polygon of 1001 corners");
}

TEST_F(ImportObj, RefusesFilesThatAreNoObj) {
  expect_error("a.obj",
               "\x7f"
               "ELF\x02\x01 binary\nmore of it\n",
               "this is no OBJ file");
  expect_error("a.obj", "{\"asset\": {\"version\": \"2.0\"}}", "this is no OBJ file");
  expect_error("a.obj", std::string("\0\0\0\0", 4), "this is no OBJ file");
}

// ---- PLY ----

/// A header of the unit square's corners and some faces.
std::string ply_header(const std::string& format, std::size_t faces, const std::string& end_of_line = "\n",
                       const std::string& scalar = "float") {
  std::string header;
  for (const std::string& line :
       {std::string("ply"), "format " + format + " 1.0", std::string("comment made by hand"),
        std::string("element vertex 4"), "property " + scalar + " x", "property " + scalar + " y",
        "property " + scalar + " z", "element face " + std::to_string(faces),
        std::string("property list uchar int vertex_indices"), std::string("end_header")})
    header += line + end_of_line;
  return header;
}

/// Appends a value in the byte order of the format.
template <typename T>
void put(std::string& bytes, T value, bool big_endian) {
  std::string text = bytes_of(std::vector<T>{value});
  if (big_endian) std::reverse(text.begin(), text.end());
  bytes += text;
}

/// The square as two triangles, in binary.
std::string binary_ply(bool big_endian, const std::vector<std::int32_t>& corners = {0, 1, 2, 0, 2, 3}) {
  std::string bytes =
      ply_header(big_endian ? "binary_big_endian" : "binary_little_endian", corners.size() / 3);
  for (float coordinate : k_square) put(bytes, coordinate, big_endian);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0) bytes += '\3';
    put(bytes, corners[i], big_endian);
  }
  return bytes;
}

const std::string k_ply_square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string ascii_ply(std::size_t faces, const std::string& lines) {
  return ply_header("ascii", faces) + k_ply_square + lines;
}

TEST_F(ImportPly, ReadsEachFormatAlike) {
  const std::vector<std::string> files = {
      ascii_ply(2, "3 0 1 2\n3 0 2 3\n"), binary_ply(false), binary_ply(true),
      ply_header("ascii", 2, "\r\n") + "0 0 0\r\n1 0\t0 \r\n\r\n1 +1e0 .0\r\n0 1 -0.\r\n3 0 1 2\r\n3 0 2 3"};
  for (const std::string& file : files) {
    const Scene scene = load("a.ply", file);
    ASSERT_EQ(scene.geometry.triangles.size(), 2u);
    EXPECT_THAT(corners(scene, 0), ElementsAre(V(0, 0, 0), V(1, 0, 0), V(1, 1, 0)));
    EXPECT_THAT(corners(scene, 1), ElementsAre(V(0, 0, 0), V(1, 1, 0), V(0, 1, 0)));
    EXPECT_EQ(albedo_of(scene, 1), Material{}.albedo);
    EXPECT_THAT(scene.report.warnings, IsEmpty());
    EXPECT_THAT(scene.cameras, IsEmpty());
    EXPECT_THAT(scene.lights, IsEmpty());
  }
}

TEST_F(ImportPly, ReadsBinaryAfterAHeaderWithCarriageReturns) {
  std::string bytes = ply_header("binary_little_endian", 1, "\r\n");
  for (float coordinate : k_square) put(bytes, coordinate, false);
  bytes += '\3';
  for (int corner : {10, 13, 2}) put(bytes, corner, false);  // 10 and 13 are the codes of ends of lines
  expect_error("a.ply", bytes, "face 0: vertex 10 is out of range");
}

template <typename T>
void expect_scalar(const std::function<Scene(const std::string&)>& load_ply, const std::string& name) {
  for (bool big_endian : {false, true}) {
    std::string bytes = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian", 1, "\n", name);
    for (float coordinate : k_square) put(bytes, static_cast<T>(100.0f * coordinate), big_endian);
    bytes += '\3';
    for (std::int32_t corner : {1, 2, 3}) put(bytes, corner, big_endian);
    EXPECT_THAT(corners(load_ply(bytes), 0), ElementsAre(V(100, 0, 0), V(100, 100, 0), V(0, 100, 0))) << name;
  }
}

TEST_F(ImportPly, ReadsCoordinatesOfEveryType) {
  const auto load_ply = [this](const std::string& bytes) { return load("a.ply", bytes); };
  expect_scalar<std::int8_t>(load_ply, "char");
  expect_scalar<std::uint8_t>(load_ply, "uint8");
  expect_scalar<std::int16_t>(load_ply, "short");
  expect_scalar<std::uint16_t>(load_ply, "uint16");
  expect_scalar<std::int32_t>(load_ply, "int");
  expect_scalar<std::uint32_t>(load_ply, "uint32");
  expect_scalar<float>(load_ply, "float32");
  expect_scalar<double>(load_ply, "double");
}

/// Vertices with colour, normal and a list, an element of its own between, and faces before the vertices.
const std::string k_rich_header =
    "ply\nformat %s 1.0\nobj_info scanned\n"
    "element face 1\nproperty uchar red\nproperty list uint8 uint16 vertex_index\nproperty list int double "
    "uv\n"
    "element edge 2\nproperty list ushort int ends\nproperty short kind\n"
    "element vertex 3\nproperty float z\nproperty list char float weights\nproperty double y\n"
    "property uchar green\nproperty float x\nelement user 0\nproperty int mood\nend_header\n";

std::string rich_header(const std::string& format) {
  std::string header = k_rich_header;
  return header.replace(header.find("%s"), 2, format);
}

TEST_F(ImportPly, SkipsWhatItDoesNotKnow) {
  std::string binary = rich_header("binary_big_endian");
  const auto add = [&](auto value) { put(binary, value, true); };
  add(std::uint8_t{255});
  add(std::uint8_t{3});
  for (std::uint16_t corner : std::vector<std::uint16_t>{2, 0, 1}) add(corner);
  add(std::int32_t{2});
  for (double uv : {0.5, 0.25}) add(uv);
  for (std::uint16_t ends : std::vector<std::uint16_t>{0, 3}) {
    add(ends);
    for (int i = 0; i < ends; ++i) add(std::int32_t{7});
    add(std::int16_t{-1});
  }
  for (int i = 0; i < 3; ++i) {
    add(1.0f + static_cast<float>(i));
    add(static_cast<std::int8_t>(i));
    for (int k = 0; k < i; ++k) add(0.1f);
    add(10.0 * i * i);
    add(std::uint8_t{9});
    add(static_cast<float>(i));
  }
  const std::string ascii = rich_header("ascii") +
                            "255 3 2 0 1 2 0.5 0.25\n0 -1\n3 7 7 7 -1\n"
                            "1 0 0 9 0\n2 1 0.1 10 9 1\n3 2 .1 .1 40 9 2\n";
  for (const std::string& file : {binary, ascii}) {
    const Scene scene = load("a.ply", file);
    ASSERT_EQ(scene.geometry.triangles.size(), 1u);
    EXPECT_THAT(corners(scene, 0), ElementsAre(V(2, 40, 3), V(0, 0, 1), V(1, 10, 2)));
    EXPECT_THAT(scene.report.warnings, ElementsAre("face colours ignored: surfaces have one colour",
                                                   "2 elements 'edge' ignored: only faces are rendered",
                                                   "vertex colours ignored: surfaces have one colour"));
  }
}

TEST_F(ImportPly, CutsPolygons) {
  const Scene fan = load("a.ply", ascii_ply(1, "4 3 0 1 2\n"));
  ASSERT_EQ(fan.geometry.triangles.size(), 2u);
  EXPECT_THAT(corners(fan, 0), ElementsAre(V(0, 1, 0), V(0, 0, 0), V(1, 0, 0)));
  EXPECT_THAT(corners(fan, 1), ElementsAre(V(0, 1, 0), V(1, 0, 0), V(1, 1, 0)));

  // An L of six corners and one in the middle of an edge, in each plane, either way round and from each
  // corner.
  const std::vector<glm::ivec2> outline = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (int turn = 0; turn < 3 * 2 * 7; ++turn) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 7\nproperty int x\nproperty int y\nproperty int z\n"
        "element face 1\nproperty list int uint vertex_indices\nend_header\n";
    for (glm::ivec2 p : outline) {
      text += turn % 3 == 0   ? fmt::format("{} {} 0\n", p.x, p.y)
              : turn % 3 == 1 ? fmt::format("0 {} {}\n", p.x, p.y)
                              : fmt::format("{} 0 {}\n", p.y, p.x);
    }
    text += "7";
    for (int i = 0; i < 7; ++i) {
      const int corner = (i + turn / 6) % 7;
      text += fmt::format(" {}", turn / 3 % 2 ? corner : 6 - corner);
    }
    const Scene scene = load("a.ply", text + "\n");
    ASSERT_EQ(scene.geometry.triangles.size(), 5u) << turn;
    double area = 0.0;
    glm::vec3 sum(0.0f);
    for (std::size_t i = 0; i < 5; ++i) {
      const std::vector<glm::vec3> c = corners(scene, i);
      const glm::vec3 twice = glm::cross(c[1] - c[0], c[2] - c[0]);
      area += 0.5 * glm::length(twice);
      sum += 0.5f * twice;
    }
    EXPECT_NEAR(area, 3.0, k_single) << turn;
    EXPECT_NEAR(glm::length(sum), 3.0, k_single) << "all face the same way, " << turn;
    EXPECT_THAT(scene.report.warnings, IsEmpty());
  }
}

TEST_F(ImportPly, WarnsOfWhatItLeavesOutWithCounts) {
  const auto warnings = [&](std::size_t faces, const std::string& lines) {
    return load("a.ply", ascii_ply(faces, lines)).report.warnings;
  };
  EXPECT_THAT(warnings(0, ""), ElementsAre("the file has no triangles"));
  EXPECT_THAT(warnings(3, "2 0 1\n0\n3 0 1 2\n"), ElementsAre("2 faces of fewer than three corners ignored"));
  EXPECT_THAT(warnings(1, "3 0 1 2\n3 0 2 3\n"), ElementsAre("what follows the last element is ignored"));
  EXPECT_EQ(load("a.ply", ascii_ply(3, "3 0 1 2\n3 0 0 1\n4 0 1 0 1\n")).report.degenerate_triangles, 3u);
  // Six corners whose edges cross so that no ear is left at the end.
  EXPECT_THAT(
      load("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "2 0 0\n1 0 0\n0 2 0\n0 0 0\n3 1 0\n2 3 0\n6 0 1 2 3 4 5\n")
          .report.warnings,
      ElementsAre("1 triangles of polygons that cross themselves could not be cut out"));
}

TEST_F(ImportPly, RefusesBinaryFilesThatAreCutOff) {
  for (bool big_endian : {false, true}) {
    const std::string whole = binary_ply(big_endian);
    for (std::size_t size = 1; size < whole.size(); ++size)
      EXPECT_THROW(load("cut.ply", whole.substr(0, size)), Error)
          << size << " of " << whole.size() << " bytes";
    expect_error("cut.ply", whole.substr(0, whole.size() - 1), "face 1: the file ends inside it");
  }
}

TEST_F(ImportPly, RefusesAsciiFilesThatAreCutOff) {
  expect_error("a.ply", ascii_ply(2, "3 0 1 2\n"), "face 1: the file ends before it");
  expect_error("a.ply", ascii_ply(1, "3 0 1\n"), "line 15: face 0: it has too few values");
  expect_error("a.ply", ply_header("ascii", 0) + "0.0 0 0\n1 0\n0.0 0 0\n0.0 0 0\n",
               "line 12: vertex 1: it has too few values");
  expect_error("a.ply", ply_header("ascii", 0) + "0 0 0\n1 0 0 5\n0 0 0\n0 0 0\n",
               "line 12: vertex 1: it has 4 values, 3 are expected");
}

TEST_F(ImportPly, BelievesNoCountThatTheFileCannotHold) {
  const auto with = [](std::string file, const std::string& old, const std::string& text) {
    return file.replace(file.find(old), old.size(), text);
  };
  for (const std::string& count : {std::string("4000000000"), std::string("18446744073709551615")}) {
    for (const std::string& file : {binary_ply(false), ascii_ply(1, "3 0 1 2\n")}) {
      expect_error("a.ply", with(file, "element vertex 4", "element vertex " + count),
                   "element 'vertex': " + count + " of them do not fit");
      const std::string faces = file.substr(file.find("element face "), 14);
      expect_error("a.ply", with(file, faces, "element face " + count),
                   "element 'face': " + count + " of them do not fit");
    }
  }
  for (const char* count : {"-1", "4.0", "18446744073709551616", "many", "0x4"})
    expect_error("a.ply", with(binary_ply(false), "vertex 4", "vertex " + std::string(count)),
                 "line 4: '" + std::string(count) + "'");

  // Lists.
  std::string list = with(binary_ply(false, {0, 1, 2}), "uchar int vertex", "int int vertex");
  list.resize(list.size() - 13);
  for (std::int32_t size : {-1, 2'000'000'000, 4, 1001}) {
    std::string bytes = list;
    put(bytes, size, false);
    bytes += std::string(12, '\0');
    expect_error("a.ply", bytes,
                 size < 0 ? "face 0: a list of -1 values" : "face 0: the file ends inside it");
  }
  expect_error("a.ply", ascii_ply(1, "4294967295 0 1 2\n"), "line 15: face 0: it has too few values");
  // Elements without properties take no bytes, however many there are.
  EXPECT_EQ(load("a.ply", with(binary_ply(false), "element vertex",
                               "element nothing 18446744073709551615\nelement vertex"))
                .geometry.triangles.size(),
            2u);
}

TEST_F(ImportPly, RefusesCoordinatesThatAreNotFinite) {
  for (const char* bad : {"nan", "inf", "-inf", "1e999", "x", "1.2.3", "0x10"})
    expect_error("a.ply", ply_header("ascii", 0) + "0 0 0\n0 " + bad + " 0\n0 0 0\n0 0 0\n",
                 "line 12: vertex 1: '" + std::string(bad) + "' is not a finite number");
  std::string bytes = binary_ply(true);
  std::string bad;
  put(bad, k_nan, true);
  const std::size_t body = bytes.find("end_header\n") + 11;
  expect_error("a.ply", bytes.replace(body + 12, 4, bad), "vertex 1: the position is not finite");
}

TEST_F(ImportPly, RefusesFacesOfVerticesThatDoNotExist) {
  expect_error("a.ply", binary_ply(false, {0, 1, 4}), "face 0: vertex 4 is out of range: 4 vertices, from 0");
  expect_error("a.ply", binary_ply(true, {0, 1, 2, 0, -1, 3}), "face 1: vertex -1 is out of range");
  expect_error("a.ply", ascii_ply(1, "3 0 1 -2147483648\n"),
               "line 15: face 0: vertex -2147483648 is out of range");
  expect_error("a.ply", ascii_ply(1, "3 0 1 1.5\n"), "line 15: face 0: '1.5' is not an integer");
  std::string many = "1001";
  for (int i = 0; i < 1001; ++i) many += " 0";
  std::string file = ascii_ply(1, many);
  expect_error("a.ply", file.replace(file.find("uchar int"), 9, "int int"),
               "line 15: face 0: a polygon of 1001 corners");
}

TEST_F(ImportPly, RefusesBrokenHeaders) {
  const auto with = [](const std::string& old, const std::string& text) {
    std::string file = ascii_ply(1, "3 0 1 2\n");
    return file.replace(file.find(old), old.size(), text);
  };
  expect_error("a.ply", "plyx\n", "this is no PLY file");
  expect_error("a.ply",
               std::string("\x7f"
                           "ELF\0\n",
                           6),
               "this is no PLY file");
  expect_error("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "the file ends inside its header");
  expect_error("a.ply", with("format ascii 1.0\n", ""), "line 9: the header names no format");
  expect_error("a.ply", with("ascii 1.0", "ascii 2.0"), "line 2: 'format ascii 2.0' is not understood");
  expect_error("a.ply", with("ascii", "binary"), "line 2: there is no format 'binary'");
  expect_error("a.ply", with("float x", "half x"), "line 5: there is no type 'half'");
  expect_error("a.ply", with("float x", "list uchar float x"),
               "element 'vertex': its properties must include");
  expect_error("a.ply", with("float y", "float x"), "line 6: the property 'x' is there twice");
  expect_error("a.ply", with("element face 1", "element vertex 1"),
               "line 8: the element 'vertex' is there twice");
  expect_error("a.ply", with("element vertex 4", "element point 4"), "the file has no element 'vertex'");
  expect_error("a.ply", with("element vertex 4\n", ""), "line 4: 'property float x' is not understood");
  expect_error("a.ply", with("list uchar", "list float"), "line 9: the length of a list must be an integer");
  expect_error("a.ply", with("vertex_indices", "corners"), "element 'face': its properties must include");
  expect_error("a.ply", with("comment", "remark"), "line 3: 'remark made by hand' is not understood");
}

TEST_F(ImportPly, SurvivesRandomDamage) {
  std::mt19937 random(1);
  for (const std::string& whole :
       {binary_ply(false), binary_ply(true), ascii_ply(2, "3 0 1 2\n4 0 1 2 3\n"),
        rich_header("ascii") + "255 3 2 0 1 0\n0 -1\n0 1\n1 0 0 9 0\n2 0 0 0 1\n1 0 1 9 1\n"}) {
    for (int i = 0; i < 500; ++i) {
      std::string bytes = whole;
      for (int k = 0; k < 3; ++k) {
        char& byte = bytes[random() % bytes.size()];
        byte = i % 2 ? static_cast<char>(random()) : "0123456789-e. \n"[random() % 15];
      }
      try {
        load("damaged.ply", bytes);
      } catch (const Error&) {
      }
    }
  }
}

// ---- Real files ----

struct Expectation {
  const char* file;
  std::size_t triangles, degenerate, cameras, lights;
};

class SharedScene : public testing::TestWithParam<Expectation> {};

TEST_P(SharedScene, Loads) {
  const Expectation& expected = GetParam();
  const std::filesystem::path file = tests::shared_file(std::string("scenes/") + expected.file);
  AIRLIGHT_NEEDS(file);
  const Scene scene = import_scene(file);
  EXPECT_EQ(scene.geometry.triangles.size() + scene.report.degenerate_triangles, expected.triangles);
  EXPECT_EQ(scene.report.degenerate_triangles, expected.degenerate);
  EXPECT_EQ(scene.cameras.size(), expected.cameras);
  EXPECT_EQ(scene.lights.size(), expected.lights);
}

INSTANTIATE_TEST_SUITE_P(
    Import, SharedScene,
    testing::Values(Expectation{"cornell_box_36.glb", 36, 0, 0, 0},
                    Expectation{"victorian_fence_19k.glb", 19'368, 128, 0, 0},
                    Expectation{"railing_degenerate_11k.glb", 11'108, 4'021, 0, 0},
                    Expectation{"sponza_262k.glb", 262'267, 0, 0, 0},
                    Expectation{"terrain_1280k.glb", 1'280'000, 0, 0, 0},
                    Expectation{"dragon_871k.glb", 871'414, 108, 0, 0},
                    Expectation{"lights_bevy_Cubes_pointlight.glb", 36, 0, 0, 1},
                    Expectation{"lights_bevy_VolumetricFogExample_geom.glb", 360, 0, 0, 1},
                    Expectation{"lights_playcanvas_Lights.glb", 12, 0, 1, 4},
                    Expectation{"lights_playcanvas_geometry_camera_light.glb", 14, 0, 1, 2},
                    Expectation{"lights_sphere.gltf", 224, 0, 0, 4}),
    [](const auto& test) {
      std::string name = test.param.file;
      return name.substr(0, name.find('.'));
    });

TEST(SharedFile, RefusesAnExtentThatOverflows) {
  const std::filesystem::path file = tests::shared_file("scenes/float_overflow_12.obj");
  AIRLIGHT_NEEDS(file);
  try {
    import_scene(file);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the extent of the geometry overflows single precision"));
  }
}

TEST(SharedFile, KeepsLightsAndCamerasOfPlaycanvas) {
  const std::filesystem::path file = tests::shared_file("scenes/lights_playcanvas_Lights.glb");
  AIRLIGHT_NEEDS(file);
  const Scene scene = import_scene(file);
  expect_near(scene.lights.at(0).position, {2.598804473876953, 3.5685081481933594, -1.0054539442062378});
  EXPECT_EQ(scene.lights.at(0).intensity, V(5, 0, 0));
  expect_near(scene.cameras.at(0).eye, {7.358891487121582, 4.958309173583984, 6.925790786743164});
  EXPECT_NEAR(scene.cameras.at(0).vertical_fov_degrees, 22.8952, 1e-4);
  EXPECT_THAT(scene.report.warnings, IsEmpty());
  ASSERT_EQ(scene.lights.size(), 4u);
}

}  // namespace
}  // namespace airlight::scene
