#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "frame/frame.h"
#include "scene/scene.h"

namespace airlight::quality {

/// Of a path the views that stand for all.
constexpr std::size_t k_looked_at = 6;

/// Of so many things the numbers of up to `most`, evenly spread, the first and the last among them.
std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t most);

/// A tile of an image, drawn with a known probability.
struct DrawnTile {
  glm::ivec2 tile;  ///< its column and row
  double weight;    ///< 1 / (how often it is drawn on average)
};

/// Draws tiles of reference::Reference::k_tile² pixels, the more likely the more images of a view by several
/// settings differ there; none is out of the question.
class TileDraw {
 public:
  /// Each image counts for as much as any other, however far it is from their median altogether: one that is
  /// nowhere right does not hide where good ones err.
  /// @param images row 0 at the top
  TileDraw(glm::ivec2 size, std::span<const std::vector<glm::vec3>> images);

  std::size_t tiles() const { return probability_.size(); }

  /// At equal steps along the sum of probabilities, from a random place on: neighbours are seldom drawn
  /// together.
  std::vector<DrawnTile> drawn(std::size_t count, std::uint32_t seed) const;

 private:
  glm::ivec2 columns_rows_;
  std::vector<double> probability_;
};

/// The truth of tiles of a view, all lights together.
class TruthOfTiles {
 public:
  /// @param tiles may name a tile several times: it is traced once
  TruthOfTiles(const scene::Geometry& geometry, const scene::View& view, std::vector<DrawnTile> tiles);

  glm::ivec2 size() const { return size_; }
  /// Whose truth was traced.
  std::size_t pixels() const { return pixels_; }
  /// Of all pixels, along the view ray [m]; 0 where it hits nothing. Row 0 at the top, as below.
  const std::vector<float>& distance() const { return distance_; }
  /// 0 outside of the tiles.
  const std::vector<glm::vec3>& airlight() const { return airlight_; }

 private:
  glm::ivec2 size_;
  std::size_t pixels_ = 0;
  std::vector<float> distance_;
  std::vector<glm::vec3> airlight_;
};

/// The same-surface rrmse of images, estimated from drawn tiles; of several views the mean.
class ErrorOfTiles {
 public:
  /// Of one more view. @param drawn are tiles of the truth
  void add(const TruthOfTiles& truth, std::span<const DrawnTile> drawn, const frame::FrameImages& images);

  /// NaN where the truth is dark.
  double rrmse() const;

  /// Of a thousand such estimates, from tiles drawn from these with repetition (Efron, "Bootstrap Methods",
  /// Annals of Statistics 7, 1979), the part that is not above a limit.
  double part_not_above(double limit) const;

 private:
  /// Weighted sums over a tile's pixels that see the same surface.
  struct Sums {
    double squares = 0.0, truth = 0.0, channels = 0.0;
    void operator+=(const Sums& other) {
      squares += other.squares;
      truth += other.truth;
      channels += other.channels;
    }
    double rrmse() const;
  };
  std::vector<std::vector<Sums>> views_;
};

}  // namespace airlight::quality
