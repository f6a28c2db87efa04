// Checks of the parameters that a fit varies.
#pragma once

#include <dolp/fit.hpp>
#include <string>

namespace dolp::fit {

/// Refuses a range that the scene's key does not have. Errors: InputError that begins with `origin`: an unknown key or
/// one that is no number, low >= high, a start outside of them, values out of the key's range.
void check_range(const FitRange& range, const std::string& origin);

}  // namespace dolp::fit
