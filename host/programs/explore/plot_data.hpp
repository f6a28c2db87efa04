// The plots of the window for a picture of lines and text.
#pragma once

#include <string>

#include "explore/scale.hpp"
#include "explore/session.hpp"

namespace dolp::explore {

/// The text of host/tools/plot_view.py.
extern const char* const kPlotScript;

/// The visible curves between these axes, the measured points, and the map where it is shown, in JSON for the script.
/// Units: those of the labels; values that the model does not give are null.
std::string plot_json(const Session& session, const Scale& x, const Scale& y);

}  // namespace dolp::explore
