// The data files that are part of the program, embedded when it is built: no files are searched at run time.
#pragma once

#include <string_view>

namespace dolp {

/// host/data/CITATION.cff.
std::string_view embedded_citation_cff();

/// host/data/materials.csv.
std::string_view embedded_materials_csv();

/// host/data/materials_sources.csv.
std::string_view embedded_materials_sources_csv();

/// host/scenes/stainless_steel.toml.
std::string_view embedded_stainless_steel_toml();

/// host/data/sun.csv.
std::string_view embedded_sun_csv();

}  // namespace dolp
