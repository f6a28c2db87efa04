// A file is complete or absent, whatever stops its writing.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <dolp/errors.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "base/atomic_file.hpp"
#include "error_text.hpp"
#include "failing_new.hpp"
#include "table/table_file.hpp"
#include "table/table_output.hpp"
#include "table/table_reader.hpp"
#include "table_support.hpp"

namespace table_writing_test {

using namespace dolp;
namespace fs = std::filesystem;

/// Sets a resource limit of the process. The destructor restores the old limit.
class Limit {
 public:
  Limit(__rlimit_resource resource, rlim_t value) : resource_(resource) {
    ::getrlimit(resource_, &before_);
    const rlimit limit{value, before_.rlim_max};
    ::setrlimit(resource_, &limit);
  }
  Limit(const Limit&) = delete;
  Limit& operator=(const Limit&) = delete;
  ~Limit() { ::setrlimit(resource_, &before_); }

 private:
  __rlimit_resource resource_;
  rlimit before_{};
};

// ---- Paths that cannot be written -----------------------------------------------------------------------------------

// The length of the table's name is allowed, but names of its temporary files would be too long.
TEST_F(TableFiles, TableOutput_NameTooLongForAPartialFile_IsRefusedBeforeAnyWork) {
  const TableValues table = sample_table(2, 1, 1);
  const TableLayout layout{table, table.quantities(), true};
  const std::vector<GridBox> parts(2);
  for (const std::size_t length : {240U, 245U, 250U}) {
    const fs::path path = at(std::string(length - 3, 'n') + ".nc");
    const auto begin = [&] { TableOutput({.path = path, .layout = layout, .parts = parts, .identity = "a 1"}); };
    const std::string error = error_text<IoError>(begin);
    EXPECT_EQ(error.find("File name too long") != std::string::npos, length > 240) << error;
    EXPECT_EQ(names(), std::vector<std::string>{}) << length;
  }
}

// ---- Whole or not there ---------------------------------------------------------------------------------------------

TEST_F(TableFiles, WriteTable_NoDescriptorsLeft_IsNoLackOfMemory) {
  const TableValues table = sample_table(1, 1, 1);
  const int first = ::dup(STDIN_FILENO);
  ::close(first);
  std::string all;
  for (rlim_t left = 0; !fs::exists(at("t.nc")); ++left) {
    ASSERT_LT(left, 10U);
    const Limit limit(RLIMIT_NOFILE, static_cast<rlim_t>(first) + left);
    try {
      write_table(table, at("t.nc"));
    } catch (const IoError& error) {
      all += error.what() + std::string("\n");
    }
  }
  EXPECT_NE(all.find("/t.nc: cannot write: Too many open files"), std::string::npos) << all;
  expect_same(read_table(at("t.nc")), table);
}

TEST_F(TableFiles, WriteTable_NoMemoryForOneAllocation_LeavesNothingOrTheTable) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a std::variant that finds no memory for its copy alarms the sanitizer of undefined behaviour";
#endif
  const TableValues table = sample_table(3, 2, 2);
  for (const char* name : {"t.nc", "t.csv", "t.npy"}) {
    write_table(table, at(name));
    const std::string whole = read_file(at(name));
    fs::remove(at(name));
    bool has_failed = true;
    for (long before = 0; has_failed; ++before) {
      try {
        const FailingNew failing(before);
        write_table(table, at(name));
        has_failed = failing.has_failed();
      } catch (const std::bad_alloc&) {
        ASSERT_EQ(names(), std::vector<std::string>{}) << before;
        continue;
      }
      EXPECT_EQ(read_file(at(name)), whole) << before;
      fs::remove(at(name));
    }
  }
}

TEST_F(TableFiles, WriteText_Killed_LeavesNothing) {
  const pid_t writer = ::fork();
  ASSERT_GE(writer, 0);
  if (writer == 0) {
    // The signal SIGXFSZ ends the process without calling destructors.
    const Limit full(RLIMIT_FSIZE, 100'000);
    std::signal(SIGXFSZ, SIG_DFL);
    write_text_atomically(at("t.csv"), std::string(200'000, 'x'));
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(writer, &status, 0), writer);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(names(), std::vector<std::string>{});
}

TEST_F(TableFiles, UnderWay_AnotherProcessHasIt_IsRefused) {
  AtomicFile file(at("t.csv"), at("t.csv.partial"));
  EXPECT_THROW(AtomicFile(at("t.csv"), at("t.csv.partial")), InputError);
  file.append("text");
  file.commit();
  EXPECT_EQ(read_file(at("t.csv")), "text");
  EXPECT_EQ(names(), std::vector<std::string>{"t.csv"});
}

/// A job that writes a table in two parts. If a partial file of the table exists, the job continues it. The first part
/// has the entries of `one_part`.
TableOutput::Job resumable_job(const fs::path& path, const TableValues& one_part) {
  const TableHead& head = one_part;
  TableHead whole = head;
  for (const double theta : one_part.axes[Axis::kTheta]) whole.axes[Axis::kTheta].push_back(theta / 2.0);
  const PerAxis count = one_part.counts();
  PerAxis second = {};
  second[Axis::kTheta] = count[Axis::kTheta];
  return {.path = path,
          .layout = {whole, one_part.quantities(), true},
          .parts = {{{}, count}, {second, count}},
          .identity = "scene a",
          .is_resumed = true};
}

TEST_F(TableFiles, PartialFile_NoMemoryForItsWriter_IsNotLeft) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a std::variant that finds no memory for its copy alarms the sanitizer of undefined behaviour";
#endif
  const TableOutput::Job job = resumable_job(at("t.nc"), sample_table(3, 2, 2));
  bool has_failed = true;
  for (long before = 0; has_failed; ++before) {
    TableOutput::Job own = job;
    try {
      const FailingNew failing(before);
      const TableOutput output(std::move(own));
      has_failed = failing.has_failed();
    } catch (const std::bad_alloc&) {
      // Not every failed allocation throws, because some library calls succeed without the memory.
    }
    ASSERT_EQ(names(), std::vector<std::string>{}) << before;
  }
}

TEST_F(TableFiles, PartialFile_ProgressFileIsALink_IsNotLeft) {
  fs::create_symlink("precious", at("t.nc.partial.txt"));
  EXPECT_THROW(TableOutput(resumable_job(at("t.nc"), sample_table(3, 2, 2))), IoError);
  EXPECT_EQ(names(), std::vector<std::string>{"t.nc.partial.txt"});
}

TEST_F(TableFiles, PartialFile_CancelledWhileItIsRead_StaysAsItWas) {
  const TableValues part = sample_table(3, 2, 2);
  TableOutput::Job job = resumable_job(at("t.nc"), part);
  TableOutput(job).write(part, {}, "first");
  const std::string values = read_file(at("t.nc.partial")), progress = read_file(at("t.nc.partial.txt"));
  job.progress = [](std::size_t, std::size_t) { return false; };
  EXPECT_THROW(TableOutput{job}, Cancelled);
  EXPECT_EQ(read_file(at("t.nc.partial")), values);
  EXPECT_EQ(read_file(at("t.nc.partial.txt")), progress);
  job.progress = [](std::size_t done, std::size_t total) { return done == 0 && total == 24; };
  EXPECT_EQ(TableOutput(job).parts_done(), 1U);
}

TEST_F(TableFiles, WriteText_ExistingFile_IsReplacedWithItsPermissions) {
  put("t.csv", "a longer text than the new one");
  fs::permissions(at("t.csv"), fs::perms::owner_read | fs::perms::owner_write);
  write_text_atomically(at("t.csv"), "new");
  EXPECT_EQ(read_file(at("t.csv")), "new");
  EXPECT_EQ(fs::status(at("t.csv")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(TableFiles, WriteText_SymbolicLink_ReplacesWhatItPointsTo) {
  fs::create_directory(at("elsewhere"));
  fs::create_symlink("elsewhere/t.csv", at("link.csv"));
  for (const char* text : {"dangling before", "replaced"}) {
    write_text_atomically(at("link.csv"), text);
    EXPECT_TRUE(fs::is_symlink(at("link.csv")));
    EXPECT_EQ(read_file(at("elsewhere/t.csv")), text);
  }
  fs::create_symlink("loop.csv", at("loop.csv"));
  EXPECT_THROW(write_text_atomically(at("loop.csv"), "text"), IoError);
}

TEST_F(TableFiles, WriteText_RelativeName_GoesToTheCurrentFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(at("."));
  write_text_atomically("here.csv", "text");
  fs::current_path(before);
  EXPECT_EQ(read_file(at("here.csv")), "text");
}

// The rows of a part are converted to text in blocks of 65,536.
TEST_F(TableFiles, ResultCsv_PartsOfManyRows_KeepTheirOrder) {
  ResultCsv csv(at("p.csv"), "row", {.quantities = {Quantity::kDolp}},
                [](std::string& text, std::size_t row) { text += std::to_string(row) + ','; });
  for (const std::size_t rows : {70'000U, 3U}) {
    ResultColumns part;
    part[Quantity::kDolp].assign(rows, 0.5);
    part.status.assign(rows, 32);
    csv.append(part);
  }
  csv.commit();
  std::string expected = "row,dolp,status\n";
  for (std::size_t row = 0; row < 70'003; ++row) expected += std::to_string(row) + ",0.5,32\n";
  EXPECT_TRUE(read_file(at("p.csv")) == expected);
}
}  // namespace table_writing_test
