// Epipolar lines of an image: through the epipole, where the light lies in the image's plane. The view rays of one look into one half-plane
// about the axis from eye to light, so that along it airlight changes as the depth of surfaces does.
// Based on: Engelhardt and Dachsbacher, "Epipolar Sampling for Shadows and Crepuscular Rays in Participating Media with Single
// Scattering", I3D 2010, section 3.1. Deviation: the epipole is homogeneous, so that lights behind the camera and beside it are like others.
#ifndef AIRLIGHT_EPIPOLAR_LINES_GLSL
#define AIRLIGHT_EPIPOLAR_LINES_GLSL
#include "frame/camera.glsl"

// Places are in pixels from the image's top left corner. Its border is counted clockwise from there [pixels].
struct EpipolarLines {
  vec3 epipole;  // lies at xy / z; z is 0 where lines are parallel, and never below
  vec2 size;     // of the image
  float start;   // where along the border the part begins at which lines end, …
  float extent;  // … and how long it is: all of the border where the epipole lies in the image
  bool is_inside;
};

// What of a line lies in the image.
struct EpipolarLine {
  vec2 from;  // the end that is next to the epipole
  vec2 to;
};

// How far from the epipole lines begin [pixels]: on it a view ray has no half-plane.
CONST float k_epipole_gap = 0.5f;

FUNCTION float border_length(IN(vec2) size) { return 2.0f * (size.x + size.y); }

// `axis`: the unit direction from the eye to the light.
FUNCTION EpipolarLines epipolar_lines(IN(CameraBlock) camera, IN(vec3) axis) {
  EpipolarLines lines;
  vec2 size = vec2(camera.image_width, camera.image_height);
  float depth = dot(axis, camera.forward);
  float x = 0.5f * size.x * (depth + dot(axis, camera.right) / camera.half_width);
  float y = 0.5f * size.y * (depth - dot(axis, camera.up) / camera.half_height);
  // Of a light behind the eye the point opposite of it lies on the same lines.
  vec3 epipole = depth < 0.0f ? vec3(-x, -y, -depth) : vec3(x, y, depth);
  // Lines leave the image over the sides that turn away from the epipole, which are next to one another.
  bool top = epipole.y > 0.0f;
  bool right = size.x * epipole.z > epipole.x;
  bool bottom = size.y * epipole.z > epipole.y;
  bool left = epipole.x > 0.0f;
  lines.epipole = epipole;
  lines.size = size;
  lines.is_inside = top && right && bottom && left;
  lines.extent = (top ? size.x : 0.0f) + (right ? size.y : 0.0f) + (bottom ? size.x : 0.0f) + (left ? size.y : 0.0f);
  lines.start = 2.0f * size.x + size.y;
  if (bottom && !right) lines.start = size.x + size.y;
  if (right && !top) lines.start = size.x;
  if (lines.is_inside || (top && !left)) lines.start = 0.0f;
  return lines;
}

// Where the line through a place leaves the image: from 0 to 1, of the part of the border at which lines end.
FUNCTION float line_end(IN(EpipolarLines) lines, IN(vec2) place) {
  vec2 way = place * lines.epipole.z - vec2(lines.epipole.x, lines.epipole.y);
  vec2 size = lines.size;
  float to_side = way.x > 0.0f ? size.x - place.x : place.x;
  float to_level = way.y > 0.0f ? size.y - place.y : place.y;
  float along;
  if (to_side * abs(way.y) < to_level * abs(way.x)) {
    float y = clamp(place.y + way.y * (to_side / abs(way.x)), 0.0f, size.y);
    along = way.x > 0.0f ? size.x + y : 2.0f * (size.x + size.y) - y;
  } else {
    float x = clamp(place.x + way.x * (to_level / max(abs(way.y), 1e-30f)), 0.0f, size.x);
    along = way.y > 0.0f ? 2.0f * size.x + size.y - x : x;
  }
  along -= lines.start;
  if (along < 0.0f) along += border_length(size);
  // What rounding moves past an end of the part lies at that end.
  if (along > lines.extent) along = along > 0.5f * (lines.extent + border_length(size)) ? 0.0f : lines.extent;
  return along / lines.extent;
}

FUNCTION vec2 border_place(IN(vec2) size, float along) {
  if (along < size.x) return vec2(along, 0.0f);
  if (along < size.x + size.y) return vec2(size.x, along - size.x);
  if (along < 2.0f * size.x + size.y) return vec2(2.0f * size.x + size.y - along, size.y);
  return vec2(0.0f, max(border_length(size) - along, 0.0f));
}

// The line whose `line_end` that is.
FUNCTION EpipolarLine line_to(IN(EpipolarLines) lines, float end) {
  float along = lines.start + end * lines.extent;
  if (along >= border_length(lines.size)) along -= border_length(lines.size);
  EpipolarLine line;
  line.to = border_place(lines.size, along);
  vec2 way = line.to * lines.epipole.z - vec2(lines.epipole.x, lines.epipole.y);
  // Back to the epipole or to the border, whichever comes first.
  float back = 1.0f / max(lines.epipole.z, 1e-30f) - k_epipole_gap / max(length(way), 1e-30f);
  if (way.x > 0.0f) back = min(back, line.to.x / way.x);
  if (way.x < 0.0f) back = min(back, (line.to.x - lines.size.x) / way.x);
  if (way.y > 0.0f) back = min(back, line.to.y / way.y);
  if (way.y < 0.0f) back = min(back, (line.to.y - lines.size.y) / way.y);
  line.from = line.to - max(back, 0.0f) * way;
  return line;
}

// Slices are lines whose ends are equally far apart along the border. Where that is all of it, the first follows on the last.
FUNCTION float slice_intervals(IN(EpipolarLines) lines, uint slices) {
  return lines.is_inside ? float(slices) : float(slices) - 1.0f;
}

FUNCTION EpipolarLine slice_line(IN(EpipolarLines) lines, uint slice, uint slices) {
  return line_to(lines, float(slice) / slice_intervals(lines, slices));
}

// Samples are equally far apart along a slice, from its one end to the other.
FUNCTION vec2 sample_place(IN(EpipolarLine) line, float sample_number, uint samples) {
  float part = sample_number / (float(samples) - 1.0f);
  return line.from + part * (line.to - line.from);
}

// The number of the sample at the point of a slice that is nearest to a place; between two of them where it lies between them.
FUNCTION float sample_beside(IN(EpipolarLine) line, IN(vec2) place, uint samples) {
  vec2 span = line.to - line.from;
  float part = dot(place - line.from, span) / max(dot(span, span), 1e-12f);
  return clamp(part, 0.0f, 1.0f) * (float(samples) - 1.0f);
}

// The plane of what a view ray sees: 1/depth [1/m], which is linear over the image.
struct SeenPlane {
  float at;    // where it is seen; 0 of no surface
  vec2 slope;  // to the right and down [1/m a pixel]
};

// `distance`: along the unit view ray, 0 for no surface [m].
FUNCTION SeenPlane seen_plane(IN(CameraBlock) camera, IN(vec2) place, IN(vec3) normal, float distance) {
  SeenPlane plane;
  plane.at = 0.0f;
  plane.slope = vec2(0.0f);
  if (distance > 0.0f) {
    vec3 ray = view_ray(camera, place);
    plane.at = 1.0f / max(distance * dot(ray, camera.forward), 1e-15f);
    float facing = dot(normal, ray);
    // Of a surface seen edge-on, which ends within the pixel, no more is known than where it is seen.
    if (facing < -1e-4f) {
      float scale = 1.0f / (max(distance, 1e-15f) * facing);
      plane.slope = scale * vec2(2.0f * camera.half_width / camera.image_width * dot(normal, camera.right),
                                 -2.0f * camera.half_height / camera.image_height * dot(normal, camera.up));
    }
  }
  return plane;
}

FUNCTION float inverse_depth_at(IN(SeenPlane) plane, IN(vec2) apart) { return plane.at + dot(plane.slope, apart); }

// What airlight is divided by before it is interpolated: it grows as 1/sin(α) about a lamp in view, with α no less than a quarter of a
// pixel. 1 of a sun.
FUNCTION float airlight_peak(IN(CameraBlock) camera, IN(vec3) axis, float is_near, IN(vec2) place) {
  vec3 ray = view_ray(camera, place);
  float sine = dot(ray, axis) > 0.0f ? max(length(cross(axis, ray)), quarter_pixel(camera)) : 1.0f;
  return is_near > 0.0f ? 1.0f / sine : 1.0f;
}

#endif
