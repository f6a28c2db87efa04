// Converts errors to exit statuses. No other code does this.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace dolp {

/// Prints one line on stderr, with the program's name first. Returns `status`.
int fail(const std::string& program, int status, const std::string& message);

void warn(const std::string& program, const std::vector<std::string>& remarks);

/// Prints a line that memory is short; allocates no memory for it. Returns kExitMemory.
int fail_out_of_memory(const char* program) noexcept;

/// Returns the result of `body`. If it throws, prints one line and returns the error's exit status.
int guarded(const std::string& program, const std::function<int()>& body);

}  // namespace dolp
