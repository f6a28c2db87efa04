#pragma once

#include <cstdlib>
#include <dolp/errors.hpp>
#include <filesystem>
#include <string>
#include <system_error>

namespace dolp {

/// The folder for temporary files: TMPDIR, else TMP, TEMP, TEMPDIR, else /tmp. Errors: IoError if it does not exist.
inline std::filesystem::path temporary_files() {
  std::filesystem::path folder = "/tmp";
  for (const char* const name : {"TEMPDIR", "TEMP", "TMP", "TMPDIR"}) {
    const char* const given = std::getenv(name);
    if (given && *given != '\0') folder = given;
  }
  std::error_code unknown;
  if (std::filesystem::is_directory(folder, unknown)) return folder;
  throw IoError(folder.string() + ": there is no such folder for temporary files; set TMPDIR to another");
}

/// A new folder in temporary_files(). The destructor removes the folder with its content.
class TemporaryFolder {
 public:
  /// `name` is the beginning of the folder's name. Errors: IoError.
  explicit TemporaryFolder(const std::string& name = "dolp") {
    std::string path = (temporary_files() / (name + "-XXXXXX")).string();
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
