#include "gpu/timer.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "support/gpu_context.h"

namespace airlight::gpu {
namespace {

using tests::gpu_context;

void sleep_ms(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

class StageTimerWith : public testing::TestWithParam<StageClock> {};

TEST_P(StageTimerWith, GivesAnInnerStageItsTimeAndTheOuterTheRest) {
  StageTimer timer(gpu_context(), GetParam());
  const auto start = std::chrono::steady_clock::now();
  timer.time("outer", [&] {
    sleep_ms(10);
    timer.time("inner", [] { sleep_ms(40); });
    sleep_ms(10);
  });
  timer.time("inner", [] { sleep_ms(20); });
  const auto stages = timer.milliseconds();
  const double total =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  ASSERT_EQ(stages.size(), 2u);
  // A busy machine may stretch a sleep, but not shorten it. The GPU's clock is read when its queue comes to
  // it, which on a software driver, a thread among others, can be late; otherwise 1 ms is what two clocks may
  // differ.
  const double late = GetParam() == StageClock::gpu ? 15.0 : 1.0;
  EXPECT_GE(stages.at("inner"), 60.0 - late);
  EXPECT_GE(stages.at("outer"), 20.0 - late);
  EXPECT_LT(stages.at("outer"), stages.at("inner"));
  EXPECT_LE(stages.at("inner") + stages.at("outer"), total + late) << "nothing is counted twice";
}

TEST_P(StageTimerWith, TellsPartsOfAFrameApart) {
  StageTimer timer(gpu_context(), GetParam());
  timer.time("stage", [] {});
  timer.begin_part(0);
  timer.time("stage", [] {});
  timer.time("own", [] {});
  timer.begin_part(1);
  timer.time("stage", [] {});
  timer.begin_part({});
  timer.time("after", [] {});
  EXPECT_EQ(timer.milliseconds().size(), 3u);
  EXPECT_EQ(timer.milliseconds(0).size(), 2u);
  EXPECT_EQ(timer.milliseconds(1).size(), 1u);
  EXPECT_TRUE(timer.milliseconds(2).empty());
  EXPECT_GE(timer.milliseconds().at("stage"),
            timer.milliseconds(0).at("stage") + timer.milliseconds(1).at("stage"));
}

TEST_P(StageTimerWith, CountsWorkOfTheGpu) {
  StageTimer timer(gpu_context(), GetParam());
  const Buffer buffer(1 << 26);
  timer.time("clear", [&] { buffer.clear(1); });
  timer.time("nothing", [] {});
  const auto stages = timer.milliseconds();
  EXPECT_GT(stages.at("clear"), 0.0);
  EXPECT_GE(stages.at("nothing"), 0.0);
  gpu_context().check();
}

INSTANTIATE_TEST_SUITE_P(Clocks, StageTimerWith, testing::Values(StageClock::gpu, StageClock::wall));

TEST(StageTimer, ThatIsOffRunsTheStages) {
  StageTimer timer(nullptr);
  int runs = 0;
  timer.time("outer", [&] { timer.time("inner", [&] { ++runs; }); });
  EXPECT_EQ(runs, 1);
  EXPECT_TRUE(timer.milliseconds().empty());
}

TEST(StageTimer, AsksTheGpuOnlyWhereThereIsOne) {
  EXPECT_EQ(stage_clock({.renderer = "", .version = "", .is_software = true}), StageClock::wall);
  EXPECT_EQ(stage_clock({.renderer = "", .version = "", .is_software = false}), StageClock::gpu);
}

}  // namespace
}  // namespace airlight::gpu
