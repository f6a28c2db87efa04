// The picture of a fit.
#pragma once

#include <string>

namespace dolp {

/// The text of host/tools/plot_fit.py.
extern const char* const kFitPictureScript;

/// Draws a report, in JSON, with Python and Matplotlib.
/// Errors: IoError when they are missing or the picture cannot be written.
void draw_fit(const std::string& json, const std::string& path);

}  // namespace dolp
