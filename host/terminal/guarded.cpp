#include "terminal/guarded.hpp"
#include "base/progress.hpp"
#include "terminal/exit_status.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "base/error.hpp"
#include "base/printable_text.hpp"

namespace dolp {

// fmt::print would throw where stderr cannot be written to.
int fail(const std::string& program, int status, const std::string& message) {
  std::fputs((program + ": " + printable_line(message) + "\n").c_str(), stderr);
  return status;
}

int guarded(const std::string& program, const std::function<int()>& body) {
  try {
    return body();
  } catch (const Cancelled&) {
    return fail(program, kExitInterrupted, "interrupted; no file was written");
  } catch (const InputError& error) {
    return fail(program, kExitInput, error.what());
  } catch (const DeviceError& error) {
    return fail(program, kExitDevice, error.what());
  } catch (const IoError& error) {
    return fail(program, kExitIo, error.what());
  } catch (const std::bad_alloc&) {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return fail(program, kExitMemory, fmt::format("out of memory: more than {} MiB wanted", used.ru_maxrss / 1024));
  } catch (const std::system_error& error) {
    return fail(program, kExitIo, error.what());
  } catch (const std::exception& error) {
    return fail(program, kExitInternal, std::string("internal error: ") + error.what());
  }
}

}  // namespace dolp
