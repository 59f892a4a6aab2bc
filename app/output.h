#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "quality/methods.h"
#include "quality/tev.h"
#include "scene/scene.h"

namespace airlight::app {

/// Makes the folder where it is missing. @throws scene::Error (bad_file) where files cannot be written into
/// it.
void require_folder(const std::filesystem::path& folder);

/// @throws scene::Error (bad_file) where the file cannot be written. An existing file is left as it is.
void require_writable(const std::filesystem::path& file);

/// Data, to standard output. @throws scene::Error (bad_file) where it cannot be written.
void print(std::string_view text);

/// One line of talk, to standard error, control characters replaced.
void say(std::string_view line);

/// Says that a page was written, and how to open it.
void say_page(const std::filesystem::path& file);

/// Says what the importer dropped or could not represent.
void say_warnings(const scene::ImportReport& report);

/// The tev that images are shown in. @param address of quality::Tev; empty for none
std::unique_ptr<quality::Tev> open_tev(const std::string& address);

/// Says so where it was closed before it was shown all. @param tev may be null
void say_of_tev(const quality::Tev* tev);

/// A line on standard error that follows long work, where that is a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Follows this line while it lives; empty where nothing is shown.
  quality::Progress follower();

 private:
  bool is_shown_;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace airlight::app
