#include "gpu/replaced_shaders.h"

namespace airlight::gpu {

ReplacedShaders& replaced_shaders() {
  static ReplacedShaders replaced;
  return replaced;
}

std::span<const std::uint32_t> current_words(std::span<const std::uint32_t> embedded) {
  const auto found = replaced_shaders().find(embedded.data());
  return found == replaced_shaders().end() ? embedded : std::span<const std::uint32_t>(found->second);
}

}  // namespace airlight::gpu
