// A file that tests write and read.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace dolp {

/// A file in a temporary folder, removed with the object.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& content) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string owner = std::string(test->test_suite_name()) + "_" + test->name() + "_" + name;
    std::replace(owner.begin(), owner.end(), '/', '_');  // of parametrised suites
    folder_ = std::filesystem::path(::testing::TempDir()) / ("dolp_" + owner);
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / name).string();
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::filesystem::remove_all(folder_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

}  // namespace dolp
