#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "epipolar/change_tree.h"
#include "epipolar/fused_scan.h"
#include "epipolar/grid.h"
#include "epipolar/mip_scan.h"
#include "epipolar/or_scan.h"
#include "epipolar/populate_conservative.h"
#include "epipolar/populate_screen_space.h"
#include "epipolar/populate_shadow_map.h"
#include "epipolar/space.h"
#include "frame/option.h"

namespace airlight::epipolar {

/// What fills the grid before the scan.
enum class Populate {
  shadow_map,    ///< PopulateShadowMap
  conservative,  ///< PopulateConservative
  screen_space,  ///< PopulateScreenSpace
};

/// How the grid is scanned.
enum class Scan {
  fused,       ///< FusedScan: bits are scattered and scanned in one pass; not for Populate::screen_space
  blocks,      ///< the same, less the texels that are wholly lit or dark
  column,      ///< bits are scattered, then OrScan
  multi_pass,  ///< bits are scattered, then MipScan
  none,        ///< of all but Query::bits
};

/// What a view ray is answered from.
enum class Query {
  bits,        ///< the voxels on its row of the grid
  tree,        ///< ChangeTree, over the first shadowed cells of light rays: no voxel is stored. Not for
               ///< Populate::screen_space.
  light_rays,  ///< each light ray's own first shadowed cell: nothing is made from them
};

/// How a shadow volume is made.
struct VolumeOptions {
  Resolution resolution = {};  ///< a count of 0 is automatic: see `fit`
  Populate populate = Populate::shadow_map;
  std::optional<Scan> scan = {};  ///< the fastest if none
  Ranges ranges = Ranges::frame;
  ThetaCells theta_cells = ThetaCells::fitted;
  Query query = Query::bits;

  /// The scan that the options stand for.
  Scan used_scan() const;

  /// The resolution that the options stand for: without bits as many cells of α are told apart as a
  /// tree's numbers can, whatever is asked for, as they cost nothing.
  Resolution used_resolution() const;

  /// @throws scene::Error (usage) when the options contradict each other.
  void validate() const;

  /// Gives automatic counts their value: rows nowhere more than a pixel apart, for the light that needs the
  /// most; the default number of samples.
  void fit(const scene::View& view);

  bool needs_closed_parts() const { return populate == Populate::screen_space; }
  bool ignores_cut_outs() const { return populate != Populate::shadow_map; }
  bool needs_shadow_map() const { return populate == Populate::shadow_map; }
};

/// What there is to choose, for the methods that have a volume.
std::vector<frame::Option> volume_options();

/// And for those that ask bits or a tree along view rays.
frame::Option query_option();

/// The voxelized shadow volume of a frame: ranges → populate → scan. Afterwards the bit of voxel (α_i, θ_j,
/// φ_k) says whether it is in shadow; with Ranges::frame, only where a pixel may read it. With Query::tree a
/// tree takes the place of scan and bits, with Query::light_rays nothing does. Based on: Wyman, "Voxelized
/// Shadow Volumes", HPG 2011, section 2.2.
class ShadowVolume {
 public:
  /// @throws scene::Error (usage) where options contradict each other or are still automatic; (driver) as
  /// Grid
  ShadowVolume(const gpu::Limits& limits, const VolumeOptions& options);

  /// Finds the ranges of α, θ and φ for a view, and cuts φ equally. Times `ranges`. Leaves the grid bound.
  /// Where the frame keeps what rests, and nothing has changed that the volume depends on, it stays as it is.
  /// @param own_ranges whether, with Ranges::frame, each half-plane has its own range of φ
  /// @returns what it wrote to the grid's block
  shaders::EpipolarBlock find_ranges(const frame::FrameInputs& inputs, bool own_ranges = true);

  /// Whether the volume stays as `fill` made it before: what depends on its ranges and on the medium alone
  /// need not be made anew either.
  bool rests() const { return rests_; }

  /// Populates and scans, unless the volume rests; the grid is bound. Times `populate`, and `scan` or `tree`,
  /// if any.
  void fill(const frame::FrameInputs& inputs);

  /// The same without the scan: the bits that it would start from. Of Query::bits.
  void fill_unscanned(const frame::FrameInputs& inputs) {
    filled_.reset();
    fill_unscanned(inputs, true);
  }

  const Grid& grid() const { return grid_; }
  /// What the last `find_ranges` returned.
  const shaders::EpipolarBlock& block() const { return found_.block; }

  /// All bits, as `fill` made them. For tests and pictures. Not with Query::tree.
  std::vector<std::uint32_t> bits() const;

  /// What a shader is specialised by that reads bits: shaders/epipolar/grid_texels.glsl.
  std::array<gpu::Constant, 4> reader_constants() const;

  /// Of the grid, what the scan wrote [bytes]; none of scans that write all, and of Query::tree.
  std::optional<std::int64_t> scanned_bytes() const;

  std::map<std::string, std::int64_t> bytes() const;  ///< memory on the GPU, by name

 private:
  /// What a volume depends on, beside its options: on where eye and light are, …
  struct Source {
    std::uint64_t scene;
    scene::Light light;
    glm::dvec3 eye;
    shaders::EpipolarBlock block;
    scene::Medium medium;  ///< … on where a medium has light come from, if the cells in φ grow with that, …
    /// … and on what the camera sees: none with Ranges::full and a cube for the shadow map.
    std::optional<std::pair<scene::CameraFrame, glm::ivec2>> image;
    bool operator==(const Source& other) const;
  };
  Source source_of(const frame::FrameInputs& inputs, const shaders::EpipolarBlock& block) const;

  void bind() const;
  void fill_unscanned(const frame::FrameInputs& inputs, bool with_bits);

  VolumeOptions options_;
  Grid grid_;
  Source found_{};                ///< of the ranges
  std::optional<Source> filled_;  ///< of the bits
  bool rests_ = false;
  gpu::Pipeline planes_, phi_range_, plane_cells_, plane_range_, scatter_;
  std::optional<gpu::Pipeline> phi_range_listed_;  ///< made when first needed
  std::optional<PopulateShadowMap> populate_shadow_map_;
  std::optional<PopulateConservative> populate_conservative_;
  std::optional<PopulateScreenSpace> populate_screen_space_;
  std::optional<FusedScan> fused_scan_;
  std::optional<OrScan> or_scan_;
  std::optional<MipScan> mip_scan_;
  std::optional<ChangeTree> tree_;
};

}  // namespace airlight::epipolar
