#include "gpu/pipeline.h"

#include <array>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frame/screen_pass.h"
#include "gpu/replaced_shaders.h"
#include "scene/error.h"
#include "support/gpu_context.h"

#include "spirv/shaders/all_stages_frag.h"
#include "spirv/shaders/all_stages_geom.h"
#include "spirv/shaders/all_stages_tesc.h"
#include "spirv/shaders/all_stages_tese.h"
#include "spirv/shaders/all_stages_vert.h"
#include "spirv/shaders/count_fragments_frag.h"
#include "spirv/shaders/count_groups_comp.h"
#include "spirv/shaders/one_frag.h"
#include "spirv/shaders/paint_bits_frag.h"
#include "spirv/shaders/paint_frag.h"
#include "spirv/shaders/rectangle_vert.h"

#include <epoxy/gl.h>

namespace airlight::gpu {
namespace {

using testing::Each;
using testing::HasSubstr;
using tests::gpu_context;

struct Counts {
  glm::uvec4 groups;
  std::uint32_t invocations, sums, padding[2];
};

TEST(Pipeline, DispatchesAsManyGroupsOfItsOwnSizeAsCoverTheInvocations) {
  Context& context = gpu_context();
  for (std::uint32_t width : {3u, 16u}) {
    const Pipeline pipeline =
        Pipeline::compute(k_count_groups_comp, std::array{Constant(0, width), Constant(7, 5)});
    EXPECT_EQ(pipeline.work_group(), glm::uvec3(width, 2, 1));
    pipeline.set(3, 2u);
    for (glm::uvec3 invocations : {glm::uvec3(1, 1, 1), glm::uvec3(48, 4, 3), glm::uvec3(49, 5, 1)}) {
      const Buffer counts(sizeof(Counts));
      counts.bind_storage(0);
      pipeline.dispatch(invocations);
      const Counts found = counts.read<Counts>().at(0);
      const glm::uvec3 groups((invocations.x + width - 1) / width, (invocations.y + 1) / 2, invocations.z);
      EXPECT_EQ(glm::uvec3(found.groups), groups);
      EXPECT_EQ(found.invocations, groups.x * groups.y * groups.z * width * 2);
      EXPECT_EQ(found.sums, 10 * found.invocations);
    }
  }
  context.check();
}

TEST(Pipeline, OverTheDriversGroupsIsAnErrorThatNamesTheLimit) {
  Context& context = gpu_context();
  const Pipeline pipeline = Pipeline::compute(k_count_groups_comp, std::array{Constant(0, 1)});
  const std::uint32_t most = context.limits().max_work_groups.y;
  EXPECT_GE(most, 65535u) << "what OpenGL 4.5 asks of a driver";
  try {
    pipeline.dispatch({1, 2 * most + 1, 1});
    FAIL();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, scene::ExitCode::driver);
    EXPECT_THAT(error.what(), HasSubstr("GL_MAX_COMPUTE_WORK_GROUP_COUNT"));
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(most)));
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(most + 1)));
  }
  EXPECT_NO_THROW(require_work_groups({4, 5, 6}, {4, 5, 6}));
  EXPECT_THROW(require_work_groups({4, 5, 6}, {5, 5, 6}), scene::Error);
  EXPECT_THROW(require_work_groups({4, 5, 6}, {4, 5, 7}), scene::Error);
  context.check();
}

TEST(Pipeline, OfOneGroupTakesItsCountFromABuffer) {
  const Pipeline pipeline = Pipeline::compute(k_count_groups_comp, std::array{Constant(0, 4)});
  const Buffer counts(sizeof(Counts));
  counts.bind_storage(0);
  const std::vector<std::uint32_t> groups = {99, 2, 3, 4};
  pipeline.dispatch_indirect(Buffer::from(std::span<const std::uint32_t>(groups)), 4);
  EXPECT_EQ(counts.read<Counts>().at(0).groups, glm::uvec4(2, 3, 4, 0));
  gpu_context().check();
}

#ifndef NDEBUG
TEST(PipelineDeathTest, AConstantThatNoStageDeclaresIsAMistake) {
  EXPECT_DEATH(Pipeline::compute(k_count_groups_comp, std::array{Constant(1, 4)}), "declares");
}
#endif

TEST(Pipeline, RunsEveryStageWithTheConstantsThatItDeclares) {
  const Texture layers(Format::r32ui, {4, 4}, 2);
  const Framebuffer target({layers});
  const Pipeline pipeline = Pipeline::graphics(
      {.vertex = k_all_stages_vert,
       .tessellation_control = k_all_stages_tesc,
       .tessellation_evaluation = k_all_stages_tese,
       .geometry = k_all_stages_geom,
       .fragment = k_all_stages_frag},
      {.patch_vertices = 4},
      std::array{Constant(0, 1), Constant(1, 2), Constant(2, 4), Constant(3, 8), Constant(4, 16)});
  GLuint vertices = 0;
  glCreateVertexArrays(1, &vertices);
  const Handle<delete_vertex_array> vertex_array(vertices);
  target.clear();
  pipeline.draw(target, [&] {
    glBindVertexArray(vertices);
    glDrawArrays(GL_PATCHES, 0, 4);
  });
  const auto texels = layers.read<std::uint32_t>();
  ASSERT_EQ(texels.size(), 32u);
  EXPECT_THAT(std::vector(texels.begin(), texels.begin() + 16), Each(31u));
  EXPECT_THAT(std::vector(texels.begin() + 16, texels.end()), Each(23u)) << "the second layer";
  gpu_context().check();
}

/// A row of eight pixels, and rectangles drawn into it. Every pixel is as wide as an eighth of clip space.
class Row {
 public:
  explicit Row(Format format = Format::rgba32f)
      : colour_(format, {8, 1}), depth_(Format::depth32f_stencil8, {8, 1}), target_({colour_}, depth_) {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    vertex_array_ = Handle<delete_vertex_array>(name);
    target_.clear(0.5f, 3);
  }

  struct Rectangle {
    std::uint32_t from = 0, to = 8;
    std::uint32_t depth = 0;  ///< eighths of w
    bool turned_over = false;
  };

  /// @param colour eighths, or bits
  void draw(const FixedState& state, const Rectangle& rectangle, glm::uvec4 colour = glm::uvec4(8)) const {
    const bool is_integer = colour_.format() == Format::r32ui;
    const Pipeline pipeline = Pipeline::graphics(
        {.vertex = k_rectangle_vert,
         .fragment = is_integer ? std::span<const std::uint32_t>(k_paint_bits_frag) : k_paint_frag},
        state);
    pipeline.set(0, glm::uvec4(rectangle.from, rectangle.to, rectangle.depth, rectangle.turned_over));
    pipeline.set(1, colour);
    run(pipeline);
  }

  void run(const Pipeline& pipeline) const {
    pipeline.draw(target_, [&] {
      glBindVertexArray(vertex_array_.get());
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    });
  }

  std::vector<float> red() const {
    std::vector<float> red;
    for (const glm::vec4& texel : colour_.read<glm::vec4>()) red.push_back(texel.r);
    return red;
  }
  glm::vec4 first() const { return colour_.read<glm::vec4>().at(0); }
  std::uint32_t first_bits() const { return colour_.read<std::uint32_t>().at(0); }
  std::vector<DepthStencil> depth_stencil() const { return depth_.read<DepthStencil>(); }
  float first_depth() const { return depth_stencil().at(0).depth; }
  const Framebuffer& target() const { return target_; }

 private:
  Texture colour_, depth_;
  Framebuffer target_;
  Handle<delete_vertex_array> vertex_array_;
};

TEST(ScreenPass, WritesEveryTexelOnce) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(17, 9), glm::ivec2(130, 65)}) {
    const Texture image(Format::rgba32f, size);
    Framebuffer({image}).clear();
    const frame::ScreenPass adds(k_one_frag, {}, Blend::add);
    adds.run({image});
    adds.run({image});
    EXPECT_THAT(image.read<glm::vec4>(), testing::Each(glm::vec4(2, 4, 6, 8))) << size.x;
    frame::ScreenPass(k_one_frag).run({image});
    EXPECT_THAT(image.read<glm::vec4>(), testing::Each(glm::vec4(1, 2, 3, 4))) << size.x;
  }
  gpu_context().check();
}

TEST(ScreenPass, IsOfTheWordsInThePlaceOfItsOwn) {
  const Texture image(Format::rgba32f, {3, 2});
  const frame::ScreenPass before(k_one_frag);
  replaced_shaders()[k_one_frag].assign(std::begin(k_paint_frag), std::end(k_paint_frag));
  const frame::ScreenPass after(k_one_frag);
  replaced_shaders().clear();
  after.pipeline().set(1, glm::uvec4(8, 0, 4, 0));
  after.run({image});
  EXPECT_THAT(image.read<glm::vec4>(), Each(glm::vec4(1, 0, 0.5, 0)));
  before.run({image});
  EXPECT_THAT(image.read<glm::vec4>(), Each(glm::vec4(1, 2, 3, 4)));
  gpu_context().check();
}

TEST(FixedState, DefaultsDrawEverything) {
  const Row row;
  row.draw({}, {.from = 2, .to = 5});
  EXPECT_EQ(row.red(), (std::vector<float>{0, 0, 1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(row.first_depth(), 0.5f) << "depth is not written without a test";
  gpu_context().check();
}

TEST(FixedState, DepthTestComparesAndWrites) {
  struct Case {
    Compare compare;
    std::array<float, 3> drawn;  ///< at a depth of 1/4, 1/2 and 3/4, over 1/2
  };
  for (const auto& [compare, drawn] :
       {Case{Compare::never, {0, 0, 0}}, Case{Compare::less, {1, 0, 0}}, Case{Compare::equal, {0, 1, 0}},
        Case{Compare::less_equal, {1, 1, 0}}, Case{Compare::greater, {0, 0, 1}},
        Case{Compare::not_equal, {1, 0, 1}}, Case{Compare::greater_equal, {0, 1, 1}},
        Case{Compare::always, {1, 1, 1}}}) {
    const Row row;
    const FixedState state{.depth_test = compare, .zero_to_one_depth = true};
    for (std::uint32_t i = 0; i < 3; ++i) row.draw(state, {.from = i, .to = i + 1, .depth = 2 * i + 2});
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(row.red()[i], drawn[i]) << static_cast<int>(compare) << " " << i;
      const float depth = drawn[i] != 0.0f ? 0.25f * static_cast<float>(i + 1) : 0.5f;
      EXPECT_EQ(row.depth_stencil()[i].depth, depth);
    }
  }
  const Row row;
  row.draw({.depth_test = Compare::always, .depth_write = false}, {.depth = 2});
  EXPECT_EQ(row.red()[0], 1.0f);
  EXPECT_EQ(row.first_depth(), 0.5f);
  gpu_context().check();
}

TEST(FixedState, ClipSpaceIsAsAsked) {
  {
    const Row row;
    row.draw({.depth_test = Compare::always}, {.depth = 4});
    EXPECT_EQ(row.first_depth(), 0.75f) << "from −w to w";
  }
  {
    const Row row;
    row.draw({.depth_test = Compare::always}, {.depth = 9});
    EXPECT_EQ(row.red()[0], 0.0f) << "clipped";
  }
  {
    const Row row;
    row.draw({.depth_test = Compare::always, .depth_clamp = true}, {.depth = 9});
    EXPECT_EQ(row.red()[0], 1.0f);
    EXPECT_EQ(row.first_depth(), 1.0f);
  }
}

TEST(FixedState, CullsBySideAndOrigin) {
  struct Case {
    Cull cull;
    bool upper_left, turned_over, drawn;
  };
  for (const auto& [cull, upper_left, turned_over, drawn] :
       {Case{Cull::none, false, false, true}, Case{Cull::none, false, true, true},
        Case{Cull::back, false, false, true}, Case{Cull::back, false, true, false},
        Case{Cull::front, false, false, false}, Case{Cull::front, false, true, true},
        Case{Cull::back, true, false, true}, Case{Cull::back, true, true, false}}) {
    const Row row;
    row.draw({.upper_left_origin = upper_left, .cull = cull}, {.turned_over = turned_over});
    EXPECT_EQ(row.red()[0], drawn ? 1.0f : 0.0f) << static_cast<int>(cull) << upper_left << turned_over;
  }
}

TEST(FixedState, StencilCountsAndTests) {
  // As shadow volumes do: front faces count up behind what is nearer, back faces down.
  const Row row;
  const StencilTest up{.on_depth_fail = StencilOp::increment_wrap};
  const StencilTest down{.on_depth_fail = StencilOp::decrement_wrap};
  const FixedState count{.depth_test = Compare::less,
                         .depth_write = false,
                         .zero_to_one_depth = true,
                         .stencil = TwoSidedStencil{up, down},
                         .colour_write = glm::bvec4(false)};
  row.draw(count, {.from = 0, .to = 4, .depth = 6});
  row.draw(count, {.from = 2, .to = 6, .depth = 6, .turned_over = true});
  row.draw(count, {.from = 0, .to = 8, .depth = 2});
  const std::array<std::uint32_t, 8> counted = {4, 4, 3, 3, 2, 2, 3, 3};
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_EQ(row.depth_stencil()[i].stencil & 0xffu, counted[i]) << "pixel " << i;
  EXPECT_THAT(row.red(), Each(0.0f));

  // Then what differs from 3 in its low bit is painted, and its high bit set.
  const StencilTest odd{.compare = Compare::not_equal,
                        .reference = 0xff,
                        .read_mask = 1,
                        .write_mask = 0x80,
                        .on_pass = StencilOp::replace};
  row.draw({.stencil = TwoSidedStencil{odd, odd}}, {});
  EXPECT_EQ(row.red(), (std::vector<float>{1, 1, 0, 0, 1, 1, 0, 0}));
  EXPECT_EQ(row.depth_stencil()[0].stencil & 0xffu, 0x84u);
  EXPECT_EQ(row.depth_stencil()[2].stencil & 0xffu, 3u);
  gpu_context().check();
}

TEST(FixedState, BlendsAndMasksColours) {
  struct Case {
    Blend blend;
    glm::vec4 expected;
  };
  const glm::uvec4 below(2, 8, 0, 8), above(4, 4, 4, 2);  // eighths
  for (const auto& [blend, expected] :
       {Case{Blend::replace, {0.5f, 0.5f, 0.5f, 0.25f}}, Case{Blend::add, {0.75f, 1.5f, 0.5f, 1.25f}},
        Case{Blend::multiply, {0.125f, 0.5f, 0.0f, 0.25f}}, Case{Blend::minimum, {0.25f, 0.5f, 0.0f, 0.25f}},
        Case{Blend::maximum, {0.5f, 1.0f, 0.5f, 1.0f}},
        Case{Blend::over, {0.3125f, 0.875f, 0.125f, 0.8125f}}}) {
    const Row row;
    row.draw({}, {}, below);
    row.draw({.blend = blend}, {}, above);
    EXPECT_EQ(row.first(), expected) << static_cast<int>(blend);
  }
  const Row row;
  row.draw({.colour_write = {true, false, true, false}}, {});
  EXPECT_EQ(row.first(), glm::vec4(1, 0, 1, 0));
}

TEST(FixedState, JoinsBitsOfIntegers) {
  for (const auto& [op, expected] :
       {std::pair{LogicOp::bit_and, 0b1000u}, std::pair{LogicOp::bit_or, 0b1110u},
        std::pair{LogicOp::bit_xor, 0b0110u}}) {
    const Row row(Format::r32ui);
    row.draw({}, {}, glm::uvec4(0b1100));
    row.draw({.logic_op = op}, {}, glm::uvec4(0b1010));
    EXPECT_EQ(row.first_bits(), expected);
  }
}

TEST(FixedState, IsThatOfANewContextAfterAnyDraw) {
  const Row row;
  const StencilTest test{.compare = Compare::equal,
                         .reference = 1,
                         .read_mask = 2,
                         .write_mask = 4,
                         .on_fail = StencilOp::zero,
                         .on_depth_fail = StencilOp::invert,
                         .on_pass = StencilOp::replace};
  const FixedState state{.depth_test = Compare::greater,
                         .depth_write = false,
                         .depth_clamp = true,
                         .upper_left_origin = true,
                         .zero_to_one_depth = true,
                         .cull = Cull::front,
                         .stencil = TwoSidedStencil{test, test},
                         .colour_write = glm::bvec4(false),
                         .blend = Blend::minimum,
                         .logic_op = LogicOp::bit_xor,
                         .patch_vertices = 5};
  const Pipeline pipeline = Pipeline::graphics({.vertex = k_rectangle_vert, .fragment = k_paint_frag}, state);
  EXPECT_THROW(pipeline.draw(row.target(), [] { throw std::runtime_error("a draw that fails"); }),
               std::runtime_error);
  for (GLenum capability :
       {GL_DEPTH_TEST, GL_DEPTH_CLAMP, GL_CULL_FACE, GL_STENCIL_TEST, GL_BLEND, GL_COLOR_LOGIC_OP})
    EXPECT_FALSE(glIsEnabled(capability)) << std::hex << capability;
  // The tables of the OpenGL 4.5 specification, 23.
  const std::vector<std::pair<GLenum, GLint>> initial = {{GL_DEPTH_FUNC, GL_LESS},
                                                         {GL_DEPTH_WRITEMASK, GL_TRUE},
                                                         {GL_CLIP_ORIGIN, GL_LOWER_LEFT},
                                                         {GL_CLIP_DEPTH_MODE, GL_NEGATIVE_ONE_TO_ONE},
                                                         {GL_CULL_FACE_MODE, GL_BACK},
                                                         {GL_STENCIL_FUNC, GL_ALWAYS},
                                                         {GL_STENCIL_BACK_FUNC, GL_ALWAYS},
                                                         {GL_STENCIL_REF, 0},
                                                         {GL_STENCIL_FAIL, GL_KEEP},
                                                         {GL_STENCIL_BACK_PASS_DEPTH_FAIL, GL_KEEP},
                                                         {GL_STENCIL_PASS_DEPTH_PASS, GL_KEEP},
                                                         {GL_BLEND_EQUATION_RGB, GL_FUNC_ADD},
                                                         {GL_BLEND_SRC_RGB, GL_ONE},
                                                         {GL_BLEND_DST_RGB, GL_ZERO},
                                                         {GL_LOGIC_OP_MODE, GL_COPY},
                                                         {GL_PATCH_VERTICES, 3},
                                                         {GL_CURRENT_PROGRAM, 0},
                                                         {GL_VERTEX_ARRAY_BINDING, 0},
                                                         {GL_DRAW_FRAMEBUFFER_BINDING, 0}};
  for (const auto& [name, expected] : initial) {
    GLint value = -1;
    glGetIntegerv(name, &value);
    EXPECT_EQ(value, expected) << std::hex << name;
  }
  GLint mask = 0;
  glGetIntegerv(GL_STENCIL_WRITEMASK, &mask);
  EXPECT_EQ(mask & 0xff, 0xff);
  glGetIntegerv(GL_STENCIL_VALUE_MASK, &mask);
  EXPECT_EQ(mask & 0xff, 0xff);
  std::array<GLboolean, 4> colour{};
  glGetBooleanv(GL_COLOR_WRITEMASK, colour.data());
  EXPECT_THAT(colour, Each(GL_TRUE));
  gpu_context().check();
}

TEST(Pipeline, DrawsThatWriteToMemoryAreSeenByLaterDispatches) {
  const Row row;
  const Buffer count(4);
  count.bind_storage(0);
  const Pipeline pipeline =
      Pipeline::graphics({.vertex = k_rectangle_vert, .fragment = k_count_fragments_frag});
  pipeline.set(0, glm::uvec4(1, 6, 0, 0));
  row.run(pipeline);
  EXPECT_EQ(count.read<std::uint32_t>().at(0), 5u);
  gpu_context().check();
}

}  // namespace
}  // namespace airlight::gpu
