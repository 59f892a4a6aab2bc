#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "gpu/buffer.h"
#include "gpu/framebuffer.h"
#include "gpu/handle.h"

namespace airlight::gpu {

void delete_program(unsigned name);

/// A value for a specialization constant of a SPIR-V shader.
struct Constant {
  Constant(std::uint32_t constant_id, std::uint32_t value) : id(constant_id), bits(value) {}
  std::uint32_t id;
  std::uint32_t bits;
};

/// The SPIR-V of the stages of a graphics pipeline; a stage that is left out is empty.
struct GraphicsStages {
  std::span<const std::uint32_t> vertex;
  std::span<const std::uint32_t> tessellation_control = {};
  std::span<const std::uint32_t> tessellation_evaluation = {};
  std::span<const std::uint32_t> geometry = {};
  std::span<const std::uint32_t> fragment = {};
};

/// Of a new value with the stored one; in OpenGL's order.
enum class Compare { never, less, equal, less_equal, greater, not_equal, greater_equal, always };

enum class Cull { none, front, back };

/// How a fragment's colour c joins what is there, d.
enum class Blend {
  replace,   ///< c
  add,       ///< c + d
  multiply,  ///< c · d
  minimum,   ///< each channel for itself
  maximum,
  over,  ///< a·c + (1 − a)·d, a the alpha of c
};

/// How a fragment's bits join those of an integer colour attachment.
enum class LogicOp { bit_and, bit_or, bit_xor };

enum class StencilOp { keep, zero, replace, increment_wrap, decrement_wrap, invert };

/// The stencil test of triangles that face one way: passes where `reference & read_mask` compares with the
/// stored value under the same mask.
struct StencilTest {
  Compare compare = Compare::always;
  std::uint8_t reference = 0;
  std::uint8_t read_mask = 0xff, write_mask = 0xff;
  StencilOp on_fail = StencilOp::keep, on_depth_fail = StencilOp::keep, on_pass = StencilOp::keep;
};

struct TwoSidedStencil {
  StencilTest front, back;
};

/// What a graphics pipeline has beside its shaders. The defaults are those of OpenGL.
struct FixedState {
  std::optional<Compare> depth_test = {};  ///< none: depth is neither tested nor written
  bool depth_write = true;
  bool depth_clamp = false;        ///< what lies beyond the near and far planes is kept, at their depth
  bool upper_left_origin = false;  ///< y of clip space runs downwards; front faces stay front faces
  bool zero_to_one_depth = false;  ///< depth of clip space runs from 0 to w, not from −w
  Cull cull = Cull::none;          ///< triangles that turn from x to y of clip space are front faces
  std::optional<TwoSidedStencil> stencil = {};
  glm::bvec4 colour_write = glm::bvec4(true);
  Blend blend = Blend::replace;
  std::optional<LogicOp> logic_op = {};
  int patch_vertices = 3;  ///< of a patch, where there is tessellation
};

/// A linked program made from embedded SPIR-V, or what has replaced it (replaced_shaders), specialised at
/// load, with its fixed state.
///
/// Between two passes OpenGL's fixed state is that of a new context: a pipeline sets what it needs before its
/// draws, and takes it back after them.
class Pipeline {
 public:
  Pipeline() = default;

  /// @param constants each declared by a stage; a stage is given those that it declares
  /// @throws scene::Error (driver) with the driver's log when it does not specialise or link.
  static Pipeline compute(std::span<const std::uint32_t> spirv, std::span<const Constant> constants = {});
  static Pipeline graphics(const GraphicsStages& stages, const FixedState& state = {},
                           std::span<const Constant> constants = {});

  /// Sets a uniform, outside of blocks, that the program uses at `location`, for all later runs.
  void set(int location, int value) const;
  void set(int location, std::uint32_t value) const;
  void set(int location, float value) const;
  void set(int location, glm::uvec2 value) const;
  void set(int location, glm::uvec3 value) const;
  void set(int location, glm::uvec4 value) const;
  void set(int location, glm::vec3 value) const;

  /// Invocations in one group of a compute pipeline.
  glm::uvec3 work_group() const { return work_group_; }

  /// Runs a compute pipeline on enough work groups to cover `invocations`, with all memory barriers that
  /// later shaders, draws and copies need.
  /// @throws scene::Error (driver) naming the limit when those are more groups than the driver takes at once.
  void dispatch(glm::uvec3 invocations) const;

  /// The same, with the number of groups read on the GPU from three words at `offset` [bytes] of `groups`.
  void dispatch_indirect(const Buffer& groups, std::int64_t offset) const;

  /// Runs a graphics pipeline: `draws` binds vertex arrays and issues the draws into `target`. Barriers
  /// follow where a shader may have written to memory.
  template <typename Draws>
  void draw(const Framebuffer& target, Draws&& draws) const {
    const Pass pass(*this, target);
    draws();
  }

 private:
  /// While it lives, OpenGL is set up for the pipeline's draws.
  class Pass {
   public:
    Pass(const Pipeline& pipeline, const Framebuffer& target);
    ~Pass();
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

   private:
    const Pipeline& pipeline_;
  };

  Handle<delete_program> handle_;
  FixedState state_;
  bool writes_memory_ = false;
  glm::uvec3 work_group_{0}, max_work_groups_{0};
};

}  // namespace airlight::gpu
