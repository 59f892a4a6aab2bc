#pragma once

#include <compare>
#include <map>
#include <optional>

#include "epipolar/volume.h"
#include "frame/method.h"
#include "frame/screen_pass.h"

namespace airlight::media {

/// How the visibility bits become radiance.
enum class VsvIntegral {
  automatic,  ///< table for a view that it can serve, else quadrature
  table,  ///< between changes of visibility, from a table of the unshadowed integral: exact up to the bits
  quadrature,  ///< between changes of visibility, by panels that follow the integrand: for every light and
               ///< medium
  riemann,     ///< the paper's sum over all samples (Eq. 5)
  /// the unshadowed integral, from the table, times the lit fraction of the samples: the cheapest and the
  /// least exact, for it does not ask where along the ray the shadow lies
  factored,
};

/// How the range of φ is cut into samples.
enum class PhiCells {
  growing,  ///< finer where more light comes from
  equal,    ///< the paper's
};

struct VsvOptions {
  VsvIntegral integral = VsvIntegral::automatic;
  PhiCells phi_cells = PhiCells::growing;
  frame::ViewRays rays = {};
  epipolar::VolumeOptions volume = {};

  /// @throws scene::Error (usage) when the options contradict each other.
  void validate() const;
  void fit(const scene::View& view) {
    integral = used_integral(view);
    volume.fit(view);
  }
  bool needs_closed_parts() const { return volume.needs_closed_parts(); }
  bool ignores_cut_outs() const { return volume.ignores_cut_outs(); }
  bool needs_shadow_map() const { return volume.needs_shadow_map(); }

  /// The integral that the options stand for.
  VsvIntegral used_integral(const scene::View& view) const;

  /// A phase function whose lobe is too narrow. And by what looks up a table of α and φ, a light that depends
  /// on θ too: one textured by direction, a spot, or a point light that shines into a layer of fog from
  /// above, or is seen from there; and one with a range.
  std::optional<frame::Refusal> refusal(const scene::View& view) const;
};

/// `vsv`: airlight from an epipolar voxelized shadow volume.
/// Based on: Wyman, "Voxelized Shadow Volumes", HPG 2011, sections 2 and 3. `factored`: Dobashi, Yamamoto and
/// Nishita, "Interactive Rendering of Atmospheric Scattering Effects Using Graphics Hardware", 2002, as the
/// paper uses it for its timings (end of its section 5).
class Vsv : public frame::Airlight {
 public:
  /// @throws scene::Error as epipolar::ShadowVolume.
  Vsv(const gpu::Context& context, const VsvOptions& options);

  /// The options must not refuse the view.
  void integrate(const frame::FrameInputs& inputs, const gpu::Texture& radiance) override;
  frame::ViewRays rays() const override { return options_.rays; }
  std::map<std::string, std::int64_t> bytes() const override;
  /// "changes" of visibility, and "reads" of 128 bits, by which they are found; "scanned_bytes", what a scan
  /// of first shadowed cells writes.
  std::map<std::string, double> counters(const frame::FrameInputs& inputs) override;
  /// Those of epipolar::debug_images, and where pixels are asked "changes": how often visibility changes
  /// along each view ray, of 64.
  std::vector<frame::DebugImage> debug_images(const frame::FrameInputs& inputs) override;
  /// Not of Populate::screen_space.
  std::optional<frame::DebugImage> debug_slice(const scene::View& view, glm::dvec2 place) override;

  const epipolar::ShadowVolume& volume() const { return volume_; }

 private:
  /// What the shaders are specialised for.
  struct Variant {
    VsvIntegral integral;
    std::uint32_t phase, channels, direct, reach;
    std::uint32_t colour_rows, colour_columns;  ///< of a light texture's table; 0 without
    bool rough, sun;
    std::uint32_t layer;
    bool looks_away;
    auto operator<=>(const Variant&) const = default;
  };
  struct Programs {
    gpu::Pipeline phi_growth, build_table;
    std::uint32_t table_rows = 0;  ///< 0 where there is no table
    frame::ScreenPass integrate;
    std::vector<gpu::Constant> of_ray;  ///< of shaders/media/vsv_ray.glsl
  };
  /// What vsv_count.frag finds along each view ray.
  gpu::Texture count(const frame::FrameInputs& inputs) const;
  /// Those of a variant, and a table with room for it. Lights of a frame may be of different ones, in turns.
  const Programs& load(const gpu::Context& context, const Variant& variant);

  VsvOptions options_;
  epipolar::ShadowVolume volume_;
  std::map<Variant, Programs> programs_;
  const Programs* last_ = nullptr;  ///< of the last `integrate`
  gpu::Buffer table_;               ///< of the integral, or of a textured light's colours
  gpu::TexelView table_texels_;
};

frame::AirlightMethod vsv_method();

}  // namespace airlight::media
