#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "scene/builtin_internal.h"
#include "scene/view_fields.h"

// A wood in leaf, seen along a path that leads towards a low sun.
//
// Ground, trunks and branches are closed solids; leaves and ferns are open.

namespace airlight::scene {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_side = 32.0, k_far = -56.0;  // how far trees stand [m]
constexpr double k_path = 1.7;                  // half the width of the path [m]

/// Middle of the path, which bends to the right among the trees [m].
double path_at(double z) {
  const double far = std::max(-4.0 - z, 0.0);
  return 0.9 * std::sin(0.2 * z) + 0.011 * far * far;
}

/// Height of the ground [m].
double ground(double x, double z) {
  const double bank = std::min(std::abs(x - path_at(z)) / 12.0, 1.0);
  return 0.9 * bank * bank + 0.35 * std::sin(0.21 * x + 0.6) * std::sin(0.17 * z) +
         0.09 * std::sin(0.83 * x + 0.31 * z) + 0.06 * std::sin(1.37 * z - 0.9 * x);
}

struct Tree {
  glm::dvec2 foot;       ///< x and z [m]
  double height, girth;  ///< [m]; girth is the trunk's radius
  double lowest;         ///< where branches begin, as a part of the height
  int sprays;            ///< of leaves, on each branch
  double leaf;           ///< length of a leaf [m]
};

class Grower {
 public:
  explicit Grower(Geometry& geometry) : model_(geometry) {}

  void grow_ground();
  void grow_tree(const Tree& tree);
  void grow_ferns(int count);
  void lay_litter(int leaves);

  double between(double a, double b) { return random_.between(a, b); }

 private:
  glm::dvec3 direction() {
    for (;;) {
      const double x = between(-1.0, 1.0), y = between(-1.0, 1.0);
      const glm::dvec3 v(x, y, between(-1.0, 1.0));
      const double length = glm::length(v);
      if (length > 0.1 && length <= 1.0) return v / length;
    }
  }
  /// Two triangles that meet in the leaf's rib, a little folded.
  void leaf(glm::dvec3 stalk, glm::dvec3 along, glm::dvec3 up, double length);
  void grow_fern(glm::dvec2 foot, double reach);
  /// A branch and what grows on it.
  void grow_branch(glm::dvec3 from, glm::dvec3 towards, double length, double girth, const Tree& tree);

  Modeller model_;
  Random random_{7};
};

void Grower::leaf(glm::dvec3 stalk, glm::dvec3 along, glm::dvec3 up, double length) {
  const glm::dvec3 across = glm::normalize(glm::cross(along, up));
  const glm::dvec3 middle = stalk + 0.45 * length * along, fold = 0.08 * length * glm::cross(across, along);
  const std::uint32_t a = model_.vertex(stalk), b = model_.vertex(stalk + length * along);
  model_.triangle(a, model_.vertex(middle + 0.3 * length * across + fold), b);
  model_.triangle(a, b, model_.vertex(middle - 0.3 * length * across + fold));
}

void Grower::grow_ground() {
  std::vector<double> x, z;
  for (double at = -36.0; at <= 36.0; at += 0.8) x.push_back(at);
  for (double at = -66.0; at <= 14.0; at += 0.8) z.push_back(at);
  model_.paint({0.11f, 0.095f, 0.045f});
  model_.slab(x, z, -4.0, [&](double u, double v) { return ground(u, v) + between(-0.03, 0.03); });
}

void Grower::grow_branch(glm::dvec3 from, glm::dvec3 towards, double length, double girth, const Tree& tree) {
  constexpr int k_pieces = 4;
  std::array<glm::dvec4, k_pieces + 1> path;
  glm::dvec3 at = from, way = towards;
  for (int i = 0; i <= k_pieces; ++i) {
    path[static_cast<std::size_t>(i)] = {at, girth * (1.0 - 0.8 * i / k_pieces)};
    way = glm::normalize(way + 0.25 * direction() + glm::dvec3(0.0, 0.06, 0.0));
    at += length / k_pieces * way;
  }
  model_.rod(path, 5);
  // Leaves grow in sprays about the outer part.
  constexpr int k_spray = 16;
  for (int spray = 0; spray < tree.sprays; ++spray) {
    const double along = k_pieces * between(0.35, 1.0);
    const auto piece = static_cast<std::size_t>(std::min(along, k_pieces - 1.0));
    const glm::dvec3 twig =
        glm::mix(glm::dvec3(path[piece]), glm::dvec3(path[piece + 1]), along - static_cast<double>(piece));
    glm::dvec3 out = direction();
    out.y *= 0.4;
    out = glm::normalize(out);
    const double reach = tree.leaf * between(2.0, 5.5);
    for (int i = 0; i < k_spray; ++i) {
      const double part = (i + 1.0) / k_spray;
      const glm::dvec3 stalk = twig + reach * part * out + 0.7 * tree.leaf * direction();
      const glm::dvec3 along_leaf = glm::normalize(out + 0.9 * direction() - glm::dvec3(0.0, 0.25, 0.0));
      const double size = tree.leaf * between(0.75, 1.25);
      leaf(stalk, along_leaf, glm::normalize(glm::dvec3(0.0, 1.0, 0.0) + 0.6 * direction()), size);
    }
  }
}

void Grower::grow_tree(const Tree& tree) {
  constexpr std::array<glm::vec3, 3> k_barks = {
      {{0.13f, 0.1f, 0.075f}, {0.17f, 0.145f, 0.115f}, {0.1f, 0.085f, 0.06f}}};
  constexpr std::array<glm::vec3, 4> k_greens = {
      {{0.11f, 0.2f, 0.03f}, {0.16f, 0.25f, 0.04f}, {0.09f, 0.17f, 0.035f}, {0.24f, 0.26f, 0.05f}}};
  model_.paint(k_barks[static_cast<std::size_t>(between(0.0, k_barks.size()))]);
  constexpr int k_pieces = 9;
  std::array<glm::dvec4, k_pieces + 1> trunk;
  glm::dvec3 at(tree.foot.x, ground(tree.foot.x, tree.foot.y) - 0.2, tree.foot.y), way(0.0, 1.0, 0.0);
  for (int i = 0; i <= k_pieces; ++i) {
    const double part = static_cast<double>(i) / k_pieces;
    const double flare = i == 0 ? 1.5 : i == 1 ? 1.0 : 0.95;
    trunk[static_cast<std::size_t>(i)] = {at, tree.girth * flare * (1.0 - 0.85 * part)};
    way = glm::normalize(way + 0.07 * direction() + glm::dvec3(0.0, 0.1, 0.0));
    at += (i == 0 ? 0.4 : (tree.height - 0.4) / (k_pieces - 1)) * way;
  }
  model_.rod(trunk, 12);

  constexpr int k_branches = 13;
  const double turn = between(0.0, 2.0 * k_pi);
  std::vector<std::array<glm::dvec3, 2>> roots;
  for (int i = 0; i < k_branches; ++i) {
    const double part = tree.lowest + (0.98 - tree.lowest) * i / (k_branches - 1.0), along = k_pieces * part;
    const auto piece = static_cast<std::size_t>(std::min(along, k_pieces - 1.0));
    const glm::dvec3 from =
        glm::mix(glm::dvec3(trunk[piece]), glm::dvec3(trunk[piece + 1]), along - static_cast<double>(piece));
    const double angle = turn + 2.4 * i, rise = 0.25 + 0.8 * part * part;
    roots.push_back({from, glm::normalize(glm::dvec3(std::cos(angle), rise, std::sin(angle)))});
  }
  model_.paint(k_greens[static_cast<std::size_t>(between(0.0, k_greens.size()))]);
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(roots.size());
    const double length = tree.height * (0.1 + 0.16 * std::sin(k_pi * (0.15 + 0.8 * part)));
    grow_branch(roots[i][0], roots[i][1], length, tree.girth * (0.26 - 0.14 * part), tree);
  }
}

void Grower::grow_fern(glm::dvec2 foot, double reach) {
  const glm::dvec3 root(foot.x, ground(foot.x, foot.y) - 0.02, foot.y);
  const int fronds = 7 + static_cast<int>(between(0.0, 4.0));
  const double turn = between(0.0, 2.0 * k_pi);
  for (int f = 0; f < fronds; ++f) {
    const double angle = turn + 2.0 * k_pi * (f + between(-0.3, 0.3)) / fronds,
                 size = reach * between(0.7, 1.1);
    const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle)), across(-out.z, 0.0, out.x);
    // A frond rises, then bows.
    const auto spine = [&](double s) {
      return root + size * (s * out + glm::dvec3(0.0, 1.3 * s - 1.05 * s * s, 0.0));
    };
    constexpr int k_pairs = 14;
    for (int i = 1; i <= k_pairs; ++i) {
      const double s = static_cast<double>(i) / k_pairs, before = s - 0.8 / k_pairs;
      const double width = size * 0.3 * std::sin(k_pi * (0.12 + 0.86 * s));
      const std::uint32_t a = model_.vertex(spine(before)), b = model_.vertex(spine(s));
      for (double hand : {1.0, -1.0}) {
        const std::uint32_t tip =
            model_.vertex(spine(s) + hand * width * across + glm::dvec3(0.0, -0.25 * width, 0.0));
        hand > 0.0 ? model_.triangle(a, b, tip) : model_.triangle(a, tip, b);
      }
    }
  }
}

void Grower::grow_ferns(int count) {
  model_.paint({0.16f, 0.28f, 0.05f});
  for (int i = 0; i < count; ++i) {
    const double part = between(0.0, 1.0), z = 7.4 - 34.0 * part * part;
    const double aside = k_path * 0.8 + (2.5 + 8.0 * part) * between(0.0, 1.0);
    const double reach = between(0.5, 1.0), hand = between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    grow_fern({path_at(z) + hand * aside, z}, reach);
  }
}

void Grower::lay_litter(int leaves) {
  constexpr std::array<glm::vec3, 4> k_browns = {
      {{0.24f, 0.13f, 0.05f}, {0.3f, 0.19f, 0.07f}, {0.17f, 0.1f, 0.05f}, {0.13f, 0.13f, 0.05f}}};
  for (const glm::vec3& brown : k_browns) {
    model_.paint(brown);
    for (std::size_t i = 0; i < static_cast<std::size_t>(leaves) / k_browns.size(); ++i) {
      // Denser where the beholder stands.
      const double part = between(0.0, 1.0), z = 12.0 - 40.0 * part * part;
      const double x = path_at(z) + (4.0 + 14.0 * part) * between(-1.0, 1.0);
      glm::dvec3 along = direction();
      along.y *= 0.3;
      const double length = between(0.07, 0.14);
      leaf({x, ground(x, z) + 0.03, z}, glm::normalize(along),
           glm::normalize(glm::dvec3(0.0, 1.0, 0.0) + 0.5 * direction()), length);
    }
  }
}

}  // namespace

Scene make_forest() {
  Scene scene;
  scene.name = "forest";
  Grower grower(scene.geometry);
  grower.grow_ground();

  // Two trees frame the view; the others stand one in each cell of a grid, off the path, and saplings among
  // them.
  grower.grow_tree({{-3.3, 4.4}, 19.0, 0.42, 0.3, 9, 0.19});
  grower.grow_tree({{5.0, 1.2}, 18.0, 0.34, 0.3, 9, 0.19});
  const auto plant = [&](double cell, bool is_sapling) {
    for (double z = 2.0; z > k_far; z -= cell) {
      for (double x = -k_side; x < k_side; x += cell) {
        const double foot_z = z - cell * grower.between(0.1, 0.9);
        const glm::dvec2 foot(x + cell * grower.between(0.1, 0.9), foot_z);
        const double size = grower.between(0.0, 1.0), far = std::clamp(-foot.y / 60.0, 0.0, 1.0);
        // In what is seen.
        if (std::abs(foot.x) > 12.0 - 0.6 * foot.y) continue;
        if (std::abs(foot.x - path_at(foot.y)) < k_path + 0.4) continue;
        if (is_sapling)
          grower.grow_tree({foot, 2.5 + 3.5 * size, 0.03 + 0.03 * size, 0.2, 1, 0.15 + 0.15 * far});
        else
          grower.grow_tree({foot, 14.0 + 7.0 * size, 0.2 + 0.18 * size, 0.24 + 0.12 * size,
                            far < 0.45 ? 8 : 5, 0.22 + 0.13 * far});
      }
    }
  };
  plant(6.2, false);
  plant(6.8, true);

  grower.lay_litter(14000);
  grower.grow_ferns(300);

  scene.cameras.push_back({"path", {0.5, 1.5, 9.5}, {-0.3, 3.0, -8.0}, {0.0, 1.0, 0.0}, 58.0});
  scene.lights.push_back(
      sun("sun", direction_of_angles({187.0, 17.0}), glm::vec3(1.0f, 0.76f, 0.42f) * 10.0f));
  scene.medium.sigma_s = glm::vec3(0.02f);
  scene.medium.phase = PhaseFunction::henyey_greenstein;
  scene.medium.g = 0.45f;
  scene.exposure = 0.9f;
  return scene;
}

}  // namespace airlight::scene
