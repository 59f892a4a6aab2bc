#include "quality/light_texture.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "quality/image_io.h"
#include "scene/error.h"

namespace airlight::quality {

scene::LightTexture read_light_texture(const std::filesystem::path& file) {
  const Image image = read_exr(file);
  std::vector<glm::vec3> texels(static_cast<std::size_t>(image.size.x) *
                                static_cast<std::size_t>(image.size.y));
  for (int channel = 0; channel < 3; ++channel) {
    const auto values = image.channels.find(std::string(1, "RGB"[channel]));
    if (values == image.channels.end()) {
      throw scene::Error(scene::ExitCode::bad_file, file.string(),
                         fmt::format("it has no channel {}", "RGB"[channel]),
                         "a light texture has the channels R, G and B");
    }
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i][channel] = values->second[i];
  }
  return {file.string(), image.size, std::move(texels)};
}

}  // namespace airlight::quality
