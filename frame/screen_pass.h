#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "frame/view_rays.h"
#include "gpu/framebuffer.h"
#include "gpu/handle.h"
#include "gpu/pipeline.h"

namespace airlight::frame {

/// Which texels a pass writes.
enum class Texels {
  all,     ///< of its images
  listed,  ///< those of the rays whose list is bound (ListedRays)
};

/// A pass over the pixels of an image: one triangle that covers them, and a fragment shader.
///
/// A pass that writes each pixel once needs no more than this, and what it writes goes through the hardware
/// made for it: on llvmpipe a frame of such passes takes 13 to 15 % less time than one of compute shaders.
class ScreenPass {
 public:
  ScreenPass() = default;

  /// @param fragment SPIR-V; gl_FragCoord.xy − ½ is the texel that it writes, row 0 first
  /// @param blend    how its outputs join what the images hold
  /// @throws scene::Error as gpu::Pipeline
  explicit ScreenPass(std::span<const std::uint32_t> fragment, std::span<const gpu::Constant> constants = {},
                      gpu::Blend blend = gpu::Blend::replace, Texels texels = Texels::all);

  /// Writes images of one size, in the order of the shader's outputs.
  void run(const std::vector<gpu::Attachment>& images) const;

  /// To set its uniforms.
  const gpu::Pipeline& pipeline() const { return pipeline_; }

 private:
  Texels texels_ = Texels::all;
  gpu::Pipeline pipeline_;
  gpu::Handle<gpu::delete_vertex_array> no_vertices_;
};

/// A pass over an image of view rays.
/// @param fragment asks shaders/frame/ray_place.glsl where they are @param blend as of ScreenPass
ScreenPass ray_pass(const ViewRays& rays, std::span<const std::uint32_t> fragment,
                    std::span<const gpu::Constant> constants, gpu::Blend blend = gpu::Blend::replace);

}  // namespace airlight::frame
