// A loop over independent items on all cores.
#pragma once

#include <cstddef>
#include <functional>

#include "model/moments.hpp"

namespace dolp {

/// Calls body(i) once for each i < count, in any order, on as many threads as the machine has cores; `progress` is
/// called from one thread at a time.
/// Errors: an exception of `body` or a cancel by `progress` (Cancelled) stops the loop and is thrown from here.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, const Progress& progress);

}  // namespace dolp
