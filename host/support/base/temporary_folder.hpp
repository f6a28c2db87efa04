// A folder for files that last as long as an object.
#pragma once

#include <cstdlib>
#include <dolp/errors.hpp>
#include <filesystem>
#include <string>
#include <system_error>

namespace dolp {

/// A new folder among the system's temporary ones, removed with all that is in it at the end.
class TemporaryFolder {
 public:
  /// `name`: begins the folder's name. Errors: IoError.
  explicit TemporaryFolder(const std::string& name = "dolp") {
    std::string path = (std::filesystem::temp_directory_path() / (name + "-XXXXXX")).string();
    if (::mkdtemp(path.data()) == nullptr) throw IoError(path + ": cannot create the folder");
    path_ = path;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace dolp
