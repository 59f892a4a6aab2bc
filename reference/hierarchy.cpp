#include "reference/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "reference/embree.h"

namespace airlight::reference {

namespace {

constexpr unsigned k_children = 4;
constexpr unsigned k_leaf_size = 8;

/// Either a leaf, which lists triangles, or an inner node, which holds the boxes of its children.
struct Node {
  std::uint32_t leaf_count = 0;  ///< triangles of a leaf; 0 of an inner node
};

struct Leaf : Node {
  std::uint32_t triangles[k_leaf_size];
};

struct Inner : Node {
  Node* children[k_children] = {};
  RTCBounds boxes[k_children];
  unsigned child_count = 0;
};

float below(double value) {
  return std::nextafter(static_cast<float>(value), -std::numeric_limits<float>::infinity());
}
float above(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

RTCBuildPrimitive primitive(const Corners& c, std::uint32_t triangle) {
  const glm::dvec3 lower = glm::min(glm::min(c[0], c[1]), c[2]), upper = glm::max(glm::max(c[0], c[1]), c[2]);
  return {.lower_x = below(lower.x),
          .lower_y = below(lower.y),
          .lower_z = below(lower.z),
          .geomID = 0,
          .upper_x = above(upper.x),
          .upper_y = above(upper.y),
          .upper_z = above(upper.z),
          .primID = triangle};
}

void* make_inner(RTCThreadLocalAllocator allocator, unsigned child_count, void*) {
  auto* inner = new (rtcThreadLocalAlloc(allocator, sizeof(Inner), alignof(Inner))) Inner;
  inner->child_count = child_count;
  return static_cast<Node*>(inner);
}

void set_children(void* node, void** children, unsigned count, void*) {
  auto* inner = static_cast<Inner*>(static_cast<Node*>(node));
  for (unsigned i = 0; i < count; ++i) inner->children[i] = static_cast<Node*>(children[i]);
}

void set_boxes(void* node, const RTCBounds** boxes, unsigned count, void*) {
  auto* inner = static_cast<Inner*>(static_cast<Node*>(node));
  for (unsigned i = 0; i < count; ++i) inner->boxes[i] = *boxes[i];
}

void* make_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count,
                void*) {
  auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(Leaf), alignof(Leaf))) Leaf;
  leaf->leaf_count = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) leaf->triangles[i] = primitives[i].primID;
  return static_cast<Node*>(leaf);
}

bool reaches(const Region& region, const RTCBounds& b) {
  const glm::dvec3 lower(b.lower_x, b.lower_y, b.lower_z), upper(b.upper_x, b.upper_y, b.upper_z);
  if (lower.x > region.box.upper.x || upper.x < region.box.lower.x || lower.y > region.box.upper.y ||
      upper.y < region.box.lower.y || lower.z > region.box.upper.z || upper.z < region.box.lower.z)
    return false;
  for (int i = 0; i < region.count; ++i) {
    const HalfSpace& half_space = region.half_spaces[i];
    const glm::dvec3 innermost(half_space.inward.x > 0.0 ? upper.x : lower.x,
                               half_space.inward.y > 0.0 ? upper.y : lower.y,
                               half_space.inward.z > 0.0 ? upper.z : lower.z);
    if (glm::dot(half_space.inward, innermost - half_space.origin) < 0.0) return false;
  }
  return true;
}

}  // namespace

struct Hierarchy::Tree {
  EmbreeDevice device;
  RTCBVH bvh = nullptr;
  const Node* root = nullptr;

  Tree() : bvh(rtcNewBVH(device.get())) { device.check(); }
  ~Tree() { rtcReleaseBVH(bvh); }
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
};

Hierarchy::Hierarchy(const Triangles& triangles, const glm::dvec3& origin) : tree_(std::make_unique<Tree>()) {
  if (triangles.count() == 0) return;
  std::vector<RTCBuildPrimitive> primitives(triangles.count());
  for (std::uint32_t i = 0; i < triangles.count(); ++i)
    primitives[i] = primitive(triangles.around(origin, i), i);

  RTCBuildArguments build = rtcDefaultBuildArguments();
  build.maxBranchingFactor = k_children;
  build.minLeafSize = 1;
  build.maxLeafSize = k_leaf_size;
  build.bvh = tree_->bvh;
  build.primitives = primitives.data();
  build.primitiveCount = build.primitiveArrayCapacity = primitives.size();
  build.createNode = make_inner;
  build.setNodeChildren = set_children;
  build.setNodeBounds = set_boxes;
  build.createLeaf = make_leaf;
  tree_->root = static_cast<const Node*>(rtcBuildBVH(&build));
  tree_->device.check();
}

Hierarchy::~Hierarchy() = default;
Hierarchy::Hierarchy(Hierarchy&&) noexcept = default;
Hierarchy& Hierarchy::operator=(Hierarchy&&) noexcept = default;

void Hierarchy::find(const Region& region, std::vector<std::uint32_t>& found) const {
  found.clear();
  if (!tree_->root) return;
  std::vector<const Node*> open = {tree_->root};
  while (!open.empty()) {
    const Node* node = open.back();
    open.pop_back();
    if (node->leaf_count > 0) {
      const auto& leaf = static_cast<const Leaf&>(*node);
      found.insert(found.end(), leaf.triangles, leaf.triangles + leaf.leaf_count);
      continue;
    }
    const auto& inner = static_cast<const Inner&>(*node);
    for (unsigned i = 0; i < inner.child_count; ++i) {
      if (reaches(region, inner.boxes[i])) open.push_back(inner.children[i]);
    }
  }
}

}  // namespace airlight::reference
