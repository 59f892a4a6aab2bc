// The camera as the shaders see it: all positions relative to the eye, so that coordinates far from the origin cost
// no precision.
#ifndef AIRLIGHT_CAMERA_GLSL
#define AIRLIGHT_CAMERA_GLSL
#include "arithmetic.glsl"

// A uniform block (std140), written once a frame by frame/blocks.cpp.
struct CameraBlock {
  vec3 eye_high;     // eye, world space [m], rounded to float …
  float half_width;  // tangent of half the horizontal field of view
  vec3 eye_low;      // … and what the rounding left
  float half_height; // tangent of half the vertical field of view
  vec3 right;        // axes of the camera, world space
  float image_width; // [pixels]
  vec3 up;
  float image_height;
  vec3 forward;
  float near;        // depth [m] below which the G-buffer no longer orders surfaces
};

// A world-space position relative to another one, which is high + low. Exact where the two are close (Sterbenz), if subtracted in
// this order.
FUNCTION vec3 relative_to(vec3 high, vec3 low, vec3 world) {
  PRECISE vec3 relative = (world - high) - low;
  return relative;
}

// Position relative to the eye of a world-space position.
FUNCTION vec3 eye_relative(IN(CameraBlock) camera, vec3 world) {
  return relative_to(camera.eye_high, camera.eye_low, world);
}

// Unit direction of the view ray through a point of the image, in pixels from its top left corner; pixel centres lie
// at half-integers.
FUNCTION vec3 view_ray(IN(CameraBlock) camera, vec2 pixel) {
  float x = (2.0f * pixel.x / camera.image_width - 1.0f) * camera.half_width;
  float y = (1.0f - 2.0f * pixel.y / camera.image_height) * camera.half_height;
  return normalize(camera.forward + x * camera.right + y * camera.up);
}

// Tangent of the angle that a quarter of a pixel spans at the image's centre: no view ray is taken to be nearer to the light's
// direction than this, where airlight grows as 1/sin(α).
FUNCTION float quarter_pixel(IN(CameraBlock) camera) { return 0.5f * camera.half_height / camera.image_height; }

// Distance along the unit ray `ray` from the eye to the plane of the triangle (a, b, c), positions relative to the
// eye. Kept between the triangle's extremes along the ray, which matters for a triangle seen edge-on, whose plane
// the ray may miss at a pixel that its rasterised edge still covers.
FUNCTION float ray_triangle_distance(IN(vec3) ray, IN(vec3) a, IN(vec3) b, IN(vec3) c) {
  vec3 normal = cross(b - a, c - a);
  float da = dot(a, ray);
  float db = dot(b, ray);
  float dc = dot(c, ray);
  float nearest = min(da, min(db, dc));
  float farthest = max(da, max(db, dc));
  float facing = dot(normal, ray);
  float height = dot(normal, a);
  float t = abs(height) < 1e20f * abs(facing) ? height / facing : nearest;  // no quotient that may overflow
  return clamp(t, nearest, farthest);
}

#endif
