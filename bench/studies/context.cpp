#include "studies/context.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <gsl/gsl_version.h>
#include <sys/utsname.h>

#include <boost/version.hpp>
#include <chrono>
#include <cstdlib>
#include <dolp/errors.hpp>
#include <fstream>
#include <thread>

#include "base/processor.hpp"
#include "device/devices.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

/// Name of the operating system and its kernel, as far as known, such as "Debian GNU/Linux 12 (bookworm), Linux 6.1.0".
std::string system_name() {
  std::string name;
  std::ifstream release("/etc/os-release");
  const std::string key = "PRETTY_NAME=\"";
  for (std::string line; std::getline(release, line);) {
    if (line.starts_with(key)) name = line.substr(key.size(), line.find('"', key.size()) - key.size()) + ", ";
  }
  utsname kernel{};
  return ::uname(&kernel) == 0 ? name + kernel.sysname + " " + kernel.release : name + "unknown kernel";
}

/// Mean number of busy programs over the last minute; 0 if the system does not report it.
double load() {
  double mean = 0.0;
  return ::getloadavg(&mean, 1) == 1 ? mean : 0.0;
}

ordered_json device_json(const std::string& choice) {
  try {
    const DeviceList list = list_devices();
    const dolp::Device& device = list.devices[choose_device(list.devices, choice, false)];
    return {{"name", device.name},
            {"type", type_name(device.type)},
            {"driver", device.driver},
            {"vulkan", device.api_version}};
  } catch (const DeviceError& error) {
    return {{"none", error.what()}};
  }
}

/// The widest vector instructions of the processor. Considers only the sets that change the speed of kernels.
const char* vector_instructions() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return "AVX-512";
  if (__builtin_cpu_supports("avx2")) return "AVX2";
  return "SSE";
#else
  return "not known";
#endif
}

}  // namespace

std::string shell_line(const std::vector<std::string>& arguments) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  std::string line;
  for (const std::string& argument : arguments) {
    if (!line.empty()) line += ' ';
    if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) {
      line += argument;
      continue;
    }
    line += '\'';
    for (const char letter : argument) line += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    line += '\'';
  }
  return line;
}

ordered_json context_json(const std::string& device, const std::vector<std::string>& arguments) {
  ordered_json context;
  context["program"] = "dolp-bench " DOLP_VERSION;
  context["command"] = shell_line(arguments);
  context["date"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
  context["machine"] = {{"processor", processor_name()},
                        {"vector_instructions", vector_instructions()},
                        {"cores", std::thread::hardware_concurrency()},
                        {"load", load()},
                        {"system", system_name()}};
  context["device"] = device_json(device);
  context["compiler"] = {{"name", DOLP_COMPILER}, {"flags", DOLP_COMPILER_FLAGS}, {"build_type", DOLP_BUILD_TYPE}};
  const char* validation = std::getenv("DOLP_VALIDATION");
  context["validation"] = validation != nullptr && std::string(validation) == "1";
  context["libraries"] = {{"GSL", GSL_VERSION}, {"Boost", BOOST_LIB_VERSION}, {"cubature", DOLP_CUBATURE_VERSION}};
  return context;
}

}  // namespace dolp::bench
