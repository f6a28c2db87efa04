// Texts of the data files. They are built into the program, so it opens no data files at run time.
#pragma once

#include <string_view>

namespace dolp {

std::string_view embedded_citation_cff();
std::string_view embedded_hard_cases_csv();
std::string_view embedded_materials_csv();
std::string_view embedded_materials_sources_csv();
std::string_view embedded_sun_csv();
std::string_view embedded_stainless_steel_toml();
std::string_view embedded_plot_fit_py();

}  // namespace dolp
