// The panels: controls made from the table of a view's fields and from the methods' descriptors.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "frame/option.h"
#include "scene/error.h"
#include "scene/view_fields.h"
#include "viewer/cameras.h"
#include "viewer/viewer.h"

namespace airlight::viewer {
namespace {

ImTextureID texture_id(const gpu::Texture& texture) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.name()));
}

ImVec2 point(glm::dvec2 place) {
  return {static_cast<float>(place.x), static_cast<float>(place.y)};
}

void help_mark(const std::string& text) {
  ImGui::SameLine();
  ImGui::TextDisabled("(?)");
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(30.0f * ImGui::GetFontSize());
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// How fast dragging changes a number of a field [1/point].
float drag_speed(const scene::FieldInfo& field, double value) {
  const double width = field.range.upper - field.range.lower;
  if (std::isfinite(width) && width < 1000.0) return static_cast<float>(width / 400.0);
  return static_cast<float>(std::max(0.01 * std::abs(value), 1e-3));
}

/// A control for a field's value. @returns whether it has been changed
/// @param note the name that it is noted by
bool edit_value(Gui& gui, const std::string& note, const scene::FieldInfo& field, scene::FieldValue& value,
                const char* label) {
  const auto drag = [&](double* numbers, int count) {
    double largest = 0.0;
    for (int i = 0; i < count; ++i) largest = std::max(largest, std::abs(numbers[i]));
    return ImGui::DragScalarN(label, ImGuiDataType_Double, numbers, count, drag_speed(field, largest),
                              nullptr, nullptr, "%.5g");
  };
  if (auto* number = std::get_if<double>(&value)) return drag(number, 1);
  if (auto* pair = std::get_if<glm::dvec2>(&value)) return drag(&pair->x, 2);
  if (auto* vector = std::get_if<glm::dvec3>(&value)) return drag(&vector->x, 3);
  if (auto* word = std::get_if<std::string>(&value)) {
    bool is_changed = false;
    if (!ImGui::BeginCombo(label, word->c_str())) return false;
    for (const std::string_view other : field.words) {
      if (ImGui::Selectable(std::string(other).c_str(), *word == other)) {
        *word = other;
        is_changed = true;
      }
      gui.note(fmt::format("{}={}", note, other));
    }
    ImGui::EndCombo();
    return is_changed;
  }
  ImGui::LabelText(label, "%s", scene::text_of(value).c_str());
  return false;
}

/// Colours of a profile's stages, far apart in hue.
ImU32 stage_colour(std::size_t i) {
  const float hue = static_cast<float>(std::fmod(0.618 * static_cast<double>(i) + 0.55, 1.0));
  float r = 0, g = 0, b = 0;
  ImGui::ColorConvertHSVtoRGB(hue, 0.55f, 0.9f, r, g, b);
  return ImGui::GetColorU32(ImVec4(r, g, b, 1.0f));
}

/// The sun's direction at an hour of an equinox at 45° north, +Z towards the south and +X towards the east.
glm::dvec3 sun_at(double hour) {
  const double turn = (hour - 12.0) / 12.0 * std::numbers::pi, latitude = 0.25 * std::numbers::pi;
  return {-std::sin(turn), std::cos(latitude) * std::cos(turn), std::sin(latitude) * std::cos(turn)};
}

double hour_of(glm::dvec3 towards) {
  return 12.0 - std::atan2(towards.x, std::hypot(towards.y, towards.z)) / std::numbers::pi * 12.0;
}

}  // namespace

template <typename Thing>
void Viewer::edit_fields(Thing& thing, const std::string& prefix) {
  for (const scene::Field<Thing>& field : scene::fields<Thing>()) {
    const std::string name(field.name);
    if (field.lack && field.lack(thing)) continue;
    std::optional<scene::FieldValue> value = field.get(thing);
    const std::string label = fmt::format("{}##{}{}", name, prefix, name);
    if (!value) {
      // A field that may be without: a button gives it one.
      if (field.kind == scene::FieldKind::file) continue;
      if (ImGui::SmallButton(fmt::format("give {}##{}", name, prefix).c_str())) {
        const scene::FieldValue first = field.kind == scene::FieldKind::vector
                                            ? scene::FieldValue(shown_.view.camera.target)
                                            : scene::FieldValue(std::max(0.25 * scene_size_, 1.0));
        if (const auto wrong = field.set(thing, first)) say(fmt::format("{}: {}", name, wrong->problem));
      }
      gui_.note(prefix + name);
      help_mark(field.help());
      continue;
    }
    if (edit_value(gui_, prefix + name, field, *value, label.c_str()))
      if (const auto wrong = field.set(thing, *value)) say(fmt::format("{}: {}", name, wrong->problem));
    gui_.note(prefix + name);
    help_mark(field.help());
  }
}

template <typename MethodType>
void Viewer::edit_method(quality::Choice<MethodType>& choice, std::span<const MethodType> methods,
                         const char* label, const std::string& prefix) {
  if (ImGui::BeginCombo(fmt::format("{}##{}", label, prefix).c_str(),
                        std::string(choice.method->name).c_str())) {
    for (const MethodType& method : methods) {
      if (!method.traits.runs_on_gpu) continue;
      if (ImGui::Selectable(std::string(method.name).c_str(), choice.method == &method))
        choice = {std::string(method.name), &method, method.defaults};
      gui_.note(fmt::format("{}={}", prefix, method.name));
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(method.description).c_str());
    }
    ImGui::EndCombo();
  }
  gui_.note(prefix);
  help_mark(std::string(choice.method->description));
  if (choice.method->options.empty() ||
      !ImGui::TreeNode(fmt::format("options of {}##{}", choice.method->name, prefix).c_str())) {
    gui_.note(prefix + "-options");
    return;
  }
  gui_.note(prefix + "-options");
  for (const frame::Option& option : choice.method->options) {
    const std::string name(option.text.name);
    const std::string id = fmt::format("{}##{}{}", name, prefix, name);
    const frame::OptionValue value = option.get(choice.method->const_address(choice.options));
    std::optional<std::string> chosen;
    if (const auto* words = std::get_if<frame::Words>(&option.values)) {
      if (ImGui::BeginCombo(id.c_str(), frame::text_of(value).c_str())) {
        for (const frame::Word& word : *words) {
          const std::string text(word.word);
          if (ImGui::Selectable(text.c_str(), text == frame::text_of(value))) chosen = text;
          gui_.note(fmt::format("{}{}={}", prefix, name, text));
          if (ImGui::IsItemHovered() && !word.meaning.empty())
            ImGui::SetTooltip("%s", std::string(word.meaning).c_str());
        }
        ImGui::EndCombo();
      }
      gui_.note(prefix + name);
    } else {
      const auto& counts = std::get<frame::Counts>(option.values);
      std::string text = frame::text_of(value);
      // Typed, and taken when done; with − and + by what it counts in.
      if (ImGui::InputText(id.c_str(), &text, ImGuiInputTextFlags_EnterReturnsTrue)) chosen = text;
      gui_.note(prefix + name);
      if (const int* count = std::get_if<int>(&value)) {
        const int step = counts.multiple_of;
        ImGui::SameLine();
        if (ImGui::SmallButton(fmt::format("/2##{}", id).c_str()))
          chosen = fmt::format("{}", std::max(*count / 2 / step * step, std::max(counts.least, step)));
        gui_.note(prefix + name + "/2");
        ImGui::SameLine();
        if (ImGui::SmallButton(fmt::format("x2##{}", id).c_str()))
          chosen = fmt::format("{}", std::min(*count * 2, counts.most / step * step));
        gui_.note(prefix + name + "x2");
      }
    }
    if (chosen) {
      try {
        choice = choice.with(option, *chosen);
      } catch (const scene::Error& error) {
        say(error.what());
      }
    }
    help_mark(frame::help_text(option, choice.method->const_address(choice.method->defaults)));
  }
  ImGui::TreePop();
}

void Viewer::draw_panels() {
  ImGui::SetNextWindowPos({8.0f, 8.0f}, ImGuiCond_Once);
  ImGui::SetNextWindowSize({330.0f, std::min(static_cast<float>(window_.y) - 48.0f, 760.0f)}, ImGuiCond_Once);
  const std::string title = fmt::format("{}###Airlight", name_.spec);
  if (ImGui::Begin(title.c_str())) {
    ImGui::PushItemWidth(-110.0f);
    const auto section = [&](const char* name, bool is_open, void (Viewer::*panel)()) {
      const bool shows = ImGui::CollapsingHeader(name, is_open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
      gui_.note(name);
      if (shows) (this->*panel)();
    };
    section("Methods", true, &Viewer::method_panel);
    section("Beside", true, &Viewer::beside_panel);
    section("Lights", false, &Viewer::light_panel);
    section("Fog", false, &Viewer::medium_panel);
    section("Camera", false, &Viewer::camera_panel);
    section("Path", false, &Viewer::path_panel);
    section("Picture", true, &Viewer::picture_panel);
    ImGui::PopItemWidth();
  }
  ImGui::End();
  if (has_help_) help_panel();
  if (has_profiler_) profiler();
  if (has_slice_) slice_panel();
}

void Viewer::slice_panel() {
  ImGui::SetNextWindowPos({360.0f, static_cast<float>(window_.y) - 330.0f}, ImGuiCond_Once);
  ImGui::SetNextWindowSize({540.0f, 300.0f}, ImGuiCond_Once);
  if (ImGui::Begin("Slice", &has_slice_) && slice_.size().x > 0) {
    const ImVec2 room = ImGui::GetContentRegionAvail();
    ImGui::Image(texture_id(slice_), {room.x, std::max(room.y - 24.0f, 16.0f)});
    ImGui::TextUnformatted(slice_caption_.c_str());
  }
  ImGui::End();
}

void Viewer::method_panel() {
  edit_method(shown_.volume, quality::volume_methods(), "airlight", "volume");
  edit_method(shown_.surface, quality::surface_methods(), "surface", "surface");
  int side = shown_.shadow_map;
  if (ImGui::InputInt("shadow map", &side, 256, 1024, ImGuiInputTextFlags_EnterReturnsTrue))
    shown_.shadow_map = std::clamp(side, 1, context_.limits().max_texture_size);
  gui_.note("shadow-map");
}

void Viewer::beside_panel() {
  int beside = static_cast<int>(beside_);
  const char* names[] = {"nothing", "a method", "the truth"};
  for (int i = 0; i < 3; ++i) {
    if (i > 0) ImGui::SameLine();
    ImGui::RadioButton(names[i], &beside, i);
    gui_.note(fmt::format("beside={}", names[i]));
  }
  set_beside(static_cast<Beside>(beside), layout_);
  if (beside_ == Beside::nothing) return;
  int layout = static_cast<int>(layout_);
  const char* layouts[] = {"left", "both", "difference"};
  for (int i = 0; i < 3; ++i) {
    if (i > 0) ImGui::SameLine();
    ImGui::RadioButton(layouts[i], &layout, i);
    gui_.note(fmt::format("layout={}", layouts[i]));
  }
  set_beside(beside_, static_cast<Layout>(layout));
  if (layout_ == Layout::difference) {
    ImGui::SliderFloat("full colour", &difference_scale_, 1e-3f, 1.0f, "%.3f of white",
                       ImGuiSliderFlags_Logarithmic);
    gui_.note("difference-scale");
  }
  if (beside_ == Beside::method) {
    edit_method(right_volume_, quality::volume_methods(), "airlight", "right");
  } else if (truth_error_) {
    ImGui::Text("error of the picture: %.3g %%", 100.0 * *truth_error_);
  } else if (truth_image_) {
    ImGui::Text("traced at %dx%d", truth_image_->size.x, truth_image_->size.y);
  }
  if (beside_ == Beside::truth && truth_.is_tracing())
    ImGui::ProgressBar(static_cast<float>(truth_.fraction()), {-1.0f, 0.0f});
}

void Viewer::camera_panel() {
  edit_fields(shown_.view.camera, "camera-");
  if (scene_.cameras.size() > 1) {
    if (ImGui::BeginCombo("of the scene", "choose")) {
      for (const scene::Camera& camera : scene_.cameras)
        if (ImGui::Selectable(camera.name.c_str())) shown_.view.camera = camera;
      ImGui::EndCombo();
    }
    gui_.note("camera-of-scene");
  }
  ImGui::Text("flying at %.3g m/s", speed_);
}

void Viewer::light_panel() {
  std::vector<scene::Light>& lights = shown_.view.lights;
  std::optional<std::size_t> off, on;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const std::string prefix = fmt::format("light{}-", i);
    bool is_on = true;
    if (ImGui::Checkbox("##on", &is_on)) off = i;
    gui_.note(prefix + "on");
    ImGui::SameLine();
    const bool shows = ImGui::TreeNodeEx(
        fmt::format("{}###light", lights[i].name.empty() ? fmt::format("{}", i) : lights[i].name).c_str(),
        lights.size() == 1 ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    gui_.note(prefix + "open");
    if (shows) {
      scene::Light& light = lights[i];
      if (scene::is_sun(light)) {
        float hour = static_cast<float>(hour_of(light.towards));
        if (ImGui::SliderFloat("time of day", &hour, 6.1f, 17.9f, "%.2f h"))
          light.towards = sun_at(static_cast<double>(hour));
        gui_.note(prefix + "hour");
      }
      // Which kind of light it is, is not for a field to change.
      edit_fields(light, prefix);
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  for (std::size_t i = 0; i < off_lights_.size(); ++i) {
    ImGui::PushID(static_cast<int>(1000 + i));
    bool is_on = false;
    if (ImGui::Checkbox(off_lights_[i].name.c_str(), &is_on)) on = i;
    gui_.note(fmt::format("off-light{}", i));
    ImGui::PopID();
  }
  if (off) {
    if (lights.size() > 1) {
      off_lights_.push_back(lights[*off]);
      lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(*off));
    } else {
      say("one light has to be on");
    }
  }
  if (on) {
    lights.push_back(off_lights_[*on]);
    off_lights_.erase(off_lights_.begin() + static_cast<std::ptrdiff_t>(*on));
  }
  const auto add = [&](scene::Light light) {
    light.name = fmt::format("added {}", lights.size() + off_lights_.size());
    lights.push_back(std::move(light));
  };
  if (ImGui::SmallButton("add a lamp")) {
    const scene::Camera& camera = shown_.view.camera;
    const double to_target = glm::distance(camera.eye, camera.target);
    add(scene::point_light("", camera.eye + 0.7 * (camera.target - camera.eye),
                           glm::vec3(static_cast<float>(to_target * to_target))));
  }
  gui_.note("add-lamp");
  ImGui::SameLine();
  if (ImGui::SmallButton("add a sun")) add(scene::sun("", sun_at(15.0), glm::vec3(10.0f)));
  gui_.note("add-sun");
  ImGui::SameLine();
  ImGui::TextDisabled("(drag them)");
}

void Viewer::medium_panel() {
  float density = static_cast<float>(shown_.view.medium.sigma_s.x);
  if (ImGui::SliderFloat("density", &density, 1e-3f, 2.0f, "%.4f 1/m", ImGuiSliderFlags_Logarithmic)) {
    glm::vec3& sigma_s = shown_.view.medium.sigma_s;
    sigma_s = sigma_s.x > 0.0f ? sigma_s * (density / sigma_s.x) : glm::vec3(density);
  }
  gui_.note("density");
  edit_fields(shown_.view.medium, "medium-");
  if (shown_.view.medium.top) {
    if (ImGui::SmallButton("no top")) shown_.view.medium.top.reset();
    gui_.note("no-top");
  }
}

void Viewer::path_panel() {
  if (path_) {
    if (ImGui::Button(is_playing_ ? "pause" : "play")) is_playing_ = !is_playing_;
    gui_.note("play");
    ImGui::SameLine();
    float time = static_cast<float>(path_seconds_);
    if (ImGui::SliderFloat("##time", &time, 0.0f, static_cast<float>(path_->seconds), "%.2f s")) {
      is_playing_ = false;
      set_path_time(static_cast<double>(time));
    }
    gui_.note("path-time");
  }
  if (ImGui::Button("key here")) record_key();
  gui_.note("key");
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::SmallButton("go")) show_moment(keys_[i].camera, keys_[i].lights);
    gui_.note(fmt::format("key{}-go", i));
    ImGui::SameLine();
    const bool is_removed = ImGui::SmallButton("x");
    gui_.note(fmt::format("key{}-x", i));
    ImGui::SameLine();
    const double least = i == 0 ? 0.0 : keys_[i - 1].time + 0.1;
    ImGui::DragScalar("##key", ImGuiDataType_Double, &keys_[i].time, 0.05f, &least, nullptr, "%.2f s");
    keys_[i].time = i == 0 ? 0.0 : std::max(keys_[i].time, least);
    ImGui::PopID();
    if (is_removed) {
      keys_.erase(keys_.begin() + static_cast<std::ptrdiff_t>(i));
      if (!keys_.empty()) keys_[0].time = 0.0;
      break;
    }
  }
  if (keys_.size() > 1) {
    if (ImGui::Button("save path")) save_path();
    gui_.note("save-path");
  }
}

void Viewer::picture_panel() {
  bool is_automatic = !shown_.exposure;
  if (ImGui::Checkbox("automatic exposure", &is_automatic)) {
    if (is_automatic)
      shown_.exposure.reset();
    else
      shown_.exposure = automatic_exposure_;
  }
  gui_.note("automatic-exposure");
  if (shown_.exposure) {
    ImGui::SliderFloat("exposure", &*shown_.exposure, 1e-3f, 1e3f, "%.4g", ImGuiSliderFlags_Logarithmic);
    gui_.note("exposure");
  }
  const auto names = scene::tone_map_names();
  if (ImGui::BeginCombo("tone map", scene::tone_map_name(shown_.tone_map).c_str())) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (ImGui::Selectable(std::string(names[i]).c_str())) shown_.tone_map = static_cast<scene::ToneMap>(i);
      gui_.note(fmt::format("tone-map={}", names[i]));
    }
    ImGui::EndCombo();
  }
  gui_.note("tone-map");
  edit_fields(shown_.view.surroundings, "surroundings-");
  if (ImGui::Button("copy as command")) {
    ImGui::SetClipboardText(command().c_str());
    say("copied: " + command());
  }
  gui_.note("copy");
  ImGui::SameLine();
  if (ImGui::Button("save shot")) save_shot();
  gui_.note("save-shot");
  if (ImGui::Button("save picture")) save_picture();
  gui_.note("save-picture");
  ImGui::SameLine();
  ImGui::Checkbox("epipolar lines", &has_epipolar_lines_);
  gui_.note("epipolar-lines");
  const std::string over = inspected_.empty() ? "nothing" : inspected_;
  if (ImGui::BeginCombo("over it", over.c_str())) {
    if (ImGui::Selectable("nothing")) inspected_.clear();
    // What a method has to show is known when it has been asked.
    if (inspections_ || (left_.is_ready(0) && is_settled_)) {
      for (const frame::DebugImage& image : inspections()) {
        if (ImGui::Selectable(image.name.c_str())) inspected_ = image.name;
        gui_.note("over=" + image.name);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", image.caption.c_str());
      }
    }
    if (ImGui::Selectable(k_undecided)) inspected_ = k_undecided;
    gui_.note(std::string("over=") + k_undecided);
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip(
          "where surfaces are wrongly lit or dark, red, and where rounding decides, yellow: judged by the "
          "truth");
    ImGui::EndCombo();
  }
  gui_.note("over");
  ImGui::Checkbox("slice under the cursor", &has_slice_);
  gui_.note("slice");
  ImGui::TextDisabled("F1 keys  F2 panels  P profiler");
}

void Viewer::help_panel() {
  ImGui::SetNextWindowPos({360.0f, 40.0f}, ImGuiCond_Once);
  if (ImGui::Begin("Keys", &has_help_, ImGuiWindowFlags_AlwaysAutoResize)) {
    constexpr const char* k_keys[][2] = {{"drag left", "look around; a light, the divider: move it"},
                                         {"drag right, middle", "turn about the target"},
                                         {"Shift + middle", "move across the view"},
                                         {"wheel", "nearer, farther; of a light that is dragged, too"},
                                         {"Shift + drag a spot", "along its shaft"},
                                         {"W A S D Q E", "fly; Shift: four times as fast"},
                                         {"Home", "back to the first view"},
                                         {"Z", "magnifier, while held"},
                                         {"Space", "play and pause the path"},
                                         {"K", "a key of a path: camera and lights as they are"},
                                         {"O", "epipolar lines"},
                                         {"P", "profiler"},
                                         {"F2", "panels"},
                                         {"F5", "reload shaders whose sources have changed"},
                                         {"F12", "save the picture"},
                                         {"Ctrl + S", "save the shot"},
                                         {"Esc, Ctrl + Q", "close"}};
    for (const auto& [key, meaning] : k_keys) {
      ImGui::TextUnformatted(key);
      ImGui::SameLine(170.0f);
      ImGui::TextUnformatted(meaning);
    }
  }
  ImGui::End();
}

void Viewer::profiler() {
  ImGui::SetNextWindowPos({static_cast<float>(window_.x) - 420.0f, 8.0f}, ImGuiCond_Once);
  ImGui::SetNextWindowSize({410.0f, 260.0f}, ImGuiCond_Once);
  if (ImGui::Begin("Profiler", &has_profiler_)) {
    std::set<std::string> names;
    double longest = 1.0;
    for (const std::map<std::string, double>& stages : history_) {
      double sum = 0.0;
      for (const auto& [name, ms] : stages) {
        names.insert(name);
        sum += ms;
      }
      longest = std::max(longest, sum);
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = 110.0f;
    list.AddRectFilled(from, {from.x + width, from.y + height}, IM_COL32(0, 0, 0, 120));
    const float bar = width / 120.0f;
    for (std::size_t i = 0; i < history_.size(); ++i) {
      float bottom = from.y + height;
      std::size_t colour = 0;
      for (const std::string& name : names) {
        const auto found = history_[i].find(name);
        const float part =
            found == history_[i].end() ? 0.0f : static_cast<float>(found->second / longest) * height;
        const float left = from.x + bar * static_cast<float>(i);
        list.AddRectFilled({left, bottom - part}, {left + bar, bottom}, stage_colour(colour++));
        bottom -= part;
      }
    }
    ImGui::Dummy({width, height});
    std::size_t colour = 0;
    for (const std::string& name : names) {
      double last = 0.0;
      if (!history_.empty() && history_.back().contains(name)) last = history_.back().at(name);
      ImGui::PushStyleColor(ImGuiCol_Text, stage_colour(colour++));
      ImGui::Text("%-16s %7.2f ms", name.c_str(), last);
      ImGui::PopStyleColor();
      if (colour % 2 == 1) ImGui::SameLine(200.0f);
    }
    ImGui::NewLine();
    ImGui::Text("bar: %.1f ms; images, volumes and maps: %.0f MiB", longest,
                static_cast<double>(bytes()) / (1024.0 * 1024.0));
  }
  ImGui::End();
}

void Viewer::status_line() {
  std::string text = fmt::format("{}x{}", pixels_.x, pixels_.y);
  if (left_.is_ready(drawn_rung_)) {
    const glm::ivec2 drawn = left_.size(drawn_rung_);
    if (drawn_rung_ > 0) text += fmt::format(", drawn at {}x{} while it moves", drawn.x, drawn.y);
    if (left_.ms(drawn_rung_)) text += fmt::format("   {:.0f} ms a frame", *left_.ms(drawn_rung_));
  }
  if (moving_ms_ > 0.0) text += fmt::format("   moving: {:.1f} frames a second", 1000.0 / moving_ms_);
  if (!message().empty()) text = message();
  // A message may have several lines.
  const float height = ImGui::CalcTextSize(text.c_str()).y + 6.0f;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const glm::vec2 size(window_);
  list.AddRectFilled({0.0f, size.y - height}, {size.x, size.y}, IM_COL32(20, 20, 24, 200));
  list.AddText({8.0f, size.y - height + 3.0f}, IM_COL32(230, 230, 230, 255), text.c_str());
}

void Viewer::overlays() {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const glm::dvec2 size(window_);
  scene::CameraFrame frame;
  try {
    frame = scene::camera_frame(shown_.view.camera, pixels_);
  } catch (const scene::Error&) {
    return;  // said already
  }
  for (const scene::Light& light : shown_.view.lights) {
    const glm::dvec3 seen = project(frame, size, light);
    if (has_epipolar_lines_ && std::abs(seen.z) > 1e-9) {
      // Where half-planes about the axis from the eye to the light are seen.
      const double reach = 2.0 * (size.x + size.y) + glm::length(glm::dvec2(seen) - 0.5 * size);
      for (int i = 0; i < 64; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 64.0;
        const glm::dvec2 way = reach * glm::dvec2(std::cos(angle), std::sin(angle));
        list.AddLine(point(glm::dvec2(seen)), point(glm::dvec2(seen) + way), IM_COL32(120, 200, 255, 110));
      }
    }
    if (seen.z <= 0.0 || !has_panels_) continue;
    list.AddCircle(point(glm::dvec2(seen)), 7.0f, IM_COL32(255, 220, 120, 220), 0, 2.0f);
    list.AddCircle(point(glm::dvec2(seen)), 8.5f, IM_COL32(0, 0, 0, 160), 0, 1.0f);
  }
  if (!inspected_.empty() && inspected_ == shown_inspection_) {
    // What is of the picture's own shape covers it; what is not lies in it.
    const bool covers = inspection_.size() == pixels_;
    const glm::dvec2 from = covers ? glm::dvec2(0.0) : glm::dvec2(0.3 * size.x, 0.1 * size.y);
    list.AddImage(texture_id(inspection_), point(from), point(covers ? size : glm::dvec2(0.97, 0.9) * size));
  }
  if (beside_ != Beside::nothing && layout_ == Layout::split) {
    const double x = divider_ * size.x;
    list.AddLine(point({x, 0.0}), point({x, size.y}), IM_COL32(255, 255, 255, 200), 1.0f);
    list.AddTriangleFilled(point({x - 7.0, 0.5 * size.y}), point({x - 2.0, 0.5 * size.y - 5.0}),
                           point({x - 2.0, 0.5 * size.y + 5.0}), IM_COL32(255, 255, 255, 220));
    list.AddTriangleFilled(point({x + 7.0, 0.5 * size.y}), point({x + 2.0, 0.5 * size.y - 5.0}),
                           point({x + 2.0, 0.5 * size.y + 5.0}), IM_COL32(255, 255, 255, 220));
  }
}

}  // namespace airlight::viewer
