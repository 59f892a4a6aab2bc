#include "viewer/window.h"

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "scene/error.h"

namespace airlight::viewer {

struct Window::State {
  GLFWwindow* window = nullptr;
  unsigned framebuffer = 0;  ///< to copy from
};

namespace {

EventQueue& queue_of(GLFWwindow* window) {
  return *static_cast<EventQueue*>(glfwGetWindowUserPointer(window));
}

void tell_size(GLFWwindow* window) {
  glm::ivec2 size, pixels;
  glfwGetWindowSize(window, &size.x, &size.y);
  glfwGetFramebufferSize(window, &pixels.x, &pixels.y);
  if (glfwGetWindowAttrib(window, GLFW_ICONIFIED)) size = pixels = glm::ivec2(0);
  queue_of(window).push(SizeEvent{size, pixels});
}

void listen(GLFWwindow* window) {
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
    if (action != GLFW_REPEAT) queue_of(w).push(KeyEvent{key, action == GLFW_PRESS});
  });
  glfwSetCharCallback(window,
                      [](GLFWwindow* w, unsigned codepoint) { queue_of(w).push(CharacterEvent{codepoint}); });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    queue_of(w).push(ButtonEvent{button, action == GLFW_PRESS});
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    queue_of(w).push(CursorEvent{{x, y}});
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) { queue_of(w).push(ScrollEvent{y}); });
  glfwSetWindowSizeCallback(window, [](GLFWwindow* w, int, int) { tell_size(w); });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { tell_size(w); });
  glfwSetWindowIconifyCallback(window, [](GLFWwindow* w, int) { tell_size(w); });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int has) { queue_of(w).push(FocusEvent{has != 0}); });
  glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { queue_of(w).push(CloseEvent{}); });
}

/// What GLFW says of its last call that failed.
std::string last_words() {
  const char* words = nullptr;
  glfwGetError(&words);
  return words ? words : "no reason given";
}

}  // namespace

Window::Window(const std::string& title, glm::ivec2 size) : state_(std::make_unique<State>()) {
  constexpr const char* k_remedy = "airlight render draws without a window";
  if (!glfwInit())
    throw scene::Error(scene::ExitCode::driver, "view", "there is no display: " + last_words(), k_remedy);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  state_->window = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
  if (!state_->window) {
    const std::string words = last_words();
    glfwTerminate();
    throw scene::Error(scene::ExitCode::driver, "view", "no window with OpenGL 4.5 can be had: " + words,
                       k_remedy);
  }
  glfwMakeContextCurrent(state_->window);
  glfwSwapInterval(1);
  glCreateFramebuffers(1, &state_->framebuffer);
  glfwSetWindowUserPointer(state_->window, &events_);
  listen(state_->window);
  tell_size(state_->window);
}

Window::~Window() {
  glDeleteFramebuffers(1, &state_->framebuffer);
  glfwDestroyWindow(state_->window);
  glfwTerminate();
}

void Window::wait(double seconds) {
  if (seconds > 0.0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
}

void Window::present(const gpu::Texture& image) {
  const glm::ivec2 size = image.size();
  glNamedFramebufferTexture(state_->framebuffer, GL_COLOR_ATTACHMENT0, image.name(), 0);
  glBlitNamedFramebuffer(state_->framebuffer, 0, 0, 0, size.x, size.y, 0, 0, size.x, size.y,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glfwSwapBuffers(state_->window);
}

double Window::seconds() {
  return glfwGetTime();
}

}  // namespace airlight::viewer
