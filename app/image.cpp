#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/output.h"
#include "quality/flip.h"
#include "quality/image_pair.h"
#include "quality/pictures.h"
#include "quality/results.h"
#include "scene/numbers.h"

namespace airlight::app {
namespace {

using scene::Error;
using scene::ExitCode;

/// One of the things that can be asked of images.
struct Question {
  std::string_view word;
  std::size_t images;
  std::vector<std::string_view> options;  ///< that it reads, without dashes
  bool needs_output, may_have_output;
};

const std::vector<Question>& questions() {
  static const std::vector<Question> k_questions = {
      {"diff", 2, {"layer"}, true, true},
      {"error", 2, {"layer", "json"}, false, false},
      {"flip", 2, {"layer", "exposure"}, false, true},
      {"info", 1, {}, false, false},
      {"crop", 1, {"crop"}, true, true},
  };
  return k_questions;
}

/// Finds what is asked. @throws scene::Error (usage) where words or options do not fit it
const Question& asked(const Options& options) {
  constexpr const char* k_words = "use diff, error, flip, info or crop";
  if (options.places.empty()) throw Error(ExitCode::usage, "image", "it is not said what is asked", k_words);
  const auto found = std::find_if(questions().begin(), questions().end(),
                                  [&](const Question& q) { return q.word == options.places[0]; });
  if (found == questions().end())
    throw Error(ExitCode::usage, options.places[0], "it is no word of image", k_words);
  const std::size_t images = options.places.size() - 1;
  if (images != found->images)
    throw Error(ExitCode::usage, fmt::format("image {}", found->word),
                fmt::format("it takes {} image{}, and {} {} given", found->images,
                            found->images == 1 ? "" : "s", images, images == 1 ? "is" : "are"));
  for (const auto& [name, value] : options.given)
    if (std::find(found->options.begin(), found->options.end(), name) == found->options.end())
      throw Error(ExitCode::usage, "--" + name, fmt::format("image {} does not read it", found->word));
  if (found->needs_output && options.output.empty())
    throw Error(ExitCode::usage, "-o", "it is missing", "name the image that is to be written");
  if (!found->may_have_output && !options.output.empty())
    throw Error(ExitCode::usage, "-o", fmt::format("image {} writes no image", found->word));
  return *found;
}

quality::Crop crop_of(const Options& options) {
  const auto text = options.get("crop");
  if (!text)
    throw Error(ExitCode::usage, "--crop", "it is missing", "give the part, as in --crop 100,50,64,64");
  std::array<int, 4> numbers{};
  std::size_t begin = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t end = i < 3 ? text->find(',', begin) : text->size();
    if (end == std::string::npos)
      throw Error(ExitCode::usage, "--crop", fmt::format("'{}' is not four numbers", *text),
                  "give the part, as in --crop 100,50,64,64");
    const std::string word = text->substr(begin, end - begin);
    numbers[i] = word == "0" ? 0 : scene::parse_count("--crop", word);
    begin = end + 1;
  }
  return {{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
}

void write_diff(const Options& options, const quality::ImageFile& x, const quality::ImageFile& r) {
  const quality::Image difference = quality::difference(x, r);
  const std::string layer = options.get("layer").value_or("");
  const std::vector<glm::vec3> colours =
      quality::error_colours(quality::layer_of(x, layer), quality::layer_of(r, layer));
  quality::write_exr(options.output, difference);
  const std::filesystem::path picture = std::filesystem::path(options.output).replace_extension(".png");
  quality::write_png(picture, colours, difference.size, 1.0f);
}

void tell_flip(const Options& options, const quality::ImageFile& x, const quality::ImageFile& r) {
  const std::string layer = options.get("layer").value_or("");
  const std::vector<glm::vec3> of_x = quality::layer_of(x, layer), of_r = quality::layer_of(r, layer);
  std::vector<float> map;
  if (const auto text = options.get("exposure")) {
    const double exposure = scene::parse_number("--exposure", *text);
    if (exposure <= 0.0) throw Error(ExitCode::usage, "--exposure", fmt::format("{} is not positive", *text));
    map = quality::ldr_flip_map(of_x, of_r, x.image.size, static_cast<float>(exposure));
  } else {
    map = quality::hdr_flip_map(of_x, of_r, x.image.size);
  }
  if (map.empty())
    throw Error(ExitCode::bad_file, r.file.string(), "it is black: FLIP has no exposure for it",
                "give --exposure");
  if (!options.output.empty())
    quality::write_png(options.output, quality::flip_colours(map), x.image.size, 1.0f);
  print(fmt::format("{:.6g}\n", quality::flip::mean(map)));
}

}  // namespace

void image(const Options& options) {
  const Question& question = asked(options);
  if (!options.output.empty()) require_writable(options.output);
  const quality::ImageFile x = quality::read_image(options.places[1]);
  if (question.word == "info") return print(quality::image_info(x));
  if (question.word == "crop")
    return quality::write_exr(options.output, quality::cropped(x, crop_of(options)));

  const quality::ImageFile r = quality::read_image(options.places[2]);
  if (question.word == "diff") return write_diff(options, x, r);
  if (question.word == "flip") return tell_flip(options, x, r);
  const quality::PairError error = quality::pair_error(x, r, options.get("layer").value_or(""));
  const auto json = options.get("json");
  if (json && *json != "-") quality::write_text(*json, quality::pair_error_json(error));
  print(json == "-" ? quality::pair_error_json(error) : quality::pair_error_text(error));
}

}  // namespace airlight::app
