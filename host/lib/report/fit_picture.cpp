#include "report/fit_picture.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <dolp/errors.hpp>
#include <memory>
#include <vector>

namespace dolp {

void draw_fit(const std::string& json, const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> input(std::tmpfile(), std::fclose);
  if (!input || std::fwrite(json.data(), 1, json.size(), input.get()) != json.size() || std::fflush(input.get()) != 0) {
    throw IoError(path + ": the report for the picture cannot be written to a temporary file");
  }
  std::rewind(input.get());
  std::vector<std::string> words = {"/usr/bin/python3", "-c", kFitPictureScript, path};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input.get()), STDIN_FILENO);
  pid_t process = 0;
  const int failure = posix_spawn(&process, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (failure != 0 || waitpid(process, &status, 0) != process || status != 0) {
    throw IoError(path + ": the picture cannot be drawn; /usr/bin/python3 with the package python3-matplotlib does it");
  }
}

}  // namespace dolp
