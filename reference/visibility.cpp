#include "reference/visibility.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "scene/error.h"

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

[[noreturn]] void fail(const std::string& problem) {
  throw scene::Error(scene::ExitCode::driver, "Embree", problem, "give it more memory or a smaller scene");
}

}  // namespace

struct Visibility::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::string error;                         ///< Embree's last message
  std::vector<glm::vec3> positions;          ///< world space, before any rounding [m]
  const std::uint32_t* triangles = nullptr;  ///< three indices each, in Embree's memory
  glm::dvec3 light{0.0};                     ///< world space [m]
  glm::dvec3 eye{0.0};                       ///< relative to the light [m]
  float nearest = 0.0f;                      ///< where light rays begin [m]
  bool wide = false;                         ///< packets of 16 are native

  Embree() = default;
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;
  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void check() const {
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) fail(error);
  }

  /// A corner of a triangle relative to the light, in full precision [m].
  glm::dvec3 corner(std::uint32_t triangle, std::size_t corner_index) const {
    return glm::dvec3(positions[triangles[3 * std::size_t{triangle} + corner_index]]) - light;
  }
  /// Normal of a triangle, as long as twice its area.
  glm::dvec3 normal(std::uint32_t triangle) const {
    const glm::dvec3 a = corner(triangle, 0);
    return glm::cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
  }

  struct SurfaceContext;
  static void reject_coplanar(const RTCFilterFunctionNArguments* arguments);

  template <class Packet>
  std::uint32_t lit_packets(const LightRays& rays, int count) const;
  std::uint32_t lit_single(const LightRays& rays, int count) const;
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
  const std::uint32_t triangle = RTCHitN_primID(arguments->hit, 1, 0);
  const glm::dvec3 normal = surface.embree->normal(triangle);
  const glm::dvec3 to_point = surface.point - surface.embree->corner(triangle, 0);
  // The triangle is rounded: its plane is the less certain the farther its corners are from the point.
  const double clearance = surface.clearance + k_rounding * glm::length(to_point);
  if (std::abs(glm::dot(normal, to_point)) <= clearance * glm::length(normal)) arguments->valid[0] = 0;
}

Visibility::Visibility(const scene::Geometry& geometry, const glm::dvec3& light, const glm::dvec3& eye)
    : embree_(std::make_unique<Embree>()) {
  Embree& embree = *embree_;
  embree.light = light;
  embree.eye = eye - light;
  embree.nearest = static_cast<float>(k_light_clearance * glm::length(embree.eye));
  embree.device = rtcNewDevice(nullptr);
  if (!embree.device) fail(fmt::format("no device, error {}", static_cast<int>(rtcGetDeviceError(nullptr))));
  rtcSetDeviceErrorFunction(
      embree.device,
      [](void* message, RTCError code, const char* text) {
        *static_cast<std::string*>(message) =
            fmt::format("error {}: {}", static_cast<int>(code), text ? text : "");
      },
      &embree.error);
  embree.wide = rtcGetDeviceProperty(embree.device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;

  embree.scene = rtcNewScene(embree.device);
  embree.check();
  rtcSetSceneFlags(embree.scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                            RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSceneBuildQuality(embree.scene, RTC_BUILD_QUALITY_HIGH);

  if (!geometry.triangles.empty()) {
    const RTCGeometry mesh = rtcNewGeometry(embree.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    embree.check();
    rtcAttachGeometry(embree.scene, mesh);
    rtcReleaseGeometry(mesh);  // the scene keeps it
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), geometry.positions.size()));
    embree.check();
    auto* triangles = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t),
                                geometry.triangles.size()));
    embree.check();
    for (std::size_t i = 0; i < geometry.positions.size(); ++i) {
      const glm::vec3 relative(glm::dvec3(geometry.positions[i]) - light);
      for (int axis = 0; axis < 3; ++axis) positions[3 * i + static_cast<std::size_t>(axis)] = relative[axis];
    }
    for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        triangles[3 * i + static_cast<std::size_t>(corner)] = geometry.triangles[i][corner];
      }
    }
    rtcCommitGeometry(mesh);
    embree.positions = geometry.positions;
    embree.triangles = triangles;
  }
  rtcCommitScene(embree.scene);
  embree.check();
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
  const glm::dvec3 normal = embree_->normal(ray.hit.primID);
  const double single = static_cast<double>(ray.ray.tfar);
  const double exact =
      glm::dot(normal, embree_->corner(ray.hit.primID, 0) - embree_->eye) / glm::dot(normal, direction);
  const double uncertainty = 1e-3 * single + k_rounding * glm::length(embree_->eye);
  const bool agrees = exact > 0.0 && std::abs(exact - single) <= uncertainty;
  return {agrees ? exact : single, ray.hit.primID};
}

bool Visibility::surface_lit(const glm::dvec3& point) const {
  const double length = glm::length(point);
  if (length == 0.0) return true;
  Embree::SurfaceContext surface{};
  rtcInitIntersectContext(&surface.context);
  surface.context.filter = Embree::reject_coplanar;
  surface.embree = embree_.get();
  surface.point = point;
  surface.clearance = k_rounding * (length + glm::length(point - embree_->eye));
  const glm::vec3 along(point / length);
  RTCRay ray{};
  ray.dir_x = along.x;
  ray.dir_y = along.y;
  ray.dir_z = along.z;
  ray.tnear = embree_->nearest;
  ray.tfar = static_cast<float>(length);
  ray.mask = ~0u;
  rtcOccluded1(embree_->scene, &surface.context, &ray);
  return ray.tfar >= 0.0f;
}

template <class Packet>
std::uint32_t Visibility::Embree::lit_packets(const LightRays& rays, int count) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  typename Packet::Ray packet{};
  alignas(64) int valid[Packet::k_width];
  std::uint32_t lit = 0;
  for (int first = 0; first < count; first += Packet::k_width) {
    for (int lane = 0; lane < Packet::k_width; ++lane) {
      packet.dir_x[lane] = rays.direction_x[first + lane];
      packet.dir_y[lane] = rays.direction_y[first + lane];
      packet.dir_z[lane] = rays.direction_z[first + lane];
      packet.tnear[lane] = nearest;
      packet.tfar[lane] = rays.length[first + lane];
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

std::uint32_t Visibility::Embree::lit_single(const LightRays& rays, int count) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  std::uint32_t lit = 0;
  RTCRay ray{};
  ray.mask = ~0u;
  for (int i = 0; i < count; ++i) {
    ray.dir_x = rays.direction_x[i];
    ray.dir_y = rays.direction_y[i];
    ray.dir_z = rays.direction_z[i];
    ray.tnear = nearest;
    ray.tfar = rays.length[i];
    rtcOccluded1(scene, &context, &ray);
    lit |= static_cast<std::uint32_t>(ray.tfar >= 0.0f) << i;
  }
  return lit;
}

std::uint32_t Visibility::lit(const LightRays& rays, int count, RayMode mode) const {
  assert(0 <= count && count <= LightRays::k_count);
  if (mode == RayMode::single) return embree_->lit_single(rays, count);
  return embree_->wide ? embree_->lit_packets<Packet16>(rays, count)
                       : embree_->lit_packets<Packet8>(rays, count);
}

}  // namespace airlight::reference
