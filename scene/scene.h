#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "scene/nodes.h"
#include "scene/pose.h"

namespace airlight::scene {

/// Squared distances between points within this range of the origin stay far inside single precision.
inline constexpr double k_largest_coordinate = 1e18;  // [m]

/// How a model is shown.
enum class Looks {
  flat,      ///< one colour a material, and flat triangles: all that its shadows depend on
  textured,  ///< with the textures of its base colours, what they cut out of it, and its shading normals
};

/// An image of base colours: sRGB and alpha of 8 bits each, row 0 at the top.
struct TextureImage {
  glm::ivec2 size{0};
  std::vector<glm::u8vec4> texels;
};

/// What a texture shows beyond its sides.
enum class TextureWrap : std::uint32_t { repeat = 0, clamp = 1, mirror = 2 };

/// Of a triangle there is a surface only where the alpha of a texture, blended bilinearly between its texels,
/// is no less than a value.
struct CutOut {
  std::uint32_t texture;  ///< of Geometry::textures
  float least_alpha;      ///< in (0, 1]
};

/// A Lambert surface.
struct Material {
  glm::vec3 albedo{0.8f};                     ///< diffuse reflectance, linear RGB in [0, 1]
  std::optional<std::uint32_t> texture = {};  ///< of Geometry::textures: multiplies `albedo`
  std::array<TextureWrap, 2> wrap = {};       ///< of its textures: left and right, above and below
  std::optional<CutOut> cut_out = {};
  /// Of the light that meets it, the share that passes straight through, RGB in [0, 1]; 0 of what is opaque.
  /// Such a surface is a thin layer: nothing is refracted. The eye does not look through it; where it is seen
  /// from the side away from the light, it glows with what it lets through.
  glm::vec3 transmittance{0.0f};
};

/// Whether its triangles need places in a texture.
inline bool is_textured(const Material& material) {
  return material.texture || material.cut_out;
}

/// What light passes. A method that cannot show it takes every triangle for opaque.
enum class Transmission {
  material,        ///< as its material says (Material::transmittance)
  opaque,          ///< nothing
  x_ray,           ///< every triangle, all alike: a share that falls with the angle of incidence
  x_ray_coloured,  ///< so, with a colour for each triangle
};

/// Every surface of a scene as one triangle list in world space: right-handed, +Y up, metres.
///
/// All values are finite, no triangle has zero area, and the extent is small enough that squared distances
/// do not overflow: the importers refuse or drop (and count) what is not.
struct Geometry {
  std::vector<glm::vec3> positions;                 ///< world space [m]
  std::vector<glm::uvec3> triangles;                ///< indices into `positions`
  std::vector<std::uint32_t> material_of_triangle;  ///< indices into `materials`, one a triangle
  std::vector<Material> materials;
  Transmission transmission = Transmission::material;

  std::vector<TextureImage> textures;
  /// Where each triangle's corners lie in its material's texture: (0, 0) is the image's top left corner, (1,
  /// 1) its bottom right one. Empty where there are no textures.
  std::vector<std::array<glm::vec2, 3>> texture_places;

  /// Unit normals of each triangle's corners, world axes, by which its shading is interpolated; on the side
  /// from which the corners go around counter-clockwise, for most of them. Empty where all triangles are
  /// flat.
  std::vector<std::array<glm::vec3, 3>> normals;

  /// Which of the scene's nodes each triangle hangs on. Empty where there are none.
  std::vector<std::uint32_t> node_of_triangle;
};

/// Whether three corners do not lie in one line, as the floats that they are.
bool has_area(glm::vec3 a, glm::vec3 b, glm::vec3 c);

/// An axis-aligned box. Empty while `lower > upper`.
struct Box {
  glm::vec3 lower{1e30f};
  glm::vec3 upper{-1e30f};
  bool empty() const { return lower.x > upper.x; }
  void include(glm::vec3 point) {
    lower = glm::min(lower, point);
    upper = glm::max(upper, point);
  }
};

/// Whether the material of a triangle cuts parts out of it.
inline bool is_cut_out(const Geometry& geometry, std::uint32_t triangle) {
  return geometry.materials[geometry.material_of_triangle[triangle]].cut_out.has_value();
}

/// Whether any material does.
bool has_cut_outs(const Geometry& geometry);

/// Texels of all textures.
std::size_t texel_count(const Geometry& geometry);

/// The box of all positions that a triangle uses.
Box bounds(const Geometry& geometry);

/// How far a box, not empty, reaches from a point [m].
double reach_from(glm::dvec3 point, const Box& box);

/// The unit vector along one of any length but 0, however short or long.
glm::dvec3 unit(glm::dvec3 v);

/// A pinhole camera. The image plane's aspect ratio comes from the image, not from here.
struct Camera {
  std::string name;
  glm::dvec3 eye{0.0};                ///< world space [m]
  glm::dvec3 target{0.0, 0.0, -1.0};  ///< any point straight ahead, world space [m]
  glm::dvec3 up{0.0, 1.0, 0.0};       ///< need not be perpendicular to the view
  double vertical_fov_degrees = 45.0;
  bool operator==(const Camera&) const = default;
};

/// The orthonormal axes of a camera and the slopes of its image's edges.
///
/// The view ray of the point (x, y) of a W×H image, in pixels, row 0 at the top, is along
/// forward + (2x/W − 1)·half_width·right + (1 − 2y/H)·half_height·up; pixel centres are at half-integers.
struct CameraFrame {
  glm::dvec3 eye, right, up, forward;
  double half_width, half_height;  ///< tangents of half the horizontal and vertical fields of view
  bool operator==(const CameraFrame&) const = default;
};

/// @throws Error (usage) when eye and target coincide, up is parallel to the view, the field of view is not
/// inside (0°, 180°), a value is not finite, or the image has no pixels.
CameraFrame camera_frame(const Camera& camera, glm::ivec2 image_size);

/// The direction, not of unit length, of the view ray through a place of an image.
/// @param place from (−1, −1), the lower left corner, to (1, 1)
glm::dvec3 image_ray(const CameraFrame& camera, glm::dvec2 place);

/// The same of a point of it in pixels, (0, 0) being the upper left corner.
glm::dvec3 image_ray(const CameraFrame& camera, glm::dvec2 image_size, glm::dvec2 point);

/// Directions, not of unit length, through the corners of an image, in their order around it.
std::array<glm::dvec3, 4> corner_rays(const CameraFrame& camera);

class LightTexture;

/// What a light is; it says which of a light's fields mean something.
enum class LightKind {
  point,  ///< radiates from one point: alike in all directions, or as its texture says
  sun,    ///< a point at infinity: its rays are parallel, it has no disc
};

/// What makes a point light a spot, as glTF's KHR_lights_punctual has it: the whole intensity within the
/// inner half-angle, none beyond the outer one, between them the square of what falls linearly in the angle's
/// cosine; where both are equal, a step.
struct Cone {
  glm::dvec3 axis{0.0, -1.0, 0.0};         ///< which way it shines, world axes; unit length
  double inner = 0.0;                      ///< [rad], from 0 to `outer`
  double outer = 0.25 * std::numbers::pi;  ///< [rad], above 0, at most π/2
  bool operator==(const Cone&) const = default;
};

struct Light {
  std::string name;
  LightKind kind = LightKind::point;
  // Of a point:
  glm::dvec3 position{0.0};   ///< world space [m]
  glm::vec3 intensity{1.0f};  ///< radiant intensity, RGB [W/sr]; candela of a glTF file are read one to one
  // Of a sun:
  glm::dvec3 towards{0.0, 1.0, 0.0};  ///< from anywhere to the sun, world axes; unit length
  /// On a surface that faces the sun, RGB [W/m²]: where its light enters the medium's layer, or anywhere in a
  /// medium without a top, in which its path has no length. Lux of a glTF file are read one to one.
  glm::vec3 irradiance{1.0f};
  /// Multiplies a point's `intensity` by direction; nullptr for none.
  std::shared_ptr<const LightTexture> texture = nullptr;
  std::optional<Cone> cone = {};  ///< of a point: a spot
  /// Of a point [m]: light at the distance r is multiplied by max(1 − (r / range)⁴, 0), as glTF's range does.
  std::optional<double> range = {};
  bool operator==(const Light&) const = default;
};

inline Light point_light(std::string name, glm::dvec3 position, glm::vec3 intensity) {
  return {.name = std::move(name), .position = position, .intensity = intensity};
}

inline Light sun(std::string name, glm::dvec3 towards, glm::vec3 irradiance) {
  return {.name = std::move(name),
          .kind = LightKind::sun,
          .towards = glm::normalize(towards),
          .irradiance = irradiance};
}

inline bool is_sun(const Light& light) {
  return light.kind == LightKind::sun;
}

/// Whether two lights differ in nothing but how bright they are, so that one's shadows are the other's.
bool shine_alike(const Light& a, const Light& b);

/// Unit direction from a point to the light.
/// @param from world space [m], not where the light is
glm::dvec3 direction_to(const Light& light, glm::dvec3 from);

/// `hoffman_preetham` mixes Rayleigh's function, of the air's molecules, with Henyey-Greenstein's, of haze.
enum class PhaseFunction : std::uint32_t {
  isotropic = 0,
  rayleigh = 1,
  henyey_greenstein = 2,
  hoffman_preetham = 3,
};

/// The names that users know them by, in their order.
std::span<const std::string_view> phase_names();

/// Empty for what is no phase function.
std::string phase_name(PhaseFunction phase);

/// Whether it has a mean cosine g to set.
bool has_g(PhaseFunction phase);

/// A homogeneous participating medium that fills space, or a layer of it.
struct Medium {
  glm::vec3 sigma_s{0.1f};  ///< scattering coefficient, RGB [1/m]
  glm::vec3 sigma_a{0.0f};  ///< absorption coefficient, RGB [1/m]
  PhaseFunction phase = PhaseFunction::isotropic;
  float g = 0.0f;  ///< mean cosine of Henyey-Greenstein, in (−1, 1); > 0 scatters forward
  /// Of Hoffman-Preetham: the fraction of the scattered light that molecules scatter, in [0, 1]. Half, where
  /// nothing is known: on a clear day that is about right for green light, in fog it is next to none.
  float rayleigh_weight = 0.5f;
  /// Height y of the layer's top, world space [m]: the medium fills what lies below. Without, all of space.
  std::optional<double> top = {};
  bool operator==(const Medium&) const = default;
};

/// What surrounds a scene beside its lights, none of which shines through the medium into the eye as airlight
/// does: it is seen through it.
struct Surroundings {
  /// Radiance that arrives at every surface from all sides, RGB [W/(m² sr)]: surfaces reflect their colour's
  /// part.
  glm::vec3 ambient{0.0f};
  glm::vec3 background{0.0f};  ///< radiance of what lies beyond all surfaces, RGB [W/(m² sr)]
  bool operator==(const Surroundings&) const = default;
};

/// How previews show radiance brighter than a display: quality/tone_map.h.
enum class ToneMap { none, reinhard, aces, agx };

/// The names that users know them by, in their order.
std::span<const std::string_view> tone_map_names();

/// The one of these.
std::string tone_map_name(ToneMap tone_map);

/// What an importer dropped or could not represent: shown to the user, kept with the results.
struct ImportReport {
  std::size_t degenerate_triangles = 0;  ///< zero-area triangles, dropped
  std::vector<std::string> warnings;     ///< one line each, with counts
};

/// The methods that a scene is best shown by, as users write them; empty for no choice.
struct UsualMethods {
  std::string volume, surface;
  std::optional<int> shadow_map;  ///< side of a cube face [texels]
};

/// A scene: what is rendered, with the views, lights and medium it brings along.
struct Scene {
  std::string name;
  Geometry geometry;
  std::vector<Node> nodes;  ///< of a glTF file, in its order
  std::vector<Camera> cameras;
  std::vector<Light> lights;        ///< all of them are on
  std::vector<Light> other_lights;  ///< brought along and off, because others were chosen
  Medium medium;
  Surroundings surroundings;
  std::optional<float> exposure;  ///< of PNG previews: linear radiance is multiplied by it; automatic without
  ToneMap tone_map = ToneMap::none;  ///< of PNG previews
  UsualMethods methods;
  ImportReport report;
};

/// What one image shows of a scene, all choices made. Of the geometry it says where its objects are.
struct View {
  Camera camera;
  std::vector<Light> lights{Light{}};  ///< at least one; what they send adds up
  Medium medium;
  glm::ivec2 size{512, 512};  ///< pixels
  Surroundings surroundings = {};
  Pose pose = {};
};

/// Checks what every method relies on.
/// @throws Error (bad_file) when there is no light, a lamp coincides with the eye, a spot has no axis, a sun
/// is textured or has a cone or a range, or a value of the view is out of its domain (not finite, negative
/// intensity or coefficient, |g| ≥ 1, a weight outside [0, 1]); (usage) as `camera_frame`, where fog is so
/// bright that single precision could overflow, and where the medium has a top and a sun does not stand above
/// the horizon.
void validate(const View& view);

/// Leaves out what `Looks::flat` does: textures, what they cut out, of which a warning tells, and normals.
void show_flat(Scene& scene);

/// Gives every triangle the same reflectance, and none a texture; what is cut out of them stays so.
void override_albedo(Geometry& geometry, glm::vec3 albedo);

/// A camera that sees all of the geometry, from the front (+Z), slightly above.
Camera fit_camera(const Geometry& geometry);

}  // namespace airlight::scene
