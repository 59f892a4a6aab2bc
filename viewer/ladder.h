#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "viewer/shown.h"

namespace airlight::viewer {

/// What a rung of the ladder takes of what is asked for: parts of the image's sides, of the counts of a
/// method's cells along each angle, and of the shadow map's side.
struct Rung {
  double image, cells, shadow_map;
};

/// From what is asked for down to what a driver on the CPU draws while something moves.
inline constexpr std::array<Rung, 5> k_rungs = {
    {{1.0, 1.0, 1.0}, {0.75, 0.75, 0.5}, {0.5, 0.5, 0.5}, {0.375, 0.5, 0.25}, {0.25, 0.25, 0.25}}};

/// Frames of one picture at several sizes, each with its own storage and its own compiled programs, so that
/// from frame to frame any of them can be drawn.
class Ladder {
 public:
  /// @param geometry kept by reference @param scene of it
  Ladder(gpu::Context& context, const scene::Geometry& geometry,
         std::shared_ptr<const frame::SceneBuffers> scene);

  /// What is drawn from now on. Of rungs whose methods or sizes change, what they had is freed.
  void show(const Shown& shown);

  /// Frees what all rungs have: what is drawn next is made anew.
  void clear();

  /// Draws a rung. @returns it once the GPU is done
  /// @throws scene::Error as Frame::render does, and where a method cannot show the view
  const frame::Frame& draw(std::size_t rung, gpu::StageTimer& timer,
                           frame::Resting resting = frame::Resting::kept);

  /// Draws a rung as it is, and what its airlight has left behind.
  std::vector<frame::DebugImage> inspect(std::size_t rung);

  /// Draws a rung as it is, and the points that its surfaces shade.
  frame::SurfacePoints surface_points(std::size_t rung);

  /// As it was drawn last.
  const frame::Frame& frame(std::size_t rung) const { return *of_rung_[rung].frame; }

  /// Whether a rung has been drawn since its methods or its size last changed.
  bool is_ready(std::size_t rung) const { return of_rung_[rung].ms.has_value(); }

  /// What a rung's last frame took, but the first, which compiles [ms]; none before.
  std::optional<double> ms(std::size_t rung) const;

  glm::ivec2 size(std::size_t rung) const;  ///< of its image [pixels]

  /// The picture as a rung draws it, methods fitted.
  Shown shown(std::size_t rung) const;

  /// The method that drew a rung last.
  frame::Airlight& airlight(std::size_t rung) { return *of_rung_[rung].made->airlight; }
  std::int64_t bytes(std::size_t rung) const;  ///< on the GPU, the scene left out

 private:
  struct Made {
    std::unique_ptr<frame::Airlight> airlight;
    std::unique_ptr<frame::SurfaceShadow> surface;
  };
  struct OfRung {
    std::optional<frame::Frame> frame;
    /// By their options: what is automatic may be another from view to view.
    std::map<std::string, Made> methods;
    Made* made = nullptr;
    std::optional<double> ms;
    int frames = 0;  ///< drawn
    void reset() {
      frame.reset();
      methods.clear();
      made = nullptr;
      ms.reset();
      frames = 0;
    }
  };

  /// Draws a rung otherwise, and then as it is. @param look (made, render(surface, airlight))
  template <typename Look>
  void look_into(std::size_t rung, const Look& look);

  gpu::Context& context_;
  const scene::Geometry& geometry_;
  std::shared_ptr<const frame::SceneBuffers> scene_;
  std::optional<Shown> shown_;
  std::array<OfRung, k_rungs.size()> of_rung_;
};

}  // namespace airlight::viewer
