// The public header, and the names that the window uses of it.
#pragma once

#include <algorithm>
#include <dolp/dolp.hpp>
#include <string>
#include <vector>

namespace dolp::explore {

inline bool is_bistatic(const Scene& scene) { return scene.word("geometry.mode") == "bistatic"; }

inline bool contains(const std::vector<std::string>& keys, const std::string& key) {
  return std::ranges::find(keys, key) != keys.end();
}

}  // namespace dolp::explore
