#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "frame/screen_pass.h"
#include "gpu/texture.h"
#include "scene/path.h"
#include "viewer/events.h"
#include "viewer/gui.h"
#include "viewer/ladder.h"
#include "viewer/shader_sources.h"
#include "viewer/shown.h"
#include "viewer/truth.h"

namespace airlight::viewer {

/// What stands beside the picture.
enum class Beside {
  nothing,
  method,  ///< the same picture by another method of airlight
  truth,   ///< the same picture with the exact airlight
};

/// How the two are looked at.
enum class Layout { left, split, difference };

/// What can lie over the picture beside what its method has to show: where the truth says that surfaces are
/// wrong, and where it cannot say.
inline constexpr const char* k_undecided = "surfaces";

/// What the window shows, whatever shows the window: frames go in as events and times, and come out as an
/// image. It edits a picture through the table of a view's fields and through the methods' descriptors.
class Viewer {
 public:
  /// A frame shorter than this is drawn as large as asked for; longer ones take a rung of the ladder [ms].
  static constexpr double k_frame_ms = 1000.0 / 15.0;

  /// @param scene kept by reference
  /// @param shown its size does not matter: the window has its own
  /// @param path played when asked for, if any
  /// @param folder where pictures, shots and paths are written
  Viewer(gpu::Context& context, const scene::Scene& scene, SceneName name, const Shown& shown,
         std::optional<scene::Path> path, std::filesystem::path folder);

  void push(const Event& event) { events_.push(event); }

  /// Takes the events that there are for one frame, and draws it.
  /// @param seconds since any moment, the same for all frames
  /// @returns whether there is an image: not of a window without pixels
  bool draw(double seconds);

  /// Whether a frame would do something that no event has asked for. @param seconds as of draw()
  bool has_work(double seconds) const;

  /// How long it may wait for an event when it has work [s]: for what others still do.
  double patience() const;

  /// What draw() has drawn: rgba8, of the window's pixels, last row first.
  const gpu::Texture& image() const { return image_; }

  bool is_closed() const { return is_closed_; }

  // For those who look on:
  const Shown& shown() const { return shown_; }
  const std::map<std::string, Gui::Place>& controls() const { return gui_.controls(); }
  /// The command that renders the picture as it is when it rests.
  std::string command() const;
  std::size_t rung() const { return drawn_rung_; }  ///< of the picture in the image
  double moving_ms() const { return moving_ms_; }   ///< of frames while something moves, whole, smoothed
  /// What the status line says in the place of the figures: what has just been done, or why there is no
  /// picture.
  const std::string& message() const { return message_.empty() ? problem_ : message_; }
  int pictures_drawn() const { return pictures_drawn_; }
  std::optional<double> truth_error() const { return truth_error_; }  ///< rrmse of what is on screen
  /// On the GPU: the picture's images, volumes and maps at all sizes, the scene left out.
  std::int64_t bytes() const;
  void set_beside(Beside beside, Layout layout);

 private:
  // viewer.cpp
  void take_keys(const std::vector<Event>& events, double elapsed);
  void take_mouse();
  bool has_shift() const;
  bool has_control() const;
  void drag_light(glm::dvec2 from, glm::dvec2 to);
  Shown shown_right() const;
  void draw_picture(double seconds);
  void draw_rung(std::size_t rung);
  void settle();
  void find_exposure();
  const frame::ScreenPass& develop_as_shown();
  const frame::ScreenPass& develop_difference();
  void develop();
  void compose();
  bool awaits_truth() const;
  void follow_truth();
  void inspect();
  const std::vector<frame::DebugImage>& inspections();
  void judge_surfaces();
  void set_path_time(double seconds);
  void make_programs_anew();
  void reload_shaders();
  /// @param seconds how long it is shown
  void say(const std::string& message, double seconds = 6.0);
  std::filesystem::path next_file(const std::string& ending) const;
  void save_picture();
  void save_shot();
  void save_path();
  void record_key();
  /// Of a path: its lights only where they are those shown.
  void show_moment(const scene::Camera& camera, const std::vector<scene::Light>& lights);

  // panels.cpp
  void draw_panels();
  void method_panel();
  void beside_panel();
  void camera_panel();
  void light_panel();
  void medium_panel();
  void picture_panel();
  void path_panel();
  void help_panel();
  void slice_panel();
  void profiler();
  void status_line();
  void overlays();
  template <typename Thing>
  void edit_fields(Thing& thing, const std::string& prefix);
  template <typename MethodType>
  void edit_method(quality::Choice<MethodType>& choice, std::span<const MethodType> methods,
                   const char* label, const std::string& prefix);

  gpu::Context& context_;
  const scene::Scene& scene_;
  SceneName name_;
  std::filesystem::path folder_;
  double scene_size_;  ///< [m]

  // What is shown.
  Shown shown_, start_;
  std::vector<scene::Light> off_lights_;
  Beside beside_ = Beside::nothing;
  Layout layout_ = Layout::split;
  quality::VolumeChoice right_volume_;
  double divider_ = 0.5;           ///< of the window's width
  float difference_scale_ = 0.2f;  ///< of the picture's white: the difference whose colour is full
  bool has_epipolar_lines_ = false, has_panels_ = true, has_help_ = false, has_profiler_ = false;
  bool has_slice_ = false;
  std::string
      inspected_;  ///< which of the method's pictures lies over the image, or k_undecided; empty for none

  // A path, and its keys where one is recorded.
  std::optional<scene::Path> path_;
  double path_seconds_ = 0.0;
  bool is_playing_ = false;
  std::vector<PathKey> keys_;

  // What has been drawn.
  std::shared_ptr<const frame::SceneBuffers> buffers_;
  Ladder left_, right_;
  int pictures_drawn_ = 0;
  std::optional<Shown> drawn_;  ///< the picture …
  std::optional<Shown> drawn_right_;
  std::size_t drawn_rung_ = 0;  ///< … and at which size
  std::size_t moving_rung_ = 0;
  double moving_ms_ = 0.0, last_change_ = -1e9, last_frame_ = -1e9;
  bool is_settled_ = false;  ///< nothing is left to be done for a picture at rest
  float automatic_exposure_ = 1.0f;
  bool exposure_is_old_ = true;                          ///< the automatic one is not of the picture as drawn
  std::deque<std::map<std::string, double>> history_;    ///< of frames, stages [ms]
  std::map<scene::ToneMap, frame::ScreenPass> develop_;  ///< made when first needed
  std::optional<frame::ScreenPass> develop_difference_;  ///< the same
  /// The pictures as the screen has colours, of their own sizes; row 0 at the top.
  gpu::Texture left_picture_, right_picture_;
  std::string developed_;  ///< what they have been developed from, in words; empty for nothing
  gpu::Texture image_, truth_radiance_;
  std::optional<std::vector<frame::DebugImage>> inspections_;  ///< of the picture as drawn, once asked for
  gpu::Texture inspection_;                                    ///< the one that is shown
  std::string shown_inspection_;                               ///< its name
  gpu::Texture slice_;
  std::string slice_caption_;
  glm::dvec2 slice_at_{-1.0};

  ShaderSources shader_sources_;

  // The truth.
  BackgroundTruth truth_;
  bool has_truth_ = false;  ///< that is being traced or is there, of the picture as drawn
  std::optional<BackgroundTruth::Image> truth_image_;
  std::optional<double> truth_error_;

  // The person.
  EventQueue events_;
  Gui gui_;
  glm::ivec2 window_{0}, pixels_{0};
  std::set<int> keys_down_;
  glm::dvec2 cursor_{0.0}, cursor_before_{0.0};
  std::array<bool, 3> buttons_{};
  double scroll_ = 0.0;
  enum class Drag { none, look, orbit, pan, light, divider };
  Drag drag_ = Drag::none;
  std::size_t dragged_light_ = 0;
  double speed_;            ///< of flying [m/s]
  int frames_to_draw_ = 0;  ///< the panels', that follow an event
  bool is_closed_ = false;
  std::string message_, problem_;
  double message_until_ = -1e9, now_ = 0.0;
};

}  // namespace airlight::viewer
