#include "scene/choices.h"

#include <algorithm>
#include <initializer_list>
#include <vector>

#include <fmt/format.h>

#include "scene/import_internal.h"

namespace airlight::scene {
namespace {

/// Puts the thing of that name or number first. @throws the choices' error, which names the others
template <typename Thing>
void put_first(const Choices& choices, const FieldInfo& choice, std::vector<Thing>& things) {
  const auto& name = std::get<std::string>(*choices.get(choice));
  auto found =
      std::find_if(things.begin(), things.end(), [&](const Thing& thing) { return thing.name == name; });
  // A name is preferred to a number, which is written as it is listed here.
  std::string list;
  for (std::size_t i = 0; i < things.size(); ++i) {
    list += fmt::format("{}'{}' ({})", i == 0 ? "" : ", ", printable(things[i].name), i);
    if (found == things.end() && fmt::format("{}", i) == name)
      found = things.begin() + static_cast<std::ptrdiff_t>(i);
  }
  if (found == things.end())
    throw choices.error(choice, fmt::format("the scene has no '{}'", printable(name)),
                        list.empty() ? "it has none" : "it has " + list);
  std::rotate(things.begin(), found, found + 1);
}

void choose_camera(const Choices& choices, std::vector<Camera>& cameras, const Geometry& geometry) {
  const FieldInfo &eye = field<Camera>("eye"), &target = field<Camera>("target");
  const bool has_eye = choices.get(eye), has_target = choices.get(target);
  if (has_eye != has_target)
    throw choices.error(has_eye ? eye : target,
                        fmt::format("it needs {}", choices.spell(has_eye ? target : eye)), "give both");
  const std::string both = fmt::format("{} and {}", choices.spell(eye), choices.spell(target));
  if (choices.get(camera_choice())) {
    if (has_eye) throw choices.error(camera_choice(), both + " contradict it", "give one or the other");
    put_first(choices, camera_choice(), cameras);
  } else if (has_eye) {
    cameras.insert(cameras.begin(), Camera{.name = "of " + both});
  } else if (cameras.empty()) {
    cameras.push_back(fit_camera(geometry));
  }
  choose(choices, cameras[0]);
}

/// The first of the fields that was given; nullptr for none.
const FieldInfo* first_given(const Choices& choices, std::initializer_list<const FieldInfo*> infos) {
  const auto* const found =
      std::find_if(infos.begin(), infos.end(), [&](const FieldInfo* info) { return choices.get(*info); });
  return found == infos.end() ? nullptr : *found;
}

void choose_light(const Choices& choices, std::vector<Light>& lights) {
  const FieldInfo &position = field<Light>("light-position"), &intensity = field<Light>("intensity"),
                  &texture = field<Light>("light-texture"), &target = field<Light>("spot-target"),
                  &cone = field<Light>("spot-angles"), &range = field<Light>("range"),
                  &sun = field<Light>("sun"), &irradiance = field<Light>("irradiance");
  const auto contradiction = [&](const FieldInfo& one, const FieldInfo& other) {
    return choices.error(one, choices.spell(other) + " contradicts it", "give one or the other");
  };
  const FieldInfo* of_lamp = first_given(choices, {&position, &intensity, &texture, &target, &cone, &range});
  const FieldInfo* of_sun = first_given(choices, {&sun, &sun_angles(), &irradiance});
  if (of_lamp && of_sun) throw contradiction(*of_lamp, *of_sun);
  if (choices.get(sun) && choices.get(sun_angles())) throw contradiction(sun, sun_angles());
  const FieldInfo* place = first_given(choices, {&position, &sun, &sun_angles()});

  if (choices.get(light_choice())) {
    if (place) throw contradiction(light_choice(), *place);
    put_first(choices, light_choice(), lights);
  } else if (place) {
    const FieldInfo& power = of_sun ? irradiance : intensity;
    if (!choices.get(power)) throw choices.error(*place, "it needs " + choices.spell(power), "give both");
    lights.insert(lights.begin(), Light{.name = "of " + choices.spell(*place),
                                        .kind = of_sun ? LightKind::sun : LightKind::point});
  } else if (lights.empty()) {
    if (const FieldInfo* given = of_lamp ? of_lamp : of_sun)
      throw choices.error(
          *given, "the scene has no light",
          fmt::format("place one by {} and {}, or by {} and {}", choices.spell(position),
                      choices.spell(intensity), choices.spell(sun), choices.spell(irradiance)));
    return;
  }
  choose(choices, lights[0]);
  if (const FieldValue* angles = choices.get(sun_angles()))
    lights[0].towards = direction_of_angles(std::get<glm::dvec2>(*angles));
}

}  // namespace

void Choices::add(const FieldInfo& field, FieldValue value) {
  if (const auto wrong = field.problem(value)) throw error(field, wrong->problem, wrong->remedy);
  values_.insert_or_assign(field.name, std::move(value));
}

const FieldValue* Choices::get(const FieldInfo& field) const {
  const auto found = values_.find(field.name);
  return found == values_.end() ? nullptr : &found->second;
}

void choose_all(const Choices& choices, Scene& scene) {
  choose_camera(choices, scene.cameras, scene.geometry);
  choose_light(choices, scene.lights);
  choose(choices, scene.medium);
  choose(choices, scene);
}

}  // namespace airlight::scene
