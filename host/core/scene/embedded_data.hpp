// The files that are part of the program, embedded when it is built: no files are searched at run time.
#pragma once

#include <string_view>

namespace dolp {

// In host/data.
std::string_view embedded_citation_cff();
std::string_view embedded_hard_cases_csv();
std::string_view embedded_materials_csv();
std::string_view embedded_materials_sources_csv();
std::string_view embedded_sun_csv();

// In host/scenes.
std::string_view embedded_stainless_steel_toml();

// In host/tools.
std::string_view embedded_plot_fit_py();

}  // namespace dolp
