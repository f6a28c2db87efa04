// A loop over independent items on all cores this process may use: std::thread, which the tables need no library
// beyond.
#pragma once

#include <cstddef>
#include <dolp/errors.hpp>
#include <functional>

namespace dolp {

/// Calls body(first, last) for ranges of at most `grain` items that together cover [0, count) once, in any order. The
/// ranges do not depend on the number of threads, so neither does a result that each item, or each range, has a place
/// of its own for.
/// Errors: the first exception of `body` stops the loop and is thrown from here.
void parallel_ranges(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t first, std::size_t last)>& body);

/// Calls body(i) once for each i < count, likewise; `progress` is called from one thread at a time.
/// Errors: as above; a cancel by `progress` (Cancelled) stops the loop and is thrown from here.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, const Progress& progress);

}  // namespace dolp
