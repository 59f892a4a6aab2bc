#include "viewer/truth.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <utility>

#include "reference/reference.h"

namespace airlight::viewer {
namespace {

/// By which the sides of the images are divided, one after the other; each takes as long as all before it,
/// and more.
constexpr int k_divisors[] = {8, 4, 2, 1};

struct Stopped {};

}  // namespace

void BackgroundTruth::start(const scene::Geometry& geometry, const scene::View& view) {
  stop();
  is_stopped_ = false;
  is_tracing_ = true;
  fraction_ = 0.0;
  thread_ = std::jthread([this, &geometry, view] {
    try {
      trace(geometry, view);
    } catch (const Stopped&) {
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      error_ = std::current_exception();
    }
    is_tracing_ = false;
  });
}

void BackgroundTruth::stop() {
  is_stopped_ = true;
  if (thread_.joinable()) thread_.join();
  const std::scoped_lock lock(mutex_);
  image_.reset();
  error_ = nullptr;
}

std::optional<BackgroundTruth::Image> BackgroundTruth::take() {
  const std::scoped_lock lock(mutex_);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  return std::exchange(image_, std::nullopt);
}

void BackgroundTruth::trace(const scene::Geometry& geometry, const scene::View& view) {
  double work = 0.0, done = 0.0;  // in images of the whole size
  for (const int divisor : k_divisors) work += 1.0 / (divisor * divisor);
  std::vector<reference::Reference> of_lights;  // whose hierarchies serve all sizes
  for (const int divisor : k_divisors) {
    Image image{
        .size = glm::max(view.size / divisor, glm::ivec2(1)), .airlight = {}, .is_whole = divisor == 1};
    for (std::size_t light = 0; light < view.lights.size(); ++light) {
      if (is_stopped_) return;
      if (light == of_lights.size()) of_lights.emplace_back(geometry, view, light);
      of_lights[light].resize(image.size);
      const double share = 1.0 / (divisor * divisor * static_cast<double>(view.lights.size()));
      const auto follow = [&](double fraction) {
        if (is_stopped_) throw Stopped{};
        fraction_ = (done + fraction * share) / work;
      };
      const auto traced = of_lights[light].exact(1, follow);
      done += share;
      if (image.airlight.empty()) image.airlight.resize(traced.radiance.size());
      for (std::size_t i = 0; i < traced.radiance.size(); ++i) image.airlight[i] += traced.radiance[i];
    }
    const std::scoped_lock lock(mutex_);
    image_ = std::move(image);
  }
}

}  // namespace airlight::viewer
