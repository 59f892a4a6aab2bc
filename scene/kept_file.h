#pragma once

#include <filesystem>
#include <functional>

/// Files that one run of the program keeps for the next.
namespace airlight::scene {

/// Makes the folder of `--cache`, where it is missing. @throws Error (bad_file) where it cannot be made
void make_cache_folder(const std::filesystem::path& folder);

/// Writes a file under another name until it is whole: whoever looks finds all of it or nothing, and two
/// programs may write it at the same time.
/// @param write called with that name
/// @throws Error (bad_file) where it cannot be written
void write_whole(const std::filesystem::path& file,
                 const std::function<void(const std::filesystem::path& part)>& write);

}  // namespace airlight::scene
