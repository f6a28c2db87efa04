// What the window says in words.
#pragma once

#include <string>
#include <vector>

#include "explore/session.hpp"

namespace dolp::explore {

/// Where the curve polarises most and how sure that is.
std::string peak_text(const Session& session);

/// Which radiation makes the polarisation there: parts of Q/I that add up.
std::string cause_text(const Session& session);

/// What is under the cursor.
std::string cursor_text(const Session& session);

/// What one effect does at the peak: "Q/I +3.61 without it"; empty where that is not known.
std::string without_text(const Session& session, const std::string& effect);

/// What the finished curve cost, in three lines: time, work, error.
std::vector<std::string> cost_lines(const Session& session);

}  // namespace dolp::explore
