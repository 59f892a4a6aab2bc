#include "reference/visibility.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <embree3/rtcore.h>

#include "reference/embree.h"

namespace airlight::reference {

namespace {

/// How far single precision may move a surface, relative to the lengths involved.
constexpr double k_rounding = 1e-6;

/// Width of a packet in lanes, its Embree type and calls.
struct Packet8 {
  static constexpr int k_width = 8;
  using Ray = RTCRay8;
  static void occluded(const int* valid, RTCScene scene, RTCIntersectContext* context, Ray* ray) {
    rtcOccluded8(valid, scene, context, ray);
  }
};
struct Packet16 {
  static constexpr int k_width = 16;
  using Ray = RTCRay16;
  static void occluded(const int* valid, RTCScene scene, RTCIntersectContext* context, Ray* ray) {
    rtcOccluded16(valid, scene, context, ray);
  }
};

}  // namespace

struct Visibility::Embree {
  EmbreeDevice device;
  RTCScene scene = nullptr;
  const Triangles& triangles;
  glm::dvec3 origin;              ///< of all that follows, world space [m]
  glm::dvec3 eye;                 ///< [m]
  std::optional<glm::dvec3> sun;  ///< unit direction to it; without, the light is at the origin
  std::vector<bool> edge_on;      ///< to the light, one a triangle; empty where none is
  std::vector<bool> holding_eye;
  bool wide;  ///< packets of 16 are native

  Embree(const Triangles& of, const glm::dvec3& around, const glm::dvec3& eye_position,
         const std::optional<glm::dvec3>& direction)
      : scene(rtcNewScene(device.get())),
        triangles(of),
        origin(around),
        eye(eye_position - around),
        sun(direction),
        edge_on(sun ? of.along(*sun, origin) : of.holding(origin)),
        holding_eye(of.holding(eye_position)),
        wide(rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0) {
    device.check();
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;
  ~Embree() { rtcReleaseScene(scene); }

  /// The corners of a triangle in full precision [m].
  Corners corners(std::uint32_t triangle) const { return triangles.around(origin, triangle); }

  void attach_triangles();

  struct SurfaceContext;
  static void reject_coplanar(const RTCFilterFunctionNArguments* arguments);
  static void reject_edge_on(const RTCFilterFunctionNArguments* arguments);
  static void reject_holding_eye(const RTCFilterFunctionNArguments* arguments);
  void reject(const RTCFilterFunctionNArguments* arguments, const std::vector<bool>& rejected) const;

  template <class Packet, class Rays>
  std::uint32_t lit_packets(const Rays& rays, int count) const;
  template <class Rays>
  std::uint32_t lit_single(const Rays& rays, int count) const;
  template <class Rays>
  std::uint32_t lit(const Rays& rays, int count, RayMode mode) const;
};

/// What the filter of a surface's light ray needs beside Embree's context, which comes first.
struct Visibility::Embree::SurfaceContext {
  RTCIntersectContext context;
  const Embree* embree;
  glm::dvec3 point;
  double clearance;  ///< [m]
};

/// Rejects an occluder in whose plane the shadowed point lies.
void Visibility::Embree::reject_coplanar(const RTCFilterFunctionNArguments* arguments) {
  assert(arguments->N == 1);
  const auto& surface = *reinterpret_cast<const SurfaceContext*>(arguments->context);
  const Corners corners = surface.embree->corners(RTCHitN_primID(arguments->hit, 1, 0));
  const glm::dvec3 n = normal(corners);
  const glm::dvec3 to_point = surface.point - corners[0];
  // The triangle is rounded: its plane is the less certain the farther its corners are from the point.
  const double clearance = surface.clearance + k_rounding * glm::length(to_point);
  if (std::abs(glm::dot(n, to_point)) <= clearance * glm::length(n)) arguments->valid[0] = 0;
}

/// @param rejected one flag a triangle; empty where none is
void Visibility::Embree::reject(const RTCFilterFunctionNArguments* arguments,
                                const std::vector<bool>& rejected) const {
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned triangle = RTCHitN_primID(arguments->hit, n, i);
    bool is_rejected = !rejected.empty() && rejected[triangle];
    if (!is_rejected && triangles.cut_outs.has(triangle)) {
      const double v = static_cast<double>(RTCHitN_u(arguments->hit, n, i)),
                   w = static_cast<double>(RTCHitN_v(arguments->hit, n, i));
      is_rejected = !triangles.cut_outs.is_there(triangle, {1.0 - v - w, v, w});
    }
    if (is_rejected) arguments->valid[i] = 0;
  }
}

void Visibility::Embree::reject_edge_on(const RTCFilterFunctionNArguments* arguments) {
  const auto* embree = static_cast<const Embree*>(arguments->geometryUserPtr);
  embree->reject(arguments, embree->edge_on);
}

void Visibility::Embree::reject_holding_eye(const RTCFilterFunctionNArguments* arguments) {
  const auto* embree = static_cast<const Embree*>(arguments->geometryUserPtr);
  embree->reject(arguments, embree->holding_eye);
}

void Visibility::Embree::attach_triangles() {
  const RTCGeometry mesh = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  device.check();
  rtcAttachGeometry(scene, mesh);
  rtcReleaseGeometry(mesh);  // the scene keeps it
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), triangles.positions.size()));
  device.check();
  for (std::size_t i = 0; i < triangles.positions.size(); ++i) {
    const glm::vec3 relative(glm::dvec3(triangles.positions[i]) - origin);
    for (int axis = 0; axis < 3; ++axis) positions[3 * i + static_cast<std::size_t>(axis)] = relative[axis];
  }
  rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.indices.data(), 0,
                             sizeof(glm::uvec3), triangles.count());
  rtcSetGeometryUserData(mesh, this);
  const bool has_cut_outs = !triangles.cut_outs.empty();
  if (has_cut_outs || !edge_on.empty()) rtcSetGeometryOccludedFilterFunction(mesh, reject_edge_on);
  if (has_cut_outs || !holding_eye.empty()) rtcSetGeometryIntersectFilterFunction(mesh, reject_holding_eye);
  rtcCommitGeometry(mesh);
}

Visibility::Visibility(const Triangles& triangles, const glm::dvec3& origin, const glm::dvec3& eye,
                       const std::optional<glm::dvec3>& sun)
    : embree_(std::make_unique<Embree>(triangles, origin, eye, sun)) {
  const RTCScene scene = embree_->scene;
  rtcSetSceneFlags(
      scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  if (triangles.count() > 0) embree_->attach_triangles();
  rtcCommitScene(scene);
  embree_->device.check();
}

Visibility::~Visibility() = default;
Visibility::Visibility(Visibility&&) noexcept = default;
Visibility& Visibility::operator=(Visibility&&) noexcept = default;

Visibility::Hit Visibility::first_hit(const glm::dvec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const glm::vec3 origin(embree_->eye), along(direction);
  RTCRayHit ray{};
  ray.ray.org_x = origin.x;
  ray.ray.org_y = origin.y;
  ray.ray.org_z = origin.z;
  ray.ray.dir_x = along.x;
  ray.ray.dir_y = along.y;
  ray.ray.dir_z = along.z;
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {0.0, 0};

  // The plane of the triangle, met in double precision: single precision leaves the hit off its surface.
  // Edge-on, where the plane says little, Embree's own distance is kept.
  const Corners corners = embree_->corners(ray.hit.primID);
  const glm::dvec3 n = normal(corners);
  const double single = static_cast<double>(ray.ray.tfar);
  const double exact = glm::dot(n, corners[0] - embree_->eye) / glm::dot(n, direction);
  const double uncertainty = 1e-3 * single + k_rounding * glm::length(embree_->eye);
  const bool agrees = exact > 0.0 && std::abs(exact - single) <= uncertainty;
  return {agrees ? exact : single, ray.hit.primID};
}

bool Visibility::surface_lit(const Hit& hit, const glm::dvec3& direction, const glm::dvec3& towards) const {
  const glm::dvec3 point = embree_->eye + hit.distance * direction;
  const bool sun = embree_->sun.has_value();
  const double length = sun ? 0.0 : glm::length(point);  // of the light ray where that ends
  if (!sun && length == 0.0) return true;

  const Corners corners = embree_->corners(hit.triangle);
  const glm::dvec3 n = normal(corners);
  const double light_height = glm::dot(n, sun ? towards : -corners[0]),
               eye_height = glm::dot(n, embree_->eye - corners[0]);
  const bool is_between = light_height * eye_height < 0.0;
  const double clearance = k_rounding * (length + hit.distance);
  if (is_between && std::abs(light_height) > glm::length(n) * (sun ? k_rounding : clearance)) return false;

  Embree::SurfaceContext surface{};
  rtcInitIntersectContext(&surface.context);
  surface.context.filter = Embree::reject_coplanar;
  surface.embree = embree_.get();
  surface.point = point;
  surface.clearance = clearance;
  const glm::vec3 from(sun ? point : glm::dvec3(0.0)), along(sun ? towards : point / length);
  RTCRay ray{};
  ray.org_x = from.x;
  ray.org_y = from.y;
  ray.org_z = from.z;
  ray.dir_x = along.x;
  ray.dir_y = along.y;
  ray.dir_z = along.z;
  ray.tfar = sun ? std::numeric_limits<float>::infinity() : static_cast<float>(length);
  ray.mask = ~0u;
  rtcOccluded1(embree_->scene, &surface.context, &ray);
  return ray.tfar >= 0.0f;
}

namespace {

/// Sets a ray, or one of a packet through a function that picks its member's lane.
template <class Ray, class Lane>
void set_ray(Ray& ray, const Lane& lane, const LightRays& rays, int i, const glm::vec3&) {
  lane(ray.dir_x) = rays.direction_x[i];
  lane(ray.dir_y) = rays.direction_y[i];
  lane(ray.dir_z) = rays.direction_z[i];
  lane(ray.tfar) = rays.length[i];
}

template <class Ray, class Lane>
void set_ray(Ray& ray, const Lane& lane, const SunwardRays& rays, int i, const glm::vec3& sun) {
  lane(ray.org_x) = rays.origin_x[i];
  lane(ray.org_y) = rays.origin_y[i];
  lane(ray.org_z) = rays.origin_z[i];
  lane(ray.dir_x) = sun.x;
  lane(ray.dir_y) = sun.y;
  lane(ray.dir_z) = sun.z;
  lane(ray.tfar) = std::numeric_limits<float>::infinity();
}

}  // namespace

template <class Packet, class Rays>
std::uint32_t Visibility::Embree::lit_packets(const Rays& rays, int count) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const glm::vec3 towards(sun.value_or(glm::dvec3(0.0)));
  typename Packet::Ray packet{};
  alignas(64) int valid[Packet::k_width];
  std::uint32_t lit = 0;
  for (int first = 0; first < count; first += Packet::k_width) {
    for (int lane = 0; lane < Packet::k_width; ++lane) {
      set_ray(
          packet, [lane](float* member) -> float& { return member[lane]; }, rays, first + lane, towards);
      packet.mask[lane] = ~0u;
      valid[lane] = first + lane < count ? -1 : 0;
    }
    Packet::occluded(valid, scene, &context, &packet);
    for (int lane = 0; lane < Packet::k_width; ++lane) {
      lit |= static_cast<std::uint32_t>(valid[lane] != 0 && packet.tfar[lane] >= 0.0f) << (first + lane);
    }
  }
  return lit;
}

template <class Rays>
std::uint32_t Visibility::Embree::lit_single(const Rays& rays, int count) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const glm::vec3 towards(sun.value_or(glm::dvec3(0.0)));
  std::uint32_t lit = 0;
  RTCRay ray{};
  ray.mask = ~0u;
  for (int i = 0; i < count; ++i) {
    set_ray(
        ray, [](float& member) -> float& { return member; }, rays, i, towards);
    rtcOccluded1(scene, &context, &ray);
    lit |= static_cast<std::uint32_t>(ray.tfar >= 0.0f) << i;
  }
  return lit;
}

template <class Rays>
std::uint32_t Visibility::Embree::lit(const Rays& rays, int count, RayMode mode) const {
  assert(0 <= count && count <= Rays::k_count);
  if (mode == RayMode::single) return lit_single(rays, count);
  return wide ? lit_packets<Packet16>(rays, count) : lit_packets<Packet8>(rays, count);
}

std::uint32_t Visibility::lit(const LightRays& rays, int count, RayMode mode) const {
  assert(!embree_->sun);
  return embree_->lit(rays, count, mode);
}

std::uint32_t Visibility::lit(const SunwardRays& rays, int count, RayMode mode) const {
  assert(embree_->sun);
  return embree_->lit(rays, count, mode);
}

}  // namespace airlight::reference
