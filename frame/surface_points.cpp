#include "frame/surface_points.h"

#include "frame/blocks.h"

#include "spirv/frame/surface_points_frag.h"

namespace airlight::frame {

LightOrigin light_origin(const scene::Light& light, glm::dvec3 eye) {
  const glm::dvec3 origin = scene::is_sun(light) ? eye : light.position;
  const glm::vec3 high(origin);
  return {high, glm::vec3(origin - glm::dvec3(high))};
}

SurfacePointPass::SurfacePointPass() : pass_(k_surface_points_frag) {}

void SurfacePointPass::run(const SceneBuffers& scene, const gpu::Texture& triangles,
                           const LightOrigin& origin, const gpu::Texture& points) const {
  scene.bind_samplers();
  triangles.bind_sampler(shaders::k_triangle_unit);
  pass_.pipeline().set(0, origin.high);
  pass_.pipeline().set(1, origin.low);
  pass_.run({points});
}

}  // namespace airlight::frame
