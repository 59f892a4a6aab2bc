#include "surface_shadows/brute.h"

#include <array>

#include <fmt/format.h>

#include "frame/blocks.h"
#include "scene/error.h"

#include "spirv/surface_shadows/brute_frag.h"

namespace airlight::surface_shadows {

/// llvmpipe ends a shader's loops unasked after 65,535 turns: what came after would be lit.
constexpr std::uint32_t k_most_triangles = 65000;

Brute::Brute(const BruteOptions& options) : occluders_(options.cull) {}

void Brute::query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) {
  if (inputs.scene.triangle_count() > k_most_triangles)
    throw scene::Error(
        scene::ExitCode::driver, "--surface brute",
        fmt::format("the model's {} triangles are more than the {} turns after which drivers end a loop",
                    inputs.scene.triangle_count(), k_most_triangles),
        "take psv or metric-tree, which answer alike");
  const gpu::Texture& points = inputs.surface_points();
  inputs.triangle_planes();
  inputs.timer.time("surface_build", [&] { occluders_.build(inputs); });
  const bool transmits = inputs.scene.transmits();
  if (!passes_.contains(transmits))
    passes_.try_emplace(transmits, k_brute_frag, std::array{transmission_constant(inputs.scene)});
  const frame::ScreenPass& pass = passes_.at(transmits);
  inputs.timer.time("surface_query", [&] {
    occluders_.bind(inputs);
    points.bind_sampler(shaders::k_surface_unit);
    inputs.triangles.bind_sampler(shaders::k_triangle_unit);
    pass.pipeline().set(1, occluders_.scale());
    pass.pipeline().set(2, occluders_.count());
    pass.run({visibility});
  });
}

frame::SurfaceMethod brute_method() {
  return frame::describe<frame::SurfaceShadow, BruteOptions>(
      "brute", "every triangle is asked whether it hides the pixel's point: exact, for small scenes",
      {.is_exact = true, .transmits = true}, {culling_option(&BruteOptions::cull)},
      [](const gpu::Context&, const BruteOptions& options) { return std::make_unique<Brute>(options); });
}

}  // namespace airlight::surface_shadows
