#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace airlight::viewer {

// How a camera is moved by hand. None of these lets it look straight up or down, where its `up` would be
// parallel to the view, or come to stand on its target.

/// Turns the view about the eye. @param right, down [rad]
void look(scene::Camera& camera, double right, double down);

/// Turns the eye about the target. @param right, down by which the scene seems to turn [rad]
void orbit(scene::Camera& camera, double right, double down);

/// Moves eye and target across the view. @param right, up [m]
void pan(scene::Camera& camera, double right, double up);

/// Moves the eye towards the target, which stays: the distance to it is divided by e^`amount`.
void dolly(scene::Camera& camera, double amount);

/// Moves eye and target. @param way right, up along the camera's `up`, forward [m]
void fly(scene::Camera& camera, glm::dvec3 way);

/// Where a point is seen in an image, in pixels, row 0 at the top, and how far it lies in front of the image
/// plane through the eye: not above 0 for what is not seen [m].
glm::dvec3 project(const scene::CameraFrame& camera, glm::dvec2 image_size, glm::dvec3 point);

/// The same of a light; of a sun, of its direction.
glm::dvec3 project(const scene::CameraFrame& camera, glm::dvec2 image_size, const scene::Light& light);

}  // namespace airlight::viewer
