#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "media/medium.h"
#include "support/gpu_context.h"
#include "support/random.h"

#include "spirv/shaders/every_function_comp.h"

namespace airlight::shaders {
#define PRIVATE static
#include "gpu/shaders/every_function.glsl"
#undef PRIVATE
}  // namespace airlight::shaders

/// The shared functions on the GPU against the same functions on the CPU.
namespace airlight {
namespace {

using shaders::Inputs;
using shaders::Outputs;

/// What a tolerance is multiplied by.
enum class Scale {
  one,
  length,   ///< the larger of D and t: of a triangle that reaches up to twice as far
  grazing,  ///< 1 / sin(α + φ), by which the rounding of angles is magnified
};

/// How the values of a function are compared: |gpu − cpu| ≤ (relative · |cpu| + absolute) · scale, but for a
/// few inputs, of all, where a decision may turn out either way.
struct Function {
  const char* name;
  int values;
  double relative, absolute;
  Scale scale = Scale::one;
  int undecided = 0;
};

/// Both sides round to single precision some times, and compilers may fuse a product into a sum.
constexpr double k_single = 1e-6;
/// One rounding, in whatever direction, on either side.
constexpr double k_rounding = 2.4e-7;
/// angle_of on a GPU whose quotients are no better than GLSL asks, 2.5 ulp, and on the CPU, where it is right
/// to 2e-7.
constexpr double k_angle = 1.4e-6;
/// sine and cosine: 3e-7 on a GPU and 1.3e-7 on the CPU.
constexpr double k_sine = 4.3e-7;

// Absolute tolerances stand where a function is a difference: near 0 only the size of its terms counts.
constexpr Function k_functions[] = {
    {"eye_angle.sine", 1, k_single, 2e-7},    // cross product of unit vectors
    {"eye_angle.cosine", 1, k_single, 2e-7},  // dot product of unit vectors
    {"alpha_of", 1, k_angle, 4e-7},           // of the two above
    {"alpha_complement", 1, k_angle, 4e-7},
    {"theta_of", 1, k_angle, 2e-5},       // two dot products over sin α ≥ 0.02
    {"phi_at", 1, k_angle, 2e-5},         // D − t cos α over a distance to the light ≥ 0.02 D
    {"alpha_at", 1, k_angle, 2e-5},       // as phi_at
    {"path_length", 1, 2 * k_single, 0},  // two sines and a quotient
    {"angle_order", 1, 0, 7e-7},          // 1 − x, of a quotient
    {"angle_from_order", 1, k_angle, 3e-7},
    {"theta_centre", 1, 0, 4e-6},  // Newton's method on sums of angles
    {"theta_cell", 1, 0, 0, Scale::one, 20},
    {"alpha_cell", 1, 0, 0, Scale::one, 20},
    {"first_shadowed_cell", 1, 0, 0, Scale::one, 20},
    {"grid_word", 1, 0, 0},
    {"phase isotropic", 1, k_single, 0},
    {"phase rayleigh", 1, k_single, 0},
    {"phase henyey-greenstein", 1, k_single, 0},
    {"phase hoffman-preetham", 1, k_single, 0},
    {"airlight_integrand", 3, 2 * k_single, 4e-7},  // exp: 3 + 2x ulp of e^−x
    {"integrate_cell", 3, 2 * k_single, 4e-8},      // a tenth of that wide
    {"smooth_length", 1, 2 * k_single, 0},
    {"integrate_run", 3, 2 * k_single, 2e-6},  // steps up to half a turn
    {"table_place", 1, k_single, k_single},
    {"complement_at", 1, k_single, k_single},
    {"airlight_scale", 3, k_single, 0},
    {"cube_point.face", 1, 0, 0, Scale::one, 20},
    {"cube_point.uv", 2, k_single, 0},
    {"cube_point.depth", 1, 0, 0},
    {"cube_direction", 3, k_single, 0},
    {"cube_texel", 2, 0, 0, Scale::one, 20},
    {"cube_texel_centre", 2, k_single, 2e-7, Scale::one, 20},  // of the same texel
    {"view_ray", 3, k_single, 3e-7},
    {"quarter_pixel", 1, k_single, 0},
    {"eye_relative", 3, k_rounding, 0},        // near the eye the first difference is exact
    {"ray_triangle_distance", 1, 1e-5, 1e-5},  // of a plane seen at up to 80° from its normal
    {"phi_of_cell", 1, k_single, 0},
    {"cell_of_phi", 1, 3 * k_single, 0},                       // 18 ulp (conservative.glsl)
    {"light_texture_place", 2, k_single, 2e-7},                // ½ minus an angle
    {"light_texture_blend.from", 3, 0, 2e-5, Scale::one, 20},  // up to 40 texels; texel and weight together
    {"light_texture_blend.to", 3, 0, 2e-5, Scale::one, 20},
    {"sine", 1, 0, k_sine},
    {"cosine", 1, 0, k_sine},
    {"sine_of_quarter", 1, 6e-7, 0},
    {"angle_of", 1, k_angle, 0},
    {"ordered_dot", 1, 0, 3 * k_rounding},
    {"unit_or", 3, 2 * k_single, 0},
    {"plane_of_theta", 1, 0, 2e-4},  // 28 e (conservative.glsl) over 0.018, the spacing's step
    {"theta_of_plane", 1, 0, 4e-6},
    {"theta_from_middle", 1, 0, 1e-6},
    {"theta_to_centre", 1, 0, 1e-5},
    {"phi_to_row_end", 1, k_angle, 1e-4},  // of cross products of points ≥ 0.02 D from the light
    // Conservative voxelization; see there what its slacks stand for.
    {"slabs_per_plane", 1, 0, 0},
    {"position_slack", 1, k_single, 0},
    {"distance_to_segment", 1, 0, 3e-6, Scale::length},
    {"wrapped", 1, 0, 1e-6},
    {"voxel_triangle", 3, 0, 2e-6, Scale::length},
    {"planes_of_triangle", 4, 0, 0, Scale::one, 60},
    {"plane_at", 1, 0, 0, Scale::one, 60},
    {"clip", 2, k_single, 0},
    // Whether a corner lies in a slab at whose side it lies to rounding: twice as often on NVIDIA's GPUs.
    {"outline_in_slab", 20, 0, 1e-5, Scale::length, 60},
    {"curvature_slack", 1, 0, 1e-9, Scale::length, 20},
    {"phi_order_bounds", 2, 0, 1e-4, Scale::one, 20},  // seen from the light, points misplaced by the slack
    {"part_in_slab.first_ray", 1, 0, 1, Scale::one, 20},
    {"part_in_slab.end_ray", 1, 0, 1, Scale::one, 20},
    {"boundary_ray", 2, 0, 5e-6},  // 34 e
    {"least_alpha_order", 1, 0, 1e-4, Scale::one, 20},
    {"first_touched_cell", 1, 0, 1, Scale::one, 20},
    // Both kinds of light.
    {"phi_through", 1, 2 * k_single, 0},
    {"phi_at sun", 1, k_single, 2e-7, Scale::length},  // eye_angle.sine times t
    {"phi_of_end", 1, k_angle, 4e-7},                  // alpha_complement
    {"crossing_of", 1, 3 * k_single, 0},               // over a cosine ≥ 0.37
    {"crossing_of sun", 1, 0, 0},
    {"phi_order_at", 1, 0, 2e-5},  // as phi_at
    {"phi_order_at sun", 1, k_single, 2e-7, Scale::length},
    {"phi_order_of_open_end", 1, 0, 1.2e-6},  // angle_order of eye_angle
    {"phi_from_order", 1, k_angle, 3e-7},     // angle_from_order
    {"phi_from_order sun", 1, 0, 0},
    {"spaced_alpha equal", 1, 0, k_rounding},
    {"cell_of_alpha equal", 1, k_single, 1e-4},  // over a step of 0.005
    {"alpha_of_cell equal", 1, k_single, 0},
    {"spaced_alpha root", 1, 0, 1e-6},  // a difference of square roots of 4.5 ulp
    {"cell_of_alpha root", 1, k_single, 2e-4},
    {"alpha_of_cell root", 1, 2 * k_single, 0},
    {"spaced_alpha root of complement", 1, 0, 1e-6},
    {"cell_of_alpha root of complement", 1, k_single, 2e-4},
    {"alpha_of_cell root of complement", 1, 0, 4e-6},  // π minus the square of such a root
    {"own_cells.first", 1, 2 * k_single, 0},
    {"own_cells.per_cell", 1, 0, 4e-9},  // a difference of places, over 512
    {"phi_of_cell own", 1, 2 * k_single, 0},
    {"cell_of_phi own", 1, 0, 6e-3},  // a place, over 512 cells of a seventh of the range or more
    {"to_light", 3, 0, k_single, Scale::length},
    {"light_above", 1, 0, k_single},
    {"part_in_medium", 2, k_single, 0},
    {"light_path", 1, k_single, 2 * k_single},      // of a height, over one of 1 m or more
    {"light_path sun", 1, k_single, 5 * k_single},  // of a height, over a sine ≥ 0.2
    {"plane_share", 1, 0, 1e-5},                    // 1 − 20
    {"plane_uv", 2, 0, k_single, Scale::length},
    {"plane_clip", 4, 0, 2 * k_single, Scale::length},  // of shares, D ≥ ½
    {"plane_z", 1, k_single, 5e-6},                     // over a scale of 0.05
    {"sun_ray.entry", 1, k_single, 0},
    {"sun_ray.exit", 1, k_single, 0},
    {"sun_ray.path", 1, k_single, 0},
    {"sun_ray.slope", 1, k_single, k_single},  // 1 − 5
    {"mean_decay", 1, 2 * k_single, 0},
    {"integrate_sun_run", 3, 2 * k_single, 4e-7, Scale::length},  // exp, see above
    {"sun_scale", 3, 2 * k_single, 0},
    {"depth_growth", 1, 3 * k_single, 0},
    {"panel_length_by_growth", 1, 3 * k_single, 0},
    {"straight_length_by_growth", 1, 3 * k_single, 0},
    {"sine_of_scattering", 1, 0, k_sine},
    {"cone_share", 1, 0, 4e-6, Scale::one, 20},  // over a ramp of 0.25
    {"range_share", 1, k_single, k_single},      // 1 − 1e5 at most, but then 0
    // Where a plane but touches a cone, or a ray the range, roots of a difference that is 0 are lost.
    {"half_width_of_cone", 1, k_angle, 5e-4, Scale::one, 20},
    {"part_in_reach of cone", 4, k_angle, 2e-3, Scale::one, 100},
    {"part_in_reach of range", 2, k_angle, 1e-3},
    {"reach_share", 1, 0, 1e-4, Scale::one, 20},  // across the axis to 2e-7 of 0.02
    {"march_steps", 2, 0, 0},
    {"place_of_step", 1, 6 * k_single, 0},  // beyond the scene by an inverse
    {"interleaved_offset", 1, 0, 0, Scale::one, 20},
    {"depth_of_slice", 1, 2e-6, 2e-6, Scale::length},  // e^x − 1
    {"slice_of_depth", 1, 2e-6, 1e-4},                 // log: 2⁻²¹ near 1; over ln 4 of 64
    {"place_in_froxel", 3, 0, 1e-5, Scale::one, 20},   // of up to 60
    {"place_in_slices", 3, 2e-6, 1e-4},                // pixels of hundreds; slices as above
    {"fold repeat", 1, 0, 1e-6, Scale::one, 20},       // of up to 10
    {"fold clamp", 1, 0, 1e-6},
    {"fold mirror", 1, 0, 1e-6, Scale::one, 20},
    {"texture_blend.from", 3, 0, 5e-5, Scale::one, 20},  // up to 40 texels; texel and weight together
    {"texture_blend.to", 3, 0, 5e-5, Scale::one, 20},
    {"texture_probes.count", 1, 0, 0, Scale::one, 20},
    {"texture_probes.level", 1, 0, 1e-5, Scale::one, 20},  // log2: 2⁻²¹ near 1
    {"texture_probes.apart", 1, 2 * k_single, 0, Scale::one, 20},
    {"store_place", 3, 0, 0},
    {"last_level", 1, 0, 0},
    {"of_octahedron", 3, 0, 1e-4},  // a step of 2/65534, and what it turns
    {"weights_per_turn", 3, 2e-5, 2e-8},
};

std::vector<Inputs> random_inputs(int count) {
  tests::Random random(1);
  std::vector<Inputs> all;
  for (int i = 0; i < count; ++i) {
    const double alpha = random.uniform(0.05, 3.0), complement = std::numbers::pi - alpha;
    const double phi = complement * random.uniform(0.01, 0.95), theta = random.uniform(-3.14, 3.14);
    const glm::dvec3 l = random.direction();
    glm::dvec3 ray = random.direction();
    while (glm::length(glm::cross(l, ray)) < 0.02) ray = random.direction();
    const double D = random.logarithmic(0.5, 5);
    const double t = D * random.logarithmic(0.05, 20);
    const glm::dvec3 any = random.logarithmic(0.01, 100) * random.direction();
    all.push_back({.a = glm::vec4(l, D),
                   .b = glm::vec4(ray, t),
                   .c = glm::vec4(alpha, theta, phi, complement),
                   .d = glm::vec4(any, random.uniform(-0.7, 0.7))});
  }
  return all;
}

TEST(EveryFunction, OnTheGpuEqualsTheSameOnTheCpu) {
  gpu::Context& context = tests::gpu_context();
  const int count = 65536;
  const std::vector<Inputs> inputs = random_inputs(count);
  const gpu::Buffer input_buffer = gpu::Buffer::from(std::span<const Inputs>(inputs));
  const gpu::Buffer output_buffer(static_cast<std::int64_t>(sizeof(Outputs)) * count);
  const gpu::Pipeline program = gpu::Pipeline::compute(k_every_function_comp);
  input_buffer.bind_storage(0);
  output_buffer.bind_storage(1);
  program.dispatch({count, 1, 1});
  const std::vector<Outputs> gpu_outputs = output_buffer.read<Outputs>();
  context.check();

  std::vector<Outputs> cpu_outputs(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    call_every_function(inputs[i]);
    cpu_outputs[i] = shaders::outputs;
  }

  std::size_t at = 0;
  for (const Function& function : k_functions) {
    double worst = 0.0;  // in units of the tolerance
    std::size_t worst_input = 0, worst_value = at;
    int beyond = 0;
    for (int value = 0; value < function.values; ++value, ++at) {
      for (std::size_t i = 0; i < inputs.size(); ++i) {
        const auto gpu = static_cast<double>(gpu_outputs[i].values[at]);
        const auto cpu = static_cast<double>(cpu_outputs[i].values[at]);
        const double scale = function.scale == Scale::length
                                 ? static_cast<double>(std::max(inputs[i].a.w, inputs[i].b.w))
                             : function.scale == Scale::grazing
                                 ? 1.0 / static_cast<double>(std::sin(inputs[i].c.w - inputs[i].c.z))
                                 : 1.0;
        const double tolerance = (function.relative * std::abs(cpu) + function.absolute) * scale;
        const double excess = gpu == cpu ? 0.0 : std::abs(gpu - cpu) / tolerance;
        beyond += excess <= 1.0 ? 0 : 1;
        if (!(excess <= worst)) worst = excess, worst_input = i, worst_value = at;
      }
    }
    EXPECT_LE(beyond, function.undecided) << function.name << ", most of input " << worst_input << ": gpu "
                                          << gpu_outputs[worst_input].values[worst_value] << ", cpu "
                                          << cpu_outputs[worst_input].values[worst_value];
    RecordProperty(function.name, std::to_string(worst));
  }
  EXPECT_EQ(at, shaders::k_outputs);
}

}  // namespace
}  // namespace airlight
