// Tables in parts: shards and their merge, runs that are killed and resumed, and axes of wavelength, n and k.
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "cli_support.hpp"
#include "table/table_file.hpp"
#include "table_support.hpp"

namespace dolp::shards_test {
namespace {

namespace fs = std::filesystem;

// The values of theta and sigma are not in ascending order. The values of sigma and q are so dense that the program
// interpolates between some of them.
const std::string kGrid = R"(title = "in parts"
[surface]
k = 0.2
masking = "v-cavity"
[emission]
temperature_K = 300.0
[surroundings]
temperature_K = 250.0
[grid]
wavelength_um = [12.0, 8.0]
n = [1.4, 3.0]
theta_deg = [0, 12, 30, 60, 85, 89.95, 90]
sigma = { from = 0.8, to = 0.05, count = 20 }
q = { from = 1.6, to = 6, count = 20 }
)";

// A table that a run computes in more than one part.
const Words kLarge =
    "--set grid.theta_deg={from=0,to=89,count=320} --set grid.sigma={from=0.1,to=0.8,count=64} --set "
    "grid.q={from=1.8,to=6,count=64} --set grid.wavelength_um=[10.0,8.0] --set grid.n=[1.5] --tolerance 1e-2 "
    "--quantities dolp,status";

class Shards : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    put("grid.toml", kGrid);
  }

  std::vector<std::string> shard_names(std::size_t count) const {
    std::vector<std::string> names;
    for (std::size_t i = 1; i <= count; ++i)
      names.push_back("t." + std::to_string(i) + "-of-" + std::to_string(count) + ".nc");
    return names;
  }

  void expect_same(const std::string& a, const std::string& b) {
    const TableValues one = read_table(at(a));
    const TableValues other = read_table(at(b));
    EXPECT_EQ(one.axes, other.axes);
    EXPECT_EQ(one.status, other.status);
    for (const Quantity quantity : kAllQuantities)
      dolp::expect_same(one[quantity], other[quantity], describe(quantity).name);
  }
};

// There are 14 shards but only 7 zeniths. So the shards also divide the axis of the two wavelengths.
TEST_F(Shards, OfSeveralAxes_MergeIntoTheTableAndItsCsv) {
  const std::string table = "table grid.toml --evaluator cpu -o ";
  succeeded(dolp(table + "one.csv"));
  for (int i = 1; i <= 14; ++i) succeeded(dolp(table + "t.nc --shard " + std::to_string(i) + "/14"));
  succeeded(dolp(joined(joined("merge", shard_names(14)), "-o m.csv")));
  EXPECT_EQ(data_lines(read_file(at("m.csv"))), data_lines(read_file(at("one.csv"))));
  expect_refused(
      dolp("table grid.toml -o t.nc --shard 1/11"),
      "the values of the axes, 7 of theta, 2 of wavelength, 2 of n, cannot be cut into 11 parts, but into 10 or 12");
}

TEST_F(Shards, MissingForeignOrDoubled_AreNamed) {
  for (const std::string shard : {"1/2", "2/2"}) succeeded(dolp("table grid.toml -o t.nc --shard " + shard));
  succeeded(dolp("table grid.toml -o f.nc --shard 2/2 --set surface.k=0.3"));
  succeeded(dolp("table scene.toml -o whole.nc"));
  for (const auto& [shards, error] :
       {std::pair("t.1-of-2.nc", "missing shards: 2/2\n"),
        {"t.1-of-2.nc t.1-of-2.nc", "t.1-of-2.nc: is shard 1/2, as t.1-of-2.nc is\n"},
        {"t.1-of-2.nc f.2-of-2.nc", "f.2-of-2.nc: is a shard of another table: it has scene"},
        {"t.1-of-2.nc whole.nc", "whole.nc: is no shard of a table (attribute shard)\n"},
        {"t.1-of-2.nc none.nc", "none.nc: there is no such file\n"}}) {
    expect_refused(dolp(joined(joined("merge", shards), "-o m.nc")), std::string("dolp: ") + error);
    EXPECT_FALSE(fs::exists(at("m.nc")));
  }
}

TEST_F(Shards, ThereAlready_IsKept_AndOneOfAnotherSceneIsNot) {
  const Words wanted = "table grid.toml -o t.nc --shard 1/2";
  succeeded(dolp(wanted));
  const auto written = fs::last_write_time(at("t.1-of-2.nc"));
  EXPECT_TRUE(contains(succeeded(dolp(wanted)).out, "the whole shard is there already"));
  EXPECT_EQ(fs::last_write_time(at("t.1-of-2.nc")), written);
  succeeded(dolp(joined(wanted, "--set surface.k=0.3")));
  EXPECT_NE(fs::last_write_time(at("t.1-of-2.nc")), written);
}

TEST_F(Shards, Auto_TakesTheTaskOfTheSlurmArray) {
  const Words wanted = "table grid.toml -o t.nc --shard auto";
  expect_refused(dolp(wanted), "SLURM_ARRAY_TASK_ID is not set");
  Command in_array = command(wanted);
  in_array.environment = {
      {"SLURM_ARRAY_TASK_ID", "12"}, {"SLURM_ARRAY_TASK_MIN", "10"}, {"SLURM_ARRAY_TASK_COUNT", "4"}};
  succeeded(run(in_array));
  EXPECT_TRUE(fs::exists(at("t.3-of-4.nc")));
}

TEST_F(Shards, BadNumbers_OneLineEach) {
  for (const std::string text : {"0/2", "3/2", "1", "a/b", "0/0", "1/0", "-1/2", "1.5/2"})
    expect_refused(dolp({"table", "grid.toml", "-o", "t.nc", "--shard=" + text}), "shard");
}

TEST_F(Shards, OneOfOne_HasTheNameOfAShard_AndMerges) {
  succeeded(dolp("table grid.toml -o t.nc --shard 1/1"));
  EXPECT_FALSE(fs::exists(at("t.nc")));
  succeeded(dolp("table grid.toml -o one.nc"));
  succeeded(dolp("merge t.1-of-1.nc -o t.nc"));
  expect_same("one.nc", "t.nc");
}

// A scene that names data files. `merge` must refuse shards that were made from different data or by different options.
class Inputs : public Shards {
 protected:
  void SetUp() override {
    Shards::SetUp();
    put("named.toml", R"(title = "named files"
[surface]
material_file = "m.csv"
[source]
file = "e.csv"
[spectrum]
wavelength_um = 10.0
[grid]
theta_deg = [0, 30, 60, 80]
sigma = [0.1, 0.4]
q = [2.0]
)");
    put("m.csv", "wavelength_um,n,k\n8,1.5,0.1\n12,1.5,0.1\n");
    put("e.csv", "8,1.0\n12,1.0\n");
  }

  Outcome shard(int number, const Words& options = {}) {
    const Words start = "table named.toml -o t.nc --evaluator cpu --shard " + std::to_string(number) + "/2";
    return dolp(joined(start, options));
  }
  Outcome merge() { return dolp(joined(joined("merge", shard_names(2)), "-o m.nc")); }
};

TEST_F(Inputs, NamedFileChangedBetweenShards_IsNamed_AndTheStaleShardIsComputedAgain) {
  for (const std::string name : {"m.csv", "e.csv"}) {
    succeeded(shard(1));
    put(name, name == "m.csv" ? "wavelength_um,n,k\n8,3.5,0.1\n12,3.5,0.1\n" : "8,2.0\n12,2.0\n");
    succeeded(shard(2));
    expect_refused(merge(), "t.2-of-2.nc: is a shard of another table: it has data fnv1a64:");
    EXPECT_FALSE(fs::exists(at("m.nc")));
    EXPECT_FALSE(contains(shard(1).out, "is there already"));
    EXPECT_EQ(merge().status, 0);
    succeeded(dolp("table named.toml -o one.nc --evaluator cpu"));
    expect_same("one.nc", "m.nc");
    fs::remove(at("m.nc"));
  }
}

TEST_F(Inputs, OtherEvaluatorOrOptions_AreNamed_AndAShardOfThemIsNotKept) {
  for (const auto& [options, part] :
       {std::pair("--evaluator reference", "evaluator reference, not cpu"),
        {"--evaluator cpu --keep-all", "keep_all yes, not no"},
        {"--evaluator cpu --precision double", "precision double, not auto"},
        {"--evaluator cpu --quantities status,dolp", "quantities dolp,status, not all"}}) {
    succeeded(shard(1));
    succeeded(dolp(joined("table named.toml -o t.nc --shard 2/2", options)));
    expect_refused(merge(), part);
    EXPECT_FALSE(contains(shard(2).out, "is there already"));
    EXPECT_EQ(merge().status, 0);
  }
}

/// Changes the file of a shard as another program might. `text` is Python code, in which `table` is the open file.
class Edited : public Inputs {
 protected:
  void edit(const std::string& name, const std::string& text) {
    const std::string script = "import netCDF4; table = netCDF4.Dataset('" + name + "', 'a'); " + text;
    succeeded(run({.arguments = {"/usr/bin/python3", "-c", script}, .folder = at("")}));
  }
};

TEST_F(Edited, HashOfValuesMissing_IsRefusedByMergeAndVerify) {
  for (const std::string text : {"table.delncattr('values_hash')", "table.values_hash = 1.0"}) {
    succeeded(shard(1));
    succeeded(shard(2));
    edit("t.2-of-2.nc", text);
    expect_refused(merge(), "t.2-of-2.nc: has no text attribute values_hash");
    expect_refused(dolp("verify t.2-of-2.nc --between 9"), "t.2-of-2.nc: has no text attribute values_hash");
    // A later run computes the shard again.
    EXPECT_FALSE(contains(shard(2).out, "is there already"));
    EXPECT_EQ(merge().status, 0);
  }
}

TEST_F(Edited, VariableOfOneShardMissing_IsNamed) {
  succeeded(shard(1));
  succeeded(shard(2));
  for (const std::string of : {"t.1-of-2.nc", "t.2-of-2.nc"}) {
    const std::string whole = content(of);
    for (const std::string name : {"status", "dolp", "stokes_i", "irradiance", "index_n"}) {
      edit(of, "table.renameVariable('" + name + "', 'gone')");
      expect_refused(merge(), "");
      EXPECT_FALSE(fs::exists(at("m.nc")));
      put(of, whole);
    }
  }
}

TEST_F(Edited, AttributesOfOneShardMissing_AreNamed_AndOthersMayBeAdded) {
  succeeded(shard(1));
  succeeded(shard(2));
  edit("t.1-of-2.nc", "table.note = 'seen'; table.createVariable('mine', 'f8', ('theta',))[:] = 2.0");
  EXPECT_EQ(merge().status, 0);
  edit("t.1-of-2.nc", "table.shard = '1/99999999999999'");
  expect_refused(merge(), "cannot be cut into 99999999999999 parts");
  edit("t.1-of-2.nc", "table.shard = '1/2'; table.delncattr('identity')");
  expect_refused(merge(), "t.1-of-2.nc: has no text attribute identity");
}

class Resume : public Shards {
 protected:
  const Words command_ = joined("table grid.toml -o t.nc --resume", kLarge);

  void make_whole() { succeeded(dolp(joined("table grid.toml -o one.nc", kLarge))); }

  /// Starts a run and sends it the signal after it has written its first part.
  Outcome interrupted(int signal) { return interrupted(signal, command_); }
  Outcome interrupted(int signal, const Words& words) {
    TerminalProcess process(command(words));
    std::error_code missing;
    while (fs::file_size(at("t.nc.partial.txt"), missing) == 0 || missing)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    process.send_signal(signal);
    return process.finish();
  }
};

TEST_F(Resume, AfterCtrlC_SaysHowToGoOn_AndGivesTheSameBits) {
  make_whole();
  const Outcome stopped = interrupted(SIGINT);
  EXPECT_EQ(stopped.status, 130);
  EXPECT_TRUE(
      contains(stopped.err, "interrupted; 1 of 3 parts are in t.nc.partial: the same command with --resume goes on"));
  EXPECT_FALSE(fs::exists(at("t.nc")));
  expect_refused(dolp(joined(command_, "--set surface.k=0.3")),
                 "t.nc.partial: is of another run: it has scene fnv1a64:");
  const Outcome resumed = succeeded(dolp(command_));
  expect_same("t.nc", "one.nc");
  EXPECT_FALSE(fs::exists(at("t.nc.partial")));
  EXPECT_FALSE(fs::exists(at("t.nc.partial.txt")));
  EXPECT_TRUE(contains(resumed.out, "2621440"));
}

// An interrupted run leaves its values in t.nc.partial and its progress in t.nc.partial.txt. One of the files is
// damaged before the run resumes.
TEST_F(Resume, OverADamagedPartialFile_GivesTheSameBits) {
  make_whole();
  ASSERT_EQ(interrupted(SIGINT).status, 130);
  const std::string values = content("t.nc.partial"), progress = content("t.nc.partial.txt");
  const auto overwritten = [](std::string bytes, std::size_t offset) {
    return bytes.replace(offset, 64, std::string(64, 'x'));
  };
  const std::vector<std::pair<std::string, std::string>> damaged = {
      {"", progress},                                         // t.nc.partial is removed
      {values.substr(0, 1000), progress},                     // cut within the values of the first part
      {content("one.nc") + values, progress},                 // the finished table stands before the values
      {overwritten(values, 400'000), progress},               // 64 bytes in the first part are overwritten
      {values, overwritten(progress, 30)},                    // the line that identifies the table is overwritten
      {values, overwritten(progress, progress.size() - 80)},  // the line of the last finished part is overwritten
      {values, progress.substr(0, progress.size() - 3)},
      {values, ""}};
  for (std::size_t i = 0; i < damaged.size(); ++i) {
    SCOPED_TRACE(i);
    put("t.nc.partial", damaged[i].first);
    put("t.nc.partial.txt", damaged[i].second);
    if (i == 0) fs::remove(at("t.nc.partial"));
    succeeded(dolp(command_));
    expect_same("t.nc", "one.nc");
    // Sizes differ only because attributes contain times and command lines.
    EXPECT_EQ(fs::file_size(at("t.nc")) / 10'000, fs::file_size(at("one.nc")) / 10'000);
    EXPECT_FALSE(fs::exists(at("t.nc.partial")) || fs::exists(at("t.nc.partial.txt")));
  }
}

TEST_F(Resume, PartialFileIsALink_IsRefused_AndWhatItPointsToStays) {
  for (const std::string name : {"t.nc.partial", "t.nc.partial.txt"}) {
    for (const bool is_symbolic : {true, false}) {
      put("precious", "mine");
      is_symbolic ? fs::create_symlink("precious", at(name)) : fs::create_hard_link(at("precious"), at(name));
      for (const bool is_resumed : {true, false}) {
        Words words = command_;
        if (!is_resumed) std::erase(words, "--resume");
        expect_refused(dolp(words), name + ": is a", 4);
        EXPECT_EQ(content("precious"), "mine");
      }
      fs::remove(at(name));
    }
  }
}

TEST_F(Resume, AfterANamedFileChanged_IsRefused) {
  put("m.csv", "wavelength_um,n,k\n8,1.5,0\n12,1.5,0\n");
  const Words words = "table named.toml -o t.nc --resume --tolerance 1e-2";
  put("named.toml", R"([surface]
material_file = "m.csv"
masking = "v-cavity"
[emission]
temperature_K = 300.0
[grid]
wavelength_um = [10.0, 8.0]
theta_deg = { from = 0, to = 89, count = 320 }
sigma = { from = 0.1, to = 0.8, count = 64 }
q = { from = 1.8, to = 6, count = 64 }
)");
  ASSERT_EQ(interrupted(SIGKILL, words).status, -SIGKILL);
  put("m.csv", "wavelength_um,n,k\n8,3.5,0\n12,3.5,0\n");
  expect_refused(dolp(words), "t.nc.partial: is of another run: it has data fnv1a64:");
}

TEST_F(Resume, OfACsv_IsTheCsvOfOneRun) {
  const Words small = "--set grid.sigma=[0.1] --set grid.q=[2]";
  succeeded(dolp(joined("table grid.toml -o a.csv", small)));
  succeeded(dolp(joined("table grid.toml -o b.csv --resume", small)));
  EXPECT_EQ(data_lines(read_file(at("a.csv"))), data_lines(read_file(at("b.csv"))));
}

}  // namespace
}  // namespace dolp::shards_test
