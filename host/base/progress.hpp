#pragma once

#include <cstddef>
#include <functional>

namespace dolp {

/// Called with the number of finished items; returning false cancels (the work then throws Cancelled).
using Progress = std::function<bool(std::size_t done, std::size_t total)>;
struct Cancelled {};

}  // namespace dolp
