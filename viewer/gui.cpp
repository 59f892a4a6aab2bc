#include "viewer/gui.h"

#include <algorithm>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "gpu/framebuffer.h"

namespace airlight::viewer {
namespace {

constexpr float k_font_size = 13.0f;  // of the built-in font, at which it is sharp

void make_font(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  ImFontConfig config;
  config.SizePixels = k_font_size * scale;
  io.Fonts->AddFontDefault(&config);
  io.FontGlobalScale = 1.0f / scale;
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void set_keys(ImGuiIO& io) {
  const std::pair<ImGuiKey, int> keys[] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                                           {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                           {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                           {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                           {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                           {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                                           {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                                           {ImGuiKey_Home, GLFW_KEY_HOME},
                                           {ImGuiKey_End, GLFW_KEY_END},
                                           {ImGuiKey_Insert, GLFW_KEY_INSERT},
                                           {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                           {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                           {ImGuiKey_Space, GLFW_KEY_SPACE},
                                           {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                           {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                           {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
                                           {ImGuiKey_A, GLFW_KEY_A},
                                           {ImGuiKey_C, GLFW_KEY_C},
                                           {ImGuiKey_V, GLFW_KEY_V},
                                           {ImGuiKey_X, GLFW_KEY_X},
                                           {ImGuiKey_Y, GLFW_KEY_Y},
                                           {ImGuiKey_Z, GLFW_KEY_Z}};
  for (const auto& [key, code] : keys) io.KeyMap[key] = code;
}

void take(ImGuiIO& io, const Event& event) {
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    if (key->key >= 0 && key->key < IM_ARRAYSIZE(io.KeysDown)) io.KeysDown[key->key] = key->is_down;
  } else if (const auto* character = std::get_if<CharacterEvent>(&event)) {
    io.AddInputCharacter(character->codepoint);
  } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
    if (button->button >= 0 && button->button < IM_ARRAYSIZE(io.MouseDown))
      io.MouseDown[button->button] = button->is_down;
  } else if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
    io.MousePos = {static_cast<float>(cursor->place.x), static_cast<float>(cursor->place.y)};
  } else if (const auto* scroll = std::get_if<ScrollEvent>(&event)) {
    io.MouseWheel += static_cast<float>(scroll->notches);
  } else if (const auto* focus = std::get_if<FocusEvent>(&event)) {
    io.AddFocusEvent(focus->has_focus);
    if (!focus->has_focus) std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
  }
  io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
  io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
  io.KeyAlt = io.KeysDown[GLFW_KEY_LEFT_ALT] || io.KeysDown[GLFW_KEY_RIGHT_ALT];
}

}  // namespace

Gui::Gui() : context_(ImGui::CreateContext()) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // where panels stand is not kept
  io.LogFilename = nullptr;
  set_keys(io);
  ImGui::StyleColorsDark();
  ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.86f;
  ImGui::GetStyle().WindowRounding = 4.0f;
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Gui::~Gui() {
  ImGui::SetCurrentContext(context_);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(context_);
}

void Gui::begin(std::span<const Event> events, glm::ivec2 size, glm::ivec2 pixels, double seconds) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(size.x), static_cast<float>(size.y)};
  const float scale = static_cast<float>(pixels.x) / static_cast<float>(std::max(size.x, 1));
  io.DisplayFramebufferScale = {scale,
                                static_cast<float>(pixels.y) / static_cast<float>(std::max(size.y, 1))};
  io.DeltaTime = static_cast<float>(std::max(seconds, 1e-4));
  if (scale != scale_) {
    ImGui_ImplOpenGL3_NewFrame();
    make_font(scale);
    scale_ = scale;
  }
  for (const Event& event : events) take(io, event);
  controls_.clear();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

void Gui::draw(const gpu::Texture& image) {
  ImGui::Render();
  const gpu::Framebuffer target({image});
  target.bind();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Gui::wants_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}
bool Gui::wants_keyboard() const {
  return ImGui::GetIO().WantTextInput;
}

void Gui::note(const std::string& name) {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  controls_[name] = {{from.x, from.y}, {to.x, to.y}};
}

}  // namespace airlight::viewer
