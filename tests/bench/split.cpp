// The airlight's error near the light and away from it.
//
// `airlight_split DIR...`, folders that `airlight compare` wrote: for each run the rrmse and the bias over
// the pixels whose view ray is within 5° of the direction to the light, and over the others, leaving out
// pixels that see another surface than the reference.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "quality/image_io.h"
#include "scene/error.h"
#include "scene/numbers.h"
#include "scene/scene.h"

namespace {

using namespace airlight;

glm::dvec3 vector_of(const quality::Image& image, const std::string& name) {
  return scene::parse_vector(name, image.metadata.at("airlight." + name));
}

scene::CameraFrame camera_of(const quality::Image& image) {
  const scene::Camera camera{.name = {},
                             .eye = vector_of(image, "eye"),
                             .target = vector_of(image, "target"),
                             .up = vector_of(image, "up"),
                             .vertical_fov_degrees = std::stod(image.metadata.at("airlight.fov"))};
  return scene::camera_frame(camera, image.size);
}

glm::dvec3 direction_to_light(const quality::Image& image, glm::dvec3 eye) {
  if (image.metadata.contains("airlight.sun")) return glm::normalize(vector_of(image, "sun"));
  return glm::normalize(vector_of(image, "light-position") - eye);
}

struct Sums {
  double reference = 0.0, difference = 0.0, squared = 0.0, count = 0.0;

  std::string text() const {
    if (count == 0.0 || reference == 0.0) return fmt::format("{:>10} {:>10}", "-", "-");
    return fmt::format("{:>9.3f}% {:>+9.3f}%", 100.0 * std::sqrt(squared / count) / (reference / count),
                       100.0 * difference / reference);
  }
};

void print_split(const std::filesystem::path& folder) {
  std::ifstream file(folder / "results.json");
  const nlohmann::json results = nlohmann::json::parse(file);
  const quality::Image truth = quality::read_exr(folder / "reference.exr");
  const scene::CameraFrame camera = camera_of(truth);
  const glm::dvec3 light = direction_to_light(truth, camera.eye);
  for (const nlohmann::json& run : results.at("runs")) {
    if (!run.contains("error")) continue;
    const quality::Image image = quality::read_exr(folder / (run.at("name").get<std::string>() + ".exr"));
    Sums near, far;
    for (int y = 0; y < truth.size.y; ++y) {
      for (int x = 0; x < truth.size.x; ++x) {
        const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(truth.size.x) +
                           static_cast<std::size_t>(x);
        const double seen = static_cast<double>(image.channels.at("distance.Y")[pixel]);
        const double hit = static_cast<double>(truth.channels.at("distance.Y")[pixel]);
        if (std::abs(seen - hit) > 1e-3 * hit) continue;
        const glm::dvec3 ray = camera.forward +
                               (2.0 * (x + 0.5) / truth.size.x - 1.0) * camera.half_width * camera.right +
                               (1.0 - 2.0 * (y + 0.5) / truth.size.y) * camera.half_height * camera.up;
        const double angle = std::atan2(glm::length(glm::cross(light, ray)), glm::dot(light, ray));
        Sums& sums = angle < glm::radians(5.0) ? near : far;
        for (const char* channel : {"airlight.R", "airlight.G", "airlight.B"}) {
          const double right = static_cast<double>(truth.channels.at(channel)[pixel]);
          const double difference = static_cast<double>(image.channels.at(channel)[pixel]) - right;
          sums.reference += right;
          sums.difference += difference;
          sums.squared += difference * difference;
          sums.count += 1.0;
        }
      }
    }
    fmt::print("{:<24} {:<40} {} {}\n", folder.filename().string(), run.at("volume").get<std::string>(),
               near.text(), far.text());
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    fmt::print("{:<24} {:<40} {:>10} {:>10} {:>10} {:>10}\n", "", "volume", "< 5°", "bias", "> 5°", "bias");
    for (int i = 1; i < argc; ++i) print_split(argv[i]);
  } catch (const scene::Error& error) {
    fmt::print(stderr, "airlight_split: {}\n", error.what());
    return static_cast<int>(error.exit_code);
  }
}
