#include "viewer/shader_sources.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "gpu/spirv.h"
#include "quality/results.h"
#include "scene/error.h"
#include "scene/parallel.h"

#include "every_shader.h"

namespace airlight::viewer {
namespace {

namespace fs = std::filesystem;
using scene::Error;
using scene::ExitCode;

/// What a file includes, and what that includes, and itself, by their names in the folder.
void add_includes(const fs::path& folder, const std::string& name, std::set<std::string>& names) {
  if (!names.insert(name).second) return;
  constexpr std::string_view k_include = "#include \"";
  std::ifstream stream(folder / name);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(k_include)) continue;
    line.erase(0, k_include.size());
    add_includes(folder, line.substr(0, line.find('"')), names);
  }
}

/// A folder that goes when this does.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "airlight-shaders-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error(ExitCode::bad_file, name, "the folder cannot be made");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// What a command says, and its exit code.
std::pair<std::string, int> output_of(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) throw Error(ExitCode::driver, "shaders", "no command can be run");
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe))
    text.append(part.data(), count);
  const int status = pclose(pipe);
  return {text, WIFEXITED(status) ? WEXITSTATUS(status) : -1};
}

/// The first lines in which a compiler says what is wrong, each after a line break, with names as they are in
/// the folder.
std::string first_errors(const std::string& said, const fs::path& folder) {
  constexpr int k_lines = 3;
  const std::string prefix = folder.string() + "/";
  std::istringstream stream(said);
  std::string errors;
  int count = 0;
  for (std::string line; count < k_lines && std::getline(stream, line);) {
    if (line.empty()) continue;
    if (const std::size_t at = line.find(prefix); at != std::string::npos) line.erase(at, prefix.size());
    errors += "\n" + line;
    ++count;
  }
  return errors;
}

std::vector<std::uint32_t> read_words(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(stream), {});
  std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
  std::copy_n(bytes.data(), words.size() * sizeof(std::uint32_t), reinterpret_cast<char*>(words.data()));
  return words;
}

std::vector<std::uint32_t> compile(const EmbeddedShader& shader, const fs::path& folder,
                                   const fs::path& output) {
  const auto [said, exit_code] = output_of(
      fmt::format("glslangValidator {} {} -o {} {}", AIRLIGHT_GLSLANG_OPTIONS,
                  quality::shell_quote("-I" + folder.string()), quality::shell_quote(output.string()),
                  quality::shell_quote((folder / shader.name).string())));
  constexpr int k_not_found = 127;  // of a shell
  if (exit_code == k_not_found)
    throw Error(ExitCode::driver, "shaders", "glslangValidator, which compiles them, is not installed",
                "install it (package glslang-tools)");
  if (exit_code != 0)
    throw Error(ExitCode::bad_file, shader.name, "it does not compile" + first_errors(said, folder));
  std::vector<std::uint32_t> words = read_words(output);
  const std::vector<std::uint32_t> declared = gpu::read_spirv(words).constant_ids;
  for (const std::uint32_t id : gpu::read_spirv(shader.words).constant_ids)
    if (std::find(declared.begin(), declared.end(), id) == declared.end())
      throw Error(ExitCode::bad_file, shader.name, fmt::format("the constant {} is missing", id),
                  "what is set from outside has to stay");
  return words;
}

}  // namespace

ShaderSources::ShaderSources(const fs::path& folder)
    : folder_(fs::absolute(folder / "").parent_path()), times_(times_of_files()) {}

fs::path ShaderSources::usual_folder() {
  const char* named = std::getenv("AIRLIGHT_SHADERS");
  return named ? named : AIRLIGHT_BUILT_SHADERS;
}

ShaderSources::Times ShaderSources::times_of_files() const {
  Times times;
  std::error_code error;
  for (fs::recursive_directory_iterator file(folder_, error), end; file != end; file.increment(error))
    if (file->is_regular_file(error))
      times[file->path().lexically_relative(folder_).generic_string()] = file->last_write_time(error);
  return times;
}

ShaderSources::Changes ShaderSources::compile_changes() const {
  Changes changes{.names = {}, .words = {}, .times = times_of_files()};
  if (changes.times.empty())
    throw Error(ExitCode::bad_file, folder_.string(), "there are no sources of shaders",
                "name their folder by the environment variable AIRLIGHT_SHADERS");
  const auto is_changed = [&](const std::string& name) {
    const auto written = [&](const Times& times) {
      const auto found = times.find(name);
      return found == times.end() ? std::nullopt : std::optional(found->second);
    };
    return written(times_) != written(changes.times);
  };
  std::vector<const EmbeddedShader*> changed;
  for (const EmbeddedShader& shader : k_every_shader) {
    std::set<std::string> names;
    add_includes(folder_, shader.name, names);
    if (!std::any_of(names.begin(), names.end(), is_changed)) continue;
    changed.push_back(&shader);
    changes.names.emplace_back(shader.name);
  }
  const ScratchFolder scratch;
  std::mutex mutex;
  scene::parallel(static_cast<int>(changed.size()),
                  [&] {
                    return [&](int i) {
                      const EmbeddedShader& shader = *changed[static_cast<std::size_t>(i)];
                      auto words = compile(shader, folder_, scratch.path() / fmt::format("{}.spv", i));
                      const std::scoped_lock lock(mutex);
                      changes.words[shader.words.data()] = std::move(words);
                    };
                  },
                  {});
  return changes;
}

}  // namespace airlight::viewer
