// Sessions of the window in files.
#pragma once

#include <string>

#include "explore/session.hpp"

namespace dolp::explore {

/// Writes scene, pins, snapshots, view, the path of the measured points and what a fit varies as TOML. Paths in it are
/// relative to its folder; skies of skies() are copied into it, as NAME_sky_ZENITH_HORIZON.csv. Errors: IoError.
void save_session(const Session& session, const std::string& path);

/// True for a file that save_session wrote; false also where it cannot be read.
bool is_session_file(const std::string& path);

/// Shows a file: measured points of a .csv, else a scene, or the session that save_session wrote.
/// Errors: InputError in one line; the session then is as it was.
void open_file(Session& session, const std::string& path);

}  // namespace dolp::explore
