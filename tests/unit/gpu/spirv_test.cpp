#include "gpu/spirv.h"

#include <algorithm>
#include <ostream>
#include <set>
#include <span>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "every_shader.h"
#include "spirv/gpu/shaders/resources_comp.h"

namespace airlight::gpu {

bool operator==(const SpirvResource& a, const SpirvResource& b) {
  return a.kind == b.kind && a.first_binding == b.first_binding && a.last_binding == b.last_binding &&
         a.is_written == b.is_written;
}

void PrintTo(const SpirvResource& resource, std::ostream* stream) {
  *stream << "kind " << static_cast<int>(resource.kind) << ", bindings " << resource.first_binding << " to "
          << resource.last_binding << (resource.is_written ? ", written" : "");
}

namespace {

using Kind = SpirvResource::Kind;
using testing::UnorderedElementsAre;

TEST(Spirv, NamesItsConstantsTheUnusedToo) {
  EXPECT_THAT(read_spirv(k_resources_comp).constant_ids, UnorderedElementsAre(2, 4, 9));
}

TEST(Spirv, TellsItsResourcesApart) {
  EXPECT_THAT(read_spirv(k_resources_comp).resources,
              UnorderedElementsAre(
                  SpirvResource{Kind::uniform_block, 3, 3, false}, SpirvResource{Kind::sampler, 5, 5, false},
                  SpirvResource{Kind::sampler, 6, 9, false}, SpirvResource{Kind::image, 1, 1, false},
                  SpirvResource{Kind::image, 2, 2, true}, SpirvResource{Kind::storage_block, 4, 4, false},
                  SpirvResource{Kind::storage_block, 6, 6, true}));
}

/// The highest bindings that every OpenGL 4.5 driver has for one stage (tables 23.63 to 23.67 of its
/// specification).
std::uint32_t highest_binding(Kind kind) {
  switch (kind) {
    case Kind::uniform_block:
      return 13;
    case Kind::storage_block:
      return 7;  // 7 is guaranteed; the queue, the flips, the planes and the mip chain lie above
    case Kind::sampler:
      return 15;
    case Kind::image:
      return 7;
  }
  return 0;
}

TEST(EveryShader, BindsOnlyWhatEveryDriverHas) {
  EXPECT_GT(std::size(k_every_shader), 10u);
  for (const auto& [name, words] : k_every_shader) {
    for (const SpirvResource& resource : read_spirv(words).resources)
      EXPECT_LE(resource.last_binding, highest_binding(resource.kind))
          << name << ": " << testing::PrintToString(resource);
  }
}

/// How many values that depend on a specialization constant a module chooses among by the way control came:
/// `constant || condition`.
int chosen_constants(std::span<const std::uint32_t> words) {
  enum { k_spec_constant_true = 48, k_spec_constant_op = 52, k_phi = 245 };
  std::set<std::uint32_t> constants;
  int count = 0;
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
    const std::uint32_t opcode = words[at] & 0xffff, length = words[at] >> 16;
    if (opcode >= k_spec_constant_true && opcode <= k_spec_constant_op) constants.insert(words[at + 2]);
    if (opcode != k_phi) continue;
    for (std::size_t value = at + 3; value < at + length; value += 2)
      count += static_cast<int>(constants.count(words[value]));
  }
  return count;
}

// NVIDIA's driver (580.159) takes such a value for false where it is true.
TEST(EveryShader, AsksSpecializationConstantsInConditionsOfTheirOwn) {
  EXPECT_EQ(chosen_constants(k_resources_comp), 1) << "the test sees nothing";
  for (const auto& [name, words] : k_every_shader) EXPECT_EQ(chosen_constants(words), 0) << name;
}

}  // namespace
}  // namespace airlight::gpu
