// The program from outside: exit statuses, messages, and what a run that fails leaves behind.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <ostream>

#include "cli_support.hpp"

namespace {

using namespace dolp;
namespace fs = std::filesystem;

enum Status { kDone = 0, kAccuracy = 1, kInput = 2, kDevice = 3, kIo = 4, kMemory = 6, kInterrupted = 130 };

const std::vector<std::string> kInputFiles = {"points.csv", "scene.toml"};
/// Half a million entries at a tight tolerance: minutes of work, so that an interrupt always comes in time.
const std::vector<std::string> kLongRun = {"--evaluator", "cpu",
                                           "--tolerance", "1e-9",
                                           "--precision", "double",
                                           "--set",       "grid.theta_deg={from=0, to=89, count=5000}",
                                           "--set",       "grid.sigma={from=0.05, to=1, count=100}"};

struct Mistake {
  const char* name;
  std::vector<std::string> arguments;
  Status status;
  std::vector<std::string> message;  ///< parts of the line
  std::string scene = kScene;
  std::string points = kPoints;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

std::string name_of(const testing::TestParamInfo<Mistake>& info) { return info.param.name; }

class CommandLineMistake : public CommandLine, public testing::WithParamInterface<Mistake> {};

TEST_P(CommandLineMistake, Run_OneLineAndNothingWritten) {
  const Mistake& mistake = GetParam();
  put("scene.toml", mistake.scene);
  put("points.csv", mistake.points);
  const Outcome outcome = dolp(mistake.arguments);
  for (const std::string& part : mistake.message) expect_refused(outcome, part, mistake.status);
  EXPECT_EQ(names(), kInputFiles);
}

const std::vector<std::string> kTable = {"table", "scene.toml", "-o", "out.nc"};
const std::vector<std::string> kEval = {"eval", "scene.toml", "--points", "points.csv", "-o", "out.csv"};

std::string scene_with(const std::string& text, const std::string& replacement) {
  std::string scene = kScene;
  return scene.replace(scene.find(text), text.size(), replacement);
}

INSTANTIATE_TEST_SUITE_P(
    Usage, CommandLineMistake,
    testing::Values(
        Mistake{"UnknownCommand", {"tabel", "scene.toml"}, kInput, {"tabel", "nearest command is table"}},
        Mistake{"UnknownOption",
                joined(kTable, {"--sigma", "3"}),
                kInput,
                {"--sigma 3: ", "--set surface.sigma=VALUE", "(see dolp table --help)"}},
        Mistake{"MisspeltOption",
                joined(kTable, {"--tolerence", "1e-3"}),
                kInput,
                {"--tolerence 1e-3: unknown here; did you mean --tolerance?"}},
        Mistake{"ToleranceOutOfRange", joined(kTable, {"--tolerance", "1"}), kInput, {"--tolerance 1: 1 is out of"}},
        Mistake{"NoScene", {"table", "-o", "out.nc"}, kInput, {"SCENE"}},
        Mistake{"NoOutput", {"table", "scene.toml"}, kInput, {"--output", "(see dolp table --help)"}},
        Mistake{"NoPoints", {"eval", "scene.toml", "-o", "out.csv"}, kInput, {"--points"}},
        Mistake{"SceneAndPointsFromStdin",
                {"eval", "-", "--points", "-", "-o", "out.csv"},
                kInput,
                {"--points -", "SCENE", "stdin"}},
        Mistake{"NoValue", joined(kTable, {"--tolerance"}), kInput, {"--tolerance"}},
        Mistake{"EmptyTolerance", joined(kTable, {"--tolerance", ""}), kInput, {"--tolerance", "must not be empty"}},
        Mistake{"DeviceOfAnEvaluatorWithoutOne",
                joined(kTable, {"--device", "nvidia", "--evaluator", "cpu"}),
                kInput,
                {"--device nvidia", "--evaluator vulkan"}},
        Mistake{"NegativeSeed", {"verify", "scene.toml", "--seed", "-1"}, kInput, {"--seed", "-1"}},
        Mistake{"ControlCharacters", {"table", "\x1b]0;t\a\n.toml", "-o", "out.nc"}, kInput, {"?]0;t??.toml: "}},
        Mistake{"UnknownEvaluator",
                joined(kTable, {"--evaluator", "gpu"}),
                kInput,
                {"--evaluator", "gpu", "vulkan", "cpu", "reference"}},
        Mistake{"UnknownSuffix", {"table", "scene.toml", "-o", "out.txt"}, kInput, {"out.txt", ".nc", ".csv", ".npy"}},
        Mistake{
            "SetUnknownKey", joined(kTable, {"--set", "surface.sigm=1"}), kInput, {"surface.sigm=1", "surface.sigma"}},
        Mistake{"MaterialRangeDescends", {"materials", "iron", "--at", "8:1"}, kInput, {"--at 8:1: ", "FROM:TO:COUNT"}},
        Mistake{"MaterialWithoutWavelength", {"materials", "iron"}, kInput, {"--at", "(see dolp materials --help)"}},
        Mistake{"MaterialThatIsUnknown", {"materials", "irn", "--at", "9"}, kInput, {"irn", "iron"}},
        Mistake{"MaterialWithAnotherLetter", {"materials", "golt", "--at", "9"}, kInput, {"golt: ", "gold ("}},
        Mistake{"MaterialBeyondItsRange",
                {"materials", "iron", "--at", "99"},
                kInput,
                {"--at 99: iron is known from 2 to 20 um"}},
        Mistake{"MaterialPartlyBeyondItsRange",
                {"materials", "iron", "--at", "8:30"},
                kInput,
                {"--at 8:30: iron is known from 2 to 20 um"}},
        Mistake{"KeyFarFromAll", {"keys", "foo"}, kInput, {"foo: is no key of a scene; dolp keys lists all"}},
        Mistake{"KeyWithoutItsTable", {"keys", "sgma"}, kInput, {"the nearest is surface.sigma"}},
        Mistake{"MaterialAtAWord", {"materials", "iron", "--at", "x"}, kInput, {"--at x"}},
        Mistake{"SetWithoutValue", joined(kTable, {"--set", "surface.sigma"}), kInput, {"--set", "surface.sigma"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    SceneValues, CommandLineMistake,
    testing::Values(Mistake{"MissingFile", {"table", "none.toml", "-o", "out.nc"}, kInput, {"none.toml"}},
                    Mistake{"SkyThatIsNone",
                            joined(kTable, {"--set", "surroundings.profile=clear"}),
                            kInput,
                            {"surroundings.profile=clear: no such file, and no built-in sky: clear-sky, overcast; the "
                             "nearest is clear-sky"}},
                    Mistake{"NotToml", kTable, kInput, {"scene.toml:2"}, scene_with("[surface]", "[surface")},
                    Mistake{"UnknownKey",
                            kTable,
                            kInput,
                            {"scene.toml:3", "surface.m", "surface.n"},
                            scene_with("n = 1.5", "m = 1.5")}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Points, CommandLineMistake,
    testing::Values(
        Mistake{"MissingFile", {"eval", "scene.toml", "--points", "none.csv", "-o", "o.csv"}, kInput, {"none.csv"}},
        Mistake{"UnknownColumn", kEval, kInput, {"points.csv:1", "angle", "theta_deg"}, kScene, "angle\n10\n"},
        Mistake{"NoAngleAnywhere", kEval, kInput, {"theta_deg"}, kScene, "sigma\n0.1\n"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Output, CommandLineMistake,
    testing::Values(Mistake{"MissingFolder", {"table", "scene.toml", "-o", "none/out.nc"}, kIo, {"none/out.nc"}},
                    // Even root can make no file there.
                    Mistake{"UnwritableFolder", {"table", "scene.toml", "-o", "/proc/out.nc"}, kIo, {"/proc/out.nc"}},
                    Mistake{"Folder", {"eval", "scene.toml", "--points", "points.csv", "-o", "."}, kIo, {"folder"}},
                    Mistake{"FullDevice",
                            {"eval", "scene.toml", "--points", "points.csv", "-o", "/dev/full"},
                            kIo,
                            {"/dev/full", "No space left"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Device, CommandLineMistake,
    testing::Values(Mistake{
        "UnknownDevice", joined(kTable, {"--device", "no such device"}), kDevice, {"no such device", "0 = "}}),
    name_of);

TEST_F(CommandLine, PointsWithoutRows_GiveAHeaderAlone) {
  put("points.csv", "theta_deg\n");
  EXPECT_EQ(dolp(joined(kEval, {"--evaluator", "cpu"})).status, kDone);
  EXPECT_EQ(data_lines(content("out.csv")).size(), 1U);
}

TEST_F(CommandLine, ToleranceThatFloatMisses_IsSaidOfWhat) {
  const Outcome outcome = dolp(joined(kTable, {"--evaluator", "cpu", "--precision", "float", "--tolerance", "1e-9"}));
  EXPECT_EQ(outcome.status, kDone) << outcome.err;
  EXPECT_NE(outcome.out.find("tolerance not met, of DOLP and rho"), std::string::npos) << outcome.out;
}

TEST_F(CommandLine, StandardOutput_Full_Exit4) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"materials"},
                                                    {"keys"},
                                                    kTable,
                                                    {"eval", "scene.toml", "--points", "points.csv", "-o", "-"},
                                                    {"--help"},
                                                    {"table", "--help"},
                                                    {"--version"},
                                                    {"--cite"},
                                                    {"completion", "bash"},
                                                    {}}) {
    Command wanted = command(arguments);
    wanted.out_path = "/dev/full";
    const Outcome outcome = run(wanted);
    EXPECT_EQ(outcome.status, kIo) << testing::PrintToString(arguments);
    expect_one_line(outcome.err, "standard output: cannot write");
  }
}

TEST_F(CommandLine, Devices_NoDriver_Exit3) {
  Command wanted = command({"devices"});
  wanted.environment = kNoDriver;
  const Outcome outcome = run(wanted);
  expect_refused(outcome, "no Vulkan driver", kDevice);
}

TEST_F(CommandLine, Vulkan_NoDriver_Exit3WithoutUsingTheCpu) {
  put("out.csv", "kept\n");
  Command wanted = command(kEval);
  wanted.environment = kNoDriver;
  const Outcome outcome = run(wanted);
  expect_refused(outcome, "no Vulkan driver", kDevice);
  EXPECT_EQ(content("out.csv"), "kept\n");
}

TEST_F(CommandLine, CpuAndReference_NoDriver_Work) {
  for (const char* evaluator : {"cpu", "reference"}) {
    Command wanted = command(joined(kEval, {"--evaluator", evaluator}));
    wanted.environment = kNoDriver;
    const Outcome outcome = run(wanted);
    EXPECT_EQ(outcome.status, kDone) << outcome.err;
    EXPECT_EQ(parse_csv(content("out.csv")).at("dolp").size(), 3U);
  }
}

TEST_F(CommandLine, Strict_FloatAtTightTolerance_Exit1WithTheResults) {
  // Float rounding alone, 6e-8 of each term, is far above this tolerance.
  const std::vector<std::string> hard = joined(kEval, {"--tolerance", "1e-10", "--precision", "float"});
  EXPECT_EQ(dolp(hard).status, kDone);
  const Outcome outcome = dolp(joined(hard, {"--strict"}));
  EXPECT_EQ(outcome.status, kAccuracy);
  const Columns columns = parse_csv(content("out.csv"));
  ASSERT_EQ(columns.at("status").size(), 3U);
  EXPECT_TRUE(std::ranges::any_of(columns.at("status"), [](double s) { return (static_cast<int>(s) & 2) != 0; }));
}

TEST_F(CommandLine, Strict_ToleranceMet_Exit0) { EXPECT_EQ(dolp(joined(kEval, {"--strict"})).status, kDone); }

TEST_F(CommandLine, BadScene_ExistingOutput_Kept) {
  put("out.nc", "kept\n");
  EXPECT_EQ(dolp(joined(kTable, {"--set", "surface.q=0"})).status, kInput);
  EXPECT_EQ(content("out.nc"), "kept\n");
}

TEST_F(CommandLine, Report_ForeignText_ObeysNoTerminal) {
  put("scene.toml", scene_with("Sixteen entries", "\\u001b]0;mine\\u0007\\nsecond"));
  const Outcome text = dolp(kEval);
  EXPECT_EQ(text.status, kDone) << text.err;
  EXPECT_TRUE(text.out.starts_with("?]0;mine??second\n")) << text.out;
  const Outcome table = dolp({"table", "scene.toml", "-o", "-", "--quiet"});
  EXPECT_EQ(table.out.find('\x1b'), std::string::npos);
}

TEST_F(CommandLine, Json_NameThatIsNotUtf8_Works) {
  for (const char* name : {"\xff.csv", "\xc2\x9b.csv"}) {
    const Outcome outcome = dolp({"eval", "scene.toml", "--points", "points.csv", "-o", name, "--json"});
    EXPECT_EQ(outcome.status, kDone) << outcome.err;
    EXPECT_TRUE(std::ranges::all_of(outcome.out, [](char c) { return c == '\n' || (c >= ' ' && c < '\x7f'); }));
    EXPECT_TRUE(fs::exists(at(name)));
  }
}

TEST_F(CommandLine, Output_OverAFileThatTheSceneNames_IsRefused) {
  const std::string index = "wavelength_um,n,k\n9,1.4,0.1\n11,1.6,0.1\n";
  const std::string light = "9,1\n11,2\n";
  put("index.csv", index);
  put("light.csv", light);
  fs::create_hard_link(at("light.csv"), at("same.csv"));
  put("scene.toml",
      scene_with("n = 1.5\nk = 0.1", "material_file = \"index.csv\"") + "[source]\nfile = \"light.csv\"\n");
  for (const char* output : {"index.csv", "light.csv", "same.csv"}) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"table", "scene.toml"}, {"eval", "scene.toml", "--points", "points.csv"}}) {
      const Outcome outcome = dolp(joined(arguments, {"-o", output}));
      EXPECT_EQ(outcome.status, kInput);
      EXPECT_NE(outcome.err.find("would overwrite an input"), std::string::npos) << outcome.err;
    }
  }
  EXPECT_EQ(content("index.csv"), index);
  EXPECT_EQ(content("light.csv"), light);
}

TEST_F(CommandLine, Output_ReadOnlyFile_IsKept) {
  put("out.csv", "kept\n");
  fs::permissions(at("out.csv"), fs::perms::owner_read);
  const Outcome outcome = dolp(kEval);
  EXPECT_EQ(outcome.status, kIo);
  EXPECT_NE(outcome.err.find("out.csv: is read-only"), std::string::npos) << outcome.err;
  EXPECT_EQ(content("out.csv"), "kept\n");
}

TEST_F(CommandLine, Interrupt_LongRun_Exit130AndNothingLeft) {
  put("out.nc", "kept\n");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    TerminalProcess process(command(joined(kTable, kLongRun)));
    ASSERT_TRUE(process.wait_for_output());  // the progress bar: the work has begun
    process.send_signal(signal);
    const Outcome outcome = process.finish();
    EXPECT_EQ(outcome.status, kInterrupted);
    EXPECT_NE(outcome.err.find("dolp: interrupted"), std::string::npos) << outcome.err;
    EXPECT_EQ(content("out.nc"), "kept\n");
    EXPECT_EQ(names(), (std::vector<std::string>{"out.nc", "points.csv", "scene.toml"}));
  }
}

TEST_F(CommandLine, Interrupt_WhileWriting_Exit130) {
  ASSERT_EQ(dolp(kTable).status, kDone);
  std::string points = "theta_deg,sigma,q\n";
  for (int i = 0; i < 2000; ++i) points += "60,0.1,2\n";  // results for more than a pipe holds
  put("many.csv", points);
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"eval", "scene.toml", "--evaluator", "cpu"}, {"lookup", "out.nc"}}) {
    TerminalProcess process(command(joined(arguments, {"--points", "many.csv", "-o", "pipe"})));
    const Descriptor reader(::open(at("pipe").c_str(), O_RDONLY | O_CLOEXEC));  // waits until the program writes
    process.send_signal(SIGINT);
    const Outcome outcome = process.finish();
    EXPECT_EQ(outcome.status, kInterrupted);
    EXPECT_NE(outcome.err.find("dolp: interrupted"), std::string::npos) << outcome.err;
  }
}

TEST_F(CommandLine, Hangup_Ignored_IsNoInterrupt) {
  std::string points = "theta_deg,sigma,q\n";
  for (int i = 0; i < 2000; ++i) points += "60,0.1,2\n";
  put("many.csv", points);
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  Command wanted = command({"eval", "scene.toml", "--evaluator", "cpu", "--points", "many.csv", "-o", "pipe"});
  wanted.arguments.insert(wanted.arguments.begin(), {"nohup"});
  TerminalProcess process(wanted);
  {
    std::ifstream reader(at("pipe"));  // waits until the program writes
    process.send_signal(SIGHUP);
    const std::string written{std::istreambuf_iterator<char>(reader), {}};
    EXPECT_EQ(std::ranges::count(written, '\n'), 2001);
  }
  EXPECT_EQ(process.finish().status, kDone);
}

TEST_F(CommandLine, LimitOfFileSize_Exit4AndNothingLeft) {
  Command wanted = command(kTable);
  wanted.arguments.insert(wanted.arguments.begin(), {"bash", "-c", "ulimit -f 1; exec \"$@\"", "bash"});
  const Outcome outcome = run(wanted);
  EXPECT_EQ(outcome.status, kIo);
  expect_one_line(outcome.err);
  EXPECT_EQ(names(), kInputFiles);
}

TEST_F(CommandLine, OutOfMemory_Exit6InOneLine) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer takes terabytes of addresses";
#endif
  std::string points = "theta_deg\n";
  for (int i = 0; i < 4'000'000; ++i) points += "0\n";
  put("points.csv", points);
  Command wanted = command(joined(kEval, {"--evaluator", "cpu"}));
  wanted.arguments.insert(wanted.arguments.begin(), {"bash", "-c", "ulimit -v 400000; exec \"$@\"", "bash"});
  const Outcome outcome = run(wanted);
  EXPECT_EQ(outcome.status, kMemory);
  expect_one_line(outcome.err);
  EXPECT_NE(outcome.err.find("out of memory: more than"), std::string::npos) << outcome.err;
  EXPECT_EQ(names(), kInputFiles);
}

TEST_F(CommandLine, Interrupt_WaitingForInput_Ends) {
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  TerminalProcess process(command({"eval", "scene.toml", "--points", "pipe", "-o", "out.csv"}));
  const Descriptor writer(::open(at("pipe").c_str(), O_WRONLY | O_CLOEXEC));  // waits until the program reads
  process.send_signal(SIGINT);
  EXPECT_EQ(process.finish().status, -SIGINT);  // which a shell shows as 130
  EXPECT_FALSE(fs::exists(at("out.csv")));
}

}  // namespace
