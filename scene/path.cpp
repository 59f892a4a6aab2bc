#include "scene/path.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scene/catmull_rom.h"
#include "scene/choices.h"
#include "scene/import_internal.h"
#include "scene/toml_table.h"

namespace airlight::scene {
namespace {

/// A value that can lie between two others; none of a word or a file.
std::optional<glm::dvec3> point_of(const FieldValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return glm::dvec3(*number, 0.0, 0.0);
  if (const auto* pair = std::get_if<glm::dvec2>(&value)) return glm::dvec3(*pair, 0.0);
  if (const auto* three = std::get_if<glm::dvec3>(&value)) return *three;
  return std::nullopt;
}

FieldValue value_at(FieldKind kind, const glm::dvec3& point) {
  if (kind == FieldKind::number) return point.x;
  if (kind == FieldKind::angles || kind == FieldKind::cone) return glm::dvec2(point);
  return point;
}

bool is_movable(FieldKind kind) {
  return kind != FieldKind::word && kind != FieldKind::file && kind != FieldKind::size;
}

/// What moves a camera or a light.
template <typename Thing>
class Track {
 public:
  /// Reads a key from the table, whose group is that of some of the thing's fields.
  void add(Table& key, std::string_view group, double seconds, const Thing& thing) {
    const auto time = key.number("time");
    if (!time) throw key.error("time", "it is missing", "say when, in seconds");
    if (!(*time >= 0.0 && *time <= seconds))
      throw key.error("time", fmt::format("{} is not between 0 and {} seconds", *time, seconds));
    const auto [last, is_first] = last_times_.emplace(group, *time);
    if (!is_first && *time <= last->second)
      throw key.error("time", fmt::format("{} is not later than the key before, at {}", *time, last->second));
    last->second = *time;
    for (const Field<Thing>& field : fields<Thing>()) {
      if (field.group != group || !is_movable(field.kind)) continue;
      auto value = key.value(field, {});
      const FieldInfo* given = &field;
      if constexpr (std::is_same_v<Thing, Light>) {
        if (field.kind == FieldKind::direction && field.group == sun_angles().group) {
          const auto angles = key.value(sun_angles(), {});
          if (angles && value) throw key.error(field.key(), sun_angles().key() + " contradicts it");
          if (angles) {
            given = &sun_angles();
            value = angles;
          }
        }
      }
      if (!value) continue;
      auto wrong = given->problem(*value);
      if (!wrong && field.lack) wrong = field.lack(thing);
      if (wrong) throw key.error(given->key(), wrong->problem, wrong->remedy);
      if (given != &field) value = direction_of_angles(std::get<glm::dvec2>(*value));
      glm::dvec3 point = *point_of(*value);
      if (field.kind == FieldKind::direction) point = unit(point);
      curves_[&field].add(*time, point);
    }
    key.refuse_others();
  }

  /// Moves the thing to where it is at a time.
  /// @returns what is wrong there
  std::optional<std::string> move(Thing& thing, double time) {
    for (const Field<Thing>& field : fields<Thing>()) {
      const auto curve = curves_.find(&field);
      if (curve == curves_.end()) continue;
      glm::dvec3 point = curve->second.at(time);
      if (field.kind == FieldKind::colour) {
        const glm::dvec3 kept = glm::max(point, glm::dvec3(0.0));
        if (kept != point) ++frames_below_0_[&field];
        point = kept;
      }
      if (const auto wrong = field.set(thing, value_at(field.kind, point)))
        return fmt::format("{}: {}", field.key(), wrong->problem);
    }
    return std::nullopt;
  }

  /// Calls `visit(field, frames)` for each colour that was taken below 0.
  template <typename Visit>
  void for_each_below_0(const Visit& visit) const {
    for (const auto& [field, frames] : frames_below_0_) visit(*field, frames);
  }

 private:
  std::map<const Field<Thing>*, CatmullRom> curves_;
  std::map<const Field<Thing>*, int> frames_below_0_;
  std::map<std::string_view, double> last_times_;  ///< by group
};

/// Of lights in a view that no one has named, their numbers.
std::vector<std::string> names_of(const std::vector<Light>& lights) {
  std::vector<std::string> names;
  for (const Light& light : lights)
    names.push_back(light.name.empty() ? fmt::format("light{}", names.size()) : light.name);
  return names;
}

/// Which of the view's lights a key is of.
std::size_t light_of(Table& key, std::span<const std::string> names) {
  const auto name = key.text("name");
  if (!name) {
    if (names.size() > 1)
      throw key.error("name", "the view has several lights", "name one of " + list_of_names(names));
    return 0;
  }
  const auto found = find_named(names, *name);
  if (!found)
    throw key.error("name", fmt::format("the view has no light '{}'", printable(*name)),
                    "it has " + list_of_names(names));
  return *found;
}

/// The tables of a light's keys: the groups of its fields.
std::set<std::string_view> light_groups() {
  std::set<std::string_view> groups;
  for (const Field<Light>& field : fields<Light>()) groups.insert(field.group);
  return groups;
}

}  // namespace

double Path::time(std::size_t frame) const {
  return views.size() < 2 ? 0.0
                          : seconds * static_cast<double>(frame) / static_cast<double>(views.size() - 1);
}

std::string frame_ending(std::size_t frame) {
  return fmt::format("_{:04}", frame);
}

Path load_path(const std::filesystem::path& file, const View& view) {
  const toml::table content = read_toml(file);
  Table root(file, content);
  const auto required = [&](const auto& value, const char* key) {
    if (!value) throw file_error(file, key, "it is missing", "a path has frames and seconds");
    return *value;
  };
  const std::size_t frames = required(root.count("frames"), "frames");
  if (frames > k_most_frames)
    throw root.error("frames", fmt::format("{} are more than {}", frames, k_most_frames));
  Path path{.seconds = required(root.number("seconds"), "seconds"), .views = {frames, view}, .warnings = {}};
  if (!(path.seconds > 0.0 && path.seconds < 1e9))
    throw root.error("seconds", fmt::format("{} is not between 0 and 1e9", path.seconds));

  // The keys.
  Track<Camera> of_camera;
  std::vector<Track<Light>> of_lights(view.lights.size());
  const std::vector<std::string> names = names_of(view.lights);
  for (Table& key : root.tables("camera")) of_camera.add(key, "camera", path.seconds, view.camera);
  for (const std::string_view group : light_groups()) {
    for (Table& key : root.tables(group)) {
      const std::size_t light = light_of(key, names);
      of_lights[light].add(key, group, path.seconds, view.lights[light]);
    }
  }
  root.refuse_others();

  // The frames.
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const double time = path.time(frame);
    View& moved = path.views[frame];
    const auto error = [&](const std::string& problem) {
      return file_error(file, fmt::format("frame {} ({:g} s)", frame, time), problem);
    };
    if (const auto wrong = of_camera.move(moved.camera, time)) throw error("camera." + *wrong);
    for (std::size_t light = 0; light < of_lights.size(); ++light)
      if (const auto wrong = of_lights[light].move(moved.lights[light], time))
        throw error(fmt::format("{}, {}", names[light], *wrong));
    try {
      validate(moved);
    } catch (const Error& problem) {
      throw error(problem.what());
    }
  }
  for (std::size_t light = 0; light < of_lights.size(); ++light) {
    of_lights[light].for_each_below_0([&](const FieldInfo& field, int count) {
      path.warnings.push_back(
          fmt::format("{}: the curve of {}'s {} goes below 0: it is 0 there, in frames: {}", file.string(),
                      names[light], field.key(), count));
    });
  }
  return path;
}

std::string_view motion_name(Motion motion) {
  static constexpr std::array<std::string_view, 4> k_names = {"nothing", "camera", "lights", "all"};
  return k_names[static_cast<std::size_t>(motion)];
}

Motion motion_between(const View& before, const View& after) {
  const bool lights_rest = std::equal(before.lights.begin(), before.lights.end(), after.lights.begin(),
                                      after.lights.end(), shine_alike);
  if (before.camera == after.camera) return lights_rest ? Motion::nothing : Motion::lights;
  return lights_rest ? Motion::camera : Motion::all;
}

}  // namespace airlight::scene
