#include "scene/view_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>

#include "scene/import_internal.h"
#include "scene/numbers.h"

namespace airlight::scene {
namespace {

using enum FieldKind;
using Texture = std::shared_ptr<const LightTexture>;

constexpr FieldRange k_any;
// Single precision ends at 3e38; surfaces a tenth of a millimetre from the light are to fit as well.
constexpr FieldRange k_intensity = {
    .lower = 0, .upper = 1e30f, .why = "more could overflow single precision, which images are in"};
// A sun's light is spread over no distance: this leaves room for the phase function's peak.
constexpr FieldRange k_irradiance = {
    .lower = 0, .upper = 1e25f, .why = "more could overflow single precision, which images are in"};
constexpr FieldRange k_per_metre = {
    .lower = 0, .upper = 1e6, .why = "a mean free path below a micrometre is no fog"};
constexpr FieldRange k_positive = {.lower = 0, .is_open = true};
constexpr FieldRange k_fraction = {.lower = 0, .upper = 1};
constexpr FieldRange k_reflectance = {.lower = 0, .upper = 1, .why = "a surface reflects at most all light"};
constexpr FieldRange k_cosine = {.lower = -1, .upper = 1, .is_open = true};
constexpr FieldRange k_half_turn = {.lower = 0, .upper = 180, .is_open = true};
constexpr FieldRange k_elevation = {.lower = -90, .upper = 90};
constexpr FieldRange k_half_angle = {.lower = 0, .upper = 90};
constexpr FieldRange k_place = {.lower = -k_largest_coordinate, .upper = k_largest_coordinate};

/// A single-precision value with the digits it has, not those of its conversion to double.
double digits(float value) {
  return std::isfinite(value) ? std::stod(fmt::format("{}", value)) : static_cast<double>(value);
}

/// An angle [rad] with no more digits in degrees than its conversion keeps.
double degrees_of(double radians) {
  const double degrees = glm::degrees(radians);
  return std::isfinite(degrees) ? std::stod(fmt::format("{:.15g}", degrees)) : degrees;
}

void assign(double& to, const FieldValue& value) {
  to = std::get<double>(value);
}
void assign(float& to, const FieldValue& value) {
  to = static_cast<float>(std::get<double>(value));
}
template <typename Number>
void assign(std::optional<Number>& to, const FieldValue& value) {
  assign(to.emplace(), value);
}
void assign(glm::vec3& to, const FieldValue& value) {
  to = std::get<glm::dvec3>(value);
}
template <typename Same>
void assign(Same& to, const FieldValue& value) {
  to = std::get<Same>(value);
}

std::optional<FieldValue> value_of(float value) {
  return digits(value);
}
std::optional<FieldValue> value_of(const std::optional<float>& value) {
  return value ? value_of(*value) : std::nullopt;
}
std::optional<FieldValue> value_of(glm::vec3 v) {
  return glm::dvec3(digits(v.x), digits(v.y), digits(v.z));
}
std::optional<FieldValue> value_of(const Texture& texture) {
  return texture ? std::optional<FieldValue>(texture) : std::nullopt;
}
template <typename Same>
std::optional<FieldValue> value_of(const Same& value) {
  return value;
}

template <typename Thing, typename Value>
Thing owner(Value Thing::*);
template <typename Thing, typename Value>
Value type(Value Thing::*);

/// A field that is a member of the thing.
template <auto member>
auto member_field(FieldInfo info,
                  std::optional<FieldProblem> (*lack)(const decltype(owner(member))&) = nullptr) {
  using Thing = decltype(owner(member));
  using Value = decltype(type(member));
  info.is_single = std::is_same_v<Value, float> || std::is_same_v<Value, std::optional<float>>;
  return Field<Thing>{info, [](Thing& thing, const FieldValue& value) { assign(thing.*member, value); },
                      [](const Thing& thing) { return value_of(thing.*member); }, lack};
}

std::optional<FieldProblem> lack_in_sun(const Light& light, std::string_view what, std::string_view remedy) {
  if (!is_sun(light)) return std::nullopt;
  return FieldProblem{fmt::format("the light is a sun, which has no {}", what), std::string(remedy)};
}

std::optional<FieldProblem> lack_in_lamp(const Light& light, std::string_view what, std::string_view remedy) {
  if (is_sun(light)) return std::nullopt;
  return FieldProblem{fmt::format("the light is a lamp, which has no {}", what), std::string(remedy)};
}

void set_direction(Light& light, const FieldValue& value) {
  light.towards = unit(std::get<glm::dvec3>(value));
}

std::optional<FieldProblem> lack_of_cone(const Light& light) {
  if (auto wrong = lack_in_sun(light, "cone", "spots are lamps")) return wrong;
  if (light.cone) return std::nullopt;
  return FieldProblem{"the light is no spot, which alone has a cone", "aim it at a target"};
}

/// A target at the lamp itself leaves an axis that is none, for `validate` to refuse.
void set_spot_target(Light& light, const FieldValue& value) {
  const glm::dvec3 way = std::get<glm::dvec3>(value) - light.position;
  if (!light.cone) light.cone.emplace();
  light.cone->axis = way == glm::dvec3(0.0) ? way : unit(way);
}

/// A point so far along the axis that its digits hold those of the axis.
std::optional<FieldValue> spot_target_of(const Light& light) {
  if (!light.cone) return std::nullopt;
  const glm::dvec3 place = glm::abs(light.position);
  return light.position + std::max({1.0, place.x, place.y, place.z}) * light.cone->axis;
}

void set_spot_angles(Light& light, const FieldValue& value) {
  const glm::dvec2 degrees = std::get<glm::dvec2>(value);
  light.cone->inner = glm::radians(degrees.x);
  light.cone->outer = glm::radians(degrees.y);
}

std::optional<FieldValue> spot_angles_of(const Light& light) {
  if (!light.cone) return std::nullopt;
  return glm::dvec2(degrees_of(light.cone->inner), degrees_of(light.cone->outer));
}

std::optional<FieldProblem> lack_of_g(const Medium& medium) {
  if (has_g(medium.phase)) return std::nullopt;
  return FieldProblem{fmt::format("the phase function {} has no g", phase_name(medium.phase)),
                      "choose henyey-greenstein or hoffman-preetham"};
}

std::optional<FieldProblem> lack_of_mix(const Medium& medium) {
  if (medium.phase == PhaseFunction::hoffman_preetham) return std::nullopt;
  return FieldProblem{fmt::format("the phase function {} mixes nothing", phase_name(medium.phase)),
                      "choose hoffman-preetham"};
}

std::ptrdiff_t place_of_word(std::span<const std::string_view> words, const FieldValue& value) {
  return std::find(words.begin(), words.end(), std::get<std::string>(value)) - words.begin();
}

void set_phase(Medium& medium, const FieldValue& value) {
  medium.phase = static_cast<PhaseFunction>(place_of_word(phase_names(), value));
  if (!has_g(medium.phase)) medium.g = 0.0f;
}

std::string list(std::span<const std::string_view> words, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i + 1 < words.size() ? ", " : last, words[i]);
  return text;
}

}  // namespace

// A row's columns: group, name, kind, placeholder, label, meaning, unit, note, default, range, words.

template <>
std::span<const Field<Camera>> fields() {
  static const std::array table = {
      member_field<&Camera::eye>({"camera", "eye", vector, "X,Y,Z", "eye", "where the camera stands", "m",
                                  "needs --target", "", k_place}),
      member_field<&Camera::target>({"camera", "target", vector, "X,Y,Z", "target",
                                     "a point straight ahead of the camera", "m", "needs --eye", "",
                                     k_place}),
      member_field<&Camera::up>({"camera", "up", vector, "X,Y,Z", "up", "the camera's up", "", "",
                                 "0,1,0 with --eye, else the camera's own"}),
      member_field<&Camera::vertical_fov_degrees>({"camera", "fov", number, "DEG", "vertical field of view",
                                                   "vertical field of view", "degrees", "",
                                                   "45 with --eye, else the camera's own", k_half_turn}),
  };
  return table;
}

template <>
std::span<const Field<Light>> fields() {
  static const std::array table = {
      member_field<&Light::position>(
          {"light", "light-position", vector, "X,Y,Z", "at", "where the light is, which makes it a lamp", "m",
           "needs --intensity", "", k_place},
          [](const Light& light) { return lack_in_sun(light, "position", "give its direction"); }),
      member_field<&Light::intensity>(
          {"light", "intensity", colour, "R,G,B", "intensity", "radiant intensity of a lamp", "W/sr",
           "at most 1e30", "", k_intensity},
          [](const Light& light) { return lack_in_sun(light, "intensity", "give its irradiance"); }),
      member_field<&Light::texture>(
          {"light", "light-texture", file, "FILE.exr", "textured by",
           "what the light radiates by direction, relative to its intensity: an equirectangular image, "
           "+Y at the top, +Z in the middle, +X to the left of it",
           "", ""},
          [](const Light& light) { return lack_in_sun(light, "texture", "textured lights are lamps"); }),
      Field<Light>{{.group = "light",
                    .name = "spot-target",
                    .kind = vector,
                    .placeholder = "X,Y,Z",
                    .label = "aimed at",
                    .meaning = "a point that the lamp shines at, which makes it a spot",
                    .unit = "m",
                    .usual = "the scene's; a lamp that has none shines in all directions",
                    .own_key = "target"},
                   set_spot_target,
                   spot_target_of,
                   [](const Light& light) { return lack_in_sun(light, "target", "spots are lamps"); }},
      Field<Light>{
          {.group = "light",
           .name = "spot-angles",
           .kind = cone,
           .placeholder = "INNER,OUTER",
           .label = "half-angles",
           .meaning =
               "half-angles of a spot's cone, up to 90: all light within the inner one, none beyond the "
               "outer one; a step where both are equal",
           .unit = "degrees",
           .note = "needs --spot-target, or a spot of the scene's",
           .usual = "the scene's, else 0,45",
           .range = k_half_angle,
           .own_key = "angles"},
          set_spot_angles,
          spot_angles_of,
          lack_of_cone},
      member_field<&Light::range>(
          {"light", "range", number, "M", "range",
           "distance from a lamp where its light ends: at r it is multiplied by 1 - (r/range)^4", "m", "",
           "the scene's; without, light reaches without limit", k_positive},
          [](const Light& light) { return lack_in_sun(light, "range", "its light has no end"); }),
      Field<Light>{
          {.group = "sun",
           .name = "sun",
           .kind = direction,
           .placeholder = "X,Y,Z",
           .label = "towards",
           .meaning = "direction towards the light, of any length, which makes it a sun",
           .note = "needs --irradiance",
           .own_key = "towards"},
          set_direction,
          [](const Light& light) { return value_of(light.towards); },
          [](const Light& light) { return lack_in_lamp(light, "direction", "give its position, or a sun"); }},
      member_field<&Light::irradiance>(
          {"sun", "irradiance", colour, "R,G,B", "irradiance",
           "of the sun, on a surface that faces it; without --fog-top its path through the medium has no "
           "length, and this is what arrives in the scene, unattenuated",
           "W/m2", "at most 1e25", "", k_irradiance},
          [](const Light& light) {
            return lack_in_lamp(light, "irradiance", "give its intensity, or a sun");
          }),
  };
  return table;
}

template <>
std::span<const Field<Medium>> fields() {
  static const std::array table = {
      member_field<&Medium::sigma_s>({"medium", "sigma-s", colour, "R,G,B", "σ_s", "scattering coefficient",
                                      "1/m", "at most 1e6", "the scene's, 0.1 for a file", k_per_metre}),
      member_field<&Medium::sigma_a>({"medium", "sigma-a", colour, "R,G,B", "σ_a", "absorption coefficient",
                                      "1/m", "at most 1e6", "the scene's, 0 for a file", k_per_metre}),
      Field<Medium>{
          {"medium", "phase", word, "NAME", "phase function", "phase function", "", "",
           "the scene's, isotropic for a file", k_any, phase_names()},
          set_phase,
          [](const Medium& medium) -> std::optional<FieldValue> { return phase_name(medium.phase); }},
      member_field<&Medium::g>({"medium", "g", number, "G", "g =",
                                "mean cosine of henyey-greenstein, between -1 and 1", "", "", "", k_cosine},
                               lack_of_g),
      member_field<&Medium::rayleigh_weight>(
          {"medium", "rayleigh-weight", number, "W", "rayleigh weight",
           "part of rayleigh in hoffman-preetham, 0 to 1; the rest is henyey-greenstein", "", "", "0.5",
           k_fraction},
          lack_of_mix),
      member_field<&Medium::top>(
          {"medium", "fog-top", number, "Y", "below y =",
           "height of the medium's top in the world, which then fills what lies below, and attenuates the "
           "sun's path through it",
           "m", "", "none: the medium fills all of space, and the sun's own path has no length", k_place}),
  };
  return table;
}

template <>
std::span<const Field<Surroundings>> fields() {
  static const std::array table = {
      member_field<&Surroundings::ambient>(
          {"", "ambient", colour, "R,G,B", "ambient",
           "radiance from all sides that surfaces reflect, in lieu of light that is scattered more than once",
           "W/(m2 sr)", "as an option also auto: fitted to scene, lights and medium",
           "0; in view dim, where the exposure is known", k_intensity}),
      member_field<&Surroundings::background>({"", "background", colour, "R,G,B", "background",
                                               "radiance beyond all surfaces, seen through the medium",
                                               "W/(m2 sr)", "", "0", k_intensity}),
  };
  return table;
}

template <>
std::span<const Field<Scene>> fields() {
  static const std::array table = {
      Field<Scene>{{"", "albedo", colour, "R,G,B", "albedo", "reflectance of every surface, 0 to 1", "",
                    "0 leaves the airlight alone", "", k_reflectance},
                   [](Scene& scene, const FieldValue& value) {
                     override_albedo(scene.geometry, std::get<glm::dvec3>(value));
                   },
                   [](const Scene& scene) {
                     const std::vector<Material>& materials = scene.geometry.materials;
                     return materials.size() == 1 ? value_of(materials[0].albedo) : std::nullopt;
                   }},
      member_field<&Scene::exposure>(
          {"", "exposure", number, "E", "exposure", "of PNG images: radiance is multiplied by it", "", "",
           "the scene's; for a file, the 95th percentile maps to 0.8", k_positive}),
      Field<Scene>{
          {"", "tone-map", word, "NAME", "tone map",
           "of PNG images: how radiance brighter than a display is shown", "", "", "none", k_any,
           tone_map_names()},
          [](Scene& scene, const FieldValue& value) {
            scene.tone_map = static_cast<ToneMap>(place_of_word(tone_map_names(), value));
          },
          [](const Scene& scene) -> std::optional<FieldValue> { return tone_map_name(scene.tone_map); }},
  };
  return table;
}

template <>
std::span<const Field<View>> fields() {
  static const std::array table = {
      member_field<&View::size>(
          {"", "size", size, "WxH", "size", "size of the image", "pixels", "", "512x512"}),
  };
  return table;
}

const FieldInfo& camera_choice() {
  static constexpr FieldInfo k_info = {
      "camera", "camera", word,
      "NAME|N", "",       "one of the scene's cameras, by name or number from 0",
      "",       "",       "the first; without one, the view is fitted"};
  return k_info;
}

const FieldInfo& light_choice() {
  static constexpr FieldInfo k_info = {
      "light",
      "light",
      word,
      "NAME|N|all",
      "",
      "one of the scene's lights, by name or number from 0, or all of them",
      "",
      "it begins a light, as --light-position, --sun and --sun-angles do: the options of lights that follow, "
      "up to the next of these, belong to it; lights given so stand in for the scene's, and what stands "
      "before "
      "them belongs to the only light",
      "all"};
  return k_info;
}

const FieldInfo& sun_angles() {
  static constexpr FieldInfo k_info = {
      .group = "sun",
      .name = "sun-angles",
      .kind = angles,
      .placeholder = "AZ,EL",
      .label = "",
      .meaning = "the same by its azimuth, from +Z towards +X, and its elevation above the horizon",
      .unit = "degrees",
      .note = "needs --irradiance",
      .range = k_elevation};
  return k_info;
}

glm::dvec3 direction_of_angles(glm::dvec2 angles) {
  const double azimuth = glm::radians(angles.x), elevation = glm::radians(angles.y);
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
          std::cos(elevation) * std::cos(azimuth)};
}

std::span<const FieldInfo* const> every_field() {
  static const std::vector<const FieldInfo*> infos = [] {
    std::vector<const FieldInfo*> list;
    const auto add = [&](auto fields) {
      for (const auto& field : fields) {
        list.push_back(&field);
        if (field.name == "sun") list.push_back(&sun_angles());
      }
    };
    list.push_back(&camera_choice());
    add(fields<Camera>());
    list.push_back(&light_choice());
    add(fields<Light>());
    add(fields<Medium>());
    add(fields<Surroundings>());
    add(fields<Scene>());
    add(fields<View>());
    return list;
  }();
  return infos;
}

const FieldInfo* find_field(std::string_view name) {
  const auto all = every_field();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const FieldInfo* field) { return field->name == name; });
  return found == all.end() ? nullptr : *found;
}

std::string FieldInfo::key() const {
  if (!own_key.empty()) return std::string(own_key);
  if (name == group) return "name";
  std::string key(name);
  const std::string prefix = fmt::format("{}-", group);
  if (key.starts_with(prefix)) key.erase(0, prefix.size());
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

std::string FieldInfo::help() const {
  std::string text(meaning);
  if (!words.empty()) text += ": " + list(words, ", ");
  if (!unit.empty()) text += fmt::format(" [{}]", unit);
  if (kind == colour) text += "; one number means grey";
  if (!note.empty()) text += fmt::format("; {}", note);
  if (!usual.empty()) text += fmt::format(" (default: {})", usual);
  return text;
}

std::optional<FieldProblem> FieldInfo::problem(const FieldValue& value) const {
  const auto wrong = [](std::string problem, std::string_view remedy = {}) {
    return FieldProblem{std::move(problem), std::string(remedy)};
  };
  if (kind == word) {
    const auto& text = std::get<std::string>(value);
    if (words.empty() || std::find(words.begin(), words.end(), text) != words.end()) return std::nullopt;
    return wrong(fmt::format("'{}' is unknown", printable(text)), "use " + list(words, " or "));
  }
  if (kind == size) {
    const auto pixels = std::get<glm::ivec2>(value);
    if (std::min(pixels.x, pixels.y) >= 1) return std::nullopt;
    return wrong(fmt::format("an image of {}x{} has no pixels", pixels.x, pixels.y));
  }
  if (kind == file) return std::nullopt;  // a LightTexture is one that can be
  if (kind == angles) {
    const auto value_of_angles = std::get<glm::dvec2>(value);
    if (!std::isfinite(value_of_angles.x)) return wrong(fmt::format("{} is not finite", value_of_angles.x));
    if (value_of_angles.y >= range.lower && value_of_angles.y <= range.upper) return std::nullopt;
    return wrong(fmt::format("the elevation {} is not between {} and {} {}", value_of_angles.y, range.lower,
                             range.upper, unit));
  }

  if (kind == cone) {
    const auto half_angles = std::get<glm::dvec2>(value);
    for (double angle : {half_angles.x, half_angles.y}) {
      if (!std::isfinite(angle)) return wrong(fmt::format("{} is not finite", angle));
      if (!(angle >= range.lower && angle <= range.upper))
        return wrong(fmt::format("the half-angle {} is not between {} and {} {}", angle, range.lower,
                                 range.upper, unit));
    }
    if (half_angles.x > half_angles.y)
      return wrong(fmt::format("the inner half-angle {} is more than the outer one, {}", half_angles.x,
                               half_angles.y));
    if (half_angles.y == 0.0) return wrong("a cone of half-angle 0 lets no light through");
    return std::nullopt;
  }

  const glm::dvec3 parts = kind == number ? glm::dvec3(std::get<double>(value)) : std::get<glm::dvec3>(value);
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(parts[i])) return wrong(fmt::format("{} is not finite", parts[i]));
    const double kept =
        is_single || kind == colour ? static_cast<double>(static_cast<float>(parts[i])) : parts[i];
    if (!std::isfinite(kept)) return wrong("it is too large");
    const bool is_inside =
        range.is_open ? kept > range.lower && kept < range.upper : kept >= range.lower && kept <= range.upper;
    if (is_inside) continue;
    if (kind == vector) return wrong(fmt::format("it is farther than {:g} m from the origin", range.upper));
    if (kind == colour && kept < range.lower) return wrong("it must not be negative");
    if (kind == colour)
      return wrong(fmt::format("it is more than {:g}{}{}", range.upper, unit.empty() ? "" : " ", unit),
                   range.why);
    if (std::isinf(range.upper)) return wrong(fmt::format("{} is not positive", parts[i]));
    return wrong(fmt::format("{} is not between {} and {}{}{}", parts[i], range.lower, range.upper,
                             unit.empty() ? "" : " ", unit));
  }
  if (kind == direction && parts == glm::dvec3(0.0)) return wrong("it has no length, and so no direction");
  return std::nullopt;
}

FieldValue value_of_text(const FieldInfo& field, const std::string& where, std::string_view text,
                         const LightTextureReader& read_light_texture) {
  switch (field.kind) {
    case number:
      return parse_number(where, text);
    case vector:
    case direction:
      return parse_vector(where, text);
    case angles:
    case cone:
      return parse_pair(where, text);
    case colour:
      return parse_colour(where, text);
    case word:
      return std::string(text);
    case file:
      return std::make_shared<const LightTexture>(read_light_texture(text));
    case size:
      return parse_size(where, text);
  }
  return {};
}

std::string text_of(const FieldValue& value) {
  struct Writer {
    std::string operator()(double v) const { return fmt::format("{}", v); }
    std::string operator()(glm::dvec2 v) const { return fmt::format("{},{}", v.x, v.y); }
    std::string operator()(glm::dvec3 v) const { return fmt::format("{},{},{}", v.x, v.y, v.z); }
    std::string operator()(const std::string& v) const { return v; }
    std::string operator()(glm::ivec2 v) const { return fmt::format("{}x{}", v.x, v.y); }
    std::string operator()(const Texture& v) const { return v->name(); }
  };
  return std::visit(Writer(), value);
}

}  // namespace airlight::scene
