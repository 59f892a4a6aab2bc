#include "quality/traced.h"

#include <algorithm>
#include <chrono>

namespace airlight::quality {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void upload(const std::vector<glm::vec3>& image, const gpu::Texture& texture) {
  std::vector<glm::vec4> rgba;
  rgba.reserve(image.size());
  for (const glm::vec3& value : image) rgba.emplace_back(value, 0.0f);
  texture.write(rgba.data());
}

/// What the three methods of airlight differ in: each prepares what its rays need, and traces one light's
/// image.
struct ExactOptions {
  int refine = 1;

  void prepare(SharedReference& shared) const { shared.prepare_truth(refine); }
  const reference::AirlightImage& trace(SharedReference& shared, std::size_t light) const {
    return shared.exact(light, refine);
  }
};

struct SampledOptions {
  int samples = 512;

  void prepare(SharedReference& shared) const { shared.prepare(); }
  reference::AirlightImage trace(SharedReference& shared, std::size_t light) const {
    return shared.sampled(light, samples);
  }
};

struct MarchOptions {
  int steps = 512;
  reference::RayMode rays = reference::RayMode::packet;

  void prepare(SharedReference& shared) const { shared.prepare(); }
  reference::AirlightImage trace(SharedReference& shared, std::size_t light) const {
    return shared.march(light, steps, rays);
  }
};

template <typename Options>
class TracedAirlight : public frame::Airlight, public Traced {
 public:
  explicit TracedAirlight(const Options& options) : options_(options) {}
  void borrow(SharedReference& shared) override {
    shared_ = &shared;
    options_.prepare(shared);
  }
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override {
    inputs.timer.time("integrate",
                      [&] { upload(options_.trace(*shared_, inputs.light_index).radiance, radiance); });
  }
  bool sees_every_light() const override { return true; }

 private:
  Options options_;
  SharedReference* shared_ = nullptr;
};

template <typename Options>
std::unique_ptr<frame::Airlight> make_traced(const gpu::Context&, const Options& options) {
  return std::make_unique<TracedAirlight<Options>>(options);
}

class TracedShadow : public frame::SurfaceShadow, public Traced {
 public:
  void borrow(SharedReference& shared) override {
    shared_ = &shared;
    shared.prepare();
  }
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override {
    inputs.timer.time("surface_query",
                      [&] { visibility.write(shared_->surfaces(inputs.light_index).visibility.data()); });
  }
  bool sees_every_light() const override { return true; }

 private:
  SharedReference* shared_ = nullptr;
};

constexpr frame::Traits k_truth = {.runs_on_gpu = false, .is_truth = true};

}  // namespace

frame::AirlightMethod reference_method() {
  return frame::describe<frame::Airlight, ExactOptions>(
      "reference", "exact intervals of shadow on the CPU, nothing sampled: the truth", k_truth,
      {frame::count_option({.name = "refine",
                            .meaning = "parts that each panel of the quadrature is cut into",
                            .quality = "changes nothing by more than the stated bound",
                            .cost = "time of the quadrature"},
                           frame::Counts{.most = 64}, &ExactOptions::refine)},
      make_traced<ExactOptions>);
}

frame::AirlightMethod reference_sampled_method() {
  return frame::describe<frame::Airlight, SampledOptions>(
      "reference-sampled", "converged ray tracing on the CPU (Embree), every change of visibility bisected",
      k_truth,
      {frame::count_option({.name = "samples",
                            .meaning = "uniform steps in the light angle that look for changes of visibility",
                            .quality = "shadows and light that lie wholly between two are missed",
                            .cost = "rays"},
                           frame::Counts{.least = 2}, &SampledOptions::samples)},
      make_traced<SampledOptions>);
}

frame::AirlightMethod reference_march_method() {
  frame::Traits traits = k_truth;
  traits.is_yardstick = true;
  return frame::describe<frame::Airlight, MarchOptions>(
      "reference-march", "ray marching with shadow rays on the CPU (Embree)", traits,
      {frame::count_option({.name = "steps",
                            .meaning = "shadow rays a view ray",
                            .quality = "too few show as noise",
                            .cost = "rays",
                            .sweep = {"32", "128", "512"}},
                           frame::Counts{}, &MarchOptions::steps),
       frame::word_option({.name = "rays",
                           .meaning = "how shadow rays are traced",
                           .quality = "none",
                           .cost = "packets are faster where neighbouring rays stay together",
                           .sweep = {"single", "packet"}},
                          {{"single"}, {"packet"}}, &MarchOptions::rays)},
      make_traced<MarchOptions>);
}

frame::SurfaceMethod reference_surface_method() {
  frame::Traits traits = k_truth;
  traits.is_exact = true;
  return frame::describe<frame::SurfaceShadow, frame::NoOptions>(
      "reference", "one shadow ray a pixel on the CPU (Embree): the truth", traits, {},
      [](const gpu::Context&, const frame::NoOptions&) { return std::make_unique<TracedShadow>(); });
}

SharedReference::SharedReference(const scene::Geometry& geometry, const scene::View& view, Progress progress,
                                 const std::filesystem::path& cache)
    : geometry_(geometry), view_(view), progress_(std::move(progress)), lights_(view.lights.size()) {
  if (!cache.empty()) cache_.emplace(cache, geometry, view);
}

const reference::Reference& SharedReference::rays(std::size_t light) {
  OfLight& of_light = lights_[light];
  if (!of_light.rays) of_light.rays.emplace(geometry_, view_, light);
  return *of_light.rays;
}

void SharedReference::prepare() {
  for (std::size_t light = 0; light < lights_.size(); ++light) rays(light);
}

void SharedReference::prepare_truth(int refinement) {
  for (std::size_t light = 0; light < lights_.size(); ++light) {
    if (!load_exact(light, refinement) || !load_surfaces(light)) rays(light);
  }
}

reference::Progress SharedReference::report(const std::string& what) const {
  if (!progress_) return {};
  return [this, what](double fraction) { progress_(what, fraction); };
}

bool SharedReference::load_surfaces(std::size_t light) {
  OfLight& of_light = lights_[light];
  if (of_light.surfaces) return true;
  auto kept = cache_ ? cache_->load_surfaces(light) : std::nullopt;
  if (!kept) return false;
  of_light.surfaces = std::move(kept->image);
  of_light.surfaces_ms = kept->ms;
  return true;
}

bool SharedReference::load_exact(std::size_t light, int refinement) {
  OfLight& of_light = lights_[light];
  if (of_light.exact.contains(refinement)) return true;
  auto kept = cache_ ? cache_->load_airlight(light, refinement) : std::nullopt;
  if (!kept) return false;
  of_light.exact.emplace(refinement, std::move(*kept));
  return true;
}

const reference::SurfaceImage& SharedReference::surfaces(std::size_t light) {
  OfLight& of_light = lights_[light];
  if (load_surfaces(light)) {
    work_.kept_ms[light]["surface_query"] += of_light.surfaces_ms;
    return *of_light.surfaces;
  }
  const reference::Reference& reference = rays(light);
  const auto start = Clock::now();
  of_light.surfaces = reference.surfaces(report("reference, surfaces"));
  of_light.surfaces_ms = milliseconds_since(start);
  if (cache_) cache_->save_surfaces(light, {*of_light.surfaces, of_light.surfaces_ms});
  return *of_light.surfaces;
}

double SharedReference::Work::kept_ms_of(const std::string& stage) const {
  double sum = 0.0;
  for (const auto& [light, stages] : kept_ms)
    if (const auto found = stages.find(stage); found != stages.end()) sum += found->second;
  return sum;
}

void SharedReference::count(const reference::AirlightImage& image) {
  work_.airlight_rays += image.rays;
  work_.airlight_ms += image.ms;
  work_.self_error = std::max(work_.self_error, image.self_error);
}

const reference::AirlightImage& SharedReference::exact(std::size_t light, int refinement) {
  OfLight& of_light = lights_[light];
  const bool is_kept = load_exact(light, refinement);
  if (!is_kept) {
    const auto& made =
        of_light.exact.emplace(refinement, rays(light).exact(refinement, report("reference, airlight")));
    if (cache_) cache_->save_airlight(light, refinement, made.first->second);
  }
  const reference::AirlightImage& image = of_light.exact.at(refinement);
  count(image);
  if (is_kept) work_.kept_ms[light]["integrate"] += image.ms;
  return image;
}

reference::AirlightImage SharedReference::sampled(std::size_t light, int samples) {
  reference::AirlightImage image = rays(light).sampled(samples, report("reference-sampled"));
  count(image);
  return image;
}

reference::AirlightImage SharedReference::march(std::size_t light, int steps, reference::RayMode mode) {
  reference::AirlightImage image = rays(light).march(steps, mode, report("reference-march"));
  count(image);
  return image;
}

}  // namespace airlight::quality
