// A library that is preloaded into a program and limits its threads, as `ulimit -u` does. Environment:
//   DOLP_MOST_THREADS allowed threads in addition to the first, for example 3; more fail with EAGAIN
#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> running{0};

long most_threads() {
  const char* most = std::getenv("DOLP_MOST_THREADS");
  return most != nullptr ? std::strtol(most, nullptr, 10) : -1;
}

/// Each running thread has such an object on its stack. The destructor lowers the count of threads when the thread
/// ends, even if the thread calls pthread_exit().
struct Counted {
  Counted() = default;
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --running; }
};

struct Work {
  void* (*routine)(void*);
  void* argument;
};

void* run(void* given) {
  const Counted counted;
  const Work work = *static_cast<Work*>(given);
  delete static_cast<Work*>(given);
  return work.routine(work.argument);
}

}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*routine)(void*),
                              void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(::dlsym(RTLD_NEXT, "pthread_create"));
  static const long most = most_threads();
  auto* const work = new (std::nothrow) Work{routine, argument};
  const bool is_allowed = ++running <= most || most < 0;
  const int result = work != nullptr && is_allowed ? create(thread, attributes, run, work) : EAGAIN;
  if (result != 0) {
    --running;
    delete work;
  }
  return result;
}
