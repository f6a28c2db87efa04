#pragma once

#include <cstddef>
#include <dolp/errors.hpp>
#include <functional>

namespace dolp {

/// Calls body(first, last) on all cores that the process may use, for ranges that cover [0, count) once, in any order.
/// A range has `grain` items, or fewer at the end; the ranges do not depend on the number of threads. Errors: the first
/// exception of `body`, which stops the loop.
void parallel_ranges(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t first, std::size_t last)>& body);

/// Calls body(i) once for each i < count, like parallel_ranges(). Calls `progress` after each `grain` items, never on
/// two threads at once. Errors: the first exception of `body`; Cancelled if `progress` returns false. Both stop the
/// loop.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body,
                  const Progress& progress = nullptr);

}  // namespace dolp
