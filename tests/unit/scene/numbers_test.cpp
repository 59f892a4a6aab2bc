#include "scene/numbers.h"

#include <gtest/gtest.h>

#include "scene/error.h"

namespace airlight::scene {
namespace {

TEST(Numbers, AreReadExactly) {
  EXPECT_EQ(parse_count("", "2147483647"), 2147483647);
  EXPECT_EQ(parse_number("", "-1.5e-3"), -1.5e-3);
  EXPECT_EQ(parse_pair("", "-1,2e1"), glm::dvec2(-1.0, 20.0));
  EXPECT_EQ(parse_vector("", "-1,2,3e2"), glm::dvec3(-1.0, 2.0, 300.0));
  EXPECT_EQ(parse_colour("", "1,2,3"), glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(parse_colour("", "0.5"), glm::dvec3(0.5));
  EXPECT_EQ(parse_size("", "640x480"), glm::ivec2(640, 480));
}

TEST(Numbers, RefuseWhatIsNotOneNumber) {
  for (const char* text : {"", " 1", "1 ", "1x", "x", "0", "-1", "+1", "1.0", "1e3", "0x10", "2147483648"}) {
    EXPECT_THROW(parse_count("", text), Error) << text;
  }
  for (const char* text : {"", " 1", "1 ", "1m", "nan", "inf", "-inf", "1e999", "1,2"}) {
    EXPECT_THROW(parse_number("", text), Error) << text;
  }
}

TEST(Numbers, RefuseWrongCounts) {
  for (const char* text : {"", "1", "1,2", "1,2,3,4", "1,,3", "1,2,nan", "1,2,3,"}) {
    EXPECT_THROW(parse_vector("", text), Error) << text;
  }
  for (const char* text : {"", "1", "1,2,3", "1,", "1,inf"}) {
    EXPECT_THROW(parse_pair("", text), Error) << text;
  }
  for (const char* text : {"", "1,2", "1,2,3,4", "1,,3", "nan", "1,2,inf"}) {
    EXPECT_THROW(parse_colour("", text), Error) << text;
  }
  for (const char* text : {"", "5", "x", "5x", "5x5x5", "5X5", "5x5.0", "99999999999x1"}) {
    EXPECT_THROW(parse_size("", text), Error) << text;
  }
}

TEST(Numbers, ErrorsNameTheOption) {
  try {
    parse_number("--fov", "wide");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "--fov: 'wide' is not a finite number");
    EXPECT_EQ(error.exit_code, ExitCode::usage);
  }
}

TEST(Split, KeepsEmptyParts) {
  EXPECT_EQ(split("a,,b", ','), (std::vector<std::string_view>{"a", "", "b"}));
  EXPECT_EQ(split("", ','), (std::vector<std::string_view>{""}));
}

}  // namespace
}  // namespace airlight::scene
