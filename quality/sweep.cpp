#include "quality/sweep.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "quality/compare.h"
#include "quality/measure.h"
#include "quality/results_json.h"
#include "quality/truth.h"
#include "scene/hash.h"

namespace airlight::quality {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t k_group = 8;                     ///< settings that are timed in turns
constexpr std::int64_t k_group_bytes = 1'000'000'000;  ///< of their methods; more are not added to a group

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Of one round: its time over the baseline's, over every `step`th view from `first` on.
double ratio_of(std::span<const double> times, std::span<const double> baseline, std::size_t first,
                std::size_t step) {
  double time = 0.0, of_baseline = 0.0;
  for (std::size_t view = first; view < times.size(); view += step) {
    time += times[view];
    of_baseline += baseline[view];
  }
  return time / of_baseline;
}

Json shadow_map_json(const std::optional<int>& side) {
  return side ? Json(*side) : Json(nullptr);
}

/// What a group's settings have in common with their line.
struct Member {
  const Setting* setting;
  Run run;
  Measurer* measurer;
  Measurer::Pair pair;                               ///< empty where it is slow
  std::vector<std::vector<double>> times, baseline;  ///< [ms] of each round, each view
  std::vector<double> cpu_ms;                        ///< of each round, a frame's mean
};

/// A sweep that runs.
class Sweep {
 public:
  Sweep(gpu::Context& context, RunFile& file, const SweepRequest& request)
      : context_(context), file_(file), request_(request), subject_(request.subject) {}

  SweepCount run() {
    SweepCount count;
    for (const Setting& setting : request_.settings) {
      const std::string key = key_of(subject_.hash, setting);
      if (file_.keys().contains(key))
        ++count.found;
      else
        pending_.emplace_back(key, &setting);
    }
    if (pending_.empty()) return count;
    // Frames of one size of shadow map follow each other, and else what is alike does not.
    std::sort(pending_.begin(), pending_.end(), [](const auto& a, const auto& b) {
      return std::pair(a.second->shadow_map, a.first) < std::pair(b.second->shadow_map, b.first);
    });
    try_out();
    trace_truths();
    baseline_ = baseline_measurer().make(request_.baseline.volume, request_.baseline.surface);
    baseline_measurer().play(baseline_, subject_.views);  // the warm-up
    start_ = std::chrono::steady_clock::now();
    while (done_ < pending_.size()) run_group();
    count.measured = pending_.size();
    return count;
  }

 private:
  using Keyed = std::pair<std::string, const Setting*>;

  int shadow_map_of(const Setting& setting) const {
    return setting.shadow_map.value_or(request_.baseline.shadow_map.value_or(1));
  }

  std::unique_ptr<Measurer> make_measurer(int shadow_map) {
    return std::make_unique<Measurer>(
        context_, subject_.scene.geometry, subject_.views[0], shadow_map,
        request_.progress ? Progress([this](const std::string& what, double) { tell(what); }) : Progress(),
        request_.cache);
  }

  /// Those of another size than the baseline's live until one of a third is asked for.
  Measurer& measurer_of(int shadow_map) {
    const int of_baseline = shadow_map_of(request_.baseline);
    std::erase_if(measurers_,
                  [&](const auto& entry) { return entry.first != shadow_map && entry.first != of_baseline; });
    std::unique_ptr<Measurer>& measurer = measurers_[shadow_map];
    if (!measurer) measurer = make_measurer(shadow_map);
    return *measurer;
  }
  Measurer& baseline_measurer() { return measurer_of(shadow_map_of(request_.baseline)); }

  void try_out() {
    std::set<int> sizes = {shadow_map_of(request_.baseline)};
    for (const Keyed& keyed : pending_) sizes.insert(shadow_map_of(*keyed.second));
    for (const int size : sizes) {
      std::map<std::string, VolumeChoice> volumes;
      std::map<std::string, SurfaceChoice> surfaces;
      const auto add = [&](const Setting& setting) {
        if (shadow_map_of(setting) != size) return;
        volumes.emplace(setting.volume.spec, setting.volume);
        surfaces.emplace(setting.surface.spec, setting.surface);
      };
      add(request_.baseline);
      for (const Keyed& keyed : pending_) add(*keyed.second);
      for (const auto& [spec, volume] : volumes) measurer_of(size).try_out({&volume, 1}, {});
      for (const auto& [spec, surface] : surfaces) measurer_of(size).try_out({}, {&surface, 1});
    }
  }

  void trace_truths() {
    Measurer& measurer = baseline_measurer();
    for (const scene::View& view : subject_.views) {
      if (subject_.is_path) measurer.look_at(view);
      truths_.push_back(trace_truth(measurer.reference(), view, measurer.surface_points()));
    }
  }

  void run_group() {
    std::vector<Member> group;
    std::int64_t bytes = 0;
    const std::size_t first = done_;
    const int size = shadow_map_of(*pending_[first].second);
    Measurer& measurer = measurer_of(size);
    for (std::size_t i = first; i < pending_.size() && group.size() < k_group && bytes < k_group_bytes; ++i) {
      if (shadow_map_of(*pending_[i].second) != size) break;
      bytes += group.emplace_back(measure(measurer, *pending_[i].second)).pair.airlight
                   ? group.back().pair.bytes()
                   : 0;
      steps_ += k_steps_of_measuring;
    }
    time(group, pending_[first].first);
    for (const Member& member : group) file_.append(line_of(pending_[done_++].first, member));
    steps_ = 0;
  }

  /// All but the rounds.
  Member measure(Measurer& measurer, const Setting& setting) {
    tell(fmt::format("{} × {}", setting.volume.spec, setting.surface.spec));
    Member member{&setting,
                  judged_run(measurer, subject_.views, subject_.is_path, truths_, setting.volume,
                             setting.surface, 1, {}),
                  &measurer,
                  {},
                  {},
                  {},
                  {}};
    if (member.run.cost.frame_ms > Measurer::k_slow_frame_ms) {
      std::vector<double>& times = member.times.emplace_back();
      for (const Run::Frame& frame : member.run.path) times.push_back(frame.cost.ms);
      if (times.empty()) times = {member.run.cost.frame_ms};
      member.cpu_ms = {member.run.cost.cpu_ms};
      member.baseline.push_back(play_baseline());
    } else {
      member.pair = measurer.make(setting.volume, setting.surface);
      measurer.play(member.pair, subject_.views);  // the warm-up
    }
    return member;
  }

  std::vector<double> play_baseline() {
    std::vector<double> times;
    for (const Measurer::FrameTime& time : baseline_measurer_of_group().play(baseline_, subject_.views))
      times.push_back(time.ms);
    return times;
  }
  /// As `baseline_measurer`, which leaves the group's as it is.
  Measurer& baseline_measurer_of_group() { return *measurers_.at(shadow_map_of(request_.baseline)); }

  void time(std::vector<Member>& group, const std::string& first_key) {
    std::vector<Member*> order;
    for (Member& member : group)
      if (member.pair.airlight) order.push_back(&member);
    std::uint64_t seed = 0;
    std::from_chars(first_key.data(), first_key.data() + 16, seed, 16);
    std::mt19937_64 random(seed);
    for (int round = 0; round < request_.rounds; ++round) {
      std::shuffle(order.begin(), order.end(), random);
      for (Member* member : order) {
        const auto play = [&] {
          std::vector<double> times, cpu;
          for (const Measurer::FrameTime& time : member->measurer->play(member->pair, subject_.views)) {
            times.push_back(time.ms);
            cpu.push_back(time.cpu_ms);
          }
          member->times.push_back(std::move(times));
          member->cpu_ms.push_back(mean(cpu));
        };
        const bool is_baseline_first = random() % 2 == 0;
        if (is_baseline_first) member->baseline.push_back(play_baseline());
        play();
        if (!is_baseline_first) member->baseline.push_back(play_baseline());
      }
      steps_ += static_cast<double>(group.size()) / request_.rounds;
      tell(fmt::format("round {} of {}", round + 1, request_.rounds));
    }
  }

  std::string line_of(const std::string& key, const Member& member) const {
    const PairedTime timed = paired_time(member.times, member.baseline, member.cpu_ms);
    Run run = member.run;
    run.command = fmt::format("{} -o {}", request_.command(*member.setting),
                              shell_quote((file_.path().parent_path() / key).string()));
    run.cost.frame_ms = timed.ms;
    run.cost.cpu_ms = timed.cpu_ms;
    run.cost.frames = timed.rounds;
    // What a path's frames have is kept in columns; a view is a path of one.
    Json rrmse = Json::array(), same_surface = Json::array(), p99 = Json::array(), flip = Json::array(),
         flicker = Json::array();
    if (run.path.empty()) run.path.push_back({{}, run.errors});
    for (const Run::Frame& frame : run.path) {
      rrmse.push_back(number_json(frame.errors.airlight.rrmse));
      same_surface.push_back(number_json(frame.errors.same_surface.rrmse));
      p99.push_back(number_json(frame.errors.airlight.p99));
      flip.push_back(number_json(frame.errors.flip));
      flicker.push_back(number_json(frame.flicker));
    }
    run.path.clear();

    const Setting& baseline = request_.baseline;
    Json timing = {{"baseline",
                    {{"key", key_of(subject_.hash, baseline)},
                     {"volume", baseline.volume.spec},
                     {"surface", baseline.surface.spec},
                     {"shadow_map", shadow_map_json(baseline.shadow_map)},
                     {"frame_ms", timed.baseline_ms}}},
                   {"rounds", timed.rounds},
                   {"ratio", interval_json(timed.ratio)}};
    if (subject_.views.size() > 1) {
      timing["odd_ratio"] = interval_json(timed.odd_ratio);
      timing["even_ratio"] = interval_json(timed.even_ratio);
    }
    const glm::ivec2 size = subject_.views[0].size;
    Json line = {
        {"key", key},
        {"airlight", version()},
        {"scene", subject_.scene_name},
        {"subject", subject_.hash},
        {"size", {size.x, size.y}},
        {"shadow_map", shadow_map_json(member.setting->shadow_map)},
        {"device", device_json(context_.device(), std::max(1u, std::thread::hardware_concurrency()))}};
    line.update(run_json(run, subject_.views[0]));
    line["timing"] = timing;
    line["views"] = {{"frame_ms", timed.view_ms},
                     {"rrmse", rrmse},
                     {"same_surface_rrmse", same_surface},
                     {"p99", p99},
                     {"flip", flip},
                     {"flicker", flicker}};
    return text_of_json(line);
  }

  /// How far it is, and how long it may take: as long a setting as those so far.
  void tell(const std::string& what) {
    if (!request_.progress) return;
    const double steps_of_setting = k_steps_of_measuring + 1.0;
    const double fraction =
        (static_cast<double>(done_) + steps_ / steps_of_setting) / static_cast<double>(pending_.size());
    std::string left;
    if (fraction > 0.0) {
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
      left = fmt::format(", {:.0f} min left", std::ceil(seconds * (1.0 - fraction) / fraction / 60.0));
    }
    request_.progress(fmt::format("{} of {} settings{}: {}", done_, pending_.size(), left, what), fraction);
  }

  /// What measuring takes of a setting's time, when its rounds take 1.
  static constexpr double k_steps_of_measuring = 1.0;

  gpu::Context& context_;
  RunFile& file_;
  const SweepRequest& request_;
  const Subject& subject_;
  std::vector<Keyed> pending_;  ///< in the order in which they are measured
  std::map<int, std::unique_ptr<Measurer>> measurers_;
  std::vector<Truth> truths_;  ///< of each view
  Measurer::Pair baseline_;
  std::size_t done_ = 0;  ///< of the pending ones
  double steps_ = 0.0;    ///< of the group
  std::chrono::steady_clock::time_point start_;
};

}  // namespace

std::string hash_of_subject(const scene::Geometry& geometry, std::span<const scene::View> views) {
  std::string words = fmt::format("geometry {}\n", hash_of_geometry(geometry));
  for (const scene::View& view : views)
    for (std::size_t light = 0; light < view.lights.size(); ++light) words += words_of_view(view, light);
  return scene::hash_of(words);
}

std::string key_of(const std::string& subject_hash, const Setting& setting) {
  return scene::hash_of(fmt::format("subject {}\nvolume {}surface {}shadow map {}\n", subject_hash,
                                    setting.volume.words(), setting.surface.words(),
                                    setting.shadow_map ? fmt::format("{}", *setting.shadow_map) : "unread"));
}

PairedTime paired_time(std::span<const std::vector<double>> times,
                       std::span<const std::vector<double>> baseline, std::span<const double> cpu_ms) {
  PairedTime timed;
  timed.rounds = static_cast<int>(times.size());
  const std::size_t views = times[0].size();
  const auto ratio = [&](std::size_t first, std::size_t step) {
    std::vector<double> ratios;
    for (std::size_t round = 0; round < times.size(); ++round)
      ratios.push_back(ratio_of(times[round], baseline[round], first, step));
    return median_interval(ratios);
  };
  timed.ratio = ratio(0, 1);
  if (views > 1) {
    timed.odd_ratio = ratio(1, 2);
    timed.even_ratio = ratio(0, 2);
  }
  const auto medians = [&](std::span<const std::vector<double>> rounds) {
    std::vector<double> of_views;
    for (std::size_t view = 0; view < views; ++view) {
      std::vector<double> of_view;
      for (const std::vector<double>& round : rounds) of_view.push_back(round[view]);
      of_views.push_back(median(of_view));
    }
    return of_views;
  };
  timed.view_ms = medians(times);
  timed.ms = mean(timed.view_ms);
  timed.baseline_ms = mean(medians(baseline));
  timed.cpu_ms = median({cpu_ms.begin(), cpu_ms.end()});
  return timed;
}

std::vector<Setting> distinct_settings(const std::string& subject_hash, std::vector<Setting> settings,
                                       const Shard& shard) {
  std::set<std::string> seen;
  std::erase_if(settings, [&](const Setting& setting) {
    const std::string key = key_of(subject_hash, setting);
    return !shard.holds(key) || !seen.insert(key).second;
  });
  return settings;
}

SweepCount sweep(gpu::Context& context, RunFile& file, const SweepRequest& request) {
  return Sweep(context, file, request).run();
}

}  // namespace airlight::quality
