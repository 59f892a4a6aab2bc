#pragma once

#include <utility>

namespace airlight::gpu {

/// Sole owner of an OpenGL name; `Delete` gives it back. 0 owns nothing.
template <void (*Delete)(unsigned)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(unsigned name) : name_(name) {}
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Handle() {
    if (name_) Delete(name_);
  }
  unsigned get() const { return name_; }

 private:
  unsigned name_ = 0;
};

}  // namespace airlight::gpu
