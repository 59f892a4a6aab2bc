#include "gpu/timer.h"

#include <cassert>
#include <cstdint>

#include <epoxy/gl.h>

namespace airlight::gpu {

void delete_query(unsigned name) {
  glDeleteQueries(1, &name);
}

StageClock stage_clock(const Device& device) {
  return device.is_software ? StageClock::wall : StageClock::gpu;
}

StageTimer::StageTimer(Context* context) : context_(context) {
  if (context) clock_ = stage_clock(context->device());
}

void StageTimer::begin(const std::string& name) {
  if (!context_) return;
  running_.push_back(name);
  mark();
}

void StageTimer::end() {
  if (!context_) return;
  running_.pop_back();
  mark();
}

void StageTimer::mark() {
  Mark mark{.stage = running_.empty() ? "" : running_.back(), .part = part_, .wall = {}, .query = {}};
  if (clock_ == StageClock::wall) {
    context_->finish();
    mark.wall = Clock::now();
  } else {
    GLuint name = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &name);
    mark.query = Handle<delete_query>(name);
    glQueryCounter(name, GL_TIMESTAMP);
    glFlush();  // so that an idle GPU takes it now, and what the CPU does until the next one counts
  }
  marks_.push_back(std::move(mark));
}

double StageTimer::milliseconds_between(const Mark& from, const Mark& to) const {
  if (clock_ == StageClock::wall)
    return std::chrono::duration<double, std::milli>(to.wall - from.wall).count();
  GLuint64 start = 0, end = 0;  // [ns]
  glGetQueryObjectui64v(from.query.get(), GL_QUERY_RESULT, &start);
  glGetQueryObjectui64v(to.query.get(), GL_QUERY_RESULT, &end);
  return static_cast<double>(static_cast<std::int64_t>(end - start)) * 1e-6;
}

std::map<std::string, double> StageTimer::milliseconds(std::optional<std::size_t> part) const {
  assert(running_.empty());
  std::map<std::string, double> milliseconds;
  for (std::size_t i = 0; i + 1 < marks_.size(); ++i) {
    if (!marks_[i].stage.empty() && (!part || marks_[i].part == part))
      milliseconds[marks_[i].stage] += milliseconds_between(marks_[i], marks_[i + 1]);
  }
  return milliseconds;
}

}  // namespace airlight::gpu
