#include "quality/pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace airlight::quality {

Image exr_image(const frame::FrameImages& images, std::map<std::string, std::string> metadata) {
  Image image{.size = images.size, .channels = {}, .metadata = std::move(metadata)};
  const auto add = [&](const std::string& prefix, const std::vector<glm::vec3>& values) {
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<float>& plane = image.channels[prefix + "RGB"[channel]];
      plane.reserve(values.size());
      for (const glm::vec3& value : values) plane.push_back(value[channel]);
    }
  };
  add("", images.radiance);
  add("airlight.", images.airlight);
  std::vector<float>& visibility = image.channels["surface.Y"];
  visibility.resize(images.distance.size());
  for (const std::vector<float>& of_light : images.visibility) {
    for (std::size_t i = 0; i < visibility.size(); ++i)
      visibility[i] += of_light[i] / static_cast<float>(images.visibility.size());
  }
  image.channels["distance.Y"] = images.distance;
  return image;
}

float automatic_exposure(const std::vector<glm::vec3>& radiance) {
  if (radiance.empty()) return 1.0f;
  std::vector<float> brightest;
  brightest.reserve(radiance.size());
  for (const glm::vec3& value : radiance) brightest.push_back(std::max({value.x, value.y, value.z}));
  std::sort(brightest.begin(), brightest.end());
  const float percentile = brightest[(brightest.size() - 1) * 95 / 100];
  const float white = percentile > 0.0f ? percentile : brightest.back();
  const float exposure = 0.8f / white;
  return white > 0.0f && std::isfinite(exposure) ? exposure : 1.0f;
}

std::vector<glm::vec3> error_colours(const std::vector<glm::vec3>& x, const std::vector<glm::vec3>& r) {
  const auto grey = [](const glm::vec3& value) {
    return (glm::dvec3(value).x + glm::dvec3(value).y + glm::dvec3(value).z) / 3.0;
  };
  double mean = 0.0;
  for (const glm::vec3& value : r) mean += grey(value) / static_cast<double>(r.size());

  const glm::vec3 white(1.0f), bright(0.5f, 0.0f, 0.0f), dark(0.0f, 0.05f, 0.5f);
  std::vector<glm::vec3> colours;
  colours.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double difference = grey(x[i]) - grey(r[i]);
    double depth = difference == 0.0 ? 0.0 : 1.0;  // against a black reference every error is infinite
    if (difference != 0.0 && mean > 0.0) {
      const double decades =
          std::log(std::abs(difference) / mean / k_error_white) / std::log(k_error_full / k_error_white);
      depth = std::clamp(decades, 0.0, 1.0);
    }
    colours.push_back(glm::mix(white, difference > 0.0 ? bright : dark, static_cast<float>(depth)));
  }
  return colours;
}

}  // namespace airlight::quality
