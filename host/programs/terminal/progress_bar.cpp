#include "terminal/progress_bar.hpp"
#include "base/interrupt.hpp"
#include "base/stopwatch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <dolp/errors.hpp>
#include <string>

namespace dolp {
namespace {

constexpr auto kRedrawInterval = std::chrono::milliseconds(100);
constexpr std::size_t kBarWidth = 30;

}  // namespace

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
