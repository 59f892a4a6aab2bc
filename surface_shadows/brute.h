#pragma once

#include <map>

#include "frame/method.h"
#include "frame/screen_pass.h"
#include "surface_shadows/occluders.h"
#include "surface_shadows/transmission.h"

namespace airlight::surface_shadows {

struct BruteOptions {
  Culling cull = Culling::none;

  bool ignores_cut_outs() const { return true; }
};

/// `brute`: asks the predicate of every triangle, in the order of their numbers. What other exact methods
/// must answer alike, bit for bit.
class Brute : public frame::SurfaceShadow {
 public:
  explicit Brute(const BruteOptions& options);
  gpu::Format visibility_format(const frame::SceneBuffers& scene) const override {
    return transmission_format(scene);
  }
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override;
  std::map<std::string, std::int64_t> bytes() const override { return {{"occluders", occluders_.bytes()}}; }

 private:
  Occluders occluders_;
  std::map<bool, frame::ScreenPass> passes_;  ///< by whether the scene transmits
};

frame::SurfaceMethod brute_method();

}  // namespace airlight::surface_shadows
