// Loops over independent items on all cores that this process may use.
#pragma once

#include <cstddef>
#include <dolp/errors.hpp>
#include <functional>

namespace dolp {

/// Calls body(first, last) for ranges of at most `grain` items, in any order. The ranges cover [0, count) exactly once
/// and do not depend on the number of threads. If each range writes only its own results, the results do not depend on
/// the number of threads either. Errors: the first exception of `body` stops the loop and is thrown from here.
void parallel_ranges(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t first, std::size_t last)>& body);

/// Calls body(i) once for each i < count, in ranges of `grain` items. Calls `progress` after each range, never on two
/// threads at once. Errors, which stop the loop: the first exception of `body`; Cancelled if `progress` returns false.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, const Progress& progress,
                  std::size_t grain = 64);

}  // namespace dolp
