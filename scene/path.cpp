#include "scene/path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
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

/// When a key is [s]. @param last when the last one of the same thing was; none before its first
double time_of(Table& key, double seconds, std::optional<double>& last) {
  const auto time = key.number("time");
  if (!time) throw key.error("time", "it is missing", "say when, in seconds");
  if (!(*time >= 0.0 && *time <= seconds))
    throw key.error("time", fmt::format("{} is not between 0 and {} seconds", *time, seconds));
  if (last && *time <= *last)
    throw key.error("time", fmt::format("{} is not later than the key before, at {}", *time, *last));
  last = *time;
  return *time;
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
    const double time = time_of(key, seconds, last_times_[group]);
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
      curves_[&field].add(time, point);
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
  std::map<std::string_view, std::optional<double>> last_times_;  ///< by group
};

/// What moves a node.
class NodeTrack {
 public:
  void add(Table& key, double seconds) {
    const double time = time_of(key, seconds, last_time_);
    if (const auto translation = key.three_numbers("translation")) {
      if (!std::isfinite(translation->x + translation->y + translation->z))
        throw key.error("translation", "it is not finite");
      translation_.add(time, *translation);
      moves_ = true;
    }
    if (const auto numbers = key.four_numbers("rotation")) {
      glm::dquat rotation(numbers->w, numbers->x, numbers->y, numbers->z);
      if (!is_unit_quaternion(rotation))
        throw key.error("rotation", fmt::format("it is not a unit quaternion: its length is {:g}",
                                                glm::length(rotation)));
      // Both signs mean one rotation: the one nearer to the last key's is the shorter way.
      if (last_rotation_ && glm::dot(*last_rotation_, rotation) < 0.0) rotation = -rotation;
      last_rotation_ = rotation;
      rotation_axis_.add(time, {rotation.x, rotation.y, rotation.z});
      rotation_cosine_.add(time, glm::dvec3(rotation.w, 0.0, 0.0));
    }
    key.refuse_others();
  }

  /// Moves the node to where it is at a time.
  /// @returns what is wrong there
  std::optional<std::string> move(Node& node, double time) const {
    if (moves_) node.translation = translation_.at(time);
    if (!last_rotation_) return std::nullopt;
    const glm::dquat rotation(rotation_cosine_.at(time).x, rotation_axis_.at(time));
    if (!(glm::length(rotation) > 1e-3)) return "it has no rotation there; give it more keys";
    node.rotation = glm::normalize(rotation);
    return std::nullopt;
  }

 private:
  CatmullRom translation_, rotation_axis_, rotation_cosine_;  ///< of a quaternion x, y, z, and w
  bool moves_ = false;                                        ///< `translation_` has a key
  std::optional<glm::dquat> last_rotation_;
  std::optional<double> last_time_;
};

/// The motion from where one matrix takes a node to where another does.
/// @returns none where that is not rigid
std::optional<Rigid> motion_of(const glm::dmat4& before, const glm::dmat4& after) {
  glm::dmat4 matrix = after * glm::inverse(before);
  const auto distance_from_rotations = [](const glm::dmat3& m) {
    const glm::dmat3 off = glm::transpose(m) * m - glm::dmat3(1.0);
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum += std::abs(off[i][j]);
    return sum;
  };
  // Matrices of files are in single precision: those that are rotations but for that are brought back to one.
  const double off = distance_from_rotations(glm::dmat3(matrix));
  if (!(off <= 1e-6) /* NaN among them */ || glm::determinant(glm::dmat3(matrix)) < 0.0) return std::nullopt;
  if (off > 1e-13) {
    const glm::dmat3 turn = glm::mat3_cast(glm::normalize(glm::quat_cast(glm::dmat3(matrix))));
    for (int i = 0; i < 3; ++i) matrix[i] = glm::dvec4(turn[i], 0.0);
  }
  matrix[0].w = matrix[1].w = matrix[2].w = 0.0;
  matrix[3].w = 1.0;
  return Rigid{matrix};
}

/// What moves nodes of a scene, each of which with all that hangs on it is an object.
class NodeTracks {
 public:
  /// @param scene nullptr for none
  explicit NodeTracks(const Scene* scene) : scene_(scene) {
    if (!scene) return;
    for (const Node& node : scene->nodes)
      names_.push_back(node.name.empty() ? fmt::format("node{}", names_.size()) : printable(node.name));
  }

  void add(Table& key, double seconds) { tracks_[node_of(key)].add(key, seconds); }

  /// Once all keys are there: the objects; nullptr for none.
  std::shared_ptr<const Objects> objects() const {
    if (tracks_.empty()) return nullptr;
    auto objects = std::make_shared<Objects>();
    std::vector<std::uint32_t> moved;
    for (const auto& [node, track] : tracks_) {
      moved.push_back(node);
      objects->names.push_back(names_[node]);
    }
    const std::vector<std::uint32_t> of_node = nearest_of(scene_->nodes, moved);
    for (const std::uint32_t node : scene_->geometry.node_of_triangle)
      objects->of_triangle.push_back(of_node[node]);
    return objects;
  }

  /// Of each object at a time, from where the scene has it. `problem` is called with what is wrong there.
  template <typename Problem>
  std::vector<Rigid> motions(double time, const Problem& problem) const {
    std::vector<Node> nodes = scene_->nodes;
    for (const auto& [node, track] : tracks_)
      if (const auto wrong = track.move(nodes[node], time)) throw problem(names_[node], *wrong);
    std::vector<Rigid> motions;
    for (const auto& [node, track] : tracks_) {
      const glm::dmat4 before = world_from_node(scene_->nodes, node), after = world_from_node(nodes, node);
      // Exactly nothing, not nearly.
      if (before == after) {
        motions.emplace_back();
        continue;
      }
      const auto motion = motion_of(before, after);
      if (!motion)
        throw problem(names_[node],
                      "its motion is not rigid, because what it hangs on is scaled unevenly, or to nothing");
      motions.push_back(*motion);
    }
    return motions;
  }

  /// Says so of each node that leaves cameras or lights behind.
  void warn(const std::filesystem::path& file, std::vector<std::string>& warnings) const {
    for (const auto& [node, track] : tracks_) {
      const std::vector<std::uint32_t> below = nearest_of(scene_->nodes, std::span(&node, 1));
      std::size_t left = 0;
      for (std::size_t i = 0; i < below.size(); ++i)
        if (below[i] != 0) left += scene_->nodes[i].cameras_and_lights;
      if (left > 0)
        warnings.push_back(
            fmt::format("{}: cameras and lights that hang on '{}' and stay where they are; keys of their own "
                        "move them: {}",
                        file.string(), names_[node], left));
    }
  }

 private:
  /// Which of the scene's nodes a key is of.
  std::uint32_t node_of(Table& key) const {
    const auto name = key.text("name");
    if (!name) throw key.error("name", "it is missing", "say which node moves");
    if (names_.empty())
      throw key.error("name", "the scene has no nodes", "those of .gltf and .glb files can be moved");
    const auto found = find_named(names_, *name);
    if (!found) {
      constexpr std::size_t k_listed = 20;
      const std::size_t more = names_.size() - std::min(names_.size(), k_listed);
      throw key.error("name", fmt::format("the scene has no node '{}'", printable(*name)),
                      fmt::format("it has {}{}", list_of_names(std::span(names_).first(names_.size() - more)),
                                  more > 0 ? fmt::format(" and {} others", more) : ""));
    }
    if (names_[*found] == *name && std::count(names_.begin(), names_.end(), *name) > 1)
      throw key.error("name", fmt::format("several nodes are called '{}'", printable(*name)),
                      fmt::format("give the number of one: the first is {}", *found));
    const auto node = static_cast<std::uint32_t>(*found);
    const Node& chosen = scene_->nodes[node];
    if (!chosen.is_shown) throw key.error("name", "it does not belong to the scene that the file shows");
    if (chosen.matrix)
      throw key.error("name", "the file places it by a matrix, not by translation and rotation",
                      "export it with these");
    if (!tracks_.contains(node) && !holds_triangles(node))
      throw key.error("name", "nothing that is seen hangs on it: there is nothing to move");
    return node;
  }

  bool holds_triangles(std::uint32_t node) const {
    const std::vector<std::uint32_t> below = nearest_of(scene_->nodes, std::span(&node, 1));
    const std::vector<std::uint32_t>& of_triangle = scene_->geometry.node_of_triangle;
    return std::any_of(of_triangle.begin(), of_triangle.end(),
                       [&](std::uint32_t each) { return below[each] != 0; });
  }

  const Scene* scene_;
  std::vector<std::string> names_;  ///< of all nodes
  std::map<std::uint32_t, NodeTrack> tracks_;
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

Path load_path(const std::filesystem::path& file, const View& view, const Scene* scene) {
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
  NodeTracks of_nodes(scene);
  for (Table& key : root.tables("node")) of_nodes.add(key, path.seconds);
  root.refuse_others();
  const std::shared_ptr<const Objects> objects = of_nodes.objects();
  of_nodes.warn(file, path.warnings);

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
    if (objects) {
      moved.pose.objects = objects;
      moved.pose.motions = of_nodes.motions(time, [&](const std::string& node, const std::string& wrong) {
        return error(fmt::format("node '{}': {}", node, wrong));
      });
    }
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
  static constexpr std::array<std::string_view, 5> k_names = {"nothing", "camera", "lights", "all",
                                                              "objects"};
  return k_names[static_cast<std::size_t>(motion)];
}

Motion motion_between(const View& before, const View& after) {
  if (before.pose != after.pose) return Motion::objects;
  const bool lights_rest = std::equal(before.lights.begin(), before.lights.end(), after.lights.begin(),
                                      after.lights.end(), shine_alike);
  if (before.camera == after.camera) return lights_rest ? Motion::nothing : Motion::lights;
  return lights_rest ? Motion::camera : Motion::all;
}

}  // namespace airlight::scene
