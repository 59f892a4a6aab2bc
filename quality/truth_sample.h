#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "frame/frame.h"
#include "reference/reference.h"
#include "scene/scene.h"

namespace airlight::quality {

/// A tile of an image, drawn with a known probability.
struct DrawnTile {
  glm::ivec2 tile;  ///< its column and row
  double weight;    ///< 1 / (how often it is drawn on average)
};

/// Draws tiles of reference::Reference::k_tile² pixels, the more likely the more two images differ there;
/// none is out of the question.
class TileDraw {
 public:
  /// @param a, b row 0 at the top
  TileDraw(glm::ivec2 size, std::span<const glm::vec3> a, std::span<const glm::vec3> b);

  std::size_t tiles() const { return probability_.size(); }

  /// At equal steps along the sum of probabilities, from a random place on: neighbours are seldom drawn
  /// together.
  std::vector<DrawnTile> drawn(std::size_t count, std::uint32_t seed) const;

 private:
  glm::ivec2 columns_rows_;
  std::vector<double> probability_;
};

/// Traces the truth of parts of a view, all lights together.
class TruthTracer {
 public:
  /// @param geometry, view kept by reference
  TruthTracer(const scene::Geometry& geometry, const scene::View& view);

  const scene::View& view() const { return view_; }
  /// Of all pixels, along the view ray [m]; 0 where it hits nothing.
  const std::vector<float>& distance() const { return distance_; }
  /// Row 0 at the top; 0 outside of the tiles.
  std::vector<glm::vec3> airlight(std::span<const glm::ivec2> tiles) const;

 private:
  const scene::View& view_;
  std::optional<scene::Geometry> posed_;
  std::vector<reference::Reference> of_light_;
  std::vector<float> distance_;
};

/// The truth of drawn tiles.
class TruthSample {
 public:
  TruthSample(const TruthTracer& tracer, std::vector<DrawnTile> tiles);

  /// Whose truth was traced.
  std::size_t pixels() const { return pixels_; }

 private:
  friend class ErrorOfTiles;
  glm::ivec2 size_;
  std::vector<DrawnTile> tiles_;
  std::vector<glm::vec3> airlight_;
  std::vector<float> distance_;
  std::size_t pixels_ = 0;
};

/// The same-surface rrmse of images, estimated from drawn tiles; of several views the mean.
class ErrorOfTiles {
 public:
  void add(const TruthSample& truth, const frame::FrameImages& images);

  /// NaN where the truth is dark.
  double rrmse() const;

  /// Of a thousand such estimates, from tiles drawn from these with repetition (Efron, "Bootstrap Methods",
  /// Annals of Statistics 7, 1979), the part that is not above a limit.
  double part_not_above(double limit) const;

 private:
  /// Weighted sums over a tile's pixels that see the same surface.
  struct Sums {
    double squares = 0.0, truth = 0.0;
    void operator+=(const Sums& other) {
      squares += other.squares;
      truth += other.truth;
      channels += other.channels;
    }
    double channels = 0.0;
    double rrmse() const;
  };
  std::vector<std::vector<Sums>> views_;
};

}  // namespace airlight::quality
