#include "studies/child.hpp"

#include <array>
#include <cstdio>
#include <filesystem>

#include "methods/method.hpp"
#include "studies/context.hpp"

namespace dolp::bench {

ChildOutcome run_child(const std::vector<std::string>& arguments, ChildErrors errors) {
  const std::string command = shell_line(arguments) + (errors == ChildErrors::kHidden ? " 2>/dev/null" : "");
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw Unavailable("no process could be started for " + arguments.front());
  ChildOutcome outcome;
  std::array<char, 4096> part{};
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe)) outcome.out.append(part.data(), size);
  outcome.status = ::pclose(pipe);
  return outcome;
}

std::string own_program() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

}  // namespace dolp::bench
