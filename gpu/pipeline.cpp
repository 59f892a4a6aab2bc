#include "gpu/pipeline.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "gpu/replaced_shaders.h"
#include "gpu/spirv.h"
#include "scene/error.h"

#include <epoxy/gl.h>

namespace airlight::gpu {
namespace {

using scene::Error;
using scene::ExitCode;

void delete_shader(unsigned name) {
  glDeleteShader(name);
}
using ShaderHandle = Handle<delete_shader>;

struct Stage {
  Stage(GLenum of_type, std::span<const std::uint32_t> embedded)
      : type(of_type), words(current_words(embedded)), module(read_spirv(words)) {}
  GLenum type;
  std::span<const std::uint32_t> words;
  SpirvModule module;
};

bool declares(const SpirvModule& module, const Constant& constant) {
  return std::find(module.constant_ids.begin(), module.constant_ids.end(), constant.id) !=
         module.constant_ids.end();
}

/// Whether a shader may write to memory by itself, which later commands do not wait for.
bool writes_memory(const SpirvModule& module) {
  return std::any_of(module.resources.begin(), module.resources.end(),
                     [](const SpirvResource& resource) { return resource.is_written; });
}

template <typename GetLength, typename GetText>
std::string info_log(GLuint name, GetLength get_length, GetText get_text) {
  GLint length = 0;
  get_length(name, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(length), '\0');
  get_text(name, length, nullptr, text.data());
  return text.c_str();
}

ShaderHandle specialise(const Stage& stage, std::span<const Constant> constants) {
  // A constant that the module does not declare would be an error of OpenGL's.
  std::vector<GLuint> ids, values;
  for (const Constant& constant : constants) {
    if (!declares(stage.module, constant)) continue;
    ids.push_back(constant.id);
    values.push_back(constant.bits);
  }
  ShaderHandle shader(glCreateShader(stage.type));
  const GLuint name = shader.get();
  glShaderBinary(1, &name, GL_SHADER_BINARY_FORMAT_SPIR_V_ARB, stage.words.data(),
                 static_cast<GLsizei>(stage.words.size_bytes()));
  glSpecializeShaderARB(name, "main", static_cast<GLuint>(ids.size()), ids.data(), values.data());
  GLint compiled = GL_FALSE;
  glGetShaderiv(name, GL_COMPILE_STATUS, &compiled);
  if (!compiled) throw Error(ExitCode::driver, "shader", info_log(name, glGetShaderiv, glGetShaderInfoLog));
  return shader;
}

Handle<delete_program> link(std::span<const Stage> stages, std::span<const Constant> constants) {
  for ([[maybe_unused]] const Constant& constant : constants) {
    assert(std::any_of(stages.begin(), stages.end(),
                       [&](const Stage& stage) { return declares(stage.module, constant); }));
  }
  Handle<delete_program> program(glCreateProgram());
  const GLuint name = program.get();
  // Shaders that are attached live as long as the program.
  for (const Stage& stage : stages) glAttachShader(name, specialise(stage, constants).get());
  glLinkProgram(name);
  GLint linked = GL_FALSE;
  glGetProgramiv(name, GL_LINK_STATUS, &linked);
  if (!linked)
    throw Error(ExitCode::driver, "shader program", info_log(name, glGetProgramiv, glGetProgramInfoLog));
  return program;
}

void enable(GLenum capability, bool on) {
  if (on) {
    glEnable(capability);
  } else {
    glDisable(capability);
  }
}

GLenum gl(Compare compare) {
  return GL_NEVER + static_cast<GLenum>(compare);
}

GLenum gl(StencilOp op) {
  constexpr std::array<GLenum, 6> k_ops = {GL_KEEP,      GL_ZERO,      GL_REPLACE,
                                           GL_INCR_WRAP, GL_DECR_WRAP, GL_INVERT};
  return k_ops[static_cast<std::size_t>(op)];
}

GLenum gl(LogicOp op) {
  constexpr std::array<GLenum, 3> k_ops = {GL_AND, GL_OR, GL_XOR};
  return k_ops[static_cast<std::size_t>(op)];
}

void apply(Blend blend) {
  struct Equation {
    GLenum operation, of_source, of_destination;
  };
  constexpr std::array<Equation, 6> k_equations = {{{GL_FUNC_ADD, GL_ONE, GL_ZERO},
                                                    {GL_FUNC_ADD, GL_ONE, GL_ONE},
                                                    {GL_FUNC_ADD, GL_DST_COLOR, GL_ZERO},
                                                    {GL_MIN, GL_ONE, GL_ONE},
                                                    {GL_MAX, GL_ONE, GL_ONE},
                                                    {GL_FUNC_ADD, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA}}};
  const Equation& equation = k_equations[static_cast<std::size_t>(blend)];
  enable(GL_BLEND, blend != Blend::replace);
  glBlendEquation(equation.operation);
  glBlendFunc(equation.of_source, equation.of_destination);
}

void apply(GLenum face, const StencilTest& test) {
  glStencilFuncSeparate(face, gl(test.compare), test.reference, test.read_mask);
  glStencilOpSeparate(face, gl(test.on_fail), gl(test.on_depth_fail), gl(test.on_pass));
  glStencilMaskSeparate(face, test.write_mask);
}

void apply(const FixedState& state) {
  enable(GL_DEPTH_TEST, state.depth_test.has_value());
  glDepthFunc(gl(state.depth_test.value_or(Compare::less)));
  glDepthMask(state.depth_write ? GL_TRUE : GL_FALSE);
  enable(GL_DEPTH_CLAMP, state.depth_clamp);
  glClipControl(state.upper_left_origin ? GL_UPPER_LEFT : GL_LOWER_LEFT,
                state.zero_to_one_depth ? GL_ZERO_TO_ONE : GL_NEGATIVE_ONE_TO_ONE);
  enable(GL_CULL_FACE, state.cull != Cull::none);
  glCullFace(state.cull == Cull::front ? GL_FRONT : GL_BACK);
  const TwoSidedStencil stencil = state.stencil.value_or(TwoSidedStencil{});
  enable(GL_STENCIL_TEST, state.stencil.has_value());
  apply(GL_FRONT, stencil.front);
  apply(GL_BACK, stencil.back);
  const glm::bvec4 write = state.colour_write;
  glColorMask(write.r, write.g, write.b, write.a);
  apply(state.blend);
  enable(GL_COLOR_LOGIC_OP, state.logic_op.has_value());
  glLogicOp(state.logic_op ? gl(*state.logic_op) : GL_COPY);
  glPatchParameteri(GL_PATCH_VERTICES, state.patch_vertices);
}

}  // namespace

void delete_program(unsigned name) {
  glDeleteProgram(name);
}

Pipeline Pipeline::compute(std::span<const std::uint32_t> spirv, std::span<const Constant> constants) {
  const Stage stage(GL_COMPUTE_SHADER, spirv);
  Pipeline pipeline;
  pipeline.handle_ = link(std::span(&stage, 1), constants);
  std::array<GLint, 3> group{};
  glGetProgramiv(pipeline.handle_.get(), GL_COMPUTE_WORK_GROUP_SIZE, group.data());
  pipeline.work_group_ = {group[0], group[1], group[2]};
  pipeline.max_work_groups_ = max_work_groups();
  return pipeline;
}

Pipeline Pipeline::graphics(const GraphicsStages& stages, const FixedState& state,
                            std::span<const Constant> constants) {
  const std::array<std::pair<GLenum, std::span<const std::uint32_t>>, 5> all = {
      {{GL_VERTEX_SHADER, stages.vertex},
       {GL_TESS_CONTROL_SHADER, stages.tessellation_control},
       {GL_TESS_EVALUATION_SHADER, stages.tessellation_evaluation},
       {GL_GEOMETRY_SHADER, stages.geometry},
       {GL_FRAGMENT_SHADER, stages.fragment}}};
  std::vector<Stage> present;
  for (const auto& [type, words] : all)
    if (!words.empty()) present.emplace_back(type, words);
  Pipeline pipeline;
  pipeline.handle_ = link(present, constants);
  pipeline.state_ = state;
  pipeline.writes_memory_ = std::any_of(present.begin(), present.end(),
                                        [](const Stage& stage) { return writes_memory(stage.module); });
  return pipeline;
}

void Pipeline::set(int location, int value) const {
  glProgramUniform1i(handle_.get(), location, value);
}

void Pipeline::set(int location, std::uint32_t value) const {
  glProgramUniform1ui(handle_.get(), location, value);
}

void Pipeline::set(int location, float value) const {
  glProgramUniform1f(handle_.get(), location, value);
}

void Pipeline::set(int location, glm::uvec2 value) const {
  glProgramUniform2ui(handle_.get(), location, value.x, value.y);
}

void Pipeline::set(int location, glm::uvec3 value) const {
  glProgramUniform3ui(handle_.get(), location, value.x, value.y, value.z);
}

void Pipeline::set(int location, glm::uvec4 value) const {
  glProgramUniform4ui(handle_.get(), location, value.x, value.y, value.z, value.w);
}

void Pipeline::set(int location, glm::vec3 value) const {
  glProgramUniform3f(handle_.get(), location, value.x, value.y, value.z);
}

void Pipeline::dispatch(glm::uvec3 invocations) const {
  const glm::uvec3 groups =
      invocations / work_group_ + glm::uvec3(glm::notEqual(invocations % work_group_, glm::uvec3(0)));
  require_work_groups(max_work_groups_, groups);
  glUseProgram(handle_.get());
  glDispatchCompute(groups.x, groups.y, groups.z);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void Pipeline::dispatch_indirect(const Buffer& groups, std::int64_t offset) const {
  glUseProgram(handle_.get());
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, groups.name());
  glDispatchComputeIndirect(offset);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

Pipeline::Pass::Pass(const Pipeline& pipeline, const Framebuffer& target) : pipeline_(pipeline) {
  target.bind();
  apply(pipeline.state_);
  glUseProgram(pipeline.handle_.get());
}

Pipeline::Pass::~Pass() {
  if (pipeline_.writes_memory_) glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glUseProgram(0);
  glBindVertexArray(0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  apply(FixedState{});
}

}  // namespace airlight::gpu
