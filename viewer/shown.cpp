#include "viewer/shown.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "quality/results.h"
#include "scene/choices.h"
#include "scene/view_fields.h"

namespace airlight::viewer {
namespace {

/// A light's values, what makes it what it is first.
std::vector<std::pair<const scene::FieldInfo*, std::string>> values_of(const scene::Light& light) {
  std::vector<std::pair<const scene::FieldInfo*, std::string>> values;
  scene::for_each_value(light, [&](const scene::FieldInfo& field, const scene::FieldValue& value) {
    values.emplace_back(&field, scene::text_of(value));
  });
  std::stable_partition(values.begin(), values.end(),
                        [](const auto& value) { return scene::names_light(*value.first); });
  return values;
}

std::string in_quotes(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

/// A field's line of a TOML file: words in quotes, numbers in brackets where there are several.
std::string toml_line(const scene::FieldInfo& field, const std::string& text) {
  std::string value = text;
  if (field.kind == scene::FieldKind::word || field.kind == scene::FieldKind::file) {
    value = in_quotes(text);
  } else if (text.find(',') != std::string::npos) {
    value.assign(1, '[');
    for (const char c : text) value += c == ',' ? std::string(", ") : std::string(1, c);
    value += ']';
  }
  return fmt::format("{} = {}\n", field.key(), value);
}

}  // namespace

template <typename MethodType>
std::string spec_of(const quality::Choice<MethodType>& choice) {
  std::string spec(choice.method->name);
  const void* options = choice.method->const_address(choice.options);
  const void* defaults = choice.method->const_address(choice.method->defaults);
  for (const frame::Option& option : choice.method->options)
    if (option.get(options) != option.get(defaults))
      spec += fmt::format(":{}={}", option.text.name, frame::text_of(option.get(options)));
  return spec;
}
template std::string spec_of(const quality::VolumeChoice&);
template std::string spec_of(const quality::SurfaceChoice&);

std::string command_of(const SceneName& scene, const Shown& shown, const std::string& output) {
  std::string command = fmt::format("airlight render {}", quality::shell_quote(scene.spec));
  const auto add = [&](std::string_view name, const std::string& value) {
    // As one word: a value may begin with a minus.
    command += fmt::format(" --{}={}", name, quality::shell_quote(value));
  };
  if (scene.triangles) add("triangles", *scene.triangles);
  if (scene.albedo) add("albedo", *scene.albedo);
  if (scene.looks) add("looks", *scene.looks);
  if (scene.occluders) add("occluders", *scene.occluders);
  scene::for_each_value_of_view(
      shown.view, [&](std::string_view, const scene::FieldInfo& field, const scene::FieldValue& value) {
        add(field.name, scene::text_of(value));
      });
  for (const scene::Light& light : shown.view.lights)
    for (const auto& [field, text] : values_of(light)) add(field->name, text);
  if (shown.exposure) add("exposure", fmt::format("{}", *shown.exposure));
  add("tone-map", scene::tone_map_name(shown.tone_map));
  if (quality::is_read("shadow-map", {&shown.volume, 1}, {&shown.surface, 1}))
    add("shadow-map", fmt::format("{}", shown.shadow_map));
  add("volume", spec_of(shown.volume));
  add("surface", spec_of(shown.surface));
  return fmt::format("{} -o {}", command, quality::shell_quote(output));
}

bool are_same_lights(std::span<const scene::Light> a, std::span<const scene::Light> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& one, const auto& other) {
    return one.name == other.name && one.kind == other.kind;
  });
}

std::string path_of(std::span<const PathKey> keys, std::span<const scene::Light> lights) {
  const double seconds = std::max(keys.back().time, 1.0);
  std::string path =
      fmt::format("frames = {}\nseconds = {}\n", static_cast<int>(std::lround(30.0 * seconds)) + 1, seconds);
  for (const PathKey& key : keys) {
    path += fmt::format("\n[[camera]]\ntime = {}\n", key.time);
    scene::for_each_value(key.camera, [&](const scene::FieldInfo& field, const scene::FieldValue& value) {
      path += toml_line(field, scene::text_of(value));
    });
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    std::vector<const scene::Field<scene::Light>*> changed;
    for (const scene::Field<scene::Light>& field : scene::fields<scene::Light>()) {
      const auto differs = [&](const PathKey& key) {
        return field.get(key.lights[i]) != field.get(lights[i]);
      };
      // A texture's file lies between no two others.
      if (field.kind != scene::FieldKind::file && std::any_of(keys.begin(), keys.end(), differs))
        changed.push_back(&field);
    }
    if (changed.empty()) continue;
    for (const PathKey& key : keys) {
      path += fmt::format("\n[[{}]]\n", changed[0]->group);
      if (lights.size() > 1) path += fmt::format("name = \"{}\"\n", i);
      path += fmt::format("time = {}\n", key.time);
      for (const scene::Field<scene::Light>* field : changed)
        if (const auto value = field->get(key.lights[i])) path += toml_line(*field, scene::text_of(*value));
    }
  }
  return path;
}

std::string shot_of(const SceneName& scene, const Shown& shown) {
  std::string shot = fmt::format("scene = {}\n", in_quotes(scene.spec));
  if (scene.triangles) shot += fmt::format("triangles = {}\n", *scene.triangles);
  if (shown.exposure) shot += fmt::format("exposure = {}\n", *shown.exposure);
  if (scene.albedo) shot += toml_line(scene::field<scene::Scene>("albedo"), *scene.albedo);
  shot += toml_line(scene::field<scene::Scene>("tone-map"), scene::tone_map_name(shown.tone_map));
  // What belongs to no table stands before all of them.
  std::string tables;
  std::string_view table;
  scene::for_each_value_of_view(
      shown.view, [&](std::string_view part, const scene::FieldInfo& field, const scene::FieldValue& value) {
        if (field.kind == scene::FieldKind::size) return;  // an image's size is no part of a shot
        if (!part.empty() && part != table) tables += fmt::format("\n[{}]\n", part);
        table = part;
        (part.empty() ? shot : tables) += toml_line(field, scene::text_of(value));
      });
  shot += tables;
  for (const scene::Light& light : shown.view.lights) {
    shot += shown.view.lights.size() > 1 ? "\n[[light]]\n"
            : scene::is_sun(light)       ? "\n[sun]\n"
                                         : "\n[light]\n";
    for (const auto& [field, text] : values_of(light)) shot += toml_line(*field, text);
  }
  return shot;
}

}  // namespace airlight::viewer
