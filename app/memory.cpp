#include "app/memory.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <sys/resource.h>

#include "scene/error.h"

namespace airlight::app {
namespace {

/// What Mesa's llvmpipe takes before it holds anything, of the address space (libraries, and arenas that it
/// never fills, and a usual grid) and of memory.
constexpr double k_driver_addresses = 700e6, k_driver_bytes = 120e6;

/// Of the CPU's and the driver's copies of a triangle, its corners and its material.
constexpr double k_bytes_per_triangle = 200.0;

/// Of a texture's texel, kept here, and with smaller levels a third more, handed over and kept by the driver.
constexpr std::size_t k_bytes_per_texel = 4 + 2 * 6;

/// Of a triangle's places in a texture, here and by the driver, or of its normals.
constexpr std::size_t k_bytes_of_corners = 48;

/// A line of a file of /proc, such as "VmSize:   1234 kB" [bytes]; none where there is none.
std::optional<double> proc_bytes(const char* file, const std::string& key) {
  std::ifstream stream(file);
  std::string word;
  while (stream >> word) {
    double kilobytes = 0.0;
    if (word == key && stream >> kilobytes) return 1024.0 * kilobytes;
  }
  return std::nullopt;
}

/// What is left of the addresses that this process may use; none without a limit.
std::optional<double> addresses_left() {
  rlimit limit{};
  const auto used = proc_bytes("/proc/self/status", "VmSize:");
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || !used) return std::nullopt;
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - *used);
}

}  // namespace

std::size_t bytes_of_looks(const scene::Geometry& geometry) {
  return k_bytes_per_texel * scene::texel_count(geometry) +
         k_bytes_of_corners * (geometry.texture_places.size() + geometry.normals.size());
}

void require_memory(const Holding& holding) {
  constexpr int k_largest_face = 16384;  // more, the driver may refuse by itself
  const double pixels = static_cast<double>(holding.size.x) * static_cast<double>(holding.size.y);
  const double image = pixels * static_cast<double>(holding.bytes_per_pixel);
  const double side = holding.shadow_map > k_largest_face ? 0.0 : holding.shadow_map;
  const double shadow_map = 6.0 * sizeof(float) * side * side;
  const double scene = holding.scenes * (k_bytes_per_triangle * static_cast<double>(holding.triangles) +
                                         static_cast<double>(holding.looks));

  const auto require = [&](double driver, std::optional<double> left, const char* of_what,
                           const char* remedy) {
    if (!left || driver + scene + shadow_map + image <= *left) return;
    std::string where = "memory", what = "the driver and the scene alone take", ask;
    double bytes = driver + scene;
    if (bytes <= *left) {
      bytes += image + shadow_map;
      const bool is_image = image >= shadow_map;
      where = is_image ? "--size" : "--shadow-map";
      what = is_image ? fmt::format("an image of {}x{} pixels takes", holding.size.x, holding.size.y)
                      : fmt::format("a shadow map of {} texels a side takes", holding.shadow_map);
      ask = fmt::format("ask for a smaller {}, or ", is_image ? "image" : "one");
    }
    throw scene::Error(
        scene::ExitCode::driver, where,
        fmt::format("{} about {:.2g} GB, and {:.2g} GB {}", what, 1e-9 * bytes, 1e-9 * *left, of_what),
        ask + remedy);
  };
  require(k_driver_addresses, addresses_left(), "are left of the address space (ulimit -v)", "allow more");
  require(k_driver_bytes, proc_bytes("/proc/meminfo", "MemAvailable:"), "of memory are free", "free some");
}

}  // namespace airlight::app
