#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scene/import.h"
#include "support/errors.h"

/// Models made by tests: their folder, and glTF documents.
namespace airlight::tests {

/// A folder of one test's models, which goes away with the test.
class ImportFolder : public testing::Test {
 protected:
  ImportFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("airlight_" + std::string(test->test_suite_name()) + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~ImportFolder() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, std::string_view content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  scene::Scene load(const std::string& name, std::string_view content) {
    return scene::import_scene(write(name, content), looks_);
  }
  scene::Scene load(const nlohmann::json& document) { return load("scene.gltf", document.dump()); }

  /// Expects an error of one line that names the file and holds the text.
  void expect_error(const std::filesystem::path& file, const std::string& text) {
    tests::expect_error(scene::ExitCode::bad_file, {text, file.filename().string()},
                        [&] { scene::import_scene(file, looks_); });
  }
  void expect_error(const std::string& name, std::string_view content, const std::string& text) {
    expect_error(write(name, content), text);
  }
  void expect_error(const nlohmann::json& document, const std::string& text) {
    expect_error("scene.gltf", document.dump(), text);
  }

  std::filesystem::path folder_;
  scene::Looks looks_ = scene::Looks::flat;
};

template <typename T>
inline std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline std::string data_uri(std::string_view bytes, const std::string& type = "application/octet-stream") {
  constexpr std::string_view k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string uri = "data:" + type + ";base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      uri += i + k > bytes.size() ? '=' : k_digits[word >> (18 - 6 * k) & 63];
  }
  return uri;
}

/// Adds bytes as a buffer of their own with one view. @returns the view's index
inline std::size_t add_view(nlohmann::json& document, std::string_view bytes) {
  document["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", data_uri(bytes)}});
  document["bufferViews"].push_back(
      {{"buffer", document["buffers"].size() - 1}, {"byteLength", bytes.size()}});
  return document["bufferViews"].size() - 1;
}

/// Adds an accessor of tightly packed values. @returns its index
template <typename T>
inline std::size_t add_accessor(nlohmann::json& document, const std::vector<T>& values, int component_type,
                                const std::string& type) {
  const std::size_t components = type == "VEC3" ? 3 : type == "VEC2" ? 2 : 1;
  const std::size_t view = add_view(document, bytes_of(values));
  document["accessors"].push_back({{"bufferView", view},
                                   {"componentType", component_type},
                                   {"count", values.size() / components},
                                   {"type", type}});
  return document["accessors"].size() - 1;
}

inline constexpr int k_u8 = 5121, k_u16 = 5123, k_u32 = 5125, k_float = 5126;

/// The corners of a unit square, counter-clockwise.
inline const std::vector<float> k_square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// One triangle, (0,0,0) (1,0,0) (1,1,0), without a material: accessor 0 holds the square's four positions,
/// accessor 1 the indices.
inline nlohmann::json triangle() {
  nlohmann::json document = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}}};
  add_accessor(document, k_square, k_float, "VEC3");
  add_accessor(document, std::vector<std::uint16_t>{0, 1, 2}, k_u16, "SCALAR");
  return document;
}

inline nlohmann::json& primitive(nlohmann::json& document) {
  return document["meshes"][0]["primitives"][0];
}

/// The triangle, with a light or camera or whatever else hung on a second node.
inline nlohmann::json with_node(nlohmann::json node, nlohmann::json document = triangle()) {
  document["nodes"].push_back(std::move(node));
  document["scenes"][0]["nodes"].push_back(document["nodes"].size() - 1);
  return document;
}

inline nlohmann::json with_light(nlohmann::json light, nlohmann::json node = nlohmann::json::object()) {
  node["extensions"]["KHR_lights_punctual"]["light"] = 0;
  nlohmann::json document = with_node(std::move(node));
  document["extensionsUsed"] = {"KHR_lights_punctual"};
  document["extensions"]["KHR_lights_punctual"]["lights"] = nlohmann::json::array({std::move(light)});
  return document;
}

inline nlohmann::json with_camera(nlohmann::json camera, nlohmann::json node = nlohmann::json::object()) {
  node["camera"] = 0;
  nlohmann::json document = with_node(std::move(node));
  document["cameras"] = nlohmann::json::array({std::move(camera)});
  return document;
}

inline const nlohmann::json k_perspective = {{"type", "perspective"},
                                             {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}};

inline std::string little_endian(std::uint32_t word) {
  return bytes_of(std::vector<std::uint32_t>{word});
}

inline std::string glb(const nlohmann::json& document, std::string binary) {
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const auto size = [](const std::string& s) { return little_endian(static_cast<std::uint32_t>(s.size())); };
  std::string chunks = size(text) + "JSON" + text;
  if (!binary.empty()) chunks += size(binary) + std::string("BIN\0", 4) + binary;
  return "glTF" + little_endian(2) + little_endian(static_cast<std::uint32_t>(chunks.size() + 12)) + chunks;
}

/// The triangle in a .glb, its positions in the binary chunk.
inline std::string triangle_glb() {
  nlohmann::json document = triangle();
  const std::string positions = bytes_of(k_square);
  document["buffers"][0].erase("uri");
  return glb(document, positions);
}

}  // namespace airlight::tests
