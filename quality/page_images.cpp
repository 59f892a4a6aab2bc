#include "quality/page_images.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "quality/flip.h"
#include "quality/metrics.h"
#include "scene/error.h"

namespace airlight::quality {
namespace {

using Json = nlohmann::ordered_json;

constexpr int k_largest_crop = 96, k_smallest_crop = 16;  ///< side [pixels]
constexpr std::size_t k_crops = 3;
constexpr int k_factors[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32};  ///< that whole images may be reduced by

/// An image of `airlight compare`.
struct Loaded {
  RgbPixels airlight;
  std::vector<float> distance;  ///< along the view ray
};

std::filesystem::path exr_of(std::filesystem::path stem) {
  return stem += ".exr";
}

Loaded load(const std::filesystem::path& stem) {
  ImageFile file = read_image(exr_of(stem));
  Loaded loaded{{file.image.size, layer_of(file, "airlight")}, {}};
  loaded.distance = std::move(file.image.channels["distance.Y"]);
  return loaded;
}

void require_size(const std::filesystem::path& stem, const Loaded& image, const Loaded& truth) {
  const std::size_t pixels = truth.airlight.values.size();
  if (image.airlight.size == truth.airlight.size && image.distance.size() == pixels) return;
  throw scene::Error(scene::ExitCode::bad_file, exr_of(stem).string(),
                     "it is not of the size of the truth's image, or has no distance.Y", "compare again");
}

/// How far each pixel is off, as a part of the whole image's error; 0 where it shows another surface than the
/// truth.
void add_error(GreyPixels& sum, const Loaded& image, const Loaded& truth) {
  const ErrorImage error = error_image(channels_of(image.airlight.values), image.distance,
                                       channels_of(truth.airlight.values), truth.distance);
  std::vector<float> of_pixel(sum.values.size(), 0.0f);
  double all = 0.0;
  for (std::size_t i = 0; i < of_pixel.size(); ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const float value = error.values[3 * i + channel];
      if (!std::isnan(value)) of_pixel[i] += std::abs(value);
    }
    all += static_cast<double>(of_pixel[i]);
  }
  if (!(all > 0.0)) return;
  for (std::size_t i = 0; i < of_pixel.size(); ++i)
    sum.values[i] += static_cast<float>(static_cast<double>(of_pixel[i]) / all);
}

/// Texts of images, each an element of the page.
class Elements {
 public:
  template <typename Pixel>
  Json add(const Pixels<Pixel>& image, const std::string& text) {
    const std::string id = fmt::format("image-{}", count_++);
    html_ += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, text);
    return {{"id", id}, {"width", image.size.x}, {"height", image.size.y}};
  }
  Json add(const RgbPixels& image, float unit) { return add(image, packed(image, unit)); }
  Json add(const GreyPixels& image) { return add(image, packed(image)); }
  Json add_parts(const RgbPixels& image, float unit, const std::vector<Crop>& crops) {
    Json parts = Json::array();
    for (const Crop& crop : crops) parts.push_back(add(part_of(image, crop), unit));
    return parts;
  }
  Json add_parts(const GreyPixels& image, const std::vector<Crop>& crops) {
    Json parts = Json::array();
    for (const Crop& crop : crops) parts.push_back(add(part_of(image, crop)));
    return parts;
  }
  const std::string& html() const { return html_; }

 private:
  std::size_t count_ = 0;
  std::string html_;
};

/// What is kept whole.
struct Whole {
  std::size_t run;  ///< of joined.runs
  Loaded image;
  std::optional<GreyPixels> flip;  ///< none where the truth is dark
};

/// All whole images and their crops, which are cut out of them where they are not reduced.
Json sources(Elements& elements, const Loaded& truth, const std::vector<Whole>& wholes,
             const std::vector<Crop>& crops, float unit, int factor) {
  const auto source_of = [&](const RgbPixels& image, const std::optional<GreyPixels>& flip) {
    Json source = {{"whole", elements.add(reduced(image, factor), unit)}};
    if (factor > 1) source["crops"] = elements.add_parts(image, unit, crops);
    if (flip) source["flip"] = elements.add(reduced(*flip, factor));
    if (flip && factor > 1) source["flip_crops"] = elements.add_parts(*flip, crops);
    return source;
  };
  Json json = {{"reduced", factor}, {"truth", source_of(truth.airlight, {})}, {"runs", Json::object()}};
  for (const Whole& whole : wholes)
    json["runs"][fmt::format("{}", whole.run)] = source_of(whole.image.airlight, whole.flip);
  return json;
}

}  // namespace

std::vector<Crop> worst_crops(const GreyPixels& error, glm::ivec2 side, std::size_t count) {
  // Sums over the parts from the corner at the top left on: Crow, "Summed-Area Tables for Texture Mapping",
  // SIGGRAPH 1984.
  const glm::ivec2 size = error.size;
  const std::size_t stride = static_cast<std::size_t>(size.x) + 1;
  std::vector<double> sums(stride * (static_cast<std::size_t>(size.y) + 1), 0.0);
  const auto at = [&](int x, int y) -> double& {
    return sums[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      at(x + 1, y + 1) =
          at(x, y + 1) + at(x + 1, y) - at(x, y) +
          static_cast<double>(error.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) +
                                           static_cast<std::size_t>(x)]);

  std::vector<Crop> crops;
  while (crops.size() < count) {
    double most = -1.0;
    Crop worst{{}, side};
    for (int y = 0; y + side.y <= size.y; ++y) {
      for (int x = 0; x + side.x <= size.x; ++x) {
        const bool overlaps = std::any_of(crops.begin(), crops.end(), [&](const Crop& crop) {
          return std::abs(x - crop.from.x) < side.x && std::abs(y - crop.from.y) < side.y;
        });
        const double sum = at(x + side.x, y + side.y) - at(x, y + side.y) - at(x + side.x, y) + at(x, y);
        if (overlaps || sum <= most) continue;
        most = sum;
        worst.from = {x, y};
      }
    }
    if (most < 0.0) break;  // there is no room left
    crops.push_back(worst);
  }
  return crops;
}

PageImages page_images(const JoinedRuns& joined, std::size_t whole, std::size_t budget) {
  PageImages page;
  std::error_code error;
  if (joined.truth.empty()) {
    page.problem = "A sweep keeps no images: the command of a run, in its details, makes them.";
    return page;
  }
  if (!std::filesystem::exists(exr_of(joined.truth), error)) {
    page.problem = joined.views > 1 ? "Along a path no images of radiance are kept."
                                    : "The truth's image no longer lies beside results.json.";
    return page;
  }

  const Loaded truth = load(joined.truth);
  double mean = 0.0;
  for (const glm::vec3& value : truth.airlight.values)
    mean += static_cast<double>(value.r + value.g + value.b) / 3.0;
  mean /= static_cast<double>(truth.airlight.values.size());
  const float unit = static_cast<float>(mean) > 0.0f ? static_cast<float>(mean) : 1.0f;
  const double floor = joined.comparison.at("reference").value("floor", 0.0);

  const auto flip_of = [&](const Loaded& image) -> std::optional<GreyPixels> {
    std::vector<float> map =
        hdr_flip_map(image.airlight.values, truth.airlight.values, truth.airlight.size, floor);
    if (map.empty()) return std::nullopt;
    return GreyPixels{truth.airlight.size, std::move(map)};
  };
  std::vector<Whole> wholes;
  std::vector<std::size_t> others;
  GreyPixels off{truth.airlight.size, std::vector<float>(truth.airlight.values.size(), 0.0f)};
  for (std::size_t i = 0; i < joined.runs.size(); ++i) {
    const std::filesystem::path& stem = joined.runs[i].image;
    if (stem.empty() || !std::filesystem::exists(exr_of(stem), error)) continue;
    if (wholes.size() + 1 >= whole) {
      others.push_back(i);
      continue;
    }
    Whole& kept = wholes.emplace_back(Whole{i, load(stem), {}});
    require_size(stem, kept.image, truth);
    add_error(off, kept.image, truth);
    kept.flip = flip_of(kept.image);
  }
  const glm::ivec2 size = truth.airlight.size;
  const int side = std::clamp(std::min(size.x, size.y) / 4, k_smallest_crop, k_largest_crop);
  const std::vector<Crop> crops = worst_crops(off, glm::min(glm::ivec2(side), size), k_crops);

  // Whole images get what the others leave, half of the room at least.
  Json runs = Json::object();
  std::size_t without = 0;
  Elements elements;
  for (const std::size_t i : others) {
    const Loaded image = load(joined.runs[i].image);
    require_size(joined.runs[i].image, image, truth);
    Elements next = elements;
    Json source = {{"crops", next.add_parts(image.airlight, unit, crops)}};
    if (const auto flip = flip_of(image)) source["flip_crops"] = next.add_parts(*flip, crops);
    if (next.html().size() > budget / 2) {
      ++without;
      continue;
    }
    elements = std::move(next);
    runs[fmt::format("{}", i)] = std::move(source);
  }
  for (const int factor : k_factors) {
    Elements all = elements;
    Json json = sources(all, truth, wholes, crops, unit, factor);
    if (all.html().size() > budget) continue;
    page.html = all.html();
    page.json = {{"size", {size.x, size.y}}, {"unit", unit}, {"mean", mean}, {"without", without}};
    page.json.update(json);
    page.json["runs"].update(runs);
    for (const Crop& crop : crops)
      page.json["crops"].push_back({crop.from.x, crop.from.y, crop.size.x, crop.size.y});
    return page;
  }
  page.problem = "The figures alone fill the page: there is no room for images.";
  return page;
}

}  // namespace airlight::quality
