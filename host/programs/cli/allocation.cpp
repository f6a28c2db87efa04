// Memory for all of the program, its libraries and drivers: where even a little of it is missing the program ends, with
// one line and its exit status. Few libraries survive that, HDF5 and LLVM do not; nothing is lost, because an output
// has no name before it is whole. What fails to get much memory is told, and can do with less.
#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>

#include "terminal/guarded.hpp"

namespace {

constexpr std::size_t kMuch = 64U << 20U;  // drivers take megabytes for a shader, and do not look

/// A function of the allocator that the program would have without this file; it may be one that was preloaded.
template <class Function>
class Next {
 public:
  explicit constexpr Next(const char* name) : name_(name) {}
  template <class... Arguments>
  auto operator()(Arguments... arguments) {
    if (!function_) function_ = reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name_));
    return function_.load()(arguments...);
  }

 private:
  const char* name_;
  std::atomic<Function*> function_ = nullptr;
};

constinit Next<void*(std::size_t)> next_malloc("malloc");
constinit Next<void*(std::size_t, std::size_t)> next_calloc("calloc");
constinit Next<void*(void*, std::size_t)> next_realloc("realloc");
constinit Next<void*(std::size_t, std::size_t)> next_aligned_alloc("aligned_alloc");
constinit Next<int(void**, std::size_t, std::size_t)> next_posix_memalign("posix_memalign");
constinit Next<void*(void*, std::size_t, int, int, int, off_t)> next_mmap("mmap");

[[noreturn]] void end() {
  static std::atomic_flag is_ending;
  while (is_ending.test_and_set()) ::pause();  // another thread says it
  ::_exit(dolp::fail_out_of_memory("dolp"));
}

void* block_or_end(void* block, std::size_t size) {
  if (!block && size > 0 && size < kMuch) end();
  return block;
}

/// Treats a crash as an out-of-memory error where the driver finds no addresses left. Any other crash takes its normal
/// course.
void on_crash(int number) {
  constexpr std::size_t kRoom = 256U << 20U;  // what drivers ask for at a time
  void* const room = next_mmap(nullptr, kRoom, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, off_t{0});
  if (room == MAP_FAILED) end();
  std::signal(number, SIG_DFL);
  std::raise(number);
}

[[gnu::constructor]] void watch_for_crashes() {
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT}) std::signal(number, on_crash);
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept { return block_or_end(next_malloc(size), size); }

void* calloc(std::size_t count, std::size_t size) noexcept {
  std::size_t bytes = 0;
  if (__builtin_mul_overflow(count, size, &bytes)) bytes = kMuch;
  return block_or_end(next_calloc(count, size), bytes);
}

void* realloc(void* block, std::size_t size) noexcept { return block_or_end(next_realloc(block, size), size); }

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return block_or_end(next_aligned_alloc(alignment, size), size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  const int error = next_posix_memalign(block, alignment, size);
  block_or_end(error == ENOMEM ? nullptr : block, size);
  return error;
}

// LLVM asks for room for the code of a kernel in this way, and aborts where there is none.
void* mmap(void* address, std::size_t size, int protection, int flags, int file, off_t offset) noexcept {
  void* const block = next_mmap(address, size, protection, flags, file, offset);
  const bool is_memory = (flags & MAP_ANONYMOUS) != 0 && (flags & MAP_NORESERVE) == 0;
  if (is_memory && block == MAP_FAILED && errno == ENOMEM) end();
  return block;
}

void* mmap64(void* address, std::size_t size, int protection, int flags, int file, off_t offset) noexcept {
  return mmap(address, size, protection, flags, file, offset);
}

}  // extern "C"
