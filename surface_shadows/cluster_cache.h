#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "surface_shadows/triangle_clusters.h"

namespace airlight::surface_shadows {

/// In words, all that `make_triangle_clusters` with these arguments depends on, and the version of what is
/// kept.
std::string key_of_clusters(const scene::Geometry& geometry, std::span<const std::uint32_t> order,
                            std::span<const std::uint32_t> part_of_triangle, const ClusterSettings& settings,
                            std::span<const std::uint32_t> object_of_triangle);

/// Clusters that an earlier run has kept; none where it has not.
/// @throws scene::Error (bad_file) for a file that is damaged, or of another key than its name says
std::optional<TriangleClusters> load_clusters(const std::filesystem::path& folder, const std::string& key);

/// Keeps them: a file named by a hash of the key, with the key, the clusters, and a hash of all that.
/// @param folder made where it is missing
/// @throws scene::Error (bad_file) where they cannot be written
void save_clusters(const std::filesystem::path& folder, const std::string& key,
                   const TriangleClusters& clusters);

}  // namespace airlight::surface_shadows
