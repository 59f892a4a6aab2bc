#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace airlight::quality {

/// A part of a sweep's runs: those whose key's hash is number − 1 modulo count.
struct Shard {
  int number = 1;  ///< from 1
  int count = 1;

  bool holds(std::string_view key) const;
};

/// Reads "K/N". @throws scene::Error (usage) naming `where`
Shard parse_shard(const std::string& where, std::string_view text);

/// The lines of a runs.jsonl file that are whole; what a kill left of a last line is none of them.
/// @throws scene::Error (bad_file) where the file cannot be read
std::vector<std::string> whole_lines(const std::filesystem::path& file);

/// The files of runs of a folder, runs.jsonl and runs-K-of-N.jsonl, by their names.
/// @throws scene::Error (bad_file) where it cannot be read
std::vector<std::filesystem::path> run_files(const std::filesystem::path& folder);

/// Where a sweep's runs are kept, one JSON object a line: DIR/runs.jsonl, or of a shard
/// DIR/runs-K-of-N.jsonl, so that no two programs write one file, wherever they run. A line is there wholly
/// or not: it is written by one call, and one that a kill has torn is dropped by the next sweep.
class RunFile {
 public:
  /// Opens the file, and makes it where it is missing; it is locked as long as this lives.
  /// @param folder exists
  /// @throws scene::Error (bad_file) where it cannot be written, another sweep writes it, or a line is none
  RunFile(const std::filesystem::path& folder, const Shard& shard);
  ~RunFile();
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// The keys of all runs of the folder, other shards' included, as it was found.
  const std::set<std::string>& keys() const { return keys_; }

  /// @param line without its end
  /// @throws scene::Error (bad_file) where it cannot be written wholly
  void append(const std::string& line);

 private:
  std::filesystem::path path_;
  int file_ = -1;
  std::set<std::string> keys_;
};

}  // namespace airlight::quality
