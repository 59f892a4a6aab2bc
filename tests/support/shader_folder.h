#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "gpu/replaced_shaders.h"
#include "viewer/shader_sources.h"

namespace airlight::tests {

/// A value of the environment that is another while this lives.
class EnvironmentValue {
 public:
  EnvironmentValue(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~EnvironmentValue() {
    if (before_.empty())
      unsetenv(name_);
    else
      setenv(name_, before_.c_str(), 1);
  }
  EnvironmentValue(const EnvironmentValue&) = delete;
  EnvironmentValue& operator=(const EnvironmentValue&) = delete;

 private:
  const char* name_;
  std::string before_;
};

/// A copy of the shaders' sources to change. What has replaced shaders is forgotten with it.
class ShaderFolder {
 public:
  ShaderFolder() {
    std::filesystem::remove_all(path_);
    std::filesystem::copy(viewer::ShaderSources::usual_folder(), path_,
                          std::filesystem::copy_options::recursive);
  }
  ~ShaderFolder() {
    std::filesystem::remove_all(path_);
    gpu::replaced_shaders().clear();
  }
  ShaderFolder(const ShaderFolder&) = delete;
  ShaderFolder& operator=(const ShaderFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::string read(const std::string& name) const {
    std::ifstream stream(path_ / name);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }

  /// Changes the one place where `old_words` stand.
  void replace(const std::string& name, const std::string& old_words, const std::string& new_words) const {
    std::string text = read(name);
    const std::size_t at = text.find(old_words);
    ASSERT_NE(at, std::string::npos) << name << " has no " << old_words;
    write(name, text.replace(at, old_words.size(), new_words));
  }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / fmt::format("airlight-shaders-of-test-{}", getpid());
};

}  // namespace airlight::tests
