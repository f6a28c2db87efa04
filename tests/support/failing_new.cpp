#include "failing_new.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

constexpr long kNone = -1;
thread_local long before_failure = kNone;

}  // namespace

void* operator new(std::size_t size) {
  if (before_failure != kNone && before_failure-- == 0) throw std::bad_alloc();
  if (void* const block = std::malloc(size > 0 ? size : 1)) return block;
  throw std::bad_alloc();
}

// The operator delete below calls std::free. The address sanitizer has its own nothrow operator new, and its memory
// must not go to std::free. So this operator replaces it.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return ::operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

namespace dolp {

FailingNew::FailingNew(long before) { before_failure = before; }
FailingNew::~FailingNew() { before_failure = kNone; }
bool FailingNew::has_failed() const { return before_failure == kNone; }

}  // namespace dolp
