#pragma once

#include <string>
#include <string_view>

#include "frame/frame.h"

namespace airlight::quality {

/// A running tev, the viewer of OpenEXR images, that shows images as they are rendered. It is told of them by
/// the packets that its documentation describes (tev, "Inter-process communication"), over TCP.
class Tev {
 public:
  static constexpr std::string_view k_address = "127.0.0.1:14158";  ///< where tev listens

  /// @param address HOST:PORT
  /// @throws scene::Error (usage) for what is none, (bad_file) where no tev answers
  explicit Tev(const std::string& address);
  ~Tev();
  Tev(const Tev&) = delete;
  Tev& operator=(const Tev&) = delete;

  /// Shows an image under a name, in the place of what it showed under it before. Its layers are those of
  /// write_frame. Nothing happens once tev has been closed.
  void show(const std::string& name, const frame::FrameImages& images);

  /// Whether it took all that it was shown.
  bool is_there() const { return socket_ >= 0; }

 private:
  void send(const std::string& packet);
  void close();

  int socket_ = -1;
};

}  // namespace airlight::quality
