#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace airlight::frame {

/// How what methods make once a scene, and are long about, is kept and followed.
struct LongWork {
  std::filesystem::path cache = {};  ///< folder where it is kept between runs of the program; empty for none
  /// Told what is being done, and the fraction done of it, on the thread that draws; may be empty.
  std::function<void(const std::string& what, double fraction)> progress = {};
};

}  // namespace airlight::frame
