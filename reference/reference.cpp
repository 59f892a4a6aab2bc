#include "reference/reference.h"

#include "reference/state.h"
#include "scene/parallel.h"

namespace airlight::reference {

glm::dvec3 Reference::State::direction(const glm::dvec2& point) const {
  const double across = (2.0 * point.x / view.size.x - 1.0) * camera.half_width;
  const double upward = (1.0 - 2.0 * point.y / view.size.y) * camera.half_height;
  return glm::normalize(camera.forward + across * camera.right + upward * camera.up);
}

template <>
ViewRay Reference::State::ray<ViewRay>(int x, int y) const {
  const glm::dvec3 direction = pixel_direction(x, y);
  return make_view_ray(eye, direction, camera.right, seen().first_hit(direction).distance, quarter_pixel,
                       top);
}

template <>
SunRay Reference::State::ray<SunRay>(int x, int y) const {
  const glm::dvec3 direction = pixel_direction(x, y);
  const std::optional<double> eye_y = top ? std::optional(-*top) : std::nullopt;
  return make_sun_ray(*sun, direction, camera.right, visibility.first_hit(direction).distance, quarter_pixel,
                      eye_y);
}

namespace {

/// Whether the light is at a thousand times the distance of all that the eye may see.
bool is_far(const scene::Box& box, const glm::dvec3& eye, double distance) {
  return !box.empty() && distance > 1000.0 * scene::reach_from(eye, box);
}

}  // namespace

Reference::State::State(const scene::Geometry& geometry, const scene::View& v, std::size_t light_index)
    : view(v),
      light(view.lights.at(light_index)),
      camera(scene::camera_frame(view.camera, view.size)),
      triangles(geometry),
      box(scene::bounds(geometry)),
      sun(scene::is_sun(light) ? std::optional(glm::normalize(light.towards)) : std::nullopt),
      origin(sun ? camera.eye : light.position),
      eye(camera.eye - origin),
      visibility(triangles, origin, camera.eye, sun) {
  resize(view.size);
  if (view.medium.top) top = *view.medium.top - origin.y;
  if (!sun && is_far(box, camera.eye, glm::length(eye)))
    around_eye.emplace(triangles, camera.eye, camera.eye, scene::direction_to(light, camera.eye));
  if (!sun && light.texture) light_texture.emplace(*light.texture);
}

void Reference::State::resize(glm::ivec2 image_size) {
  view.size = image_size;
  camera = scene::camera_frame(view.camera, image_size);
  // The tangent size of a pixel at the image's centre stands for its angle.
  quarter_pixel = 0.25 * 2.0 * camera.half_height / image_size.y;
}

Reference::Reference(const scene::Geometry& geometry, const scene::View& view, std::size_t light_index) {
  scene::validate(view);
  state_ = std::make_unique<State>(geometry, view, light_index);
}

void Reference::resize(glm::ivec2 image_size) {
  state_->resize(image_size);
}

Reference::~Reference() = default;
Reference::Reference(Reference&&) noexcept = default;
Reference& Reference::operator=(Reference&&) noexcept = default;

SurfaceImage Reference::surfaces(const Progress& progress) const {
  const State& state = *state_;
  SurfaceImage image{.distance = std::vector<float>(state.pixels()),
                     .visibility = std::vector<float>(state.pixels())};
  const auto make_worker = [&] {
    return [&](int y) {
      for (int x = 0; x < state.view.size.x; ++x) {
        const glm::dvec3 direction = state.pixel_direction(x, y);
        const Visibility::Hit hit = state.seen().first_hit(direction);
        if (hit.distance == 0.0) continue;
        image.distance[state.index(x, y)] = static_cast<float>(hit.distance);
        const glm::dvec3 towards =
            scene::direction_to(state.light, state.camera.eye + hit.distance * direction);
        const bool is_lit = state.seen().surface_lit(hit, direction, towards);
        image.visibility[state.index(x, y)] = is_lit ? 1.0f : 0.0f;
      }
    };
  };
  scene::parallel(state.view.size.y, make_worker, progress);
  return image;
}

}  // namespace airlight::reference
