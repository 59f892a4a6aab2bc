#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace airlight::gpu {

/// Shaders that have been compiled anew while the program runs: by the address of the embedded words, those
/// in their place.
using ReplacedShaders = std::map<const std::uint32_t*, std::vector<std::uint32_t>>;

/// What pipelines that are made from now on are made of; empty at first.
ReplacedShaders& replaced_shaders();

/// The words in the place of embedded ones, or these.
std::span<const std::uint32_t> current_words(std::span<const std::uint32_t> embedded);

}  // namespace airlight::gpu
