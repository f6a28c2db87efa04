// Only these functions convert errors to exit statuses.
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

/// Returns the result of `body`. If `body` throws an error, prints one line and returns the exit status for this error.
int guarded(const std::string& program, const std::function<int()>& body);

}  // namespace dolp
