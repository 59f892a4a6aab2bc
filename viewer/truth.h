#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "scene/scene.h"

namespace airlight::viewer {

/// The exact airlight of a view, traced beside the window's own work: first a coarse image, then finer ones.
class BackgroundTruth {
 public:
  struct Image {
    glm::ivec2 size{0};
    std::vector<glm::vec3> airlight;  ///< of all lights; row 0 at the top [W/(m² sr)]
    bool is_whole = false;            ///< of the view's size: no finer one comes
  };

  ~BackgroundTruth() { stop(); }

  /// Stops what is being traced, and begins anew. @param geometry kept by reference until `stop`
  void start(const scene::Geometry& geometry, const scene::View& view);
  void stop();

  /// The finest image since the last call, if any. @throws what tracing threw
  std::optional<Image> take();
  bool is_tracing() const { return is_tracing_; }
  /// Of all images together.
  double fraction() const { return fraction_; }

 private:
  void trace(const scene::Geometry& geometry, const scene::View& view);

  std::jthread thread_;
  std::mutex mutex_;
  std::optional<Image> image_;
  std::exception_ptr error_;
  std::atomic<bool> is_tracing_ = false, is_stopped_ = false;
  std::atomic<double> fraction_ = 0.0;
};

}  // namespace airlight::viewer
