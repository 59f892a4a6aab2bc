#include "quality/run_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "scene/error.h"
#include "scene/hash.h"
#include "scene/numbers.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw Error(ExitCode::bad_file, file.string(), "it cannot be read");
  return text;
}

/// Waits a little: a program that was killed lets go of its lock a moment later.
bool lock(int file) {
  constexpr int k_tries = 50;
  constexpr auto k_pause = std::chrono::milliseconds(100);
  for (int i = 0; flock(file, LOCK_EX | LOCK_NB) != 0; ++i) {
    if (errno != EWOULDBLOCK || i == k_tries) return false;
    std::this_thread::sleep_for(k_pause);
  }
  return true;
}

std::string name_of(const Shard& shard) {
  return shard.count == 1 ? "runs.jsonl" : fmt::format("runs-{}-of-{}.jsonl", shard.number, shard.count);
}

}  // namespace

bool Shard::holds(std::string_view key) const {
  // Hashed once more: the last bytes of a text alone leave most bits of its hash as they are.
  const std::string digits = scene::hash_of(key);
  std::uint64_t hash = 0;
  std::from_chars(digits.data(), digits.data() + 16, hash, 16);
  return hash % static_cast<std::uint64_t>(count) == static_cast<std::uint64_t>(number - 1);
}

Shard parse_shard(const std::string& where, std::string_view text) {
  const std::vector<std::string_view> parts = scene::split(text, '/');
  if (parts.size() != 2)
    throw Error(ExitCode::usage, where, fmt::format("'{}' is not K/N", text), "as in 1/4 to 4/4");
  const Shard shard{scene::parse_count(where, parts[0]), scene::parse_count(where, parts[1])};
  if (shard.number > shard.count)
    throw Error(ExitCode::usage, where, fmt::format("there is no shard {} of {}", parts[0], parts[1]),
                "count from 1");
  return shard;
}

std::vector<std::string> whole_lines(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines.push_back(text.substr(begin, end - begin));
  return lines;
}

std::vector<std::filesystem::path> run_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name == "runs.jsonl" || (name.starts_with("runs-") && name.ends_with(".jsonl")))
      files.push_back(entry->path());
  }
  if (error) throw Error(ExitCode::bad_file, folder.string(), error.message());
  std::sort(files.begin(), files.end());
  return files;
}

RunFile::RunFile(const std::filesystem::path& folder, const Shard& shard) : path_(folder / name_of(shard)) {
  file_ = open(path_.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  const auto fail = [&](const std::string& problem, const std::string& remedy = {}) {
    if (file_ >= 0) close(file_);
    throw Error(ExitCode::bad_file, path_.string(), problem, remedy);
  };
  if (file_ < 0) fail("it cannot be written");
  if (!lock(file_))
    fail(errno == EWOULDBLOCK ? "another sweep writes it" : "it cannot be locked",
         "wait for it, or choose another folder or --shard");

  // What a kill has torn of the last line is dropped.
  try {
    const std::string text = read_text(path_);
    const std::size_t whole = text.rfind('\n') + 1;  // npos + 1 = 0
    if (whole < text.size() && ftruncate(file_, static_cast<off_t>(whole)) != 0)
      throw Error(ExitCode::bad_file, path_.string(), "it cannot be written");
    for (const std::filesystem::path& file : run_files(folder)) {
      const std::vector<std::string> lines = whole_lines(file);
      for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto json = nlohmann::json::parse(lines[i], nullptr, false);
        if (!json.is_object() || !json.contains("key") || !json["key"].is_string())
          throw Error(ExitCode::bad_file, fmt::format("{}, line {}", file.string(), i + 1), "it is no run",
                      "remove the line, or choose another folder");
        keys_.insert(json["key"].get<std::string>());
      }
    }
  } catch (const Error&) {
    close(file_);
    throw;
  }
}

RunFile::~RunFile() {
  close(file_);
}

void RunFile::append(const std::string& line) {
  const std::string text = line + '\n';
  const ssize_t written = write(file_, text.data(), text.size());
  if (written != static_cast<ssize_t>(text.size()) || fdatasync(file_) != 0)
    throw Error(ExitCode::bad_file, path_.string(), "a run cannot be written to it", "is the disk full?");
}

}  // namespace airlight::quality
