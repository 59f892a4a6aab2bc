// Objects that a path moves look as they do in a file that has them there.

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "frame/frame.h"
#include "frame/none.h"
#include "quality/methods.h"
#include "quality/traced.h"
#include "scene/path.h"
#include "support/models.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shadow_cases.h"
#include "surface_shadows/brute.h"
#include "surface_shadows/metric_tree.h"
#include "surface_shadows/psv.h"
#include "surface_shadows/shadow_map_lookup.h"

namespace airlight::surface_shadows {
namespace {

using nlohmann::json;

std::size_t add_mesh(json& document, const scene::Geometry& geometry) {
  std::vector<float> positions;
  for (const glm::vec3& p : geometry.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
  std::vector<std::uint32_t> indices;
  for (const glm::uvec3& t : geometry.triangles) indices.insert(indices.end(), {t.x, t.y, t.z});
  const std::size_t position = tests::add_accessor(document, positions, tests::k_float, "VEC3");
  const std::size_t index = tests::add_accessor(document, indices, tests::k_u32, "SCALAR");
  json mesh, primitive = {{"attributes", {{"POSITION", position}}}, {"indices", index}};
  mesh["primitives"].push_back(std::move(primitive));
  document["meshes"].push_back(std::move(mesh));
  return document["meshes"].size() - 1;
}

/// A floor, node 0; above it a 'swarm' of triangles, 1, on which a closed 'ball', 2, hangs; and a 'box', 3.
json model() {
  json document = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0, 1, 3}}}}}};
  tests::Random random(4);
  scene::Geometry floor, swarm, ball = tests::ball(), box;
  tests::add_quad(floor, {-6, -2, -6}, {0, 0, 12}, {12, 0, 0});
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 corner = random.in_box(1.5);
    const double size = random.logarithmic(0.02, 0.8);
    tests::add_triangle(swarm, glm::vec3(corner), glm::vec3(corner + size * random.direction()),
                        glm::vec3(corner + size * random.direction()));
  }
  for (glm::vec3& position : ball.positions) position = 0.5f * position + glm::vec3(-2, -1, 1);
  tests::add_box(box, {1.5f, -1.5f, 0}, {2.5f, -0.5f, 1});
  for (const scene::Geometry& mesh : {floor, swarm, ball, box})
    document["nodes"].push_back({{"mesh", add_mesh(document, mesh)}});
  document["nodes"][1]["name"] = "swarm";
  document["nodes"][1]["children"] = {2};
  document["nodes"][2]["name"] = "ball";
  document["nodes"][3]["name"] = "box";
  return document;
}

struct Place {
  std::array<double, 3> translation;
  std::array<double, 4> rotation;
};

/// Of the nodes 1 and 2 in the frames of a path: where the file has them, elsewhere, and far away.
struct Frames {
  Place swarm, ball;
};
const std::vector<Frames> k_frames = {
    {{{0, 0, 0}, {0, 0, 0, 1}}, {{0, 0, 0}, {0, 0, 0, 1}}},
    {{{0.3, 0.4, -0.7}, {0.36, 0.48, 0, 0.8}}, {{0.7, 1.1, 0.2}, {0, 0.6, 0, 0.8}}},
    {{{1.7, 0.1, 0.9}, {0, -0.28, 0.96, 0}}, {{-0.1, 0.3, 0}, {0.5, 0.5, -0.5, 0.5}}},
};

class Motion : public tests::ImportFolder {
 protected:
  scene::Path path(const scene::Scene& scene, const scene::View& view) {
    std::string text = "frames = 3\nseconds = 2\n";
    for (std::size_t i = 0; i < k_frames.size(); ++i) {
      const auto add = [&](const char* name, const Place& place) {
        text += "[[node]]\nname = '" + std::string(name) + "'\ntime = " + std::to_string(i) +
                "\ntranslation = " + json(place.translation).dump() +
                "\nrotation = " + json(place.rotation).dump() + "\n";
      };
      add("swarm", k_frames[i].swarm);
      add("ball", k_frames[i].ball);
    }
    return scene::load_path(write("path.toml", text), view, &scene);
  }

  /// The file whose nodes are where the path's frame has them.
  scene::Scene moved_file(json document, const Frames& frame) {
    const auto place = [&](std::size_t node, const Place& where) {
      document["nodes"][node]["translation"] = where.translation;
      document["nodes"][node]["rotation"] = where.rotation;
    };
    place(1, frame.swarm);
    place(2, frame.ball);
    return load(document);
  }
};

/// What is seen of a frame.
frame::FrameImages render(frame::Frame& frame, const scene::View& view, frame::SurfaceShadow& method) {
  frame::NoAirlight no_airlight;
  gpu::StageTimer timer(nullptr);
  frame.render(view, method, no_airlight, timer, frame::Resting::kept);
  return frame.read();
}

const scene::Light k_lamp = scene::point_light("", {1, 4, 1}, glm::vec3(1e12f));
const scene::Light k_sun = scene::sun("", {0.3, 1, 0.2}, glm::vec3(1.0f));

/// Places of vertices at rest are floats as the file has them: moved, they are rounded once, as the moved
/// file's are, so that all bits are the same.
TEST_F(Motion, ShowsWhatTheMovedFileShows) {
  const json document = model();
  const scene::Scene scene = load(document);
  MetricTree tree({}), culled({.cull = Culling::automatic});
  Psv psv({});
  Brute brute({});
  ShadowMapLookup map;
  for (const scene::Light& light : {k_lamp, k_sun}) {
    const scene::Path path = this->path(scene, tests::view_of_soup(light));
    frame::Frame frame(tests::gpu_context(), scene.geometry, 256);
    std::vector<float> before;
    for (std::size_t i = 0; i < k_frames.size(); ++i) {
      const scene::View& view = path.views[i];
      const scene::Scene there = moved_file(document, k_frames[i]);
      const scene::Geometry posed = scene::posed(scene.geometry, view.pose);
      EXPECT_TRUE(posed.positions == there.geometry.positions) << i;
      scene::View resting = view;
      resting.pose = {};
      frame::Frame of_file(tests::gpu_context(), there.geometry, 256);
      const auto expect_same = [&](const char* name, frame::SurfaceShadow& of_path,
                                   frame::SurfaceShadow&& of_moved) {
        const frame::FrameImages moved = render(frame, view, of_path),
                                 other = render(of_file, resting, of_moved);
        EXPECT_TRUE(moved.distance == other.distance) << name << ", frame " << i;
        EXPECT_TRUE(moved.visibility == other.visibility) << name << ", frame " << i;
        EXPECT_TRUE(moved.radiance == other.radiance) << name << ", frame " << i;
        return moved.visibility.at(0);
      };
      const std::vector<float> exact = expect_same("brute", brute, Brute({}));
      EXPECT_TRUE(expect_same("metric-tree", tree, MetricTree({})) == exact) << i;
      EXPECT_TRUE(expect_same("psv", psv, Psv({})) == exact) << i;
      expect_same("metric-tree, culled", culled, Brute({.cull = Culling::automatic}));
      expect_same("shadow-map", map, ShadowMapLookup());
      EXPECT_FALSE(exact == before) << "it moves";
      before = exact;

      // The truth, too.
      const auto judge = quality::parse_surfaces("reference")[0];
      quality::SharedReference of_path(scene.geometry, view, {}), of_moved(there.geometry, resting, {});
      const auto by_path = judge.make(tests::gpu_context(), of_path),
                 by_moved = judge.make(tests::gpu_context(), of_moved);
      EXPECT_TRUE(render(frame, view, *by_path).visibility == render(of_file, resting, *by_moved).visibility)
          << i;
      EXPECT_TRUE(of_path.distance() == of_moved.distance()) << i;
      EXPECT_TRUE(of_path.exact(0, 1).radiance == of_moved.exact(0, 1).radiance) << i;
    }
  }
}

/// Where the file places its nodes elsewhere than at the origin, their vertices at rest are rounded, and once
/// more where they are moved to: the moved file's differ. All methods see the same ones.
TEST_F(Motion, OfPlacedNodesIsTheSameToAllMethods) {
  json document = model();
  document["nodes"][1]["translation"] = {0.1, 0.3, 0.7};
  document["nodes"][1]["rotation"] = {0.64, 0.48, 0, 0.6};
  document["nodes"][2]["translation"] = {0.2, 0.6, 0.1};
  document["nodes"][2]["scale"] = {1.1, 0.9, 1.3};
  const scene::Scene scene = load(document);
  const scene::Path path = this->path(scene, tests::view_of_soup(k_lamp));
  frame::Frame frame(tests::gpu_context(), scene.geometry, 16);
  MetricTree tree({}), small({.cluster = 3}), culled({.cull = Culling::automatic});
  Psv psv({});
  Brute brute({}), culled_brute({.cull = Culling::automatic});
  for (const scene::View& view : path.views) {
    const auto by = [&](frame::SurfaceShadow& method) {
      return render(frame, view, method).visibility.at(0);
    };
    const std::vector<float> exact = by(brute);
    EXPECT_TRUE(by(tree) == exact);
    EXPECT_TRUE(by(small) == exact);
    EXPECT_TRUE(by(psv) == exact);
    EXPECT_TRUE(by(culled) == by(culled_brute));
    const auto judge = quality::parse_surfaces("reference")[0];
    quality::SharedReference reference(scene.geometry, view, {});
    const auto judged = by(*judge.make(tests::gpu_context(), reference));
    std::size_t different = 0;
    for (std::size_t i = 0; i < judged.size(); ++i) different += judged[i] != exact[i] ? 1 : 0;
    EXPECT_LE(different, 2u) << "undecided pixels: at the edge of a shadow, to the points' own rounding";
  }
}

/// The stages of a frame, and their times.
std::map<std::string, double> stages(frame::Frame& frame, const scene::View& view,
                                     frame::SurfaceShadow& method) {
  frame::NoAirlight no_airlight;
  gpu::StageTimer timer(&tests::gpu_context());
  frame.render(view, method, no_airlight, timer);
  return timer.milliseconds();
}

TEST_F(Motion, DoesNotGroupTrianglesAnew) {
  const scene::Scene scene = load(model());
  const scene::Path path = this->path(scene, tests::view_of_soup(k_lamp));
  frame::Frame frame(tests::gpu_context(), scene.geometry, 16);
  for (const Culling cull : {Culling::none, Culling::automatic}) {
    MetricTree tree({.cull = cull});
    EXPECT_TRUE(stages(frame, path.views[0], tree).contains("triangle_clusters"));
    for (const std::size_t i : {1u, 2u, 2u, 0u}) {
      const std::map<std::string, double> times = stages(frame, path.views[i], tree);
      EXPECT_FALSE(times.contains("triangle_clusters")) << i;
      EXPECT_TRUE(times.contains("surface_build")) << i;
    }
    EXPECT_TRUE(stages(frame, path.views[1], tree).contains("pose"));
    EXPECT_FALSE(stages(frame, path.views[1], tree).contains("pose")) << "it is there";
    scene::View resting = path.views[0];
    resting.pose = {};
    EXPECT_TRUE(stages(frame, resting, tree).contains("triangle_clusters")) << "of other objects";
  }
}

/// Two boxes that share a side are one part while they do: then none of that side's two sheets counts.
TEST_F(Motion, GroupsAnewWhereCulledPartsCome) {
  json document = model();
  scene::Geometry beside;
  tests::add_box(beside, {2.5f, -1.5f, 0}, {3.5f, -0.5f, 1});
  document["nodes"].push_back({{"name", "beside"}, {"mesh", add_mesh(document, beside)}});
  document["scenes"][0]["nodes"].push_back(4);
  const scene::Scene scene = load(document);
  const scene::Path path = scene::load_path(
      write("path.toml",
            "frames = 3\nseconds = 2\n[[node]]\nname = 'beside'\ntime = 0\n[[node]]\nname = 'beside'\ntime = "
            "1\n"
            "translation = [0.5, 0, 0]\n[[node]]\nname = 'beside'\ntime = 2\ntranslation = [0, 0, 0]\n"),
      tests::view_of_soup(k_lamp), &scene);
  frame::Frame frame(tests::gpu_context(), scene.geometry, 16);
  MetricTree tree({.cull = Culling::automatic});
  Brute brute({.cull = Culling::automatic});
  bool is_grouped_anew = false;
  for (const scene::View& view : path.views) {
    EXPECT_TRUE(render(frame, view, tree).visibility == render(frame, view, brute).visibility);
    MetricTree other({.cull = Culling::automatic});
    EXPECT_TRUE(render(frame, view, other).visibility == render(frame, view, brute).visibility);
  }
  for (const std::size_t i : {1u, 2u})
    is_grouped_anew = stages(frame, path.views[i], tree).contains("triangle_clusters") || is_grouped_anew;
  EXPECT_TRUE(is_grouped_anew);
}

}  // namespace
}  // namespace airlight::surface_shadows
