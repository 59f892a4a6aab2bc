#include "gpu/program.h"

#include <initializer_list>
#include <string>
#include <vector>

#include "scene/error.h"

#include <epoxy/gl.h>

namespace airlight::gpu {
namespace {

using scene::Error;
using scene::ExitCode;

struct Stage {
  GLenum type;
  std::span<const std::uint32_t> spirv;
};

template <typename GetLength, typename GetText>
std::string info_log(GLuint name, GetLength get_length, GetText get_text) {
  GLint length = 0;
  get_length(name, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(length), '\0');
  get_text(name, length, nullptr, text.data());
  return text.c_str();
}

GLuint link(std::initializer_list<Stage> stages, std::span<const Constant> constants) {
  std::vector<GLuint> ids, values;
  for (const Constant& constant : constants) {
    ids.push_back(constant.id);
    values.push_back(constant.bits);
  }
  const GLuint program = glCreateProgram();
  for (const Stage& stage : stages) {
    const GLuint shader = glCreateShader(stage.type);
    glShaderBinary(1, &shader, GL_SHADER_BINARY_FORMAT_SPIR_V_ARB, stage.spirv.data(),
                   static_cast<GLsizei>(stage.spirv.size_bytes()));
    glSpecializeShaderARB(shader, "main", static_cast<GLuint>(ids.size()), ids.data(), values.data());
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
      throw Error(ExitCode::driver, "shader", info_log(shader, glGetShaderiv, glGetShaderInfoLog));
    }
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) {
    throw Error(ExitCode::driver, "shader program", info_log(program, glGetProgramiv, glGetProgramInfoLog));
  }
  return program;
}

}  // namespace

void delete_program(unsigned name) {
  glDeleteProgram(name);
}

Program Program::compute(std::span<const std::uint32_t> spirv, std::span<const Constant> constants) {
  return Program(link({{GL_COMPUTE_SHADER, spirv}}, constants));
}

Program Program::graphics(std::span<const std::uint32_t> vertex, std::span<const std::uint32_t> fragment) {
  return Program(link({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}}, {}));
}

void Program::use() const {
  glUseProgram(handle_.get());
}

void Program::dispatch(glm::uvec3 invocations, glm::uvec3 group) const {
  use();
  const glm::uvec3 groups = (invocations + group - 1u) / group;
  glDispatchCompute(groups.x, groups.y, groups.z);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void Program::dispatch_indirect(const Buffer& groups, std::int64_t offset) const {
  use();
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, groups.name());
  glDispatchComputeIndirect(offset);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

}  // namespace airlight::gpu
