#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "spirv/epipolar/populate_conservative_comp.h"
#include "spirv/epipolar/populate_screen_space_comp.h"

/// What is PRECISE in shaders/ is so in what the driver is given: SPIR-V forbids reordering and fusing by
/// NoContraction, which glslang puts on sums and products, but not on a dot product, and not across calls.
namespace airlight {
namespace {

enum : std::uint32_t {
  k_op_name = 5,
  k_op_ext_inst = 12,
  k_op_function = 54,
  k_op_fadd = 129,
  k_op_fsub = 131,
  k_op_fmul = 133,
  k_op_vector_times_scalar = 142,
  k_op_dot = 148,
  k_op_decorate = 71,
  k_no_contraction = 42,
  k_ext_cross = 68,
  k_ext_normalize = 69,
};

/// How many sums and products a function has, and how many of them may be reordered.
struct Arithmetic {
  int all = 0, loose = 0;
};

std::map<std::string, Arithmetic> arithmetic_of(std::span<const std::uint32_t> words) {
  std::map<std::uint32_t, std::string> names;
  std::set<std::uint32_t> kept;
  std::map<std::string, Arithmetic> functions;
  std::string function;
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
    const std::uint32_t op = words[at] & 0xffffu;
    const std::span<const std::uint32_t> operands = words.subspan(at + 1, (words[at] >> 16) - 1);
    if (op == k_op_name) {
      // "eye_relative(struct-CameraBlock-…": up to its parameters.
      const std::string_view name(reinterpret_cast<const char*>(&operands[1]));
      names[operands[0]] = name.substr(0, name.find('('));
    } else if (op == k_op_decorate && operands[1] == k_no_contraction) {
      kept.insert(operands[0]);
    } else if (op == k_op_function) {
      function = names[operands[1]];
    } else if (op == k_op_fadd || op == k_op_fsub || op == k_op_fmul || op == k_op_vector_times_scalar) {
      ++functions[function].all;
      functions[function].loose += kept.contains(operands[1]) ? 0 : 1;
    } else if (op == k_op_dot ||
               (op == k_op_ext_inst && (operands[3] == k_ext_cross || operands[3] == k_ext_normalize))) {
      ++functions[function].loose;
    }
  }
  return functions;
}

void expect_precise(std::span<const std::uint32_t> words, std::initializer_list<const char*> names) {
  const std::map<std::string, Arithmetic> functions = arithmetic_of(words);
  for (const char* name : names) {
    const auto found = functions.find(name);
    ASSERT_NE(found, functions.end()) << name;
    EXPECT_GT(found->second.all, 0) << name;
    EXPECT_EQ(found->second.loose, 0) << name << " of " << found->second.all;
  }
}

TEST(Precise, PositionsAndSinesAreNotReordered) {
  expect_precise(k_populate_conservative_comp, {"relative_to", "less_half_turns", "sine_of_quarter"});
}

TEST(Precise, WhichSideOfAnEdgeARayPassesIsTheSameInAllPasses) {
  const std::span<const std::uint32_t> words = k_populate_screen_space_comp;
  expect_precise(words, {"relative_to", "ordered_dot", "make_edge", "less_half_turns", "sine_of_quarter",
                         "sine", "cosine", "alpha_of_cell", "row_angle", "row_ray"});
  // What calls them adds nothing of its own.
  const std::map<std::string, Arithmetic> functions = arithmetic_of(words);
  EXPECT_FALSE(functions.contains("eye_relative"));
  EXPECT_FALSE(functions.contains("corner"));
  EXPECT_FALSE(functions.contains("is_left"));
}

TEST(Precise, AreNotAllFunctions) {
  EXPECT_GT(arithmetic_of(k_populate_conservative_comp).at("angle_of").loose, 0)
      << "or the test sees nothing";
}

}  // namespace
}  // namespace airlight
