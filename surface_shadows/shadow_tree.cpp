#include "surface_shadows/shadow_tree.h"

#include "frame/blocks.h"
#include "surface_shadows/transmission.h"

namespace airlight::surface_shadows {

gpu::Format ShadowTree::visibility_format(const frame::SceneBuffers& scene) const {
  return transmission_format(scene);
}

const frame::ScreenPass& ShadowTree::pass(const frame::SceneBuffers& scene, Counted counted) {
  const std::pair key(scene.transmits(), counted);
  if (const auto found = passes_.find(key); found != passes_.end()) return found->second;
  std::vector<gpu::Constant> constants = walk_constants(scene);
  constants.emplace_back(0, static_cast<std::uint32_t>(counted));
  return passes_.try_emplace(key, query_, constants).first->second;
}

void ShadowTree::run(const frame::ScreenPass& pass, const frame::FrameInputs& inputs,
                     const gpu::Texture& image) const {
  bind_walk(inputs, pass.pipeline());
  inputs.surface_points().bind_sampler(shaders::k_surface_unit);
  inputs.triangles.bind_sampler(shaders::k_triangle_unit);
  pass.run({image});
}

void ShadowTree::query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) {
  inputs.surface_points();  // a stage of its own
  build(inputs);
  const frame::ScreenPass& query = pass(inputs.scene, Counted::none);
  inputs.timer.time("surface_query", [&] { run(query, inputs, visibility); });
}

void ShadowTree::count_nodes(const frame::FrameInputs& inputs, const gpu::Texture& counts) {
  run(pass(inputs.scene, Counted::nodes), inputs, counts);
}

double ShadowTree::total(const frame::FrameInputs& inputs, Counted counted) {
  const gpu::Texture of_pixels(gpu::Format::r32f, inputs.view.size);
  run(pass(inputs.scene, counted), inputs, of_pixels);
  double sum = 0.0;
  for (const float of_pixel : of_pixels.read<float>()) sum += static_cast<double>(of_pixel);
  return sum;
}

}  // namespace airlight::surface_shadows
