// Shell completions and man pages, generated from the command line's own description.
#pragma once

#include <CLI/App.hpp>
#include <array>
#include <string>

namespace dolp::cli {

inline constexpr std::array kCompletions = {"bash", "zsh", "fish", "man"};

/// The completions of a shell, or the manual page in roff; `form` is one of kCompletions.
std::string completion_text(const CLI::App& app, const std::string& form);

}  // namespace dolp::cli
