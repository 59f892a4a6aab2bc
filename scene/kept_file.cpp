#include "scene/kept_file.h"

#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "scene/error.h"

namespace airlight::scene {

void make_cache_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw Error(ExitCode::bad_file, folder.string(),
                fmt::format("the folder cannot be made: {}", error.message()),
                "choose another one with --cache");
}

void write_whole(const std::filesystem::path& file,
                 const std::function<void(const std::filesystem::path& part)>& write) {
  std::filesystem::path part = file;
  part.replace_extension(fmt::format("{}.part", getpid()));
  write(part);
  std::error_code error;
  std::filesystem::rename(part, file, error);
  if (error) throw Error(ExitCode::bad_file, file.string(), "it cannot be written");
}

}  // namespace airlight::scene
