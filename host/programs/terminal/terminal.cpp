#include "terminal/terminal.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <dolp/errors.hpp>
#include <exception>
#include <new>
#include <system_error>

#include "base/interrupt.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"

namespace dolp {
namespace {

constexpr auto kRedrawInterval = std::chrono::milliseconds(100);
constexpr std::size_t kBarWidth = 30;

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
    // Memory may be lacking, for example if std::thread found none for the stack of a new thread.
    const bool lacks_memory =
        error.code() == std::errc::not_enough_memory || error.code() == std::errc::resource_unavailable_try_again;
    return lacks_memory ? fail_out_of_memory(program.c_str()) : fail(program, kExitIo, error.what());
  } catch (const std::exception& error) {
    return fail(program, kExitInternal, std::string("internal error: ") + error.what());
  }
}

ProgressBar::ProgressBar(bool quiet) : visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

Progress ProgressBar::callback() {
  return [this](std::size_t done, std::size_t total) {
    if (!watches_) watch_for_interrupts();
    watches_ = true;
    const Clock::time_point now = Clock::now();
    if (visible_ && now - last_drawn_ >= kRedrawInterval) {
      draw(done, total);
      last_drawn_ = now;
    }
    return !interrupted();
  };
}

void ProgressBar::count(const std::string& what) {
  what_ = what;
  start_ = Clock::now();
}

void ProgressBar::draw(std::size_t done, std::size_t total) {
  const double elapsed_s = seconds_since(start_);
  const double rate = elapsed_s > 0.0 ? static_cast<double>(done) / elapsed_s : 0.0;
  const double left_s = rate > 0.0 ? static_cast<double>(total - done) / rate : 0.0;
  const std::size_t filled = total > 0 ? kBarWidth * done / total : kBarWidth;
  const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
  fmt::print(stderr, "\r\033[K[{}] {}/{} {}, {:.3g}/s, {:.0f} s left", bar, done, total, what_, rate, left_s);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace dolp
