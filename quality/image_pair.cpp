#include "quality/image_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "quality/flip.h"
#include "quality/results_json.h"
#include "scene/error.h"

namespace airlight::quality {

namespace {

using scene::Error;
using scene::ExitCode;

std::string names_of(const ImageFile& image) {
  std::string names;
  for (const auto& [name, values] : image.image.channels) names += (names.empty() ? "" : ", ") + name;
  return names;
}

void require_same_size(const ImageFile& image, const ImageFile& reference) {
  const glm::ivec2 size = image.image.size, other = reference.image.size;
  if (size != other)
    throw Error(ExitCode::bad_file, image.file.string(),
                fmt::format("it has {}x{} pixels, {} has {}x{}", size.x, size.y, reference.file.string(),
                            other.x, other.y),
                "compare images of one size");
}

}  // namespace

ImageFile read_image(const std::filesystem::path& file) {
  return {file, read_exr(file)};
}

std::vector<glm::vec3> layer_of(const ImageFile& image, const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  const auto& channels = image.image.channels;
  std::array<const std::vector<float>*, 3> rgb{};
  for (std::size_t i = 0; i < 3; ++i) {
    auto found = channels.find(prefix + "RGB"[i]);
    if (found == channels.end()) found = channels.find(prefix + "Y");
    if (found == channels.end())
      throw Error(ExitCode::bad_file, image.file.string(),
                  fmt::format("it has no channel {0}{1}, nor {0}Y", prefix, "RGB"[i]),
                  fmt::format("choose a --layer of its channels: {}", names_of(image)));
    rgb[i] = &found->second;
  }
  std::vector<glm::vec3> values;
  values.reserve(rgb[0]->size());
  for (std::size_t i = 0; i < rgb[0]->size(); ++i)
    values.emplace_back((*rgb[0])[i], (*rgb[1])[i], (*rgb[2])[i]);
  return values;
}

PairError pair_error(const ImageFile& image, const ImageFile& reference, const std::string& layer) {
  require_same_size(image, reference);
  const std::vector<glm::vec3> x = layer_of(image, layer), r = layer_of(reference, layer);
  PairError error{airlight_error(channels_of(x), channels_of(r)), {}, hdr_flip(x, r, image.image.size)};
  const auto distance = image.image.channels.find("distance.Y"),
             reference_distance = reference.image.channels.find("distance.Y");
  if (distance != image.image.channels.end() && reference_distance != reference.image.channels.end())
    error.same_surface =
        same_surface_error(channels_of(x), distance->second, channels_of(r), reference_distance->second);
  return error;
}

std::string pair_error_text(const PairError& error) {
  std::string text;
  const auto add = [&](const char* name, double value, const char* meaning) {
    text += fmt::format("{:<26}{:>12.6g}  {}\n", name, value, meaning);
  };
  add("bias", error.all.bias, "mean(x) / mean(r) - 1");
  add("rmse", error.all.rmse, "in the images' unit");
  add("rrmse", error.all.rrmse, "rmse / mean(r)");
  add("mae", error.all.mae, "mean |x - r| / mean(r)");
  add("p99", error.all.p99, "99th percentile of |x - r| / mean(r)");
  add("max", error.all.max, "largest |x - r| / mean(r)");
  add("relmse", error.all.relmse, "mean((x - r)^2 / (r^2 + e)), e = 0.01 mean(r)^2");
  add("leaked", error.all.leaked, "what is too bright, of all light");
  add("spurious", error.all.spurious, "what is too dark, of all light");
  add("flip", error.flip, "mean of HDR-FLIP, 0 to 1, at 67 pixels a degree");
  if (error.same_surface) {
    add("same-surface bias", error.same_surface->bias,
        "of pixels whose distance.Y differs by less than 0.1 %");
    add("same-surface rrmse", error.same_surface->rrmse, "of the same");
    add("left-out pixels", static_cast<double>(error.same_surface->left_out_pixels), "the others");
  }
  return text;
}

std::string pair_error_json(const PairError& error) {
  nlohmann::ordered_json json = {{"airlight", airlight_json(error.all, error.flip)}};
  if (error.same_surface) json["airlight_same_surface"] = same_surface_json(*error.same_surface);
  return text_of_json(json, 2) + "\n";
}

Image difference(const ImageFile& image, const ImageFile& reference) {
  require_same_size(image, reference);
  Image result;
  result.size = image.image.size;
  for (const auto& [name, values] : image.image.channels) {
    const auto other = reference.image.channels.find(name);
    if (other == reference.image.channels.end()) continue;
    std::vector<float>& channel = result.channels[name];
    channel.reserve(values.size());
    std::transform(values.begin(), values.end(), other->second.begin(), std::back_inserter(channel),
                   std::minus());
  }
  if (result.channels.empty())
    throw Error(ExitCode::bad_file, image.file.string(),
                fmt::format("it has no channel in common with {}: {} against {}", reference.file.string(),
                            names_of(image), names_of(reference)));
  return result;
}

Image cropped(const ImageFile& image, const Crop& crop) {
  const glm::ivec2 whole = image.image.size;
  const bool is_inside = crop.from.x >= 0 && crop.from.y >= 0 && crop.size.x > 0 && crop.size.y > 0 &&
                         crop.size.x <= whole.x - crop.from.x && crop.size.y <= whole.y - crop.from.y;
  if (!is_inside)
    throw Error(ExitCode::usage, "--crop",
                fmt::format("{}x{} pixels from ({}, {}) on do not lie in the {}x{} of {}", crop.size.x,
                            crop.size.y, crop.from.x, crop.from.y, whole.x, whole.y, image.file.string()));
  Image result{.size = crop.size, .channels = {}, .metadata = image.image.metadata};
  for (const auto& [name, values] : image.image.channels) {
    std::vector<float>& channel = result.channels[name];
    for (int row = 0; row < crop.size.y; ++row) {
      const auto first = values.begin() + std::ptrdiff_t{crop.from.y + row} * whole.x + crop.from.x;
      channel.insert(channel.end(), first, first + crop.size.x);
    }
  }
  return result;
}

std::string image_info(const ImageFile& image) {
  std::string text = fmt::format("{}x{} pixels\n", image.image.size.x, image.image.size.y);
  for (const auto& [name, value] : image.image.metadata) text += fmt::format("{}: {}\n", name, value);
  text +=
      fmt::format("{:<24}{:>14}{:>14}{:>14}{:>12}\n", "channel", "least", "mean", "greatest", "not finite");
  for (const auto& [name, values] : image.image.channels) {
    double sum = 0.0;
    float least = std::numeric_limits<float>::infinity(), greatest = -least;
    std::size_t finite = 0;
    for (const float value : values) {
      if (!std::isfinite(value)) continue;
      sum += static_cast<double>(value);
      least = std::min(least, value);
      greatest = std::max(greatest, value);
      ++finite;
    }
    if (finite == 0) least = greatest = std::numeric_limits<float>::quiet_NaN();
    text += fmt::format("{:<24}{:>14.6g}{:>14.6g}{:>14.6g}{:>12}\n", name, least,
                        sum / static_cast<double>(finite), greatest, values.size() - finite);
  }
  return text;
}

}  // namespace airlight::quality
