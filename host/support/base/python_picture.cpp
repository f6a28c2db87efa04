#include "base/python_picture.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <dolp/errors.hpp>
#include <memory>
#include <vector>

namespace dolp {

void draw_with_python(const char* script, const std::string& input, const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  if (!file || std::fwrite(input.data(), 1, input.size(), file.get()) != input.size() || std::fflush(file.get()) != 0) {
    throw IoError(path + ": the report for the picture cannot be written to a temporary file");
  }
  std::rewind(file.get());
  std::vector<std::string> words = {"/usr/bin/python3", "-c", script, path};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(file.get()), STDIN_FILENO);
  pid_t process = 0;
  const int failure = posix_spawn(&process, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (failure != 0 || waitpid(process, &status, 0) != process || status != 0) {
    throw IoError(path + ": the picture cannot be drawn; /usr/bin/python3 with the package python3-matplotlib does it");
  }
}

}  // namespace dolp
