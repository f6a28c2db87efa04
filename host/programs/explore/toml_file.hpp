// TOML files of the window's own.
#pragma once

#include <string>
#include <vector>

#include <toml++/toml.h>

namespace dolp::explore {

/// Errors: InputError in one line, with file and place, for a file that cannot be read or is no TOML.
toml::table read_toml(const std::string& path);

/// The texts of an array; empty without it.
std::vector<std::string> texts_in(toml::node_view<const toml::node> node);
toml::array array_of(const std::vector<std::string>& texts);

}  // namespace dolp::explore
