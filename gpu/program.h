#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "gpu/buffer.h"
#include "gpu/handle.h"

namespace airlight::gpu {

void delete_program(unsigned name);

/// A value for a specialization constant of a SPIR-V shader.
struct Constant {
  Constant(std::uint32_t constant_id, std::uint32_t value) : id(constant_id), bits(value) {}
  std::uint32_t id;
  std::uint32_t bits;
};

/// A linked program made from embedded SPIR-V, specialised at load.
class Program {
 public:
  Program() = default;

  /// @throws scene::Error (driver) with the driver's log when it does not specialise or link.
  static Program compute(std::span<const std::uint32_t> spirv, std::span<const Constant> constants = {});
  static Program graphics(std::span<const std::uint32_t> vertex, std::span<const std::uint32_t> fragment);

  void use() const;

  /// Runs a compute program on enough work groups of `group` invocations to cover `invocations`, with all
  /// memory barriers that later shaders, draws and copies need.
  void dispatch(glm::uvec3 invocations, glm::uvec3 group) const;

  /// The same, with the number of groups read on the GPU from three words at `offset` [bytes] of `groups`.
  void dispatch_indirect(const Buffer& groups, std::int64_t offset) const;

 private:
  explicit Program(unsigned name) : handle_(name) {}
  Handle<delete_program> handle_;
};

}  // namespace airlight::gpu
