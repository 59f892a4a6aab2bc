#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

namespace airlight::tests {

/// In the place of a tev: keeps what it is told. It reads packets as tev documents them, and nothing of ours.
class TevListener {
 public:
  struct Shown {
    std::int32_t width = 0, height = 0;
    std::map<std::string, std::vector<float>> channels;
  };

  TevListener() : listening_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof any;
    if (bind(listening_, reinterpret_cast<sockaddr*>(&any), size) != 0 || listen(listening_, 1) != 0 ||
        getsockname(listening_, reinterpret_cast<sockaddr*>(&any), &size) != 0)
      throw std::runtime_error("no port is free");
    address = fmt::format("127.0.0.1:{}", ntohs(any.sin_port));
  }
  ~TevListener() { stop_listening(); }
  TevListener(const TevListener&) = delete;
  TevListener& operator=(const TevListener&) = delete;

  void stop_listening() {
    if (listening_ >= 0) ::close(listening_);
    listening_ = -1;
  }

  /// Takes all that comes until the other end has closed, or so many packets.
  void listen_to_all(std::optional<int> packets = {}) {
    const int connection = accept(listening_, nullptr, nullptr);
    std::string length;
    for (int i = 0; packets != i && read(connection, 4, length); ++i) {
      std::uint32_t bytes = 0;
      std::memcpy(&bytes, length.data(), sizeof bytes);
      packet_.clear();
      if (bytes < 5 || !read(connection, bytes - 4, packet_)) throw std::runtime_error("a packet is cut");
      at_ = 0;
      take();
      if (at_ != packet_.size()) throw std::runtime_error("a packet has another length than it says");
    }
    ::close(connection);
  }

  std::string address;
  std::map<std::string, Shown> shown;

 private:
  static bool read(int connection, std::size_t bytes, std::string& into) {
    into.assign(bytes, '\0');
    return recv(connection, into.data(), bytes, MSG_WAITALL) == static_cast<ssize_t>(bytes);
  }
  template <typename Number>
  Number number() {
    Number value;
    if (at_ + sizeof value > packet_.size()) throw std::runtime_error("a packet is too short");
    std::memcpy(&value, packet_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string word() {
    const std::string text = packet_.c_str() + at_;
    at_ += text.size() + 1;
    return text;
  }
  void take() {
    const auto type = number<char>();
    number<char>();  // whether it is to be looked at
    Shown& image = shown[word()];
    if (type == 4) {
      image = {};
      image.width = number<std::int32_t>();
      image.height = number<std::int32_t>();
      const auto count = number<std::int32_t>();
      for (int i = 0; i < count; ++i)
        image.channels[word()].resize(static_cast<std::size_t>(image.width * image.height), -1.0f);
    } else if (type == 6) {
      const auto count = number<std::int32_t>();
      std::vector<std::string> names;
      for (int i = 0; i < count; ++i) names.push_back(word());
      const auto x = number<std::int32_t>(), y = number<std::int32_t>(), width = number<std::int32_t>(),
                 height = number<std::int32_t>();
      std::vector<std::int64_t> offsets, steps;
      for (int i = 0; i < count; ++i) offsets.push_back(number<std::int64_t>());
      for (int i = 0; i < count; ++i) steps.push_back(number<std::int64_t>());
      const std::size_t first = at_;
      for (std::size_t i = 0; i < names.size(); ++i) {
        for (std::int32_t pixel = 0; pixel < width * height; ++pixel) {
          at_ = first + sizeof(float) * static_cast<std::size_t>(offsets[i] + steps[i] * pixel);
          image.channels.at(names[i]).at(static_cast<std::size_t>((y + pixel / width) * image.width + x +
                                                                  pixel % width)) = number<float>();
        }
      }
    } else {
      throw std::runtime_error(fmt::format("a packet of type {}", static_cast<int>(type)));
    }
  }

  int listening_;
  std::string packet_;
  std::size_t at_ = 0;
};

}  // namespace airlight::tests
