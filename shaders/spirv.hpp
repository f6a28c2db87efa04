#pragma once

#include <cstdint>
#include <span>

namespace dolp::spirv {

#define DOLP_ENTRY_POINT(name) extern const std::span<const std::uint32_t> name##_float, name##_double
DOLP_ENTRY_POINT(moments);
DOLP_ENTRY_POINT(moments_rows);
DOLP_ENTRY_POINT(moments_sky);
DOLP_ENTRY_POINT(moments_sky_rows);
DOLP_ENTRY_POINT(moments_responses);
DOLP_ENTRY_POINT(moments_responses_rows);
DOLP_ENTRY_POINT(slopes);
DOLP_ENTRY_POINT(slopes_sky);
DOLP_ENTRY_POINT(slopes_orders);
DOLP_ENTRY_POINT(slopes_sky_orders);
DOLP_ENTRY_POINT(slopes_responses);
DOLP_ENTRY_POINT(masking_table);
// Entry points that exist only in float; the second one belongs to bench/.
DOLP_ENTRY_POINT(arithmetic);
DOLP_ENTRY_POINT(product_rule);
#undef DOLP_ENTRY_POINT

}  // namespace dolp::spirv
