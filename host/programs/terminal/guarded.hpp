// The only place where errors become exit statuses.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace dolp {

/// One line on stderr that begins with the program's name; returns `status`.
int fail(const std::string& program, int status, const std::string& message);

/// One line on stderr for each remark: a warning, after which the program goes on.
void warn(const std::string& program, const std::vector<std::string>& remarks);

/// The line of a program that is out of memory, which needs none; returns kExitMemory.
int fail_out_of_memory(const char* program) noexcept;

/// Returns the result of `body`, or the exit status of the error that it threw, after a message of one line.
int guarded(const std::string& program, const std::function<int()>& body);

}  // namespace dolp
