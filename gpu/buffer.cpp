#include "gpu/buffer.h"

#include <algorithm>

#include <fmt/format.h>

#include "scene/error.h"

#include <epoxy/gl.h>

namespace airlight::gpu {

void delete_buffer(unsigned name) {
  glDeleteBuffers(1, &name);
}
void delete_vertex_array(unsigned name) {
  glDeleteVertexArrays(1, &name);
}

void require_allocated(std::int64_t bytes) {
  if (glGetError() != GL_OUT_OF_MEMORY) return;
  throw scene::Error(scene::ExitCode::driver, "graphics memory",
                     fmt::format("the driver has no {:.0f} MiB left", static_cast<double>(bytes) / 0x100000),
                     "ask for less");
}

Buffer::Buffer(std::int64_t bytes, const void* data) : bytes_(bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  handle_ = Handle<delete_buffer>(name);
  glNamedBufferStorage(name, std::max<GLsizeiptr>(bytes, 4), bytes > 0 ? data : nullptr,
                       GL_DYNAMIC_STORAGE_BIT);
  require_allocated(bytes);
  if (!data) clear();
}

void Buffer::bind_storage(unsigned binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name());
}

void Buffer::bind_storage(unsigned binding, std::int64_t offset, std::int64_t bytes) const {
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, name(), offset, bytes);
}

void Buffer::bind_uniform(unsigned binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, name());
}

void Buffer::write(const void* data, std::int64_t bytes) const {
  glNamedBufferSubData(name(), 0, bytes, data);
}

void Buffer::clear(std::uint32_t word) const {
  glClearNamedBufferData(name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

void Buffer::read_bytes(std::int64_t offset, std::int64_t bytes, void* destination) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(name(), offset, bytes, destination);
}

}  // namespace airlight::gpu
