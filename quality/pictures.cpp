#include "quality/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "quality/results.h"

namespace airlight::quality {

std::string skipped_lights(const frame::FrameImages& images) {
  std::string names;
  for (std::size_t i = 0; i < images.lights.size(); ++i)
    if (images.is_skipped[i]) names += (names.empty() ? "" : ", ") + images.lights[i];
  return names;
}

std::map<std::string, std::string> metadata_of(const Making& making, const scene::View& view) {
  std::map<std::string, std::string> configuration = view_options(view);
  configuration["scene"] = making.scene;
  configuration["volume"] = making.volume.spec;
  configuration["surface"] = making.surface.spec;
  for (const auto& [name, value] : making.volume.values()) configuration[name] = frame::text_of(value);
  for (const auto& [name, value] : making.surface.values())
    configuration["surface." + name] = frame::text_of(value);
  if (is_read("shadow-map", {&making.volume, 1}, {&making.surface, 1}))
    configuration["shadow-map"] = fmt::format("{}", making.shadow_map);
  configuration["exposure"] = fmt::format("{}", making.exposure);
  configuration["tone-map"] = scene::tone_map_name(making.tone_map);
  for (const auto& [name, value] : making.model_options) configuration[name] = value;
  configuration["version"] = version();
  configuration["renderer"] = making.renderer;
  configuration["command"] = making.command;
  std::map<std::string, std::string> metadata;
  for (const auto& [name, value] : configuration) metadata["airlight." + name] = value;
  return metadata;
}

FrameLayers::FrameLayers(const frame::FrameImages& images) {
  const auto add = [&](const std::string& prefix, const std::vector<glm::vec3>& values) {
    for (int channel = 0; channel < 3; ++channel)
      channels_[prefix + "RGB"[channel]] = {&values[0][channel], 3};
  };
  add("", images.radiance);
  add("airlight.", images.airlight);
  channels_["distance.Y"] = {images.distance.data(), 1};
  for (std::size_t light = 0; light < images.airlight_of_light.size(); ++light) {
    add(fmt::format("airlight.{}.", images.lights[light]), images.airlight_of_light[light]);
    channels_[fmt::format("surface.{}.Y", images.lights[light])] = {images.visibility[light].data(), 1};
    if (!images.transmittance.empty())
      add(fmt::format("surface.{}.", images.lights[light]), images.transmittance[light]);
  }
  if (images.transmittance.size() == 1) add("surface.", images.transmittance[0]);
  if (images.visibility.size() > 1) {
    mean_visibility_.resize(images.distance.size());
    for (const std::vector<float>& of_light : images.visibility) {
      for (std::size_t i = 0; i < mean_visibility_.size(); ++i)
        mean_visibility_[i] += of_light[i] / static_cast<float>(images.visibility.size());
    }
  }
  channels_["surface.Y"] = {mean_visibility_.empty() ? images.visibility[0].data() : mean_visibility_.data(),
                            1};
}

void write_frame(const std::filesystem::path& file, const frame::FrameImages& images,
                 std::map<std::string, std::string> metadata) {
  if (const std::string skipped = skipped_lights(images); !skipped.empty())
    metadata["airlight.skipped-lights"] = skipped;
  const FrameLayers layers(images);
  write_exr(file, {.size = images.size, .channels = layers.channels(), .metadata = metadata});
}

float automatic_exposure(const std::vector<glm::vec3>& radiance) {
  if (radiance.empty()) return 1.0f;
  std::vector<float> brightest;
  brightest.reserve(radiance.size());
  for (const glm::vec3& value : radiance) brightest.push_back(std::max({value.x, value.y, value.z}));
  const auto rank = static_cast<std::ptrdiff_t>((brightest.size() - 1) * 95 / 100);
  std::nth_element(brightest.begin(), brightest.begin() + rank, brightest.end());
  const float percentile = brightest[static_cast<std::size_t>(rank)];
  // Those above it come after it.
  const float white =
      percentile > 0.0f ? percentile : *std::max_element(brightest.begin() + rank, brightest.end());
  const float exposure = 0.8f / white;
  return white > 0.0f && std::isfinite(exposure) ? exposure : 1.0f;
}

std::vector<glm::vec3> flip_colours(const std::vector<float>& map) {
  static constexpr std::array<glm::vec3, 5> k_stops = {
      glm::vec3(0.0f), glm::vec3(0.08f, 0.006f, 0.2f), glm::vec3(0.47f, 0.04f, 0.19f),
      glm::vec3(0.97f, 0.25f, 0.12f), glm::vec3(1.0f, 0.98f, 0.9f)};
  std::vector<glm::vec3> colours;
  colours.reserve(map.size());
  for (const float value : map) {
    const float place = std::clamp(value, 0.0f, 1.0f) * static_cast<float>(k_stops.size() - 1);
    const std::size_t stop = std::min(static_cast<std::size_t>(place), k_stops.size() - 2);
    colours.push_back(glm::mix(k_stops[stop], k_stops[stop + 1], place - static_cast<float>(stop)));
  }
  return colours;
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

std::vector<glm::vec3> surface_colours(const frame::FrameImages& images,
                                       const std::vector<SurfaceVerdicts>& verdicts) {
  // In shadow a surface is still told from none.
  constexpr float k_shadow = 0.03f, k_lit = 0.5f;
  const glm::vec3 red(1.0f, 0.0f, 0.0f), yellow(1.0f, 0.75f, 0.0f);
  std::vector<glm::vec3> colours(images.distance.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i < colours.size(); ++i) {
    glm::vec3 sum(0.0f);
    int lights = 0;
    bool any_wrong = false, any_undecided = false;
    for (std::size_t light = 0; light < verdicts.size(); ++light) {
      const auto& verdict = verdicts[light][i];
      if (images.is_skipped[light] || !verdict) continue;
      const bool is_coloured = !images.transmittance.empty();
      const float visibility = images.visibility[light][i];
      sum += is_coloured ? images.transmittance[light][i] : glm::vec3(visibility);
      ++lights;
      any_wrong = any_wrong || (is_coloured ? is_wrong(images.transmittance[light][i], *verdict)
                                            : is_wrong(visibility, *verdict));
      any_undecided = any_undecided || !verdict->is_decided;
    }
    if (lights == 0) continue;
    const glm::vec3 arriving = k_shadow + (k_lit - k_shadow) * sum / static_cast<float>(lights);
    colours[i] = any_wrong ? red : any_undecided ? yellow : arriving;
  }
  return colours;
}

}  // namespace airlight::quality
