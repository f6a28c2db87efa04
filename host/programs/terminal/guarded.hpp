#pragma once

#include <functional>
#include <string>
#include <vector>

namespace dolp {

/// Prints "PROGRAM: MESSAGE" as one line on stderr. Returns `status`.
int fail(const std::string& program, int status, const std::string& message);

void warn(const std::string& program, const std::vector<std::string>& remarks);

/// Prints "out of memory" on stderr without allocating memory. Returns kExitMemory.
int fail_out_of_memory(const char* program) noexcept;

/// Returns the result of `body`. If `body` throws an error, prints one line and returns the exit status for this error.
int guarded(const std::string& program, const std::function<int()>& body);

}  // namespace dolp
