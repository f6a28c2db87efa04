#include "base/python_picture.hpp"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <dolp/errors.hpp>
#include <filesystem>
#include <memory>

#include "base/atomic_file.hpp"

namespace dolp {
namespace {

/// A file that exists only in memory, so that the program needs no folder for temporary files.
class MemoryFile {
 public:
  MemoryFile() : file_(::fdopen(::memfd_create("picture", MFD_CLOEXEC), "w+b"), std::fclose) {}

  int descriptor() const { return file_ ? fileno(file_.get()) : -1; }
  bool write(const std::string& bytes) const {
    const bool is_written = file_ && std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size();
    if (!is_written || std::fflush(file_.get()) != 0) return false;
    std::rewind(file_.get());
    return true;
  }
  std::string read() const {
    std::string bytes;
    std::array<char, 1U << 16U> block;
    std::rewind(file_.get());
    while (const std::size_t got = std::fread(block.data(), 1, block.size(), file_.get()))
      bytes.append(block.data(), got);
    return bytes;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// Runs a Python script that reads `input` from stdin and writes `output` to stdout. Returns false if the script fails.
bool run_python(const char* script, std::string argument, const MemoryFile& input, const MemoryFile& output) {
  std::string program = "/usr/bin/python3", option = "-c", text = script;
  const std::array<char*, 5> arguments = {program.data(), option.data(), text.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.descriptor(), STDOUT_FILENO);
  pid_t process = 0;
  const int failure = posix_spawn(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  return failure == 0 && waitpid(process, &status, 0) == process && status == 0;
}

}  // namespace

void draw_with_python(const char* script, const std::string& input, const std::string& path) {
  const MemoryFile report, picture;
  if (!report.write(input) || picture.descriptor() < 0)
    throw IoError(path + ": there is no memory for the report of the picture");
  if (!run_python(script, std::filesystem::path(path).extension().string(), report, picture))
    throw IoError(path + ": the picture cannot be drawn; /usr/bin/python3 with the package python3-matplotlib does it");
  write_text_atomically(path, picture.read());
}

}  // namespace dolp
