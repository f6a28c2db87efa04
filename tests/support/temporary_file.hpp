#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/temporary_folder.hpp"

namespace dolp {

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A file in a new folder. The destructor removes both.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& content) : path_((folder_.path() / name).string()) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  const std::string& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

}  // namespace dolp
