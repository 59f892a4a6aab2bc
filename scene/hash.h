#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace airlight::scene {

/// FNV-1a of 128 bits, as 32 hexadecimal digits. Fowler, Noll, Vo, "The FNV Non-Cryptographic Hash
/// Algorithm".
class Hash {
 public:
  void add(std::span<const std::byte> bytes) {
    constexpr auto k_prime = (static_cast<Word>(1) << 88) + 0x13b;
    for (const std::byte byte : bytes) word_ = (word_ ^ static_cast<Word>(byte)) * k_prime;
  }

  template <typename T>
  void add(const std::vector<T>& values) {
    add(std::as_bytes(std::span(values)));
  }
  void add(std::string_view text) { add(std::as_bytes(std::span(text))); }

  std::string text() const {
    return fmt::format("{:016x}{:016x}", static_cast<std::uint64_t>(word_ >> 64),
                       static_cast<std::uint64_t>(word_));
  }

 private:
  using Word = unsigned __int128;
  Word word_ = static_cast<Word>(0x6c62272e07bb0142) << 64 | 0x62b821756295c58d;
};

inline std::string hash_of(std::string_view text) {
  Hash hash;
  hash.add(std::as_bytes(std::span(text)));
  return hash.text();
}

}  // namespace airlight::scene
