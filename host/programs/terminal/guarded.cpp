#include "terminal/guarded.hpp"
#include "terminal/exit_status.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <dolp/errors.hpp>
#include <exception>
#include <new>
#include <system_error>

#include "base/text.hpp"

namespace dolp {
namespace {

/// True if lack of memory caused `error`, for example if std::thread found no memory for the stack of a new thread.
bool is_of_memory(const std::system_error& error) {
  return error.code() == std::errc::not_enough_memory || error.code() == std::errc::resource_unavailable_try_again;
}

}  // namespace

// Uses fputs, because fmt::print would throw if stderr cannot be written.
int fail(const std::string& program, int status, const std::string& message) {
  std::fputs((program + ": " + printable_line(message) + "\n").c_str(), stderr);
  return status;
}

void warn(const std::string& program, const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks) fail(program, kExitDone, "warning: " + remark);
}

int fail_out_of_memory(const char* program) noexcept {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  std::array<char, 128> line{};
  const int length = std::snprintf(line.data(), line.size(), "%.40s: out of memory: more than %ld MiB wanted\n",
                                   program, used.ru_maxrss / 1024);
  // Ignores a failure of write(), because there is no other way to tell the user.
  if (length > 0) static_cast<void>(!::write(STDERR_FILENO, line.data(), static_cast<std::size_t>(length)));
  return kExitMemory;
}

int guarded(const std::string& program, const std::function<int()>& body) {
  try {
    return body();
  } catch (const Cancelled& cancelled) {
    return fail(program, kExitInterrupted, std::string("interrupted; ") + cancelled.what());
  } catch (const InputError& error) {
    return fail(program, kExitInput, error.what());
  } catch (const DeviceError& error) {
    return fail(program, kExitDevice, error.what());
  } catch (const MemoryError& error) {
    return fail(program, kExitMemory, error.what());
  } catch (const IoError& error) {
    return fail(program, kExitIo, error.what());
  } catch (const std::bad_alloc&) {
    return fail_out_of_memory(program.c_str());
  } catch (const std::system_error& error) {
    if (is_of_memory(error)) return fail_out_of_memory(program.c_str());
    return fail(program, kExitIo, error.what());
  } catch (const std::exception& error) {
    return fail(program, kExitInternal, std::string("internal error: ") + error.what());
  }
}

}  // namespace dolp
