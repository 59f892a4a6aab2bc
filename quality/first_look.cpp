#include "quality/first_look.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "quality/measure.h"
#include "quality/truth_sample.h"

namespace airlight::quality {
namespace {

/// Of the limit: a sample of the truth finds a fifth less than there is, and now and then more.
constexpr double k_margin = 0.8;
constexpr double k_gain = 0.9;       ///< finer counts are worth it where the error is so much less
constexpr std::size_t k_halves = 2;  ///< of the sample of the truth: both have to find counts enough

/// The choice with another count; none where the method has no such one.
std::optional<VolumeChoice> with(const VolumeChoice& volume, const std::string& name, double factor) {
  const frame::Option& option = *volume.method->find(name);
  const int now = std::get<int>(option.get(volume.method->const_address(volume.options)));
  const auto& counts = std::get<frame::Counts>(option.values);
  const int units = static_cast<int>(factor * now / counts.multiple_of + 0.5);
  const int count = counts.multiple_of * units;
  if (count == now || !counts.allow(count)) return std::nullopt;
  try {
    return volume.with(option, fmt::format("{}", count));
  } catch (const scene::Error&) {
    return std::nullopt;  // it contradicts another option
  }
}

class FirstLook {
 public:
  FirstLook(Measurer& measurer, std::span<const scene::View> views, Progress progress)
      : progress_(std::move(progress)), measurer_(measurer) {
    for (const std::size_t i : evenly_spread(views.size(), k_looked_at))
      views_.push_back({&views[i], {}, {}});
  }

  /// Traces the truth where two choices differ.
  void trace(const scene::Geometry& geometry, const VolumeChoice& fine, const VolumeChoice& coarse) {
    for (OfView& of_view : views_) {
      tell("truth");
      const std::array images = {render(of_view, fine).airlight, render(of_view, coarse).airlight};
      const TileDraw draw(of_view.view->size, images);
      std::vector<DrawnTile> all;
      for (std::size_t half = 0; half < k_halves; ++half) {
        of_view.tiles[half] =
            draw.drawn(std::max<std::size_t>(64, draw.tiles() / 50), static_cast<std::uint32_t>(half + 1));
        all.insert(all.end(), of_view.tiles[half].begin(), of_view.tiles[half].end());
      }
      of_view.truth.emplace(geometry, *of_view.view, std::move(all));
    }
  }

  /// The larger of the rrmses by both halves of the sample; NaN where the truth is dark.
  double error_of(const VolumeChoice& volume) {
    std::array<ErrorOfTiles, k_halves> errors;
    for (const OfView& of_view : views_) {
      const frame::FrameImages images = render(of_view, volume);
      for (std::size_t half = 0; half < k_halves; ++half)
        errors[half].add(*of_view.truth, of_view.tiles[half], images);
    }
    tell(fmt::format("as few cells as the scene needs: {} frames", frames_));
    return std::max(errors[0].rrmse(), errors[1].rrmse());
  }

 private:
  struct OfView {
    const scene::View* view;
    std::array<std::vector<DrawnTile>, k_halves> tiles;
    std::optional<TruthOfTiles> truth;
  };

  frame::FrameImages render(const OfView& of_view, const VolumeChoice& volume) {
    measurer_.look_at(*of_view.view);
    ++frames_;
    return measurer_.render(volume, surface_);
  }
  void tell(const std::string& what) const {
    constexpr double k_usual_frames = 20.0;  // a view
    if (progress_)
      progress_(what,
                std::min(static_cast<double>(frames_) / (k_usual_frames * static_cast<double>(views_.size())),
                         0.99));
  }

  Progress progress_;
  Measurer& measurer_;
  SurfaceChoice surface_ = parse_surfaces("none")[0];
  std::vector<OfView> views_;
  std::size_t frames_ = 0;
};

/// Makes the counts of one method fewer. @param limit that an error of the sample has to be within
void make_fewer(FirstLook& look, const scene::Geometry& geometry, VolumeChoice& volume,
                std::span<const std::string> counts, double limit) {
  VolumeChoice coarse = volume;
  for (const std::string& name : counts)
    if (const auto other = with(coarse, name, 0.25)) coarse = *other;
  look.trace(geometry, volume, coarse);

  double error = look.error_of(volume);
  for (const std::string& name : counts) {
    if (std::get<frame::Counts>(volume.method->find(name)->values).multiple_of == 1) continue;
    while (error > limit) {
      const auto finer = with(volume, name, 2.0);
      if (!finer) break;
      const double of_finer = look.error_of(*finer);
      if (!(of_finer < k_gain * error)) break;
      volume = *finer;
      error = of_finer;
    }
  }
  if (!(error <= limit)) return;
  std::vector<std::string> left(counts.begin(), counts.end());
  while (!left.empty()) {
    std::erase_if(left, [&](const std::string& name) {
      const auto coarser = with(volume, name, 0.5);
      if (!coarser || !(look.error_of(*coarser) <= limit)) return true;
      volume = *coarser;
      return false;
    });
  }
}

}  // namespace

std::vector<std::string> automatic_counts(const VolumeChoice& volume) {
  std::vector<std::string> names;
  for (const frame::Option& option : volume.method->options) {
    const auto* counts = std::get_if<frame::Counts>(&option.values);
    if (counts && !counts->automatic.empty() &&
        option.get(volume.method->const_address(volume.options)) == frame::OptionValue("auto"))
      names.emplace_back(option.text.name);
  }
  return names;
}

void take_first_looks(gpu::Context& context, const scene::Geometry& geometry,
                      std::span<const scene::View> views, std::vector<VolumeChoice>& volumes,
                      const AutomaticCounts& automatic, int shadow_map, double limit,
                      const Progress& progress) {
  std::optional<Measurer> measurer;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (automatic[i].empty()) continue;
    if (!measurer)
      measurer.emplace(context, geometry, views[0], shadow_map, Progress(), std::filesystem::path());
    FirstLook look(*measurer, views, progress);
    make_fewer(look, geometry, volumes[i], automatic[i], k_margin * limit);
  }
}

}  // namespace airlight::quality
