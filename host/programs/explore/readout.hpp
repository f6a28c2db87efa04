// Text that the window shows.
#pragma once

#include <string>
#include <vector>

#include "explore/session.hpp"

namespace dolp::explore {

/// The position of the curve's maximum of polarisation, and its uncertainty.
std::string peak_text(const Session& session);

/// The radiation that causes the polarisation there: parts of Q/I that add up.
std::string cause_text(const Session& session);

/// The values under the cursor.
std::string cursor_text(const Session& session);

/// Q/I at the peak with all effects and without one, in percent: "-14.36 → -59.59 %"; empty where it is unknown.
std::string without_text(const Session& session, const std::string& effect);

/// The same in a sentence; empty also where the model fails without the effect.
std::string without_words(const Session& session, const std::string& effect);

/// The command that writes the table of a scene, for a shell.
std::string table_command(const SceneEdits& edits);

/// The cost of the finished curve, in three lines: time, work, error.
std::vector<std::string> cost_lines(const Session& session);

}  // namespace dolp::explore
