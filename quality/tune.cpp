#include "quality/tune.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "quality/measure.h"
#include "quality/statistics.h"
#include "quality/truth_sample.h"

namespace airlight::quality {
namespace {

constexpr std::size_t k_drawn = 8;  ///< settings whose images tell where errors may lie
constexpr std::size_t k_finalists = 6;
constexpr double k_nearly = 1.3;  ///< what is timed again may take so much more than the quickest

class Tuner {
 public:
  Tuner(gpu::Context& context, const TuneRequest& request) : context_(context), request_(request) {}

  Tuned run() {
    choose_views();
    try_settings();
    Tuned tuned;
    choose(tuned);
    tuned.settings = request_.settings.size();
    tuned.views = views_.size();
    double traced = 0.0, all = 0.0;
    for (const OfView& of_view : views_) {
      traced += static_cast<double>(of_view.truth.pixels());
      all += static_cast<double>(of_view.view->size.x) * of_view.view->size.y;
    }
    tuned.truth_share = traced / all;
    if (request_.explains && tuned.is_met) explain(tuned);
    tuned.frames = frames_;
    return tuned;
  }

 private:
  struct OfView {
    const scene::View* view;
    std::vector<DrawnTile> chosen, judged;  ///< to choose by, to judge by; of a path one of them is empty
    TruthOfTiles truth;
  };
  struct Candidate {
    TunedSetting tuned;
    ErrorOfTiles on_judged;
    std::vector<double> times;
  };

  Measurer& measurer_of(const Setting& setting) {
    const int size = setting.shadow_map.value_or(1);
    std::unique_ptr<Measurer>& measurer = measurers_[size];
    if (!measurer)
      measurer =
          std::make_unique<Measurer>(context_, request_.subject.scene.geometry, request_.subject.views[0],
                                     size, Progress(), std::filesystem::path());
    return *measurer;
  }

  void tell(const std::string& what, double fraction) const {
    if (request_.progress) request_.progress(what, fraction);
  }

  void choose_views() {
    const auto& views = request_.subject.views;
    const std::vector<std::size_t> numbers = evenly_spread(views.size(), k_looked_at);
    // Every other one of a path's is for judging. Images by several settings tell where errors may lie.
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const scene::View& view = views[numbers[i]];
      tell("truth", static_cast<double>(i) / static_cast<double>(numbers.size()));
      std::vector<std::vector<glm::vec3>> images;
      for (const std::size_t number : evenly_spread(request_.settings.size(), k_drawn)) {
        const Setting& setting = request_.settings[number];
        Measurer& measurer = measurer_of(setting);
        measurer.look_at(view);
        ++frames_;
        images.push_back(measurer.render(setting.volume, setting.surface).airlight);
      }
      const TileDraw draw(view.size, images);
      const bool is_alone = numbers.size() == 1;
      const std::size_t tiles = std::max<std::size_t>(48, draw.tiles() / 50);
      std::vector<DrawnTile> chosen, judged;
      if (is_alone || i % 2 == 0) chosen = draw.drawn(tiles, 1);
      if (is_alone || i % 2 == 1) judged = draw.drawn(tiles, 2);
      std::vector<DrawnTile> both = chosen;
      both.insert(both.end(), judged.begin(), judged.end());
      views_.push_back({&view, std::move(chosen), std::move(judged),
                        TruthOfTiles(request_.subject.scene.geometry, view, std::move(both))});
    }
  }

  /// Draws a setting in each view, and keeps its time and its errors on both sets of pixels.
  Candidate measured(const Setting& setting) {
    Candidate candidate{{setting}, {}, {}};
    Measurer& measurer = measurer_of(setting);
    const Measurer::Pair pair = measurer.make(setting.volume, setting.surface);
    ErrorOfTiles on_chosen;
    for (const OfView& of_view : views_) {
      const std::span<const scene::View> view(of_view.view, 1);
      measurer.play(pair, view);
      const frame::FrameImages images = measurer.images();
      candidate.times.push_back(measurer.play(pair, view)[0].ms);
      frames_ += 2;
      if (!of_view.chosen.empty()) on_chosen.add(of_view.truth, of_view.chosen, images);
      if (!of_view.judged.empty()) candidate.on_judged.add(of_view.truth, of_view.judged, images);
    }
    candidate.tuned.bytes = measurer.shared_bytes() + pair.bytes();
    candidate.tuned.chosen_error = on_chosen.rrmse();
    candidate.tuned.error = candidate.on_judged.rrmse();
    candidate.tuned.frame_ms = std::accumulate(candidate.times.begin(), candidate.times.end(), 0.0) /
                               static_cast<double>(views_.size());
    return candidate;
  }

  void try_settings() {
    // Those of one shadow map follow each other.
    std::vector<const Setting*> order;
    for (const Setting& setting : request_.settings) order.push_back(&setting);
    std::stable_sort(order.begin(), order.end(),
                     [](const Setting* a, const Setting* b) { return a->shadow_map < b->shadow_map; });
    for (std::size_t i = 0; i < order.size(); ++i) {
      tell(fmt::format("{} of {} settings: {}", i, order.size(), order[i]->volume.spec),
           static_cast<double>(i) / static_cast<double>(order.size()));
      candidates_.push_back(measured(*order[i]));
    }
  }

  bool reaches(const TunedSetting& tuned, double slack) const {
    const double limit = request_.goal.limit;
    switch (request_.goal.kind) {
      case TuneGoal::Kind::error:
        return tuned.chosen_error <= limit;
      case TuneGoal::Kind::ms:
        return tuned.frame_ms <= slack * limit;
      case TuneGoal::Kind::bytes:
        return static_cast<double>(tuned.bytes) <= limit;
    }
    return false;
  }
  bool by_time() const { return request_.goal.kind == TuneGoal::Kind::error; }

  void choose(Tuned& tuned) {
    std::vector<Candidate*> good;
    for (Candidate& candidate : candidates_)
      if (reaches(candidate.tuned, k_nearly)) good.push_back(&candidate);
    const auto worth = [&](const Candidate* c) {
      return by_time() ? c->tuned.frame_ms : c->tuned.chosen_error;
    };
    const auto is_better = [&](const Candidate* a, const Candidate* b) { return worth(a) < worth(b); };
    std::sort(good.begin(), good.end(), is_better);
    if (good.size() > k_finalists) good.resize(k_finalists);
    if (by_time())
      std::erase_if(good, [&](const Candidate* c) { return worth(c) > k_nearly * worth(good[0]); });
    time(good);
    std::sort(good.begin(), good.end(), is_better);
    // Some that reach it by the pixels that they were chosen by may not by others.
    for (Candidate* candidate : good) {
      const bool holds =
          reaches(candidate->tuned, 1.0) && (!by_time() || candidate->tuned.error <= request_.goal.limit);
      if (!holds) continue;
      tuned.best = candidate->tuned;
      tuned.is_met = true;
      tuned.confidence = confidence(*candidate);
      return;
    }
    const auto miss = [&](const Candidate& c) {
      return by_time()                                  ? std::max(c.tuned.chosen_error, c.tuned.error)
             : request_.goal.kind == TuneGoal::Kind::ms ? c.tuned.frame_ms
                                                        : static_cast<double>(c.tuned.bytes);
    };
    const auto nearest =
        std::min_element(candidates_.begin(), candidates_.end(),
                         [&](const Candidate& a, const Candidate& b) { return miss(a) < miss(b); });
    tuned.best = nearest->tuned;
    tuned.confidence = confidence(*nearest);
  }

  double confidence(const Candidate& candidate) const {
    const double limit = request_.goal.limit;
    if (by_time()) return candidate.on_judged.part_not_above(limit);
    if (request_.goal.kind == TuneGoal::Kind::bytes)
      return static_cast<double>(candidate.tuned.bytes) <= limit ? 1.0 : 0.0;
    const auto within =
        std::count_if(candidate.times.begin(), candidate.times.end(), [&](double ms) { return ms <= limit; });
    return static_cast<double>(within) / static_cast<double>(candidate.times.size());
  }

  /// In rounds, each in another order, so that a disturbance falls on all alike.
  void time(std::span<Candidate* const> candidates) {
    if (candidates.size() < 2 && by_time()) return;
    std::mt19937 random(1);
    struct Finalist {
      Candidate* candidate;
      Measurer& measurer;
      Measurer::Pair pair;
    };
    std::vector<Finalist> finalists;
    for (Candidate* candidate : candidates) {
      candidate->times.clear();
      const Setting& setting = candidate->tuned.setting;
      Measurer& measurer = measurer_of(setting);
      finalists.push_back({candidate, measurer, measurer.make(setting.volume, setting.surface)});
    }
    std::vector<std::size_t> order(finalists.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (int round = 0; round < request_.rounds; ++round) {
      tell(fmt::format("round {} of {}", round + 1, request_.rounds),
           static_cast<double>(round) / request_.rounds);
      std::shuffle(order.begin(), order.end(), random);
      for (const std::size_t i : order) {
        const auto& [candidate, measurer, pair] = finalists[i];
        double sum = 0.0;
        for (const OfView& of_view : views_) {
          measurer.play(pair,
                        {of_view.view, 1});  // what is made once a scene, and what others left in caches
          sum += measurer.play(pair, {of_view.view, 1})[0].ms;
          frames_ += 2;
        }
        candidate->times.push_back(sum / static_cast<double>(views_.size()));
      }
    }
    for (Candidate* candidate : candidates) candidate->tuned.frame_ms = median(candidate->times);
  }

  /// Each knob of the best to the next values that are worth sweeping.
  void explain(Tuned& tuned) {
    const Setting& best = tuned.best.setting;
    const auto try_out = [&](const std::string& name, const std::string& from, const std::string& to,
                             const Setting& setting) {
      const Candidate candidate = measured(setting);
      tuned.knobs.push_back({name, from, to, candidate.tuned.error / tuned.best.error,
                             candidate.tuned.frame_ms / tuned.best.frame_ms});
    };
    for (const frame::Option& option : best.volume.method->options) {
      const std::string now =
          frame::text_of(option.get(best.volume.method->const_address(best.volume.options)));
      for (const std::string_view value : option.text.sweep) {
        if (value == now) continue;
        Setting other = best;
        try {
          other.volume = best.volume.with(option, value);
          other.volume.fit(request_.subject.views);
        } catch (const scene::Error&) {
          continue;  // it contradicts another option
        }
        // With some settings of the others an option is not looked at.
        if (frame::text_of(option.get(other.volume.method->const_address(other.volume.options))) == now)
          continue;
        try_out(std::string(option.text.name), now, std::string(value), other);
      }
    }
    if (!best.shadow_map) return;
    for (const int size : {*best.shadow_map / 2, *best.shadow_map * 2}) {
      Setting other = best;
      other.shadow_map = size;
      try_out("shadow-map", fmt::format("{}", *best.shadow_map), fmt::format("{}", size), other);
    }
  }

  gpu::Context& context_;
  const TuneRequest& request_;
  std::map<int, std::unique_ptr<Measurer>> measurers_;
  std::vector<OfView> views_;
  std::vector<Candidate> candidates_;
  std::size_t frames_ = 0;
};

}  // namespace

Tuned tune(gpu::Context& context, const TuneRequest& request) {
  return Tuner(context, request).run();
}

}  // namespace airlight::quality
