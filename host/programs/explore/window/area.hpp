#pragma once

namespace dolp::explore {

/// A rectangle in pixels of the window, y downwards.
struct Area {
  float left = 0.0F;
  float top = 0.0F;
  float right = 0.0F;
  float bottom = 0.0F;
};

}  // namespace dolp::explore
