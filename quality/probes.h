#pragma once

#include <functional>
#include <utility>

#include "frame/methods.h"

namespace airlight::quality {

/// Looks at what an airlight method has left behind of each light.
class AirlightProbe : public frame::Airlight {
 public:
  using Look = std::function<void(const frame::FrameInputs& inputs)>;
  AirlightProbe(frame::Airlight& airlight, Look look) : airlight_(airlight), look_(std::move(look)) {}
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override {
    airlight_.integrate(inputs, radiance);
    look_(inputs);
  }
  frame::ViewRays rays() const override { return airlight_.rays(); }
  bool sees_every_light() const override { return airlight_.sees_every_light(); }

 private:
  frame::Airlight& airlight_;
  Look look_;
};

/// The same of a method of surface shadow.
class ShadowProbe : public frame::SurfaceShadow {
 public:
  using Look = AirlightProbe::Look;
  ShadowProbe(frame::SurfaceShadow& shadow, Look look) : shadow_(shadow), look_(std::move(look)) {}
  gpu::Format visibility_format(const frame::SceneBuffers& scene) const override {
    return shadow_.visibility_format(scene);
  }
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override {
    shadow_.query(inputs, visibility);
    look_(inputs);
  }
  bool sees_every_light() const override { return shadow_.sees_every_light(); }

 private:
  frame::SurfaceShadow& shadow_;
  Look look_;
};

}  // namespace airlight::quality
