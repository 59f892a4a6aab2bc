#include "quality/tone_map.h"

#include <cmath>

#include "quality/flip.h"

namespace airlight::quality {
namespace {

constexpr glm::vec3 k_luminance(0.2126f, 0.7152f, 0.0722f);  // of Rec. 709

glm::vec3 reinhard(glm::vec3 radiance) {
  return radiance / (1.0f + glm::dot(radiance, k_luminance));
}

glm::vec3 aces(glm::vec3 radiance) {
  return {flip::tone_mapped(radiance.r), flip::tone_mapped(radiance.g), flip::tone_mapped(radiance.b)};
}

glm::vec3 agx(glm::vec3 radiance) {
  // By columns: from Rec. 709 to AgX's own primaries, within which bright colours lose their saturation, and
  // back.
  constexpr glm::mat3 k_inset(0.842479062253094f, 0.0423282422610123f, 0.0423756549057051f,  //
                              0.0784335999999992f, 0.878468636469772f, 0.0784336f,           //
                              0.0792237451477643f, 0.0791661274605434f, 0.879142973793104f);
  constexpr glm::mat3 k_outset(1.19687900512017f, -0.0528968517574562f, -0.0529716355144438f,  //
                               -0.0980208811401368f, 1.15190312990417f, -0.0980434501171241f,  //
                               -0.0990297440797205f, -0.0989611768448433f, 1.15107367264116f);
  constexpr float k_least = -12.47393f, k_most = 4.026069f;  // log2 of what the curve spans
  const glm::vec3 stops = glm::log2(glm::max(k_inset * radiance, glm::vec3(1e-30f)));
  const glm::vec3 x = (glm::clamp(stops, k_least, k_most) - k_least) / (k_most - k_least);
  const glm::vec3 curve =
      (((((15.5f * x - 40.14f) * x + 31.96f) * x - 6.868f) * x + 0.4298f) * x + 0.1191f) * x - 0.00232f;
  // The curve's result is encoded for a display of gamma 2.2.
  return glm::pow(glm::max(k_outset * curve, glm::vec3(0.0f)), glm::vec3(2.2f));
}

}  // namespace

glm::vec3 tone_mapped(scene::ToneMap tone_map, glm::vec3 radiance) {
  // Beyond, all is white.
  radiance = glm::clamp(radiance, 0.0f, 1e30f);
  switch (tone_map) {
    case scene::ToneMap::none:
      break;
    case scene::ToneMap::reinhard:
      radiance = reinhard(radiance);
      break;
    case scene::ToneMap::aces:
      radiance = aces(radiance);
      break;
    case scene::ToneMap::agx:
      radiance = agx(radiance);
      break;
  }
  return glm::min(radiance, glm::vec3(1.0f));
}

}  // namespace airlight::quality
