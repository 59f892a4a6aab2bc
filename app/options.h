#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "quality/first_look.h"
#include "quality/methods.h"
#include "scene/path.h"
#include "scene/scene.h"

namespace airlight::app {

/// One option of the command line that takes a value.
struct OptionLine {
  std::string_view name;         ///< without the dashes
  std::string_view placeholder;  ///< what stands for the value in the help
  std::string help;
};

/// What `render`, `compare` and `sweep` share.
std::span<const OptionLine> common_options();

/// The command line of a command as it was typed.
struct Options {
  std::string command;  ///< "render", "compare" or "sweep"
  std::string scene;    ///< SCENE
  /// Each option that was typed, by its name without dashes, and its value, in their order: those of lights
  /// may be there several times.
  std::vector<std::pair<std::string, std::string>> given;
  std::vector<std::string> places;  ///< DIR of `front` and `report`, words of `image`
  std::string output;               ///< -o; empty without
  std::string tev;                  ///< of `render` and `compare`: where a tev listens; empty without
  bool quiet = false;
  bool debug = false;    ///< of `compare`
  bool all = false;      ///< of `sweep`
  bool explain = false;  ///< of `tune`

  /// Of an option that is no light's.
  std::optional<std::string> get(std::string_view name) const {
    for (const auto& [given_name, value] : given)
      if (given_name == name) return value;
    return std::nullopt;
  }

  /// The command line again, ready for a shell, without -o and the options named.
  std::string command_line(std::span<const std::string> without) const;
};

/// A scene and what one image shows of it.
struct Subject {
  scene::Scene scene;
  scene::View view;
  std::optional<float> exposure;    ///< asked for or brought by the scene; else automatic
  std::optional<scene::Path> path;  ///< its first view is `view`

  /// The path's, or the one.
  std::span<const scene::View> views() const {
    return path ? std::span<const scene::View>(path->views) : std::span(&view, 1);
  }

  /// How many copies of the scene are held: where objects move, at rest and where they are.
  int scenes() const { return path && path->moves_objects() ? 2 : 1; }
};

/// The scene as its file or its maker has it.
/// @throws scene::Error (usage, bad_file)
scene::Scene load_scene(const Options& options);

/// Loads the scene and makes all choices of the view.
/// @throws scene::Error (usage, bad_file)
Subject make_subject(const Options& options);

/// The options that are meant for every method that has them. @throws scene::Error (usage)
std::vector<quality::CommonOption> common_method_options(const Options& options);

/// The methods of --volume or --surface, or the usual ones.
std::vector<quality::VolumeChoice> parse_volumes(const Options& options, std::string_view usual);
std::vector<quality::SurfaceChoice> parse_surfaces(const Options& options);

/// Takes the methods that the scene is best shown by, or where light passes its triangles such as show that,
/// for those that the user did not choose.
/// @throws scene::Error (usage) as parse_volumes and require_read
void take_usual_methods(const Options& options, const Subject& subject,
                        std::vector<quality::VolumeChoice>& volumes,
                        std::vector<quality::SurfaceChoice>& surfaces, int& shadow_map);

/// @throws scene::Error (usage) for an option given that is meant for methods and that none of these reads
void require_read(const Options& options, std::span<const quality::VolumeChoice> volumes,
                  std::span<const quality::SurfaceChoice> surfaces);

/// Fits methods to the view; what counts are automatic, quality::take_first_looks makes fewer.
/// @throws scene::Error (usage) where a method asked for cannot show it
quality::AutomaticCounts fit_to_view(std::vector<quality::VolumeChoice>& volumes,
                                     std::vector<quality::SurfaceChoice>& surfaces, Subject& subject);

/// The command of one pair of methods, but -o. What neither reads is left out.
/// @param without names of options that the command does not have
std::string command_of_pair(const Options& options, const quality::VolumeChoice& volume,
                            const quality::SurfaceChoice& surface, std::vector<std::string> without);

/// -o, or out/ and the scene's name.
std::filesystem::path output_folder(const Options& options);

/// What comparing takes of a pixel: see require_memory.
std::size_t bytes_of_compare(const Subject& subject);

/// --shadow-map [texels]
int shadow_map_size(const Options& options);

}  // namespace airlight::app
