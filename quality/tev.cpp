#include "quality/tev.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "quality/pictures.h"
#include "scene/error.h"

namespace airlight::quality {
namespace {

using scene::Error;
using scene::ExitCode;

constexpr int k_patience = 5;                       ///< [s]
constexpr std::int64_t k_most_of_packet = 1 << 18;  ///< [values]

enum class Packet : char { create_image = 4, update_image = 6 };

/// What is sent: little-endian numbers, words that end with a 0, and in front how long all of it is.
class Message {
 public:
  explicit Message(Packet packet) : bytes_(sizeof(std::uint32_t), '\0') {
    static_assert(std::endian::native == std::endian::little);
    bytes_ += static_cast<char>(packet);
  }
  template <typename Number>
  Message& number(Number value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Message& word(const std::string& text) {
    bytes_.append(text.c_str(), text.size() + 1);
    return *this;
  }
  const std::string& finished() {
    const auto length = static_cast<std::uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof length);
    return bytes_;
  }

 private:
  std::string bytes_;
};

}  // namespace

Tev::Tev(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == address.size())
    throw Error(ExitCode::usage, "--tev", fmt::format("'{}' is not HOST:PORT", address),
                fmt::format("tev listens at {}", k_address));
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const std::string host = address.substr(0, colon), port = address.substr(colon + 1);
  std::string problem;
  if (const int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found); error != 0)
    problem = gai_strerror(error);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, [](addrinfo* list) {
    if (list) freeaddrinfo(list);
  });
  for (const addrinfo* at = found; at && socket_ < 0; at = at->ai_next) {
    socket_ = socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC, at->ai_protocol);
    if (socket_ < 0) continue;
    const timeval patience{k_patience, 0};
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    if (connect(socket_, at->ai_addr, at->ai_addrlen) == 0) break;
    problem = std::strerror(errno);
    close();
  }
  if (socket_ < 0)
    throw Error(ExitCode::bad_file, "--tev", fmt::format("no tev answers at {}: {}", address, problem),
                "start tev first, or leave out --tev");
}

Tev::~Tev() {
  close();
}

void Tev::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

void Tev::send(const std::string& packet) {
  std::size_t sent = 0;
  while (socket_ >= 0 && sent < packet.size()) {
    const ssize_t now = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    if (now > 0)
      sent += static_cast<std::size_t>(now);
    else if (errno != EINTR)
      close();
  }
}

void Tev::show(const std::string& name, const frame::FrameImages& images) {
  const FrameLayers layers(images);
  Message create(Packet::create_image);
  create.number(char{0}).word(name).number(std::int32_t{images.size.x}).number(std::int32_t{images.size.y});
  create.number(static_cast<std::int32_t>(layers.channels().size()));
  for (const auto& [channel, values] : layers.channels()) create.word(channel);
  send(create.finished());

  const int rows = static_cast<int>(std::max<std::int64_t>(k_most_of_packet / images.size.x, 1));
  for (const auto& [channel, values] : layers.channels()) {
    for (int y = 0; y < images.size.y; y += rows) {
      const int height = std::min(rows, images.size.y - y);
      Message update(Packet::update_image);
      update.number(char{0}).word(name).number(std::int32_t{1}).word(channel);
      for (const int side : {0, y, images.size.x, height}) update.number(std::int32_t{side});
      update.number(std::int64_t{0}).number(std::int64_t{1});  // where its values begin, and their step
      const std::size_t width = static_cast<std::size_t>(images.size.x);
      const std::size_t first = static_cast<std::size_t>(y) * width;
      for (std::size_t i = first; i < first + static_cast<std::size_t>(height) * width; ++i)
        update.number(values.first[i * values.step]);
      send(update.finished());
    }
  }
}

}  // namespace airlight::quality
