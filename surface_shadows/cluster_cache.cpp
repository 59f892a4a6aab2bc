#include "surface_shadows/cluster_cache.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "scene/error.h"
#include "scene/hash.h"
#include "scene/kept_file.h"

namespace airlight::surface_shadows {
namespace {

using scene::Error;
using scene::ExitCode;

/// Another one where the same arguments give other clusters, or their bytes mean something else.
constexpr int k_version = 1;

std::filesystem::path file_of(const std::filesystem::path& folder, const std::string& key) {
  return folder / (scene::hash_of(key) + ".clusters");
}

/// Appends how many there are, and their bytes.
template <class Values>
void put(std::string& bytes, const Values& values) {
  using Value = typename Values::value_type;
  static_assert(std::is_trivially_copyable_v<Value>);
  const std::uint64_t count = values.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(values.data()), count * sizeof(Value));
}

/// The reverse; takes them off the front. @returns whether there were so many
template <class Values>
bool take(std::string_view& bytes, Values& values) {
  using Value = typename Values::value_type;
  std::uint64_t count = 0;
  if (bytes.size() < sizeof count) return false;
  std::memcpy(&count, bytes.data(), sizeof count);
  bytes.remove_prefix(sizeof count);
  if (count > bytes.size() / sizeof(Value)) return false;
  values.resize(count);
  std::memcpy(values.data(), bytes.data(), count * sizeof(Value));
  bytes.remove_prefix(count * sizeof(Value));
  return true;
}

}  // namespace

std::string key_of_clusters(const scene::Geometry& geometry, std::span<const std::uint32_t> order,
                            std::span<const std::uint32_t> part_of_triangle, const ClusterSettings& settings,
                            std::span<const std::uint32_t> object_of_triangle) {
  scene::Hash hash;
  hash.add(geometry.positions);
  hash.add(geometry.triangles);
  for (const std::span<const std::uint32_t> numbers : {order, part_of_triangle, object_of_triangle}) {
    hash.add(fmt::format("{} ", numbers.size()));
    hash.add(std::as_bytes(numbers));
  }
  return fmt::format("clusters of version {}\ntriangles {}\nat most {}{}\n", k_version, hash.text(),
                     settings.most_triangles, settings.has_capsules ? ", capsules" : "");
}

std::optional<TriangleClusters> load_clusters(const std::filesystem::path& folder, const std::string& key) {
  const std::filesystem::path file = file_of(folder, key);
  if (std::error_code error; !std::filesystem::exists(file, error)) return {};
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  TriangleClusters clusters;
  std::string kept_key, hash;
  std::string_view rest = bytes;
  const bool is_whole =
      stream && take(rest, kept_key) && take(rest, clusters.clusters) && take(rest, clusters.triangles);
  const std::size_t hashed = bytes.size() - rest.size();
  if (!is_whole || !take(rest, hash) || !rest.empty() ||
      hash != scene::hash_of(std::string_view(bytes).substr(0, hashed)) || kept_key != key)
    throw Error(ExitCode::bad_file, file.string(), "it does not hold the clusters that its name says",
                "remove it");
  return clusters;
}

void save_clusters(const std::filesystem::path& folder, const std::string& key,
                   const TriangleClusters& clusters) {
  std::string bytes;
  put(bytes, key);
  put(bytes, clusters.clusters);
  put(bytes, clusters.triangles);
  put(bytes, scene::hash_of(bytes));
  scene::make_cache_folder(folder);
  scene::write_whole(file_of(folder, key), [&](const std::filesystem::path& part) {
    std::ofstream stream(part, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw Error(ExitCode::bad_file, part.string(), "it cannot be written");
  });
}

}  // namespace airlight::surface_shadows
