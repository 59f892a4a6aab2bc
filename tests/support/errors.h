#pragma once

#include <functional>
#include <initializer_list>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/error.h"

namespace airlight::tests {

/// Expects an error of that code, one line that has all of the texts.
inline void expect_error(scene::ExitCode code, std::initializer_list<std::string> texts,
                         const std::function<void()>& act) {
  try {
    act();
    ADD_FAILURE() << "no error; expected one with: " << *texts.begin();
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.exit_code, code) << error.what();
    for (const std::string& text : texts) EXPECT_THAT(error.what(), testing::HasSubstr(text));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
  }
}

}  // namespace airlight::tests
