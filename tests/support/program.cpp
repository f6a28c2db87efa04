#include "program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr int kCannotStart = 127;
constexpr unsigned kLongestRun_s = 60;

void require(bool good, const char* what) {
  if (!good) throw std::runtime_error(what);
}

int open_file(const fs::path& path, int flags) {
  constexpr mode_t kMode = 0600;
  return ::open(path.c_str(), flags | O_CLOEXEC | O_NOCTTY, kMode);
}

/// Opens the end of a pseudo-terminal that the program under test uses as its terminal.
int open_partner(const Descriptor& terminal) {
  require(::grantpt(terminal.number()) == 0 && ::unlockpt(terminal.number()) == 0, "cannot open a terminal");
  return open_file(::ptsname(terminal.number()), O_RDWR);
}

/// Arguments and environment of a program as arrays for execve.
class Image {
 public:
  explicit Image(const Command& command) : texts_(command.arguments) {
    const std::size_t argument_count = texts_.size();
    for (char** one = environ; *one != nullptr; ++one) {
      const std::string text = *one;
      const auto replaces = [&](const auto& own) { return text.starts_with(own.first + '='); };
      if (std::ranges::none_of(command.environment, replaces)) texts_.push_back(text);
    }
    for (const auto& [name, value] : command.environment) texts_.emplace_back(name).append("=").append(value);
    for (std::string& text : texts_) {
      (arguments_.size() < argument_count ? arguments_ : environment_).push_back(text.data());
    }
    arguments_.push_back(nullptr);
    environment_.push_back(nullptr);
  }
  void execute() const { ::execvpe(arguments_.front(), arguments_.data(), environment_.data()); }

 private:
  std::vector<std::string> texts_;
  std::vector<char*> arguments_, environment_;
};

pid_t start(const Command& command, const Descriptor& in, const Descriptor& out, const Descriptor& err) {
  // Allocates memory before the fork. The child must not allocate: another thread may have held the allocator's lock.
  const Image image(command);
  const pid_t process = ::fork();
  require(process >= 0, "cannot fork");
  if (process != 0) return process;
  ::alarm(kLongestRun_s);
  const bool redirected = ::dup2(in.number(), STDIN_FILENO) >= 0 && ::dup2(out.number(), STDOUT_FILENO) >= 0 &&
                          ::dup2(err.number(), STDERR_FILENO) >= 0;
  if (redirected && ::chdir(command.folder.c_str()) == 0) image.execute();
  ::_exit(kCannotStart);
}

pid_t start_on_terminal(const Command& command, const Descriptor& terminal) {
  const Descriptor nowhere(open_file("/dev/null", O_RDWR));
  const Descriptor partner(open_partner(terminal));
  return start(command, nowhere, nowhere, partner);
}

int wait_for(pid_t process) {
  int status = 0;
  require(::waitpid(process, &status, 0) == process, "cannot wait for the program");
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace

Descriptor::Descriptor(int number) : number_(number) { require(number_ >= 0, "cannot open a file"); }

Descriptor::~Descriptor() { ::close(number_); }

Outcome run(const Command& command) {
  // The program writes to files. If it wrote to pipes, this process would have to read them while the program runs.
  const TemporaryFolder folder;
  const fs::path in_path = folder.path() / "in";
  const fs::path out_path = command.out_path.empty() ? folder.path() / "out" : command.out_path;
  const fs::path err_path = folder.path() / "err";
  std::ofstream(in_path, std::ios::binary) << command.input;
  const Descriptor in(open_file(in_path, O_RDONLY));
  const Descriptor out(open_file(out_path, O_WRONLY | O_CREAT));
  const Descriptor err(open_file(err_path, O_WRONLY | O_CREAT));
  const int status = wait_for(start(command, in, out, err));
  return {status, command.out_path.empty() ? read_file(out_path) : std::string(), read_file(err_path)};
}

TerminalProcess::TerminalProcess(const Command& command)
    : terminal_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)), process_(start_on_terminal(command, terminal_)) {}

TerminalProcess::~TerminalProcess() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

bool TerminalProcess::read_some() {
  std::array<char, 4096> buffer{};
  const ssize_t count = ::read(terminal_.number(), buffer.data(), buffer.size());
  if (count <= 0) return false;
  shown_.append(buffer.data(), static_cast<std::size_t>(count));
  return true;
}

bool TerminalProcess::wait_for_output() { return !shown_.empty() || read_some(); }

void TerminalProcess::send_signal(int number) const { ::kill(process_, number); }

Outcome TerminalProcess::finish() {
  while (read_some()) {
  }
  const int status = wait_for(process_);
  process_ = -1;
  return {status, "", shown_};
}

}  // namespace dolp
