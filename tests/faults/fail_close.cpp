// A preloaded library. Each close of a table that the program has read fails, as if a file server were lost.
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>

extern "C" int close(int file) {
  using Close = int (*)(int);
  static const auto real_close = reinterpret_cast<Close>(::dlsym(RTLD_NEXT, "close"));
  char name[4096];
  const ssize_t length = ::readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), name, sizeof name);
  const bool is_table = length > 0 && std::string(name, static_cast<std::size_t>(length)).ends_with(".nc");
  const bool is_read = (::fcntl(file, F_GETFL) & O_ACCMODE) == O_RDONLY;
  const int result = real_close(file);
  if (!is_table || !is_read) return result;
  errno = EIO;
  return -1;
}
