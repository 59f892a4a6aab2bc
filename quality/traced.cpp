#include "quality/traced.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "frame/point_reader.h"
#include "reference/surface_judge.h"
#include "scene/error.h"
#include "scene/transmission.h"
#include "surface_shadows/transmission.h"

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

class JudgedShadow : public frame::SurfaceShadow, public Traced {
 public:
  void borrow(SharedReference& shared) override { shared_ = &shared; }
  gpu::Format visibility_format(const frame::SceneBuffers& scene) const override {
    return surface_shadows::transmission_format(scene);
  }
  void query(const frame::FrameInputs& inputs, const gpu::Texture& visibility) override {
    inputs.surface_points();  // a stage of its own
    inputs.timer.time("surface_query", [&] {
      reader_.query(inputs, visibility);
      const SurfaceVerdicts& verdicts = shared_->verdicts(inputs.light_index, reader_.points());
      if (visibility.format() == gpu::Format::r32f)
        write<float>(verdicts, visibility, [](const glm::vec3& share) { return share.r; });
      else
        write<glm::vec4>(verdicts, visibility, [](const glm::vec3& share) { return glm::vec4(share, 0.0f); });
    });
  }
  bool sees_every_light() const override { return true; }

 private:
  /// @param texel Texel(const glm::vec3& share)
  template <typename Texel, typename MakeTexel>
  static void write(const SurfaceVerdicts& verdicts, const gpu::Texture& visibility, const MakeTexel& texel) {
    std::vector<Texel> texels;
    texels.reserve(verdicts.size());
    for (const auto& verdict : verdicts) texels.push_back(texel(verdict ? verdict->share : glm::vec3(0.0f)));
    visibility.write(texels.data());
  }

  frame::PointReader reader_;
  SharedReference* shared_ = nullptr;
};

/// The points of the pixels that show a surface, in their order.
std::vector<reference::SurfacePoint> seen_points(const frame::SurfacePoints& frame, std::size_t light) {
  std::vector<reference::SurfacePoint> points;
  for (std::size_t i = 0; i < frame.triangles.size(); ++i) {
    if (frame.triangles[i] == 0) continue;
    const glm::vec3 position(frame.of_light[light][i]);
    // Infinity and NaN times 0 are NaN.
    if (!(glm::dot(position, glm::vec3(0.0f)) == 0.0f))
      throw scene::Error(scene::ExitCode::driver, fmt::format("surface point of pixel number {}", i),
                         "it is not finite", "this is a fault of the program: please report the command");
    points.push_back({position, frame.triangles[i] - 1});
  }
  return points;
}

constexpr frame::Traits k_truth = {.runs_on_gpu = false, .is_truth = true};

frame::Traits transmitting_truth() {
  frame::Traits traits = k_truth;
  traits.transmits = true;
  return traits;
}

}  // namespace

frame::AirlightMethod reference_method() {
  return frame::describe<frame::Airlight, ExactOptions>(
      "reference", "exact intervals of shadow on the CPU, nothing sampled: the truth", transmitting_truth(),
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
  frame::Traits traits = transmitting_truth();
  traits.is_exact = true;
  return frame::describe<frame::SurfaceShadow, frame::NoOptions>(
      "reference",
      "whether any triangle hides the pixel's point, decided without rounding on the CPU: the truth", traits,
      {}, [](const gpu::Context&, const frame::NoOptions&) { return std::make_unique<JudgedShadow>(); });
}

SharedReference::SharedReference(const scene::Geometry& geometry, const scene::View& view, Progress progress,
                                 const std::filesystem::path& cache)
    : at_rest_(geometry),
      view_(view),
      progress_(std::move(progress)),
      cache_folder_(cache),
      lights_(view.lights.size()) {
  if (!cache.empty()) cache_.emplace(cache, this->geometry(), view);
}

const scene::Geometry& SharedReference::geometry() {
  if (view_.pose.is_at_rest()) return at_rest_;
  if (!posed_) posed_ = scene::posed(at_rest_, view_.pose);
  return *posed_;
}

struct SharedReference::Opaque {
  scene::Geometry geometry;
  std::optional<SharedReference> reference;
};

SharedReference::~SharedReference() = default;

SharedReference* SharedReference::taken_opaque() {
  if (!scene::transmits(at_rest_)) return nullptr;
  if (!opaque_) {
    opaque_ = std::make_unique<Opaque>();
    opaque_->geometry = at_rest_;
    opaque_->geometry.transmission = scene::Transmission::opaque;
    opaque_->reference.emplace(opaque_->geometry, view_, progress_, cache_folder_);
  }
  return &*opaque_->reference;
}

const reference::Reference& SharedReference::rays(std::size_t light) {
  OfLight& of_light = lights_[light];
  if (!of_light.rays) of_light.rays.emplace(geometry(), view_, light);
  return *of_light.rays;
}

void SharedReference::prepare() {
  for (std::size_t light = 0; light < lights_.size(); ++light) rays(light);
}

void SharedReference::prepare_truth(int refinement) {
  for (std::size_t light = 0; light < lights_.size(); ++light) {
    if (!load_exact(light, refinement)) rays(light);
  }
  if (!load_distance()) rays(0);
}

reference::Progress SharedReference::report(const std::string& what) const {
  if (!progress_) return {};
  return [this, what](double fraction) { progress_(what, fraction); };
}

bool SharedReference::load_distance() {
  if (!distance_ && cache_) distance_ = cache_->load_distance(0);
  return distance_.has_value();
}

bool SharedReference::load_exact(std::size_t light, int refinement) {
  OfLight& of_light = lights_[light];
  if (of_light.exact.contains(refinement)) return true;
  auto kept = cache_ ? cache_->load_airlight(light, refinement) : std::nullopt;
  if (!kept) return false;
  of_light.exact.emplace(refinement, std::move(*kept));
  return true;
}

const std::vector<float>& SharedReference::distance() {
  if (load_distance()) return *distance_;
  distance_ = rays(0).surfaces(report("reference, surfaces")).distance;
  if (cache_) cache_->save_distance(0, *distance_);
  return *distance_;
}

const SurfaceVerdicts& SharedReference::verdicts(std::size_t light, const frame::SurfacePoints& points) {
  OfLight& of_light = lights_[light];
  SurfaceVerdicts& verdicts = of_light.verdicts;
  if (of_light.triangles == points.triangles && of_light.points == points.of_light[light]) {
    work_.kept_ms[light]["surface_query"] += of_light.verdicts_ms;
    return verdicts;
  }
  if (progress_) progress_("reference, surface shadows", 0.0);
  const auto start = Clock::now();
  verdicts.assign(points.triangles.size(), std::nullopt);
  if (const std::vector<reference::SurfacePoint> seen = seen_points(points, light); !seen.empty()) {
    const reference::Triangles triangles(geometry());
    const reference::SurfaceJudge judge(triangles, view_.lights[light], view_.camera.eye);
    const std::vector<reference::SurfaceVerdict> found = judge.judge(seen);
    auto verdict = found.begin();
    for (std::size_t i = 0; i < verdicts.size(); ++i)
      if (points.triangles[i] != 0) verdicts[i] = *verdict++;
  }
  of_light.triangles = points.triangles;
  of_light.points = points.of_light[light];
  of_light.verdicts_ms = milliseconds_since(start);
  return verdicts;
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
  if (scene::transmits_by_incidence(at_rest_)) {  // no method shows its airlight: require_airlight
    auto& black = of_light.exact[refinement];
    black.radiance.resize(static_cast<std::size_t>(view_.size.x) * static_cast<std::size_t>(view_.size.y));
    return black;
  }
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
