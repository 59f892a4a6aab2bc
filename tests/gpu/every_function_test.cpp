#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "media/medium.h"
#include "support/gpu_context.h"
#include "support/random.h"

#include "spirv/shaders/every_function_comp.h"

namespace airlight::shaders {
#include "gpu/shaders/every_function.glsl"
}  // namespace airlight::shaders

/// The shared functions on the GPU against the same functions on the CPU.
namespace airlight {
namespace {

using shaders::Inputs;
using shaders::Outputs;

/// How the values of a function are compared: |gpu − cpu| ≤ relative · |cpu| + absolute.
struct Function {
  const char* name;
  int values;
  double relative, absolute;
};

/// Both sides round to single precision, and compilers may fuse a product into a sum.
constexpr double k_single = 1e-6;
/// Mesa's arc tangent is a polynomial whose first coefficient is 1 − 2.1e-5.
constexpr double k_atan = 2.2e-5;

// Absolute tolerances stand where a function is a difference: near 0 only the size of its terms counts.
constexpr Function k_functions[] = {
    {"eye_angle.sine", 1, k_single, 2e-7},    // cross product of unit vectors
    {"eye_angle.cosine", 1, k_single, 2e-7},  // dot product of unit vectors
    {"alpha_of", 1, k_atan, 4e-7},            // of the two above
    {"alpha_complement", 1, k_atan, 4e-7},
    {"theta_of", 1, k_atan, 2e-5},          // two dot products over sin α ≥ 0.02
    {"phi_at", 1, k_atan, 2e-5},            // D − t cos α over a distance to the light ≥ 0.02 D
    {"distance_from_eye", 1, k_single, 0},  // divided by sin(α + φ) below
    {"alpha_at", 1, k_atan, 2e-5},          // as phi_at
    {"light_ray", 3, k_single, 3e-7},       // sums of unit vectors
    {"view_ray_of", 3, k_single, 3e-7},
    {"path_length", 1, k_single, 0},
    {"angle_order", 1, k_single, 3e-7},  // 1 − x
    {"angle_from_order", 1, k_atan, 3e-7},
    {"theta_centre", 1, k_single, 5e-7},  // θ − π
    {"theta_cell", 1, 0, 1},              // a cell: either side of its edge
    {"alpha_cell", 1, 0, 1},
    {"first_shadowed_cell", 1, 0, 1},
    {"grid_word", 1, 0, 0},
    {"phase isotropic", 1, k_single, 0},
    {"phase rayleigh", 1, k_single, 0},
    {"phase henyey-greenstein", 1, k_single, 0},
    {"phase hoffman-preetham", 1, k_single, 0},
    {"airlight_integrand", 3, k_single, 2e-7},  // e^{−x}: a relative error of x is one of x times as much
    {"integrate_cell", 3, k_single, 2e-8},
    {"airlight_scale", 3, k_single, 0},
    {"cube_point.face", 1, 0, 0},
    {"cube_point.uv", 2, k_single, 0},
    {"cube_point.depth", 1, 0, 0},
    {"cube_direction", 3, k_single, 0},
    {"cube_texel", 2, 0, 1},  // a texel: either side of its edge
    {"cube_texel_centre", 2, k_single, 1.0 / 256},
    {"view_ray", 3, k_single, 3e-7},
    {"quarter_pixel", 1, k_single, 0},
    {"eye_relative", 3, k_single, 1e-5},       // a difference of coordinates up to 100
    {"ray_triangle_distance", 1, 1e-5, 1e-5},  // of a plane seen at up to 80° from its normal
    {"phi_of_cell", 1, k_single, 0},
    {"cell_of_phi", 1, k_single, 0},
    {"light_texture_place", 2, k_single, 1e-6},  // ½ minus an angle
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
  for (std::size_t i = 0; i < inputs.size(); ++i) call_every_function(inputs[i], cpu_outputs[i]);

  std::size_t at = 0;
  for (const Function& function : k_functions) {
    double worst = 0.0;  // in units of the tolerance
    std::size_t worst_input = 0, worst_value = at;
    for (int value = 0; value < function.values; ++value, ++at) {
      for (std::size_t i = 0; i < inputs.size(); ++i) {
        const auto gpu = static_cast<double>(gpu_outputs[i].values[at]);
        const auto cpu = static_cast<double>(cpu_outputs[i].values[at]);
        double tolerance = function.relative * std::abs(cpu) + function.absolute;
        const bool is_distance = std::string_view(function.name) == "distance_from_eye";
        if (is_distance) tolerance /= static_cast<double>(std::sin(inputs[i].c.w - inputs[i].c.z));
        const double excess = gpu == cpu ? 0.0 : std::abs(gpu - cpu) / tolerance;
        if (!(excess <= worst)) worst = excess, worst_input = i, worst_value = at;
      }
    }
    EXPECT_LE(worst, 1.0) << function.name << " of input " << worst_input << ": gpu "
                          << gpu_outputs[worst_input].values[worst_value] << ", cpu "
                          << cpu_outputs[worst_input].values[worst_value];
    RecordProperty(function.name, std::to_string(worst));
  }
  EXPECT_LE(at, shaders::k_outputs);
  for (; at < shaders::k_outputs; ++at)
    EXPECT_EQ(cpu_outputs[0].values[at], 0.0f) << "a value that is not compared";
}

}  // namespace
}  // namespace airlight
