#include "quality/page_pictures.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <png.h>

#include "quality/packed_image.h"
#include "quality/report_tables.h"
#include "scene/decode_image.h"
#include "scene/error.h"
#include "scene/path.h"

namespace airlight::quality {
namespace {

using Json = nlohmann::ordered_json;

constexpr int k_sides[] = {320, 240, 160, 120, 80};  ///< that a picture may have at most [pixels]

struct Picture {
  std::filesystem::path file;
  std::string caption;
};

/// Those of a run that are there.
std::vector<Picture> pictures_of(const JoinedRun& run) {
  std::vector<Picture> pictures;
  if (run.image.empty()) return pictures;
  std::string frame, which;
  if (run.json.contains("path")) {
    const std::size_t worst = run.json["path"].value("worst_frame", std::size_t{0});
    frame = scene::frame_ending(worst);
    which = fmt::format(", frame {}, the worst", worst);
  }
  const auto add = [&](const std::filesystem::path& stem, const std::string& ending,
                       const std::string& caption) {
    std::filesystem::path file = stem;
    file += ending + ".png";
    std::error_code error;
    if (std::filesystem::exists(file, error)) pictures.push_back({file, caption});
  };
  add(run.image, frame, "radiance" + which);
  if (!frame.empty())
    add(run.image, "_error" + frame, "airlight error: red too bright, blue too dark" + which);
  add(run.image, "_surface" + frame, "surface shadow: wrong pixels red, undecided ones yellow" + which);
  for (const Json& image : run.json.value("debug_images", Json::array()))
    add(run.image.parent_path() / image.value("name", ""), "",
        fmt::format("{}; white is {:.3g} %", image.value("caption", ""), 100.0 * image.value("white", 1.0)));
  return pictures;
}

RgbPixels read_png(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(stream), {}};
  try {
    const scene::TextureImage image = scene::decode_image(bytes);
    RgbPixels pixels{image.size, {}};
    for (const glm::u8vec4& texel : image.texels) pixels.values.emplace_back(texel.r, texel.g, texel.b);
    return pixels;
  } catch (const std::runtime_error& error) {
    throw scene::Error(scene::ExitCode::bad_file, file.string(), error.what());
  }
}

std::string png_of(const RgbPixels& pixels) {
  std::vector<png_byte> bytes;
  for (const glm::vec3& value : pixels.values)
    for (int channel = 0; channel < 3; ++channel)
      bytes.push_back(static_cast<png_byte>(std::lround(value[channel])));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(pixels.size.x);
  image.height = static_cast<png_uint_32>(pixels.size.y);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(size, '\0');
  if (!png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, nullptr))
    throw scene::Error(scene::ExitCode::bad_file, "a preview",
                       fmt::format("it cannot be made smaller: {}", image.message));
  file.resize(size);
  return file;
}

/// One run's, with no side longer than that; means are of what is encoded, which is good enough to recognise
/// it.
std::string figures_html(const std::vector<Picture>& pictures, int side) {
  std::string html;
  for (const Picture& picture : pictures) {
    const RgbPixels whole = read_png(picture.file);
    const int longest = std::max(whole.size.x, whole.size.y);
    const RgbPixels small = reduced(whole, (longest + side - 1) / side);
    html += fmt::format(
        "<figure><img src=\"data:image/png;base64,{}\" width=\"{}\" height=\"{}\" alt=\"{}\">"
        "<figcaption>{}</figcaption></figure>\n",
        base64(png_of(small)), small.size.x, small.size.y, escape_html(picture.caption),
        escape_html(picture.caption));
  }
  return html;
}

}  // namespace

std::string pictures_html(const JoinedRuns& joined, std::size_t budget) {
  std::string html;
  std::size_t left_out = 0;
  for (const int side : k_sides) {
    html.clear();
    left_out = 0;
    for (const JoinedRun& run : joined.runs) {
      const std::vector<Picture> pictures = pictures_of(run);
      if (pictures.empty()) continue;
      const std::string of_run =
          fmt::format("<h3>{} × {}</h3>\n<div class=\"pictures\">\n{}</div>\n", escape_html(run.volume),
                      escape_html(run.surface), figures_html(pictures, side));
      if (html.size() + of_run.size() <= budget)
        html += of_run;
      else
        ++left_out;
      if (left_out > 0 && side != k_sides[std::size(k_sides) - 1]) break;  // smaller ones are tried
    }
    if (left_out == 0) break;
  }
  if (left_out > 0)
    html += fmt::format("<p class=\"note\">For want of room without pictures: {} runs.</p>\n", left_out);
  if (html.empty()) return {};
  return "<section id=\"pictures-part\"><h2>Pictures</h2>\n<details><summary>Radiance and surface shadow of "
         "each "
         "run</summary>\n" +
         html + "</details></section>\n";
}

}  // namespace airlight::quality
