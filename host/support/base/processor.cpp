#include "base/processor.hpp"

#include <sys/resource.h>

#include <fstream>

namespace dolp {

const std::string& processor_name() {
  static const std::string name = []() -> std::string {
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);) {
      const std::size_t colon = line.find(": ");
      if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown processor";
  }();
  return name;
}

std::size_t peak_resident_bytes() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<std::size_t>(used.ru_maxrss) * 1024;  // ru_maxrss is in kilobytes
}

}  // namespace dolp
