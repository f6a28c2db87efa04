// The study of scale: time and peak memory of `dolp table` for tables of different size, and for shards of one table.
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <array>
#include <chrono>
#include <dolp/errors.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/stopwatch.hpp"
#include "base/temporary_folder.hpp"
#include "methods/method.hpp"
#include "studies/child.hpp"
#include "studies/study.hpp"
#include "studies/study_run.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kQuickListEntries = 1'000'000;
constexpr std::size_t kShardedEntries = 10'000'000;
constexpr std::array<std::size_t, 4> kShards = {1, 2, 4, 8};
constexpr std::size_t kBytesOfKilobyte = 1024;

constexpr const char* kScene = R"([surface]
masking = "v-cavity"
[emission]
temperature_K = 300
[surroundings]
temperature_K = 260
[grid]
theta_deg = { from = 0, to = 88, count = 50 }
sigma = { from = 0.05, to = 0.8, count = 50, spacing = "log" }
q = [1.8, 2, 3, 5]
[accuracy]
tolerance = 1e-3
)";

/// Numbers of wavelengths, of n and of k on the grid. Each combination of these values has 10,000 entries.
struct Size {
  std::size_t wavelengths, n, k;
  std::size_t entries() const { return 10'000 * wavelengths * n * k; }
};
constexpr std::array<Size, 7> kSizes = {
    {{1, 1, 1}, {1, 10, 1}, {1, 10, 10}, {10, 10, 10}, {10, 20, 10}, {10, 25, 20}, {10, 25, 40}}};

std::vector<std::string> grid_of(const Size& size) {
  const auto axis = [](const char* key, double from, double to, std::size_t count) {
    return fmt::format("grid.{}={{from={}, to={}, count={}}}", key, from, count == 1 ? from : to, count);
  };
  return {"--set", axis("wavelength_um", 8.0, 12.0, size.wavelengths),
          "--set", axis("n", 1.3, 4.0, size.n),
          "--set", axis("k", 0.05, 1.0, size.k)};
}

/// A temporary folder that contains the scene file.
class Folder {
 public:
  Folder() : folder_("dolp-bench") { std::ofstream(at("scene.toml")) << kScene; }
  std::string at(const std::string& name) const { return (folder_.path() / name).string(); }

 private:
  TemporaryFolder folder_;
};

/// Starts a program and discards its standard output.
pid_t start(const std::vector<std::string>& arguments) {
  std::vector<char*> words;
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int error = ::posix_spawn(&process, words.front(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw Unavailable("no process could be started for " + arguments.front());
  return process;
}

/// Waits for the end of all programs and returns the largest peak memory. Errors: Unavailable if a program failed.
std::size_t peak_bytes(const std::vector<pid_t>& processes) {
  std::size_t peak = 0;
  bool is_done = true;
  for (const pid_t process : processes) {
    int status = 0;
    rusage used{};
    is_done = ::wait4(process, &status, 0, &used) >= 0 && status == 0 && is_done;
    peak = std::max(peak, static_cast<std::size_t>(used.ru_maxrss) * kBytesOfKilobyte);
  }
  if (!is_done) throw Unavailable("dolp failed");
  return peak;
}

std::vector<std::string> table_command(const StudyOptions& options, const Folder& folder, const Size& size) {
  const std::string program = fs::path(own_program()).replace_filename("dolp").string();
  std::vector<std::string> command = {program, "table", folder.at("scene.toml"), "-o", folder.at("t.nc"), "--quiet"};
  const std::vector<std::string> grid = grid_of(size);
  command.insert(command.end(), grid.begin(), grid.end());
  if (!options.device.empty()) command.insert(command.end(), {"--device", options.device});
  return command;
}

/// Measures a table that one process computes. Returns a row of the results. For comparison with the time of the table,
/// the row also has the time in which `cp` copies the file.
ordered_json size_row(const StudyOptions& options, const Size& size) {
  const Folder folder;
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t peak = peak_bytes({start(table_command(options, folder, size))});
  const double time_s = seconds_since(begin);
  const auto copy = std::chrono::steady_clock::now();
  peak_bytes({start({"/bin/cp", folder.at("t.nc"), folder.at("copy.nc")})});
  return {{"method", "dolp table"},
          {"case", "entries"},
          {"setting", fmt::format("{} x {} x {} x 50 x 50 x 4", size.wavelengths, size.n, size.k)},
          {"entries", size.entries()},
          {"time_s", time_s},
          {"copy_time_s", seconds_since(copy)},
          {"peak_bytes", peak},
          {"file_bytes", fs::file_size(folder.at("t.nc"))},
          {"raw_times_s", {time_s}}};
}

/// Measures a table in `count` shards, which run at the same time. Then `dolp merge` joins their files. Returns a row
/// of the results.
ordered_json shards_row(const StudyOptions& options, const Size& size, std::size_t count) {
  const Folder folder;
  const auto begin = std::chrono::steady_clock::now();
  std::vector<pid_t> processes;
  std::vector<std::string> merge = {fs::path(own_program()).replace_filename("dolp").string(), "merge"};
  for (std::size_t i = 1; i <= count; ++i) {
    std::vector<std::string> command = table_command(options, folder, size);
    if (count > 1) command.insert(command.end(), {"--shard", fmt::format("{}/{}", i, count)});
    processes.push_back(start(command));
    merge.push_back(folder.at(fmt::format("t.{}-of-{}.nc", i, count)));
  }
  const std::size_t peak = peak_bytes(processes);
  const double time_s = seconds_since(begin);
  const auto join = std::chrono::steady_clock::now();
  merge.insert(merge.end(), {"-o", folder.at("t.nc"), "--quiet"});
  if (count > 1) peak_bytes({start(merge)});
  return {
      {"method", "dolp table"},    {"case", "shards"},       {"setting", std::to_string(count)},
      {"entries", size.entries()}, {"time_s", time_s},       {"merge_time_s", count > 1 ? seconds_since(join) : 0.0},
      {"peak_bytes", peak},        {"raw_times_s", {time_s}}};
}

void measure_tables(StudyRun& run) {
  const StudyOptions& options = run.options();
  const std::size_t most = options.quick ? std::min(options.entries, kQuickListEntries) : options.entries;
  std::vector<Size> sizes;
  for (const Size& size : kSizes) {
    if (size.entries() <= most) sizes.push_back(size);
  }
  if (sizes.empty()) throw InputError(fmt::format("--entries {}: must be at least 10000", options.entries));
  Size sharded = sizes.back();
  for (const Size& size : sizes) {
    if (size.entries() == kShardedEntries) sharded = size;
  }
  run.describe("scale", "none", "seconds of `dolp table`, from its start to its end, file included");
  run.expect(sizes.size() + kShards.size());
  for (const Size& size : sizes) run.finish(size_row(options, size));
  for (const std::size_t count : kShards) run.finish(shards_row(options, sharded, count));
}

std::string scale_table(const ordered_json& result) {
  std::string text = fmt::format("{:<8} {:>28} {:>12} {:>10} {:>10}\n", "case", "setting", "entries", "time", "peak");
  for (const ordered_json& row : result["results"]) {
    text += fmt::format("{:<8} {:>28} {:>12} {:>10} {:>7.0f} MB\n", row["case"].get<std::string>(),
                        row["setting"].get<std::string>(), row["entries"].get<std::size_t>(),
                        time_text(row["time_s"].get<double>()), 1e-6 * row["peak_bytes"].get<double>());
  }
  return text;
}

}  // namespace

void run_scale(const StudyOptions& options) {
  run_study(options, {.measure = measure_tables, .table_text = scale_table});
}

}  // namespace dolp::bench
