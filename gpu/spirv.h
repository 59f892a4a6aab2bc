#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace airlight::gpu {

/// A variable of a shader that is bound from outside.
struct SpirvResource {
  enum class Kind { uniform_block, storage_block, sampler, image };
  Kind kind;
  std::uint32_t first_binding, last_binding;  ///< the same unless it is an array
  bool is_written;                            ///< a storage block or image that is not declared `readonly`
};

/// What a SPIR-V module says about itself.
struct SpirvModule {
  std::vector<std::uint32_t> constant_ids;  ///< of its specialization constants
  std::vector<SpirvResource> resources;
};

/// Reads the declarations of a module that the build has made; needs no GL.
SpirvModule read_spirv(std::span<const std::uint32_t> words);

}  // namespace airlight::gpu
