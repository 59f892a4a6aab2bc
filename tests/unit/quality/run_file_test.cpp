#include "quality/run_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "scene/error.h"
#include "scene/hash.h"

namespace airlight::quality {
namespace {

using scene::Error;
using testing::ElementsAre;

TEST(Shards, HoldEachKeyOnceAndAboutAsManyEach) {
  std::vector<int> held(5, 0);
  for (int i = 0; i < 1000; ++i) {
    const std::string key = scene::hash_of(fmt::format("{}", i));
    int holders = 0;
    for (int number = 1; number <= 5; ++number) {
      if (!Shard{number, 5}.holds(key)) continue;
      ++holders;
      ++held[static_cast<std::size_t>(number - 1)];
    }
    EXPECT_EQ(holders, 1);
    EXPECT_TRUE(Shard{}.holds(key));
  }
  EXPECT_GT(*std::min_element(held.begin(), held.end()), 150);
}

TEST(Hashes, AreThoseOfTheAlgorithm) {
  // The authors' offset basis, and their test vector of "a".
  EXPECT_EQ(scene::hash_of(""), "6c62272e07bb014262b821756295c58d");
  EXPECT_EQ(scene::hash_of("a"), "d228cb696f1a8caf78912b704e4a8964");
}

class RunFiles : public testing::Test {
 protected:
  RunFiles() { std::filesystem::create_directories(folder_); }
  ~RunFiles() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("airlight-runs-{}", getpid());
};

TEST_F(RunFiles, KeepLinesAndDropTheTornOne) {
  write("runs.jsonl", "{\"key\":\"a\"}\n{\"key\":\"b\"}\n{\"key\":\"c");
  write("runs-1-of-2.jsonl", "{\"key\":\"d\"}\n{\"ke");
  write("other.jsonl", "no run\n");
  {
    RunFile file(folder_, {});
    EXPECT_THAT(file.keys(), ElementsAre("a", "b", "d"));
    file.append("{\"key\":\"e\"}");
  }
  EXPECT_THAT(whole_lines(folder_ / "runs.jsonl"),
              ElementsAre("{\"key\":\"a\"}", "{\"key\":\"b\"}", "{\"key\":\"e\"}"));
  // What another shard may be writing is left to it.
  EXPECT_EQ(std::filesystem::file_size(folder_ / "runs-1-of-2.jsonl"), 16u);
}

TEST_F(RunFiles, AreLocked) {
  const RunFile file(folder_, {1, 2});
  EXPECT_NO_THROW(RunFile(folder_, {2, 2}));
  EXPECT_THROW(RunFile(folder_, {1, 2}), Error);
}

TEST_F(RunFiles, ThatAreNoneAreErrors) {
  write("runs.jsonl", "{\"key\":\"a\"}\n[]\n");
  EXPECT_THROW(RunFile(folder_, {}), Error);
  EXPECT_THROW(RunFile(folder_ / "nosuch", {}), Error);
  EXPECT_THROW(run_files(folder_ / "nosuch"), Error);
}

}  // namespace
}  // namespace airlight::quality
