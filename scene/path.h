#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace airlight::scene {

/// Views at equal steps of time, in which camera, lights and objects move.
struct Path {
  double seconds = 0.0;               ///< from the first view to the last
  std::vector<View> views;            ///< at least one; each is one that `validate` lets pass
  std::vector<std::string> warnings;  ///< one line each

  /// Whether it moves objects of the scene: the poses of its views are of the same ones.
  bool moves_objects() const { return views.front().pose.objects != nullptr; }

  /// Of a view, from the first on [s]: frame / (frames − 1) of all seconds; 0 of a single one.
  double time(std::size_t frame) const;
};

/// What ends the names of files of a path's frame, before the format: "_0007".
std::string frame_ending(std::size_t frame);

inline constexpr std::size_t k_most_frames = 10000;

/// Reads a path, a TOML file that says where camera, lights and a model's nodes are when:
///
///     frames = 32                # how many images show it
///     seconds = 8
///     [[camera]]                 # a key: where the camera is at a time
///     time = 0                   # [s], from 0 to `seconds`, later than the key before
///     eye = [0, 1, 4]            # as in a shot, as are target, up and fov
///     target = [0, 1, 0]
///     [[light]]                  # a key of a lamp
///     name = "lamp"              # or its number in the view, from 0; needless where there is one light
///     time = 2.5
///     position = [0, 1.85, 0]    # as in a shot, as is intensity
///     [[sun]]                    # the same of a sun: towards or angles, irradiance
///     [[node]]                   # a key of a node of a glTF file, which moves with all that hangs on it
///     name = "door"              # or its number in the file, from 0
///     time = 1
///     translation = [2, 0, 0]    # within its parent, in the place of the file's [m]
///     rotation = [0, 0.6, 0, 0.8]    # the same: x, y, z and w of a quaternion of unit length, as in glTF
///
/// A key gives what it gives: each of these goes along a curve of its own (CatmullRom) through the keys that
/// give it, rests before the first and after the last of them, and is the view's where none does. A sun's
/// direction is brought back to unit length, and so is a rotation, which goes the shorter way from a key to
/// the next. Colours that a curve takes below 0 are 0 there; a warning counts the frames. A node's scale
/// stays the file's; cameras and lights that hang on it stay where they are, of which a warning tells.
/// @param view what the path starts from: all that it does not move is the view's
/// @param scene whose nodes may move; nullptr of none
/// @throws Error (bad_file) with file, line and key; with file and frame for a view that `validate` refuses,
/// for a node whose motion is not rigid, because one that it hangs on is scaled unevenly, and for one that
/// leaves single precision
Path load_path(const std::filesystem::path& file, const View& view, const Scene* scene = nullptr);

/// What has moved from one view to the next.
enum class Motion {
  nothing,
  camera,
  lights,
  all,      ///< both, and no object
  objects,  ///< and whatever else
};

/// The most restless first, the order of tables.
inline constexpr std::array k_motions = {Motion::objects, Motion::all, Motion::lights, Motion::camera,
                                         Motion::nothing};

/// "nothing", "camera", "lights", "all" or "objects".
std::string_view motion_name(Motion motion);

/// A light that is brighter or darker has not moved. Both views are of one path.
Motion motion_between(const View& before, const View& after);

}  // namespace airlight::scene
