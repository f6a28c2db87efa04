// Shared code of the fuzzers. Each passes bytes to one public reader, which must accept them or throw InputError.
#pragma once

#include <unistd.h>

#include <dolp/errors.hpp>
#include <filesystem>
#include <fstream>
#include <string>

namespace dolp::fuzz {

/// Passes an input to the reader that this fuzzer tests. libFuzzer reports the input if the reader crashes or throws an
/// exception other than InputError.
void read(const std::string& text);

template <class Reader>
void refused(const Reader& reader) {
  try {
    reader();
  } catch (const InputError&) {
    // InputError is the right answer to bad input.
  }
}

/// A file that is rewritten with each input.
class InputFile {
 public:
  explicit InputFile(const std::string& suffix)
      : path_(std::filesystem::temp_directory_path() / ("dolp-fuzz-" + std::to_string(::getpid()) + suffix)) {}
  ~InputFile() { std::filesystem::remove(path_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace dolp::fuzz
