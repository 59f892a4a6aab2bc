#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "gpu/replaced_shaders.h"

namespace airlight::viewer {

/// The sources of the shaders that are embedded in the program: what has changed in them since it was started
/// is compiled as the build compiled them. What C++ includes of them stays as it was built.
class ShaderSources {
 public:
  /// @param folder the project's shaders/; it need not be there
  explicit ShaderSources(const std::filesystem::path& folder = usual_folder());

  /// The folder that the environment variable AIRLIGHT_SHADERS names, or the one that the program was built
  /// from.
  static std::filesystem::path usual_folder();

  using Times = std::map<std::string, std::filesystem::file_time_type>;
  struct Changes {
    std::vector<std::string> names;  ///< of entry points, as "frame/composite.frag"
    gpu::ReplacedShaders words;
    Times times;  ///< when each file was written
  };

  /// Compiles the entry points of which a file, or one that it includes, has changed since the last changes
  /// that were accepted.
  /// @throws scene::Error (bad_file) where the folder is not there, or one does not compile: with the
  /// compiler's first lines; (driver) where there is no glslangValidator
  Changes compile_changes() const;

  void accept(const Changes& changes) { times_ = changes.times; }

 private:
  Times times_of_files() const;

  std::filesystem::path folder_;
  Times times_;
};

}  // namespace airlight::viewer
