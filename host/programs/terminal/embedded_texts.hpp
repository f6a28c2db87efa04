// The files that are built into the programs, as text.
#pragma once

#include <string_view>

namespace dolp {

std::string_view embedded_night_paint_toml();  ///< a scene for new users
std::string_view embedded_plot_view_py();      ///< a script that draws the plots of the window

// Scripts for shells. They call `dolp completion words -- WORD... :CURRENT` to complete the unfinished word CURRENT.
std::string_view embedded_dolp_bash();
std::string_view embedded_dolp_fish();
std::string_view embedded_dolp_zsh();
std::string_view embedded_description_man();  ///< the part of the manual page before the commands
std::string_view embedded_end_man();          ///< the part after the commands

}  // namespace dolp
