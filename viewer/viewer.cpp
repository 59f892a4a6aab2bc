#include "viewer/viewer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "quality/metrics.h"
#include "quality/pictures.h"
#include "quality/results.h"
#include "scene/error.h"
#include "viewer/cameras.h"

#include "spirv/viewer/develop_frag.h"

namespace airlight::viewer {
namespace {

constexpr double k_rest = 0.2;          ///< how long nothing has moved when something rests [s]
constexpr double k_handle = 9.0;        ///< how near a light's handle is taken [points]
constexpr double k_lens = 120.0;        ///< half the side of the magnifier [points]
constexpr double k_zoom = 4.0;          ///< and by what it magnifies
constexpr double k_look_speed = 0.004;  ///< [rad a point]

/// The length by which one moves about a scene.
double size_of(const scene::Scene& scene, const scene::Camera& camera) {
  const scene::Box box = scene::bounds(scene.geometry);
  const double to_target = glm::distance(camera.eye, camera.target);
  if (box.empty()) return std::max(to_target, 1.0);
  return std::min(glm::length(glm::dvec3(box.upper) - glm::dvec3(box.lower)), 20.0 * to_target);
}

bool are_alike(const Shown& a, const Shown& b) {
  return a.view.camera == b.view.camera && a.view.lights == b.view.lights && a.view.medium == b.view.medium &&
         a.view.size == b.view.size && a.view.surroundings == b.view.surroundings &&
         a.shadow_map == b.shadow_map && spec_of(a.volume) == spec_of(b.volume) &&
         spec_of(a.surface) == spec_of(b.surface);
}

}  // namespace

Viewer::Viewer(gpu::Context& context, const scene::Scene& scene, SceneName name, const Shown& shown,
               std::optional<scene::Path> path, std::filesystem::path folder)
    : context_(context),
      scene_(scene),
      name_(std::move(name)),
      folder_(std::move(folder)),
      scene_size_(size_of(scene, shown.view.camera)),
      shown_(shown),
      start_(shown),
      off_lights_(scene.other_lights),
      right_volume_(quality::parse_volumes("march")[0]),
      path_(std::move(path)),
      buffers_(std::make_shared<const frame::SceneBuffers>(context, scene.geometry)),
      left_(context, scene.geometry, buffers_),
      right_(context, scene.geometry, buffers_),
      speed_(0.1 * scene_size_) {}

std::string Viewer::command() const {
  return command_of(name_, shown_, "picture.exr");
}

std::int64_t Viewer::bytes() const {
  std::int64_t sum = image_.bytes() + truth_radiance_.bytes();
  for (std::size_t rung = 0; rung < k_rungs.size(); ++rung) sum += left_.bytes(rung) + right_.bytes(rung);
  return sum;
}

void Viewer::say(const std::string& message, double seconds) {
  message_ = message;
  message_until_ = now_ + seconds;
  frames_to_draw_ = std::max(frames_to_draw_, 1);
}

bool Viewer::has_work(double seconds) const {
  return patience() == 0.0 || awaits_truth() || (!message_.empty() && seconds > message_until_);
}

double Viewer::patience() const {
  const bool is_busy =
      !events_.empty() || frames_to_draw_ > 0 || !is_settled_ || is_playing_ || !keys_down_.empty();
  return is_busy ? 0.0 : awaits_truth() ? 0.1 : 1.0;
}

void Viewer::set_beside(Beside beside, Layout layout) {
  layout_ = layout;
  if (beside == beside_) return;
  beside_ = beside;
  drawn_right_.reset();
  is_settled_ = false;
}

bool Viewer::awaits_truth() const {
  return beside_ == Beside::truth && !truth_error_ && problem_.empty() && pixels_.x > 0;
}

bool Viewer::draw(double seconds) {
  const double elapsed = std::clamp(seconds - last_frame_, 0.0, 0.25);
  last_frame_ = now_ = seconds;
  const std::vector<Event> events = events_.take();
  if (!events.empty()) frames_to_draw_ = 2;  // ImGui shows some answers a frame later
  cursor_before_ = cursor_;
  scroll_ = 0.0;
  for (const Event& event : events) {
    if (const auto* size = std::get_if<SizeEvent>(&event)) {
      window_ = size->size;
      pixels_ = size->pixels;
    } else if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
      cursor_ = cursor->place;
    } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
      if (button->button >= 0 && button->button < 3)
        buttons_[static_cast<std::size_t>(button->button)] = button->is_down;
    } else if (const auto* scroll = std::get_if<ScrollEvent>(&event)) {
      scroll_ += scroll->notches;
    } else if (const auto* focus = std::get_if<FocusEvent>(&event)) {
      if (!focus->has_focus) keys_down_.clear();
    } else if (std::holds_alternative<CloseEvent>(event)) {
      is_closed_ = true;
    }
  }
  if (std::min({window_.x, window_.y, pixels_.x, pixels_.y}) <= 0) {
    frames_to_draw_ = 0;
    is_settled_ = true;  // until it has a size again
    return false;
  }
  if (frames_to_draw_ > 0) --frames_to_draw_;
  if (!message_.empty() && now_ > message_until_) message_.clear();
  if (image_.size() != pixels_) image_ = gpu::Texture(gpu::Format::rgba8, pixels_);

  gui_.begin(events, window_, pixels_, elapsed);
  take_keys(events, elapsed);
  take_mouse();
  if (path_ && is_playing_) set_path_time(path_seconds_ + elapsed);
  if (has_panels_) draw_panels();
  shown_.view.size = pixels_;
  try {
    draw_picture(seconds);
    problem_.clear();
  } catch (const scene::Error& error) {
    problem_ = error.what();
    is_settled_ = true;
  }
  overlays();
  status_line();
  compose();
  gui_.draw(image_);
  context_.check();
  return true;
}

bool Viewer::has_shift() const {
  return keys_down_.contains(GLFW_KEY_LEFT_SHIFT) || keys_down_.contains(GLFW_KEY_RIGHT_SHIFT);
}

bool Viewer::has_control() const {
  return keys_down_.contains(GLFW_KEY_LEFT_CONTROL) || keys_down_.contains(GLFW_KEY_RIGHT_CONTROL);
}

void Viewer::take_keys(const std::vector<Event>& events, double elapsed) {
  for (const Event& event : events) {
    const auto* key = std::get_if<KeyEvent>(&event);
    if (!key) continue;
    if (!key->is_down) {
      keys_down_.erase(key->key);
      continue;
    }
    if (gui_.wants_keyboard()) continue;
    keys_down_.insert(key->key);
    const bool is_control = has_control();
    switch (key->key) {
      case GLFW_KEY_ESCAPE:
        is_closed_ = true;
        break;
      case GLFW_KEY_F1:
        has_help_ = !has_help_;
        break;
      case GLFW_KEY_F2:
        has_panels_ = !has_panels_;
        break;
      case GLFW_KEY_F5:
        reload_shaders();
        break;
      case GLFW_KEY_F12:
        save_picture();
        break;
      case GLFW_KEY_P:
        has_profiler_ = !has_profiler_;
        break;
      case GLFW_KEY_SPACE:
        if (path_) is_playing_ = !is_playing_;
        break;
      case GLFW_KEY_O:
        has_epipolar_lines_ = !has_epipolar_lines_;
        break;
      case GLFW_KEY_HOME:
        shown_.view.camera = start_.view.camera;
        break;
      case GLFW_KEY_K:
        record_key();
        break;
      case GLFW_KEY_S:
        if (is_control) save_shot();
        break;
      case GLFW_KEY_Q:
        if (is_control) is_closed_ = true;
        break;
      default:
        break;
    }
  }
  if (gui_.wants_keyboard() || has_control()) return;
  const auto towards = [&](int more, int less) {
    return (keys_down_.contains(more) ? 1.0 : 0.0) - (keys_down_.contains(less) ? 1.0 : 0.0);
  };
  const glm::dvec3 way(towards(GLFW_KEY_D, GLFW_KEY_A), towards(GLFW_KEY_E, GLFW_KEY_Q),
                       towards(GLFW_KEY_W, GLFW_KEY_S));
  if (way != glm::dvec3(0.0)) fly(shown_.view.camera, (has_shift() ? 4.0 : 1.0) * speed_ * elapsed * way);
}

void Viewer::take_mouse() {
  const bool is_held = buttons_[0] || buttons_[1] || buttons_[2];
  scene::Camera& camera = shown_.view.camera;
  if (is_held && drag_ == Drag::none && !gui_.wants_mouse()) {
    // What the button has gone down on decides what it drags.
    const glm::dvec2 size(window_);
    if (buttons_[1]) {
      drag_ = Drag::orbit;
    } else if (buttons_[2]) {
      drag_ = has_shift() ? Drag::pan : Drag::orbit;
    } else {
      drag_ = Drag::look;
      if (beside_ != Beside::nothing && layout_ == Layout::split &&
          std::abs(cursor_.x - divider_ * size.x) < k_handle)
        drag_ = Drag::divider;
      const scene::CameraFrame frame = scene::camera_frame(camera, pixels_);
      for (std::size_t i = 0; i < shown_.view.lights.size(); ++i) {
        const glm::dvec3 seen = project(frame, size, shown_.view.lights[i]);
        if (seen.z > 0.0 && glm::distance(glm::dvec2(seen), cursor_) < k_handle) {
          drag_ = Drag::light;
          dragged_light_ = i;
        }
      }
    }
    cursor_before_ = cursor_;
  }
  const glm::dvec2 way = cursor_ - cursor_before_;
  if (way != glm::dvec2(0.0)) {
    const double distance = glm::distance(camera.eye, camera.target);
    const double metres =
        2.0 * distance * std::tan(glm::radians(0.5 * camera.vertical_fov_degrees)) / window_.y;
    switch (drag_) {
      case Drag::none:
        break;
      case Drag::look:
        look(camera, k_look_speed * way.x, k_look_speed * way.y);
        break;
      case Drag::orbit:
        orbit(camera, k_look_speed * way.x, k_look_speed * way.y);
        break;
      case Drag::pan:
        pan(camera, -metres * way.x, metres * way.y);
        break;
      case Drag::divider:
        divider_ = std::clamp(cursor_.x / window_.x, 0.0, 1.0);
        break;
      case Drag::light:
        drag_light(cursor_before_, cursor_);
        break;
    }
  }
  if (!is_held) drag_ = Drag::none;  // after the way that the cursor went before
  if (scroll_ != 0.0 && !gui_.wants_mouse()) {
    if (drag_ == Drag::light && dragged_light_ < shown_.view.lights.size()) {
      // Along the line of sight.
      scene::Light& light = shown_.view.lights[dragged_light_];
      if (!scene::is_sun(light))
        light.position = camera.eye + std::exp(0.05 * scroll_) * (light.position - camera.eye);
    } else if (drag_ == Drag::look) {
      speed_ *= std::exp(0.2 * scroll_);
    } else {
      dolly(camera, 0.1 * scroll_);
    }
  }
}

void Viewer::drag_light(glm::dvec2 from, glm::dvec2 to) {
  if (dragged_light_ >= shown_.view.lights.size()) return;
  scene::Light& light = shown_.view.lights[dragged_light_];
  const scene::CameraFrame frame = scene::camera_frame(shown_.view.camera, pixels_);
  const glm::dvec2 size(window_);
  if (scene::is_sun(light)) {
    light.towards = scene::unit(scene::image_ray(frame, size, to));
    return;
  }
  if (has_shift() && light.cone) {
    // Along its shaft, as far as the cursor goes along it.
    const glm::dvec2 at = project(frame, size, light);
    const glm::dvec3 ahead = project(frame, size, light.position + 0.01 * scene_size_ * light.cone->axis);
    const glm::dvec2 along = glm::dvec2(ahead) - at;
    const double share = glm::dot(to - from, along) / std::max(glm::dot(along, along), 1e-9);
    if (ahead.z > 0.0)
      light.position += std::clamp(share, -20.0, 20.0) * 0.01 * scene_size_ * light.cone->axis;
    return;
  }
  const double depth = project(frame, size, light).z;
  light.position += depth * (scene::image_ray(frame, size, to) - scene::image_ray(frame, size, from));
}

void Viewer::set_path_time(double seconds) {
  path_seconds_ = path_->seconds > 0.0 ? std::fmod(seconds, path_->seconds) : 0.0;
  const std::size_t last = path_->views.size() - 1;
  const double place =
      path_->seconds > 0.0 ? path_seconds_ / path_->seconds * static_cast<double>(last) : 0.0;
  const scene::View& view = path_->views[std::min(static_cast<std::size_t>(std::lround(place)), last)];
  show_moment(view.camera, view.lights);
}

Shown Viewer::shown_right() const {
  Shown right = shown_;
  right.volume = right_volume_;
  return right;
}

void Viewer::draw_picture(double seconds) {
  scene::validate(shown_.view);
  const bool has_right = beside_ == Beside::method;
  const Shown right = shown_right();
  const bool is_changed = !drawn_ || !are_alike(*drawn_, shown_) ||
                          (has_right && (!drawn_right_ || !are_alike(*drawn_right_, right)));
  if (is_changed) {
    last_change_ = drawn_ ? seconds : -1e9;
    is_settled_ = false;
    truth_.stop();
    has_truth_ = false;
    truth_image_.reset();
    truth_error_.reset();
    inspections_.reset();
    shown_inspection_.clear();
    slice_at_ = glm::dvec2(-1.0);
    drawn_.reset();
    left_.show(shown_);
    if (has_right) right_.show(right);
  }
  const bool rests = !is_playing_ && seconds - last_change_ > k_rest;
  const std::size_t rung = rests ? 0 : moving_rung_;
  if (is_changed || (rests && drawn_rung_ != 0)) {
    const auto start = std::chrono::steady_clock::now();
    const bool was_ready = left_.is_ready(rung);
    draw_rung(rung);
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    drawn_ = shown_;
    if (has_right) drawn_right_ = right;
    drawn_rung_ = rung;
    if (rests) find_exposure();
    if (!rests && was_ready) {
      moving_ms_ = moving_ms_ == 0.0 ? ms : 0.7 * moving_ms_ + 0.3 * ms;
      // A rung up has up to 2.25 times the pixels.
      if (ms > k_frame_ms && moving_rung_ + 1 < k_rungs.size()) {
        ++moving_rung_;
        moving_ms_ = 0.0;
      } else if (moving_ms_ < 0.3 * k_frame_ms && moving_rung_ > 0) {
        --moving_rung_;
        moving_ms_ = 0.0;
      }
    }
    return;
  }
  if (rests) find_exposure();
  if (rests && !is_settled_) settle();
  if (rests && is_settled_) inspect();
  follow_truth();
}

void Viewer::find_exposure() {
  if (!exposure_is_old_ || shown_.exposure) return;
  automatic_exposure_ = quality::automatic_exposure(left_.frame(0).read().radiance);
  exposure_is_old_ = false;
}

void Viewer::draw_rung(std::size_t rung) {
  gpu::StageTimer timer(has_profiler_ ? &context_ : nullptr);
  left_.draw(rung, timer);
  ++pictures_drawn_;
  exposure_is_old_ = true;
  if (has_profiler_) {
    history_.push_back(timer.milliseconds());
    if (history_.size() > 120) history_.pop_front();
  }
  gpu::StageTimer off(nullptr);
  if (beside_ == Beside::method) right_.draw(rung, off);
}

void Viewer::settle() {
  // Rungs are made ready one a frame, down to the first that is fast enough to move by.
  for (std::size_t rung = 0; rung < k_rungs.size(); ++rung) {
    if (!left_.is_ready(rung) || !left_.ms(rung)) {
      gpu::StageTimer off(nullptr);
      left_.draw(rung, off, frame::Resting::redrawn);
      if (beside_ == Beside::method) right_.draw(rung, off);
      moving_rung_ = std::max(moving_rung_, rung);
      return;
    }
    if (*left_.ms(rung) < 0.6 * k_frame_ms) break;
  }
  is_settled_ = true;
}

void Viewer::judge_surfaces() {
  const frame::FrameImages images = left_.frame(0).read();
  const frame::SurfacePoints points = left_.surface_points(0);
  quality::SharedReference reference(scene_.geometry, shown_.view, {});
  quality::SharedReference* opaque = reference.taken_opaque();
  quality::SharedReference& judge = opaque && images.transmittance.empty() ? *opaque : reference;
  std::vector<quality::SurfaceVerdicts> verdicts;
  for (std::size_t light = 0; light < shown_.view.lights.size(); ++light)
    verdicts.push_back(judge.verdicts(light, points));
  std::vector<glm::vec4> colours;
  for (const glm::vec3& colour : quality::surface_colours(images, verdicts))
    colours.emplace_back(glm::sqrt(colour), 1.0f);  // nearly as the screen has them
  if (inspection_.size() != images.size || inspection_.format() != gpu::Format::rgba32f)
    inspection_ = gpu::Texture(gpu::Format::rgba32f, images.size);
  inspection_.write(colours.data());
  shown_inspection_ = inspected_;
  frames_to_draw_ = 1;
}

const std::vector<frame::DebugImage>& Viewer::inspections() {
  if (!inspections_) inspections_ = left_.inspect(0);
  return *inspections_;
}

void Viewer::inspect() {
  const auto upload = [](gpu::Texture& texture, const frame::DebugImage& image) {
    if (texture.size() != image.size || texture.format() != gpu::Format::r32f) {
      texture = gpu::Texture(gpu::Format::r32f, image.size);
      texture.sample_as_grey();
    }
    texture.write(image.values.data());
  };
  if (inspected_ == k_undecided && inspected_ != shown_inspection_) {
    judge_surfaces();
  } else if (inspected_ != shown_inspection_ && !inspected_.empty()) {
    for (const frame::DebugImage& image : inspections()) {
      if (image.name != inspected_) continue;
      upload(inspection_, image);
      shown_inspection_ = inspected_;
      frames_to_draw_ = 1;
    }
    if (shown_inspection_ != inspected_) inspected_.clear();
  }
  const glm::dvec2 at = cursor_ * glm::dvec2(pixels_) / glm::dvec2(window_);
  if (has_slice_ && at != slice_at_ && !gui_.wants_mouse()) {
    slice_at_ = at;
    if (const auto slice = left_.airlight(0).debug_slice(shown_.view, at)) {
      upload(slice_, *slice);
      slice_caption_ = slice->caption;
      frames_to_draw_ = 1;
    }
  }
}

void Viewer::follow_truth() {
  if (beside_ != Beside::truth || !is_settled_ || drawn_rung_ != 0) return;
  if (!has_truth_) {
    truth_.start(scene_.geometry, shown_.view);
    has_truth_ = true;
  }
  std::optional<BackgroundTruth::Image> image;
  try {
    image = truth_.take();
  } catch (const std::exception& error) {
    say(error.what());
    truth_error_ = std::numeric_limits<double>::quiet_NaN();
  }
  if (!image) return;
  // Its airlight in the place of the picture's: surfaces are the picture's own.
  const frame::FrameImages images = left_.frame(0).read();
  const glm::ivec2 size = images.size;
  std::vector<glm::vec4> picture(images.radiance.size());
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x);
      const glm::ivec2 at = glm::min(glm::ivec2(x, y) * image->size / size, image->size - 1);
      const glm::vec3& truth =
          image->airlight[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(image->size.x) +
                          static_cast<std::size_t>(at.x)];
      picture[pixel] = glm::vec4(images.radiance[pixel] - images.airlight[pixel] + truth, 1.0f);
    }
  }
  if (truth_radiance_.size() != size) truth_radiance_ = gpu::Texture(gpu::Format::rgba32f, size);
  truth_radiance_.write(picture.data());
  if (image->is_whole) {
    const auto error =
        quality::airlight_error(quality::channels_of(images.airlight), quality::channels_of(image->airlight));
    truth_error_ = error.rrmse;
  }
  truth_image_ = std::move(image);
  frames_to_draw_ = 1;
}

const frame::ScreenPass& Viewer::develop_as_shown() {
  auto found = develop_.find(shown_.tone_map);
  if (found == develop_.end()) {
    const std::array tone_map = {gpu::Constant(1, static_cast<std::uint32_t>(shown_.tone_map))};
    found = develop_.emplace(shown_.tone_map, frame::ScreenPass(k_develop_frag, tone_map)).first;
  }
  return found->second;
}

const frame::ScreenPass& Viewer::develop_difference() {
  if (!develop_difference_) develop_difference_.emplace(k_develop_frag, std::array{gpu::Constant(0, 1)});
  return *develop_difference_;
}

void Viewer::develop() {
  const gpu::Texture& left = left_.frame(drawn_rung_).radiance();
  const gpu::Texture* right = beside_ == Beside::method && right_.is_ready(drawn_rung_)
                                  ? &right_.frame(drawn_rung_).radiance()
                              : beside_ == Beside::truth && truth_image_ ? &truth_radiance_
                                                                         : nullptr;
  const float exposure = shown_.exposure.value_or(automatic_exposure_);
  const bool is_difference = right && layout_ == Layout::difference;
  const auto develop = [&](gpu::Texture& picture, const gpu::Texture& radiance, const frame::ScreenPass& pass,
                           float brightness) {
    if (picture.size() != radiance.size()) picture = gpu::Texture(gpu::Format::rgba8, radiance.size());
    radiance.bind_sampler(0);
    pass.pipeline().set(0, brightness);
    pass.run({picture});
  };
  if (right) right->bind_sampler(1);
  if (is_difference)
    develop(left_picture_, left, develop_difference(), exposure / difference_scale_);
  else
    develop(left_picture_, left, develop_as_shown(), exposure);
  if (right && layout_ == Layout::split)
    develop(right_picture_, *right, develop_as_shown(), exposure);
  else
    right_picture_ = {};
}

void Viewer::compose() {
  if (!left_.is_ready(drawn_rung_)) {
    image_.clear();
    return;
  }
  // Developed once, and shown until something changes.
  const std::string wanted = fmt::format(
      "{} {} {} {} {} {} {}", pictures_drawn_, static_cast<int>(shown_.tone_map), static_cast<int>(beside_),
      static_cast<int>(layout_), shown_.exposure.value_or(automatic_exposure_), difference_scale_,
      truth_image_ ? truth_image_->size.x : 0);
  if (wanted != developed_) develop();
  developed_ = wanted;

  // The window has its last row first.
  const auto place = [&](glm::dvec2 part) {
    return glm::ivec2(glm::round(glm::dvec2(part.x, 1.0 - part.y) * glm::dvec2(pixels_)));
  };
  const auto show = [&](const gpu::Texture& picture, glm::dvec2 from, glm::dvec2 to, glm::dvec2 over_from,
                        glm::dvec2 over_to, bool smoothly) {
    const glm::dvec2 size(picture.size());
    gpu::stretch(picture, {glm::ivec2(glm::round(from * size)), glm::ivec2(glm::round(to * size))}, image_,
                 {place(over_from), place(over_to)}, smoothly);
  };
  const bool is_split = right_picture_.size().x > 0;
  show(left_picture_, {0, 0}, {1, 1}, {0, 0}, {1, 1}, drawn_rung_ > 0);
  // Cut where a column of its own begins.
  const double columns = is_split ? right_picture_.size().x : 1.0;
  const double cut = std::round(divider_ * columns) / columns;
  if (is_split && cut < 1.0) show(right_picture_, {cut, 0}, {1, 1}, {cut, 0}, {1, 1}, drawn_rung_ > 0);
  if (!keys_down_.contains(GLFW_KEY_Z)) return;
  // The magnifier, about the cursor.
  const glm::dvec2 at = glm::clamp(cursor_ / glm::dvec2(window_), 0.0, 1.0),
                   half = k_lens / glm::dvec2(window_);
  const gpu::Texture& magnified = is_split && at.x >= cut ? right_picture_ : left_picture_;
  show(magnified, at - half / k_zoom, at + half / k_zoom, at - half, at + half, false);
}

void Viewer::make_programs_anew() {
  left_.clear();
  right_.clear();
  develop_.clear();
  develop_difference_.reset();
  drawn_.reset();
  drawn_right_.reset();
  developed_.clear();
  // What does not link is found now. Rungs of other sizes are of the same words.
  left_.show(shown_);
  gpu::StageTimer off(nullptr);
  left_.draw(0, off);
  if (beside_ == Beside::method) {
    right_.show(shown_right());
    right_.draw(0, off);
  }
  develop_as_shown();
  develop_difference();
}

void Viewer::reload_shaders() {
  constexpr double k_seconds_to_read = 60.0;
  try {
    scene::validate(shown_.view);
    const ShaderSources::Changes changes = shader_sources_.compile_changes();
    if (changes.names.empty()) {
      say("no shader has changed");
      return;
    }
    const gpu::ReplacedShaders before = gpu::replaced_shaders();
    for (const auto& [embedded, words] : changes.words) gpu::replaced_shaders()[embedded] = words;
    try {
      make_programs_anew();
    } catch (const scene::Error&) {
      gpu::replaced_shaders() = before;
      make_programs_anew();
      throw;
    }
    shader_sources_.accept(changes);
    say(changes.names.size() == 1 ? changes.names[0] + " reloaded"
                                  : fmt::format("{} shaders reloaded", changes.names.size()));
  } catch (const std::exception& error) {
    say(error.what(), k_seconds_to_read);
  }
}

std::filesystem::path Viewer::next_file(const std::string& ending) const {
  const std::string stem = std::filesystem::path(name_.spec).stem().string();
  for (int i = 1;; ++i) {
    const std::filesystem::path file = folder_ / fmt::format("{}_{:03}{}", stem, i, ending);
    if (std::error_code error; !std::filesystem::exists(file, error)) return file;
  }
}

void Viewer::save_picture() {
  try {
    std::filesystem::create_directories(folder_);
    scene::validate(shown_.view);
    gpu::StageTimer off(nullptr);
    left_.show(shown_);
    const frame::FrameImages images = left_.draw(0, off).read();
    const std::filesystem::path file = next_file(".exr");
    const float exposure = shown_.exposure.value_or(quality::automatic_exposure(images.radiance));
    Shown fitted = left_.shown(0);
    fitted.volume.spec = spec_of(shown_.volume);
    fitted.surface.spec = spec_of(shown_.surface);
    quality::Making making{.scene = name_.spec,
                           .model_options = {},
                           .volume = fitted.volume,
                           .surface = fitted.surface,
                           .shadow_map = shown_.shadow_map,
                           .exposure = exposure,
                           .tone_map = shown_.tone_map,
                           .renderer = context_.device().renderer,
                           .command = command()};
    const std::pair<const char*, const std::optional<std::string>&> model_options[] = {
        {"albedo", name_.albedo},
        {"looks", name_.looks},
        {"occluders", name_.occluders},
        {"triangles", name_.triangles}};
    for (const auto& [name, value] : model_options)
      if (value) making.model_options[name] = *value;
    quality::write_frame(file, images, quality::metadata_of(making, shown_.view));
    std::filesystem::path preview = file;
    quality::write_png(preview.replace_extension(".png"), images.radiance, images.size, exposure,
                       shown_.tone_map);
    say(fmt::format("{} and {} written", file.string(), preview.filename().string()));
  } catch (const std::exception& error) {
    say(error.what());
  }
}

void Viewer::save_shot() {
  try {
    std::filesystem::create_directories(folder_);
    SceneName name = name_;
    // A shot's scene is relative to the shot.
    if (std::error_code error; std::filesystem::exists(name.spec, error))
      name.spec = std::filesystem::absolute(name.spec).string();
    const std::filesystem::path file = next_file(".toml");
    std::ofstream stream(file);
    stream << shot_of(name, shown_);
    stream.close();
    say(stream ? fmt::format("{} written", file.string())
               : fmt::format("{} cannot be written", file.string()));
  } catch (const std::exception& error) {
    say(error.what());
  }
}

void Viewer::record_key() {
  if (!keys_.empty() && !are_same_lights(keys_[0].lights, shown_.view.lights)) {
    say("no key: a path's lights are those of its first key all along");
    return;
  }
  const double time = keys_.empty() ? 0.0 : keys_.back().time + 2.0;
  keys_.push_back({time, shown_.view.camera, shown_.view.lights});
  say(fmt::format("key {} of the path at {} s", keys_.size(), time));
}

void Viewer::show_moment(const scene::Camera& camera, const std::vector<scene::Light>& lights) {
  shown_.view.camera = camera;
  if (are_same_lights(lights, shown_.view.lights)) shown_.view.lights = lights;
}

void Viewer::save_path() {
  try {
    std::filesystem::create_directories(folder_);
    const std::filesystem::path file = next_file("_path.toml");
    // Lights that the scene does not have are those of a shot.
    const bool is_of_scene = are_same_lights(start_.view.lights, keys_[0].lights);
    scene::View view = shown_.view;
    view.lights = is_of_scene ? start_.view.lights : keys_[0].lights;
    std::ofstream stream(file);
    stream << path_of(keys_, view.lights);
    stream.close();
    if (!stream) throw scene::Error(scene::ExitCode::bad_file, file.string(), "it cannot be written");
    path_ = scene::load_path(file, view);
    path_seconds_ = 0.0;
    say(fmt::format("{} written; space plays it{}", file.string(),
                    is_of_scene ? "" : ", render on the shot that Ctrl + S saves with these lights"));
  } catch (const std::exception& error) {
    say(error.what());
  }
}

}  // namespace airlight::viewer
