#include "scene/choices.h"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "scene/import_internal.h"

namespace airlight::scene {
namespace {

constexpr std::string_view k_all_lights = "all";

template <typename Things>
std::vector<std::string> names_of(const Things& things) {
  std::vector<std::string> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

/// The place of the thing of that name or number. @throws the choices' error, which names the others
template <typename Thing>
std::size_t find(const Choices& choices, const FieldInfo& choice, const std::vector<Thing>& things) {
  const auto& name = std::get<std::string>(*choices.get(choice));
  const std::vector<std::string> names = names_of(things);
  const auto found = find_named(names, name);
  if (!found)
    throw choices.error(choice, fmt::format("the scene has no '{}'", printable(name)),
                        names.empty() ? "it has none" : "it has " + list_of_names(names));
  return *found;
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
    const auto chosen =
        cameras.begin() + static_cast<std::ptrdiff_t>(find(choices, camera_choice(), cameras));
    std::rotate(cameras.begin(), chosen, chosen + 1);
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

/// Gives each light a name that no other has: a number to those without one, another to those whose name is
/// taken.
void name_lights(std::vector<Light>& lights) {
  std::set<std::string> taken;
  const auto name = [&](Light& light, const std::string& before, std::size_t number) {
    while (!taken.insert(light.name).second) light.name = fmt::format("{}{}", before, number++);
  };
  for (Light& light : lights)
    if (!light.name.empty()) name(light, light.name + "_", 2);
  taken.insert("");
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (lights[i].name.empty()) name(lights[i], "light", i);
}

bool has(const std::vector<Light>& lights, const std::string& name) {
  return std::any_of(lights.begin(), lights.end(), [&](const Light& light) { return light.name == name; });
}

/// The lights that one light's choices make: a new one, or some of those that the scene brings.
/// @param on those of them that are on
std::vector<Light> choose_light(const Choices& choices, const std::vector<Light>& brought,
                                std::span<const Light> on) {
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

  std::vector<Light> chosen;
  if (const FieldValue* choice = choices.get(light_choice())) {
    if (place) throw contradiction(light_choice(), *place);
    if (std::get<std::string>(*choice) == k_all_lights && !on.empty())
      chosen.assign(on.begin(), on.end());
    else
      chosen = {brought[find(choices, light_choice(), brought)]};
  } else if (place) {
    const FieldInfo& power = of_sun ? irradiance : intensity;
    if (!choices.get(power)) throw choices.error(*place, "it needs " + choices.spell(power), "give both");
    chosen = {Light{.name = {}, .kind = of_sun ? LightKind::sun : LightKind::point}};
  } else {
    const auto all = every_field();
    const auto first =
        std::find_if(all.begin(), all.end(), [&](const FieldInfo* info) { return choices.get(*info); });
    const FieldInfo& given = first == all.end() ? light_choice() : **first;
    if (on.empty())
      throw choices.error(
          given, "the scene has no light",
          fmt::format("place one by {} and {}, or by {} and {}", choices.spell(position),
                      choices.spell(intensity), choices.spell(sun), choices.spell(irradiance)));
    if (on.size() > 1)
      throw choices.error(given, fmt::format("the scene has several lights, {}", list_of_names(names_of(on))),
                          fmt::format("say which one is meant by {}", choices.spell(light_choice())));
    chosen.assign(on.begin(), on.end());
  }
  for (Light& light : chosen) {
    choose(choices, light);
    if (const FieldValue* angles = choices.get(sun_angles()))
      light.towards = direction_of_angles(std::get<glm::dvec2>(*angles));
  }
  return chosen;
}

void choose_lights(std::span<const std::unique_ptr<const Choices>> choices, Scene& scene) {
  std::vector<Light> brought = scene.lights;
  brought.insert(brought.end(), scene.other_lights.begin(), scene.other_lights.end());
  name_lights(brought);
  const std::span on(brought.begin(), scene.lights.size());
  std::vector<Light> lights;
  if (choices.empty()) lights.assign(on.begin(), on.end());
  for (const auto& of_light : choices) {
    for (Light& light : choose_light(*of_light, brought, on)) {
      if (!light.name.empty() && has(lights, light.name))
        throw of_light->error(light_choice(),
                              fmt::format("the light '{}' is chosen twice", printable(light.name)),
                              "choose it once");
      lights.push_back(std::move(light));
    }
  }
  // Those that are new are named, too.
  const auto count = static_cast<std::ptrdiff_t>(lights.size());
  std::copy_if(brought.begin(), brought.end(), std::back_inserter(lights),
               [&](const Light& light) { return !has(lights, light.name); });
  name_lights(lights);
  scene.lights.assign(lights.begin(), lights.begin() + count);
  scene.other_lights.assign(lights.begin() + count, lights.end());
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

std::optional<std::size_t> find_named(std::span<const std::string> names, const std::string& text) {
  std::optional<std::size_t> of_number;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == text) return i;
    if (fmt::format("{}", i) == text) of_number = i;
  }
  return of_number;
}

std::string list_of_names(std::span<const std::string> names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i)
    list += fmt::format("{}'{}' ({})", i == 0 ? "" : ", ", printable(names[i]), i);
  return list;
}

bool is_of_light(const FieldInfo& field) {
  return field.group == light_choice().group || field.group == sun_angles().group;
}

bool names_light(const FieldInfo& field) {
  return field.name == light_choice().name || field.name == "light-position" || field.name == "sun" ||
         field.name == sun_angles().name;
}

void choose_all(const Choices& choices, std::span<const std::unique_ptr<const Choices>> lights,
                Scene& scene) {
  choose_camera(choices, scene.cameras, scene.geometry);
  choose_lights(lights, scene);
  choose(choices, scene.medium);
  choose(choices, scene.surroundings);
  choose(choices, scene);
}

}  // namespace airlight::scene
