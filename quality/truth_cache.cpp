#include "quality/truth_cache.h"

#include <array>
#include <charconv>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "scene/error.h"
#include "scene/hash.h"
#include "scene/kept_file.h"
#include "scene/light_texture.h"
#include "scene/transmission.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;

/// Numbers with every bit they have.
template <typename Vector>
std::string exact(const Vector& v) {
  return fmt::format("{:a} {:a} {:a}", v.x, v.y, v.z);
}

double number(const Image& image, const char* name) {
  const auto found = image.metadata.find(name);
  double value = 0.0;
  if (found != image.metadata.end())
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
  return value;
}

constexpr const char* k_key = "airlight.truth";
constexpr std::array<const char*, 3> k_channels = {"R", "G", "B"};

}  // namespace

TruthCache::TruthCache(std::filesystem::path folder, const scene::Geometry& geometry, const scene::View& view)
    : folder_(std::move(folder)), geometry_(geometry), view_(view) {
  scene::make_cache_folder(folder_);
}

std::string hash_of_geometry(const scene::Geometry& geometry) {
  scene::Hash hash;
  hash.add(geometry.positions);
  hash.add(geometry.triangles);
  if (scene::has_cut_outs(geometry)) {
    hash.add(geometry.texture_places);
    hash.add(geometry.material_of_triangle);
    for (const scene::Material& material : geometry.materials) {
      if (!material.cut_out) continue;
      const scene::TextureImage& mask = geometry.textures[material.cut_out->texture];
      hash.add(mask.texels);
      hash.add(std::vector{mask.size.x, mask.size.y, static_cast<int>(material.wrap[0]),
                           static_cast<int>(material.wrap[1])});
      hash.add(std::vector{material.cut_out->least_alpha});
    }
  }
  hash.add(scene::attenuations_of(geometry));
  return hash.text();
}

std::string words_of_view(const scene::View& view, std::size_t light_index) {
  const scene::Camera& camera = view.camera;
  const scene::Light& light = view.lights[light_index];
  const scene::Medium& medium = view.medium;
  std::string words = fmt::format(
      "camera {} {} {} {:a} {}x{}\n"
      "light {} {} {} {} {}\n"
      "medium {} {} {} {:a} {:a} {}\n",
      exact(camera.eye), exact(camera.target), exact(camera.up), camera.vertical_fov_degrees, view.size.x,
      view.size.y, static_cast<int>(light.kind), exact(light.position), exact(light.intensity),
      exact(light.towards), exact(light.irradiance), exact(medium.sigma_s), exact(medium.sigma_a),
      static_cast<int>(medium.phase), medium.g, medium.rayleigh_weight,
      medium.top ? fmt::format("{:a}", *medium.top) : "everywhere");
  if (light.texture) {
    scene::Hash hash;
    hash.add(light.texture->texels());
    words += fmt::format("texture {} {}x{}\n", hash.text(), light.texture->size().x, light.texture->size().y);
  }
  if (light.cone)
    words +=
        fmt::format("cone {} {:a} {:a}\n", exact(light.cone->axis), light.cone->inner, light.cone->outer);
  if (light.range) words += fmt::format("range {:a}\n", *light.range);
  if (!view.pose.is_at_rest()) {
    scene::Hash hash;
    hash.add(view.pose.objects->of_triangle);
    hash.add(view.pose.motions);
    words += fmt::format("pose {}\n", hash.text());
  }
  return words;
}

std::string TruthCache::key(std::size_t light, const std::string& what) const {
  if (geometry_hash_.empty()) geometry_hash_ = hash_of_geometry(geometry_);
  return fmt::format("{} of version {}\ngeometry {}\n{}", what, reference::k_truth_version, geometry_hash_,
                     words_of_view(view_, light));
}

std::optional<Image> TruthCache::load(const std::string& key) const {
  const std::filesystem::path file = folder_ / (scene::hash_of(key) + ".exr");
  if (std::error_code error; !std::filesystem::exists(file, error)) return {};
  Image image = read_exr(file);
  const auto kept = image.metadata.find(k_key);
  if (kept == image.metadata.end() || kept->second != key || image.size != view_.size)
    throw Error(ExitCode::bad_file, file.string(), "it is not the truth that its name says", "remove it");
  return image;
}

void TruthCache::save(const std::string& key, Image image) const {
  image.size = view_.size;
  image.metadata[k_key] = key;
  scene::write_whole(folder_ / (scene::hash_of(key) + ".exr"),
                     [&](const std::filesystem::path& part) { write_exr(part, image); });
}

std::optional<std::vector<float>> TruthCache::load_distance(std::size_t light) const {
  std::optional<Image> image = load(key(light, "distance"));
  if (!image) return {};
  return std::move(image->channels["distance.Y"]);
}

void TruthCache::save_distance(std::size_t light, const std::vector<float>& distance) const {
  Image image;
  image.channels["distance.Y"] = distance;
  save(key(light, "distance"), std::move(image));
}

std::optional<reference::AirlightImage> TruthCache::load_airlight(std::size_t light, int refinement) const {
  const std::optional<Image> image = load(key(light, fmt::format("airlight, refined {} times", refinement)));
  if (!image) return {};
  reference::AirlightImage airlight;
  airlight.radiance.resize(image->channels.at("R").size());
  for (int channel = 0; channel < 3; ++channel) {
    const std::vector<float>& values = image->channels.at(k_channels[static_cast<std::size_t>(channel)]);
    for (std::size_t i = 0; i < values.size(); ++i) airlight.radiance[i][channel] = values[i];
  }
  airlight.ms = number(*image, "airlight.ms");
  airlight.bound = number(*image, "airlight.bound");
  airlight.shadows_per_pixel = number(*image, "airlight.shadows-per-pixel");
  airlight.lit_runs_per_pixel = number(*image, "airlight.lit-runs-per-pixel");
  return airlight;
}

void TruthCache::save_airlight(std::size_t light, int refinement,
                               const reference::AirlightImage& airlight) const {
  Image image;
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float>& values = image.channels[k_channels[static_cast<std::size_t>(channel)]];
    for (const glm::vec3& radiance : airlight.radiance) values.push_back(radiance[channel]);
  }
  image.metadata["airlight.ms"] = fmt::format("{}", airlight.ms);
  image.metadata["airlight.bound"] = fmt::format("{}", airlight.bound);
  image.metadata["airlight.shadows-per-pixel"] = fmt::format("{}", airlight.shadows_per_pixel);
  image.metadata["airlight.lit-runs-per-pixel"] = fmt::format("{}", airlight.lit_runs_per_pixel);
  save(key(light, fmt::format("airlight, refined {} times", refinement)), std::move(image));
}

}  // namespace airlight::quality
