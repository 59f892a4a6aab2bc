#include "quality/tone_map.h"

#include "shared.h"

namespace airlight::shaders {
using glm::pow;
#include "viewer/tone_map.glsl"
}  // namespace airlight::shaders

namespace airlight::quality {

glm::vec3 tone_mapped(scene::ToneMap tone_map, glm::vec3 radiance) {
  return shaders::tone_mapped(static_cast<std::uint32_t>(tone_map), radiance);
}

}  // namespace airlight::quality
