// Choices of a scene that exclude one another, and the changes that follow when one is chosen.
#pragma once

#include <string>
#include <vector>

#include "explore/scene_edits.hpp"

namespace dolp::explore {

/// The word of a value, without quotes.
std::string word_of(const Value& value);

/// The changes that `chosen` asks for elsewhere: each choice of the scene that excludes a chosen one gets a word that
/// goes with it. Empty where nothing is in the way.
std::vector<Setting> asked_for(const Scene& scene, const std::vector<Setting>& chosen);

/// The choices of one table as a scene has them: restoring the table makes these choices.
std::vector<Setting> choices_of(const Scene& scene, const std::string& table);

}  // namespace dolp::explore
