#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "quality/image_io.h"
#include "reference/reference.h"
#include "scene/scene.h"

namespace airlight::quality {

/// Of positions and triangles: FNV-1a, the same on every machine.
std::string hash_of_geometry(const scene::Geometry& geometry);

/// All of a view that one of its lights' airlight and shadows depend on, with every bit of each number.
std::string words_of_view(const scene::View& view, std::size_t light);

/// The truth of a view, kept on disk so that nothing is traced twice: one OpenEXR file an image, named by a
/// hash of everything that it depends on, `reference::k_truth_version` included. Two programs may use one
/// folder at the same time.
class TruthCache {
 public:
  /// @param folder made where it is missing; @param geometry where the view has it, kept by reference
  /// @throws scene::Error (bad_file) where it cannot be made
  TruthCache(std::filesystem::path folder, const scene::Geometry& geometry, const scene::View& view);

  // Of one of the view's lights; nothing where the image is not there yet.
  // @throws scene::Error (bad_file) where a file is damaged or cannot be written
  std::optional<std::vector<float>> load_distance(std::size_t light) const;
  void save_distance(std::size_t light, const std::vector<float>& distance) const;
  std::optional<reference::AirlightImage> load_airlight(std::size_t light, int refinement) const;
  void save_airlight(std::size_t light, int refinement, const reference::AirlightImage& image) const;

 private:
  /// All that an image depends on, in words.
  std::string key(std::size_t light, const std::string& what) const;
  std::optional<Image> load(const std::string& key) const;
  void save(const std::string& key, Image image) const;

  std::filesystem::path folder_;
  const scene::Geometry& geometry_;
  mutable std::string geometry_hash_;  ///< empty until it is asked for
  scene::View view_;
};

}  // namespace airlight::quality
