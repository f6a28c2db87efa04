// Tables and files for tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "in_folder.hpp"
#include "table/table.hpp"

namespace dolp {

using TableFiles = InFolder;

/// A table with numbers that need many digits, NaN and infinity.
inline TableValues sample_table(std::size_t thetas, std::size_t sigmas, std::size_t qs) {
  TableValues table;
  for (std::size_t i = 0; i < thetas; ++i)
    table.axes[Axis::kTheta].push_back(90.0 - static_cast<double>(i) / 3.0);  // descending
  for (std::size_t i = 0; i < sigmas; ++i) table.axes[Axis::kSigma].push_back(0.05 * static_cast<double>(i + 1));
  for (std::size_t i = 0; i < qs; ++i) table.axes[Axis::kQ].push_back(1.5 + static_cast<double>(i) / 7.0);
  double seed = 0.0;
  for (const Quantity quantity : kAllQuantities) {
    std::vector<double>& values = table[quantity];
    for (std::size_t i = 0; i < table.size(); ++i) values.push_back(std::sin(seed += 1.0) * 1e-3);
    values.back() = std::numeric_limits<double>::quiet_NaN();
  }
  table[Quantity::kErrorEstimate].front() = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < table.size(); ++i) table.status.push_back(static_cast<std::uint32_t>(i % 16));
  for (std::size_t i = 0; i < sigmas; ++i) table.wind_m_s.push_back(5.0 * static_cast<double>(i));
  table.index_n = {{8.0, 10.0}, {1.5, 1.6}};
  table.index_k = {{9.0}, {0.1}};
  table.attributes = {
      {"title", "Stainless steel, 10.6 µm"}, {"tolerance", 1e-4}, {"scene", "a = 1\nb = 2\n"}, {"driver", ""}};
  return table;
}

inline void expect_same(const std::vector<double>& actual, const std::vector<double>& expected, const char* name) {
  ASSERT_EQ(actual.size(), expected.size()) << name;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_TRUE(actual[i] == expected[i] || (std::isnan(actual[i]) && std::isnan(expected[i])))
        << name << "[" << i << "]: " << actual[i] << " instead of " << expected[i];
  }
}

inline void expect_same(const TableValues& actual, const TableValues& expected) {
  EXPECT_EQ(actual.axes, expected.axes);
  EXPECT_EQ(actual.wind_m_s, expected.wind_m_s);
  for (const Quantity quantity : kAllQuantities)
    expect_same(actual[quantity], expected[quantity], describe(quantity).name);
  EXPECT_EQ(actual.status, expected.status);
  for (const TableCurve& described : kTableCurves) EXPECT_EQ(actual.*described.curve, expected.*described.curve);
  EXPECT_EQ(actual.stokes_units, expected.stokes_units);
  EXPECT_EQ(actual.attributes, expected.attributes);
}
}  // namespace dolp
