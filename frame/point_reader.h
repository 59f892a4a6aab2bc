#pragma once

#include <utility>

#include "frame/methods.h"
#include "frame/surface_points.h"

namespace airlight::frame {

/// Reads back what a frame shades. It answers no question: the visibility that it writes is 0.
class PointReader : public SurfaceShadow {
 public:
  void query(const FrameInputs& inputs, const gpu::Texture& visibility) override;
  bool sees_every_light() const override { return true; }

  /// Of the last frame.
  const SurfacePoints& points() const { return points_; }
  SurfacePoints take_points() { return std::exchange(points_, {}); }

 private:
  SurfacePoints points_;
};

}  // namespace airlight::frame
