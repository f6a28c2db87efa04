// The compiled entry points, embedded at build time (see CMakeLists.txt and embed.cmake).
#pragma once

#include <cstdint>
#include <span>

namespace dolp::spirv {

// NOLINTBEGIN(readability-identifier-naming): named as their files.
extern const std::span<const std::uint32_t> moments_float;
extern const std::span<const std::uint32_t> moments_double;
extern const std::span<const std::uint32_t> moments_rows_float;
extern const std::span<const std::uint32_t> moments_rows_double;
extern const std::span<const std::uint32_t> moments_sky_float;
extern const std::span<const std::uint32_t> moments_responses_float;
extern const std::span<const std::uint32_t> moments_sky_double;
extern const std::span<const std::uint32_t> moments_responses_double;
extern const std::span<const std::uint32_t> moments_sky_rows_float;
extern const std::span<const std::uint32_t> moments_responses_rows_float;
extern const std::span<const std::uint32_t> moments_sky_rows_double;
extern const std::span<const std::uint32_t> moments_responses_rows_double;
extern const std::span<const std::uint32_t> slopes_float;
extern const std::span<const std::uint32_t> slopes_double;
extern const std::span<const std::uint32_t> slopes_sky_float;
extern const std::span<const std::uint32_t> slopes_responses_float;
extern const std::span<const std::uint32_t> slopes_sky_double;
extern const std::span<const std::uint32_t> slopes_responses_double;
extern const std::span<const std::uint32_t> masking_table_float;
extern const std::span<const std::uint32_t> masking_table_double;
extern const std::span<const std::uint32_t> mueller_float;
extern const std::span<const std::uint32_t> mueller_double;
// Of the benchmark, in bench/:
extern const std::span<const std::uint32_t> product_rule_float;
extern const std::span<const std::uint32_t> arithmetic_peak_float;
// NOLINTEND(readability-identifier-naming)

}  // namespace dolp::spirv
