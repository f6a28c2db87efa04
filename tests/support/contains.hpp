#pragma once

#include <gtest/gtest.h>

#include <string_view>

namespace dolp {

/// Whether `text` contains `part`. If EXPECT_TRUE or EXPECT_FALSE fails, it prints both.
inline testing::AssertionResult contains(std::string_view text, std::string_view part) {
  if (text.find(part) != std::string_view::npos)
    return testing::AssertionSuccess() << "found \"" << part << "\" in:\n" << text;
  return testing::AssertionFailure() << "no \"" << part << "\" in:\n" << text;
}

}  // namespace dolp
