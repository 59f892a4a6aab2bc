#include "scene/nodes.h"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/path.h"
#include "support/models.h"

/// Nodes of glTF files, and how paths move them.
namespace airlight::scene {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using V = glm::vec3;

constexpr const char* k_head = "frames = 3\nseconds = 2\n";

/// A triangle on each of: node 1 'arm', its child 2 'hand' and node 3, that has no name. Node 0 'stand' holds
/// all of them, node 4 'none' holds nothing.
json figure() {
  json document = tests::triangle();
  document["nodes"] = {{{"name", "stand"}, {"children", {1, 3, 4}}},
                       {{"name", "arm"}, {"mesh", 0}, {"children", {2}}, {"translation", {1, 0, 0}}},
                       {{"name", "hand"}, {"mesh", 0}, {"translation", {0, 2, 0}}},
                       {{"mesh", 0}},
                       {{"name", "none"}}};
  return document;
}

class Nodes : public tests::ImportFolder {
 protected:
  Path path(const Scene& scene, std::string_view content) {
    View view;
    view.camera.eye = {0, 0, 9};
    return load_path(write("path.toml", k_head + std::string(content)), view, &scene);
  }
  void expect_path_error(const Scene& scene, std::string_view content, const std::string& text) {
    tests::expect_error(ExitCode::bad_file, {text, "path.toml"}, [&] { path(scene, content); });
  }

  /// The first corner of each triangle where a frame of the path has it.
  std::vector<V> first_corners(const Scene& scene, const Path& path, std::size_t frame) {
    const Geometry there = posed(scene.geometry, path.views[frame].pose);
    std::vector<V> corners;
    for (const glm::uvec3& t : there.triangles) corners.push_back(there.positions[t.x]);
    return corners;
  }
};

TEST_F(Nodes, AreKeptWithWhatHangsOnThem) {
  const Scene scene = load(figure());
  ASSERT_EQ(scene.nodes.size(), 5u);
  EXPECT_EQ(scene.nodes[1].name, "arm");
  EXPECT_EQ(scene.nodes[2].parent, 1u);
  EXPECT_FALSE(scene.nodes[0].parent);
  EXPECT_THAT(scene.geometry.node_of_triangle, ElementsAre(1, 2, 3));
  EXPECT_THAT(chain_to(scene.nodes, 2), ElementsAre(0, 1, 2));
  EXPECT_THAT(nearest_of(scene.nodes, std::vector<std::uint32_t>{1, 2}), ElementsAre(0, 1, 2, 0, 0));
  EXPECT_THAT(nearest_of(scene.nodes, std::vector<std::uint32_t>{0}), ElementsAre(1, 1, 1, 1, 1));
  EXPECT_EQ(glm::dvec3(world_from_node(scene.nodes, 2)[3]), glm::dvec3(1, 2, 0));
}

TEST_F(Nodes, OfDroppedTrianglesAreDropped) {
  json document = figure();
  document["nodes"][1]["scale"] = {1, 0, 1};
  EXPECT_THAT(load(document).geometry.node_of_triangle, ElementsAre(3));
}

TEST_F(Nodes, MoveWithAllThatHangsOnThem) {
  const Scene scene = load(figure());
  const Path moved = path(
      scene, "[[node]]\nname = 'arm'\ntime = 0\n[[node]]\nname = 'arm'\ntime = 2\ntranslation = [5, 0, 1]\n");
  EXPECT_TRUE(moved.moves_objects());
  EXPECT_THAT(moved.views[0].pose.objects->names, ElementsAre("arm"));
  EXPECT_THAT(moved.views[0].pose.objects->of_triangle, ElementsAre(1, 1, 0));
  for (const std::size_t frame : {0u, 2u})
    EXPECT_THAT(first_corners(scene, moved, frame), ElementsAre(V(5, 0, 1), V(5, 2, 1), V(0, 0, 0)))
        << "one key gives it";
  EXPECT_FALSE(path(scene, "").moves_objects());
}

TEST_F(Nodes, MoveAlongCurvesAndTurn) {
  const Scene scene = load(figure());
  const Path moved = path(
      scene,
      "[[node]]\nname = 'arm'\ntime = 0\ntranslation = [1, 0, 0]\nrotation = [0, 0, 0, 1]\n"
      "[[node]]\nname = 'arm'\ntime = 2\ntranslation = [3, 0, 0]\nrotation = [0, 0, -0.70710678118654752, "
      "-0.70710678118654752]\n");
  EXPECT_TRUE(moved.views[0].pose.is_at_rest());
  EXPECT_THAT(first_corners(scene, moved, 0), ElementsAre(V(1, 0, 0), V(1, 2, 0), V(0, 0, 0)));
  const std::vector<V> half_way = first_corners(scene, moved, 1), last = first_corners(scene, moved, 2);
  EXPECT_NEAR(half_way[0].x, 2.0, 1e-6);
  // An eighth of a turn, the shorter way: the hand goes to the left.
  EXPECT_NEAR(half_way[1].x, 2.0 - std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(half_way[1].y, std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(last[1].x, 1.0, 1e-6);
  EXPECT_NEAR(last[1].y, 0.0, 1e-6);
}

TEST_F(Nodes, MoveWithinOthersThatMove) {
  const Scene scene = load(figure());
  const Path moved = path(scene,
                          "[[node]]\nname = 'hand'\ntime = 0\ntranslation = [0, 3, 0]\n"
                          "[[node]]\nname = '0'\ntime = 0\ntranslation = [0, 0, 7]\n");
  EXPECT_THAT(moved.views[0].pose.objects->names, ElementsAre("stand", "hand"));
  EXPECT_THAT(moved.views[0].pose.objects->of_triangle, ElementsAre(1, 2, 1));
  EXPECT_THAT(first_corners(scene, moved, 1), ElementsAre(V(1, 0, 7), V(1, 3, 7), V(0, 0, 7)));
}

/// As a file would have it whose node has the same transform, but for what rounding the file's own positions
/// left.
TEST_F(Nodes, MoveToWhereAMovedFileHasThem) {
  json document = figure();
  document["nodes"][0]["rotation"] = {0.5, 0.5, 0.5, 0.5};
  document["nodes"][0]["scale"] = {3, 3, 3};
  document["nodes"][1]["scale"] = {1, 2, 0.5};
  const Scene scene = load(document);
  const Path moved = path(scene,
                          "[[node]]\nname = 'arm'\ntime = 0\ntranslation = [0.1, 0.7, -2]\nrotation = [0.36, "
                          "0.48, 0, 0.8]\n");
  document["nodes"][1]["translation"] = {0.1, 0.7, -2};
  document["nodes"][1]["rotation"] = {0.36, 0.48, 0, 0.8};
  const Scene other = load(document);
  const Geometry there = posed(scene.geometry, moved.views[0].pose);
  ASSERT_EQ(there.triangles, other.geometry.triangles);
  for (const glm::uvec3& t : there.triangles)
    for (const glm::uint corner : {t.x, t.y, t.z})
      EXPECT_NEAR(glm::distance(there.positions[corner], other.geometry.positions[corner]), 0.0f, 4e-6f);
}

TEST_F(Nodes, TurnTheNormalsThatHangOnThem) {
  looks_ = Looks::textured;
  json document = figure();
  tests::primitive(document)["attributes"]["NORMAL"] = tests::add_accessor(
      document, std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, tests::k_float, "VEC3");
  const Scene scene = load(document);
  const Path moved =
      path(scene,
           "[[node]]\nname = 'arm'\ntime = 0\nrotation = [0, 0.70710678118654752, 0, 0.70710678118654752]\n");
  const Geometry there = posed(scene.geometry, moved.views[0].pose);
  EXPECT_NEAR(there.normals[0][0].x, 1.0f, 1e-6f);
  EXPECT_NEAR(there.normals[2][0].z, 1.0f, 1e-6f) << "it rests";
}

TEST_F(Nodes, ThatCannotBeMovedAreErrorsOfFileAndLine) {
  json document = figure();
  document["nodes"][3]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  document["nodes"].push_back({{"name", "arm"}});
  document["nodes"].push_back({{"name", "unseen"}, {"mesh", 0}});
  document["nodes"][0]["children"].push_back(5);
  const Scene scene = load(document);
  const auto key = [](const std::string& name, const std::string& rest) {
    return "[[node]]\nname = '" + name + "'\ntime = 0\n" + rest;
  };
  expect_path_error(scene, key("leg", ""),
                    "line 4, node.name: the scene has no node 'leg'; it has 'stand' (0), 'arm' (1)");
  expect_path_error(scene, key("arm", ""),
                    "line 4, node.name: several nodes are called 'arm'; give the number of one");
  EXPECT_NO_THROW(path(scene, key("1", "")));
  expect_path_error(scene, key("node3", ""), "the file places it by a matrix");
  expect_path_error(scene, key("none", ""), "there is nothing to move");
  expect_path_error(scene, key("unseen", ""), "it does not belong to the scene");
  expect_path_error(scene, "[[node]]\ntime = 0\n", "line 3, node.name: it is missing");
  expect_path_error(scene, key("hand", "translation = [0, nan, 0]"),
                    "line 6, node.translation: it is not finite");
  expect_path_error(scene, key("hand", "translation = [0, inf, 0]"),
                    "line 6, node.translation: it is not finite");
  expect_path_error(scene, key("hand", "translation = 1"),
                    "line 6, node.translation: it must be three numbers");
  expect_path_error(scene, key("hand", "rotation = [0, 1, 0]"),
                    "line 6, node.rotation: it must be four numbers");
  expect_path_error(scene, key("hand", "rotation = [0, 1, 0, 1]"),
                    "line 6, node.rotation: it is not a unit quaternion: its length is 1.41421");
  expect_path_error(scene, key("hand", "rotation = [0, nan, 0, 1]"), "it is not a unit quaternion");
  expect_path_error(scene, key("hand", "scale = [1, 2, 1]"), "line 6: there is no key 'scale' in [[node]]");
  expect_path_error(scene, key("hand", "") + key("hand", ""), "is not later than the key before");
  expect_path_error(load("x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), key("hand", ""),
                    "the scene has no nodes");
  View view;
  tests::expect_error(ExitCode::bad_file, {"the scene has no nodes"},
                      [&] { load_path(write("path.toml", k_head + key("hand", "")), view); });
}

TEST_F(Nodes, WhoseMotionIsNotRigidAreRefused) {
  json document = figure();
  document["nodes"][1]["scale"] = {1, 2, 1};
  const Scene scene = load(document);
  constexpr const char* k_turn = "time = 0\nrotation = [0, 0, 0.6, 0.8]\n";
  expect_path_error(scene, "[[node]]\nname = 'hand'\n" + std::string(k_turn),
                    "frame 0 (0 s): node 'hand': its motion is not rigid");
  EXPECT_NO_THROW(path(scene, "[[node]]\nname = 'arm'\n" + std::string(k_turn)))
      << "its own scale turns with it";
  document["nodes"][0]["scale"] = {0, 1, 1};
  expect_path_error(load(document), "[[node]]\nname = 'arm'\n" + std::string(k_turn),
                    "there is nothing to move");
}

TEST_F(Nodes, ThatLeaveLightsBehindAreWarnedOf) {
  json document = figure();
  document["extensionsUsed"] = {"KHR_lights_punctual"};
  document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  document["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const Scene scene = load(document);
  EXPECT_THAT(path(scene, "[[node]]\nname = 'arm'\ntime = 0\n").warnings,
              ElementsAre(HasSubstr("cameras and lights that hang on 'arm' and stay where they are; keys of "
                                    "their own move them: 1")));
  EXPECT_THAT(path(scene, "[[node]]\nname = 'node3'\ntime = 0\n").warnings, IsEmpty());
}

TEST_F(Nodes, ThatAreMovedOutOfSinglePrecisionAreErrors) {
  const Scene scene = load(figure());
  const auto move = [&](const std::string& translation) {
    const Path moved = path(scene, "[[node]]\nname = 'arm'\ntime = 0\ntranslation = " + translation);
    posed(scene.geometry, moved.views[0].pose);
  };
  tests::expect_error(ExitCode::bad_file, {"'arm', moved", "overflow single precision"},
                      [&] { move("[1e30, 0, 0]"); });
  tests::expect_error(ExitCode::bad_file, {"'arm', moved", "no area there"}, [&] { move("[1e12, 0, 0]"); });
}

}  // namespace
}  // namespace airlight::scene
