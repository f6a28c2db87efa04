// A preloaded library that makes one allocation of a program fail, or this allocation and all later ones. Environment:
//   DOLP_FAIL_ALLOCATION   17 makes the 17th allocation of the program fail; 17+ makes all later ones fail, too
//   DOLP_COUNT_ALLOCATIONS a file that receives the number of allocations when the program ends
#include <dlfcn.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

// The C library's own allocation functions, under names that nobody replaces.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_calloc(std::size_t count, std::size_t size);
extern "C" void* __libc_realloc(void* block, std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);
// NOLINTEND(bugprone-reserved-identifier)

namespace {

std::atomic<unsigned long> allocations{0};
unsigned long failing = 0;
bool all_after = false;

[[gnu::constructor]] void read_environment() {
  const char* wanted = std::getenv("DOLP_FAIL_ALLOCATION");
  if (wanted == nullptr) return;
  char* end = nullptr;
  failing = std::strtoul(wanted, &end, 10);
  all_after = *end == '+';
  allocations = 0;
}

[[gnu::destructor]] void report_count() {
  const char* path = std::getenv("DOLP_COUNT_ALLOCATIONS");
  const unsigned long count = allocations;
  std::FILE* file = path != nullptr ? std::fopen(path, "w") : nullptr;
  if (file == nullptr) return;
  std::fprintf(file, "%lu\n", count);
  std::fclose(file);
}

bool fails() {
  const unsigned long number = ++allocations;
  const bool does = failing > 0 && (number == failing || (all_after && number > failing));
  if (does) errno = ENOMEM;
  return does;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) { return fails() ? nullptr : __libc_malloc(size); }

void* calloc(std::size_t count, std::size_t size) { return fails() ? nullptr : __libc_calloc(count, size); }

void* realloc(void* block, std::size_t size) { return fails() ? nullptr : __libc_realloc(block, size); }

void* memalign(std::size_t alignment, std::size_t size) { return fails() ? nullptr : __libc_memalign(alignment, size); }

void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }

int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  *block = memalign(alignment, size);
  return *block != nullptr ? 0 : ENOMEM;
}

}  // extern "C"
