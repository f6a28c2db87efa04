#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace dolp {

/// Called with the number of finished items; returning false cancels (the work then throws Cancelled).
using Progress = std::function<bool(std::size_t done, std::size_t total)>;
struct Cancelled {
  std::string left;  ///< what is there all the same, and how to go on with it; empty: nothing is
};

}  // namespace dolp
