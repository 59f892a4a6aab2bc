#include "surface_shadows/cluster_cache.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "frame/clusters.h"
#include "support/errors.h"
#include "support/scenes.h"

namespace airlight::surface_shadows {
namespace {

namespace fs = std::filesystem;

class ClusterCache : public testing::Test {
 protected:
  ClusterCache()
      : folder_(fs::path(testing::TempDir()) /
                ("airlight_clusters_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))),
        order_(frame::make_clusters(geometry_).order) {
    fs::remove_all(folder_);
  }
  ~ClusterCache() override { fs::remove_all(folder_); }

  fs::path only_file() const { return fs::directory_iterator(folder_)->path(); }

  fs::path folder_;
  scene::Geometry geometry_ = tests::builtin("cornell").geometry;
  std::vector<std::uint32_t> order_;
};

TEST_F(ClusterCache, GivesBackEveryBit) {
  const TriangleClusters made = make_triangle_clusters(geometry_, order_, {}, {});
  const std::string key = key_of_clusters(geometry_, order_, {}, {}, {});
  EXPECT_FALSE(load_clusters(folder_, key)) << "there is no folder";
  save_clusters(folder_, key, made);
  EXPECT_FALSE(load_clusters(folder_, key + "other"));
  const auto kept = load_clusters(folder_, key);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->triangles, made.triangles);
  ASSERT_EQ(kept->clusters.size(), made.clusters.size());
  EXPECT_EQ(std::memcmp(kept->clusters.data(), made.clusters.data(),
                        made.clusters.size() * sizeof(TriangleCluster)),
            0);
  const TriangleClusters none;
  save_clusters(folder_, "none", none);
  EXPECT_TRUE(load_clusters(folder_, "none")->clusters.empty());
}

TEST_F(ClusterCache, TellsApartWhateverClustersDependOn) {
  std::set<std::string> keys = {key_of_clusters(geometry_, order_, {}, {}, {})};
  const auto expect_new = [&](const char* what, const std::string& key) {
    EXPECT_TRUE(keys.insert(key).second) << what;
  };
  const std::vector<std::uint32_t> groups(order_.size(), 1);
  expect_new("size", key_of_clusters(geometry_, order_, {}, {.most_triangles = 8}, {}));
  expect_new("capsules", key_of_clusters(geometry_, order_, {}, {.has_capsules = false}, {}));
  expect_new("parts", key_of_clusters(geometry_, order_, groups, {}, {}));
  expect_new("objects", key_of_clusters(geometry_, order_, {}, {}, groups));
  std::vector<std::uint32_t> order = order_;
  std::swap(order[0], order[1]);
  expect_new("order", key_of_clusters(geometry_, order, {}, {}, {}));
  scene::Geometry other = geometry_;
  other.positions[0].x += 1e-3f;
  expect_new("position", key_of_clusters(other, order_, {}, {}, {}));
  other = geometry_;
  std::swap(other.triangles[0].x, other.triangles[0].y);
  expect_new("triangle", key_of_clusters(other, order_, {}, {}, {}));
}

TEST_F(ClusterCache, DamagedAndForeignFilesAreErrorsThatNameThem) {
  const std::string key = key_of_clusters(geometry_, order_, {}, {}, {});
  save_clusters(folder_, key, make_triangle_clusters(geometry_, order_, {}, {}));
  const fs::path file = only_file();
  std::ifstream stream(file, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  const auto expect_refused = [&](const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
    tests::expect_error(scene::ExitCode::bad_file, {file.string(), "remove it"},
                        [&] { load_clusters(folder_, key); });
  };
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, whole.size() / 2, whole.size() - 1})
    expect_refused(whole.substr(0, size));
  expect_refused(whole + "x");
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 97) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
    expect_refused(damaged);
  }
  // A sound file, of other clusters.
  const fs::path other_folder = folder_ / "other";
  save_clusters(other_folder, "other", make_triangle_clusters(geometry_, order_, {}, {}));
  fs::copy_file(fs::directory_iterator(other_folder)->path(), file, fs::copy_options::overwrite_existing);
  tests::expect_error(scene::ExitCode::bad_file, {file.string()}, [&] { load_clusters(folder_, key); });
  tests::expect_error(scene::ExitCode::bad_file, {"/dev/null/cache", "--cache"},
                      [&] { save_clusters("/dev/null/cache", key, {}); });
}

}  // namespace
}  // namespace airlight::surface_shadows
