// Failures of `dolp` as a user sees them: exit statuses, messages, and the files that a failed run leaves.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>

#include "cli_support.hpp"

namespace cli_failure_test {

using namespace dolp;
namespace fs = std::filesystem;

enum Status { kDone = 0, kAccuracy = 1, kInput = 2, kDevice = 3, kIo = 4, kInterrupted = 130 };

const std::vector<std::string> kInputFiles = {"points.csv", "scene.toml"};
/// 500,000 entries at a tight tolerance take minutes, so the run does not end before the signal.
const Words kLongRun =
    "--evaluator cpu --tolerance 1e-9 --precision double --set grid.theta_deg={from=0,to=89,count=5000} "
    "--set grid.sigma={from=0.05,to=1,count=100}";
const std::string kTableLine = "table scene.toml -o out.nc";
const std::string kEvalLine = "eval scene.toml --points points.csv -o out.csv";
const Words kTable = kTableLine;
const Words kEval = kEvalLine;

const std::string kLongName(300, 'n');

std::string scene_with(const std::string& text, const std::string& replacement) {
  std::string scene = kScene;
  return scene.replace(scene.find(text), text.size(), replacement);
}

struct Mistake {
  std::string line;
  std::vector<std::string> message;  ///< text that the message must contain
  Status status = kInput;
  std::string scene = kScene;
  std::string points = kPoints;
};

const std::vector<Mistake> kMistakes = {
    {"tabel scene.toml", {"tabel", "nearest command is table"}},
    {"frobnicate", {"frobnicate: unknown command or option (see dolp --help)"}},
    {kTableLine + " --sigma 3", {"--sigma 3: ", "--set surface.sigma=VALUE", "(see dolp table --help)"}},
    {kTableLine + " --tolerence 1e-3", {"--tolerence 1e-3: unknown here; did you mean --tolerance?"}},
    {kTableLine + " --tolerance 1", {"--tolerance 1: 1 is out of"}},
    {kTableLine + " --tolerance", {"--tolerance"}},
    {kTableLine + " --device nvidia --evaluator cpu", {"--device nvidia", "--evaluator vulkan"}},
    {kTableLine + " --evaluator gpu", {"--evaluator", "gpu", "vulkan", "cpu", "reference"}},
    {kTableLine + " --set surface.sigm=1", {"surface.sigm=1", "surface.sigma"}},
    {kTableLine + " --set surface.sigma", {"--set", "surface.sigma"}},
    {kTableLine + " --device nosuch", {"nosuch", "0 = "}, kDevice},
    {"table -o out.nc", {"SCENE"}},
    {"table scene.toml", {"--output", "(see dolp table --help)"}},
    {"table scene.toml -o out.txt", {"out.txt", ".nc", ".csv", ".npy"}},
    {"table \x1b]0;t\a\n.toml -o out.nc", {"?]0;t??.toml: "}},
    {"eval scene.toml -o out.csv", {"--points"}},
    {"eval - --points - -o out.csv", {"--points -", "SCENE", "stdin"}},
    {"verify scene.toml --seed -1", {"--seed", "-1"}},
    {"materials iron --at 8:1", {"--at 8:1: ", "FROM:TO:COUNT"}},
    {"materials asphalt", {"asphalt: is not one of the 41 built-in materials"}},
    {"materials asphalt --at 10", {"asphalt: is not one of the 41 built-in materials"}},
    {"materials irn --at 9", {"irn", "iron"}},
    {"materials golt --at 9", {"golt: ", "gold ("}},
    {"materials iron --at 99", {"--at 99: iron is known from 2 to 20 um"}},
    {"materials iron --at 8:30", {"--at 8:30: iron is known from 2 to 20 um"}},
    {"materials iron --at x", {"--at x"}},
    {"keys foo", {"foo: is no key of a scene; dolp keys lists all"}},
    {"keys sgma", {"the nearest is surface.sigma"}},
    // Scene and points files.
    {"table none.toml -o out.nc", {"none.toml"}},
    {kTableLine + " --set surroundings.profile=clear",
     {"surroundings.profile=clear: no such file, and no built-in sky: clear-sky, overcast; the nearest is clear-sky"}},
    {kTableLine, {"scene.toml:2"}, kInput, scene_with("[surface]", "[surface")},
    {kTableLine, {"scene.toml:3", "surface.nn", "surface.n"}, kInput, scene_with("n = 1.5", "nn = 1.5")},
    {kTableLine + " --set surroundings.profile=mine.csv",
     {"mine.csv: no such file, and no built-in sky: clear-sky, overcast\n"}},
    {"eval scene.toml --points none.csv -o o.csv", {"none.csv"}},
    {kEvalLine, {"points.csv:1", "angle", "theta_deg"}, kInput, kScene, "angle\n10\n"},
    {kEvalLine, {"theta_deg"}, kInput, kScene, "sigma\n0.1\n"},
    // Output files. In /proc even root cannot create a file.
    {"table scene.toml -o none/out.nc", {"none/out.nc"}, kIo},
    {"table scene.toml -o /proc/out.nc", {"/proc/out.nc"}, kIo},
    {"table scene.toml -o " + kLongName + ".nc", {".nc: cannot create the file: File name too long"}, kIo},
    {"eval scene.toml --points points.csv -o " + kLongName, {"n: cannot create the file: File name too long"}, kIo},
    {"eval scene.toml --points points.csv -o .", {"folder"}, kIo},
    {"eval scene.toml --points points.csv -o /dev/full", {"/dev/full", "No space left"}, kIo}};

TEST_F(CommandLine, Mistake_OneLineAndNothingWritten) {
  for (const Mistake& mistake : kMistakes) {
    SCOPED_TRACE(mistake.line);
    put("scene.toml", mistake.scene);
    put("points.csv", mistake.points);
    const Outcome outcome = dolp(mistake.line);
    for (const std::string& part : mistake.message) expect_refused(outcome, part, mistake.status);
    EXPECT_EQ(names(), kInputFiles);
  }
  expect_refused(dolp(joined(kTable, {"--tolerance", ""})), "must not be empty");
}

TEST_F(CommandLine, InputThatCannotBeLookedAt_IsRefusedWithTheReason) {
  fs::create_symlink("loop.nc", at("loop.nc"));
  const std::vector<std::pair<std::string, std::string>> inputs = {{"loop.nc", "Too many levels of symbolic links"},
                                                                   {kLongName, "File name too long"}};
  for (const auto& [input, reason] : inputs) {
    for (const std::string& line :
         {"table " + input + " -o o.nc", "eval scene.toml --points " + input + " -o o.csv",
          "lookup " + input + " --points points.csv -o o.csv", "verify " + input, "merge " + input + " -o o.nc",
          "fit scene.toml --vary surface.n=1:2 --data " + input, kTableLine + " --set surroundings.profile=" + input,
          kTableLine + " --set surface.material_file=" + input, kTableLine + " --set source.file=" + input}) {
      SCOPED_TRACE(line);
      expect_refused(dolp(line), "cannot be read: " + reason);
    }
  }
}

TEST_F(CommandLine, TemporaryFolderMissing_IsNamed) {
  Command wanted = command("eval scene.toml --points points.csv -o /dev/null --evaluator cpu");
  wanted.environment = {{"TMPDIR", "/none/such"}};
  expect_refused(run(wanted), "/none/such: there is no such folder for temporary files; set TMPDIR", kIo);
}

TEST_F(CommandLine, InputThatWasProbablyMeantOtherwise_IsOneWarningAndGoesOn) {
  put("n.csv", "wavelength_um,n\n8,1.5\n12,1.6\n");
  put("minus.csv", "wavelength_um,n,k\n8,1.5,-0.1\n12,1.5,-0.1\n");
  put("nan.csv", "wavelength_um,n,k\n8,1.5,0.1\n12,1.5,0.1\n13,1.5,nan\n");
  put("unit.dat", "# wavelength n k\n8 1.5 0.1\n12 1.5 0.1\n");
  put("radians.csv", "theta_deg,dolp\n0.5,0.01\n1.2,0.1\n");
  put("nm.csv", "theta_deg,wavelength_um\n60,8000\n");
  for (const auto& [line, warning] :
       {std::pair("plan scene.toml --set emission.temperature_K=25", "--set emission.temperature_K=25: 25 K is cold"),
        {"table scene.toml -o t.csv --evaluator cpu --set surface.material_file=n.csv",
         "=n.csv: the file has no k, so that k = 0"},
        {"plan scene.toml --set surface.material_file=minus.csv",
         "=minus.csv: k is negative in the file, which gives N = n - ik; it is taken as positive"},
        {"plan scene.toml --set surface.material_file=nan.csv", "=nan.csv: rows with NaN are left out: 1 at 13 um"},
        {"plan scene.toml --set surface.material_file=unit.dat",
         "=unit.dat: the file gives no unit of the wavelength; it is taken in um"},
        {"plan scene.toml --set geometry.mode=bistatic", "=bistatic: without [source] nothing depends on theta"},
        {"eval scene.toml --points nm.csv -o o.csv --evaluator cpu --quiet",
         "nm.csv:2: wavelength_um: is in micrometres"},
        {"fit scene.toml --data radians.csv --vary surface.n=1.4:1.6 --starts 1 --evaluator cpu",
         "radians.csv: theta_deg is at most 1.2 degrees"}}) {
    const Outcome outcome = succeeded(dolp(line));
    expect_one_line(outcome.err, "dolp: warning: ");
    expect_one_line(outcome.err, warning);
  }
}

TEST_F(CommandLine, ToleranceThatFloatMisses_IsSaidOfDolpAndOfRho) {
  const Outcome outcome = succeeded(dolp(joined(kTable, "--evaluator cpu --precision float --tolerance 1e-9")));
  for (const char* row : {"status 2   ", "status 16  "}) {
    EXPECT_TRUE(contains(outcome.out, row));
    EXPECT_FALSE(contains(outcome.out, std::string(row) + "0 of"));
  }
}

TEST_F(CommandLine, StandardOutput_Full_Exit4) {
  for (const char* line : {"materials", "keys", "table scene.toml -o out.nc", "--help", "table --help", "--version",
                           "--cite", "completion bash", "", "eval scene.toml --points points.csv -o -"}) {
    Command wanted = command(line);
    wanted.out_path = "/dev/full";
    const Outcome outcome = run(wanted);
    EXPECT_EQ(outcome.status, kIo) << line;
    expect_one_line(outcome.err, "standard output: cannot write");
  }
}

TEST_F(CommandLine, NoDriver_Exit3WithoutUsingTheCpu) {
  put("out.csv", "kept\n");
  for (const auto& arguments : {Words("devices"), Words("verify --hard-cases"), kEval})
    expect_refused(without_device(arguments), "no Vulkan driver", kDevice);
  EXPECT_EQ(content("out.csv"), "kept\n");
}

TEST_F(CommandLine, CpuAndReference_NoDriver_Work) {
  for (const char* evaluator : {"cpu", "reference"}) {
    succeeded(without_device(joined(kEval, {"--evaluator", evaluator})));
    EXPECT_EQ(parse_csv(content("out.csv")).at("dolp").size(), 3U);
  }
}

TEST_F(CommandLine, Strict_FloatAtTightTolerance_Exit1WithTheResults) {
  // rounding in float is 6e-8, far above this tolerance
  const Words hard = joined(kEval, "--tolerance 1e-10 --precision float");
  succeeded(dolp(hard));
  const Outcome outcome = dolp(joined(hard, "--strict"));
  EXPECT_EQ(outcome.status, kAccuracy);
  const Columns columns = parse_csv(content("out.csv"));
  ASSERT_EQ(columns.at("status").size(), 3U);
  EXPECT_TRUE(std::ranges::any_of(columns.at("status"), [](double s) { return (static_cast<int>(s) & 2) != 0; }));
}

TEST_F(CommandLine, Report_ForeignText_ObeysNoTerminal) {
  put("scene.toml", scene_with("Sixteen entries", "\\u001b]0;mine\\u0007\\nsecond"));
  const Outcome text = succeeded(dolp(kEval));
  EXPECT_TRUE(text.out.starts_with("?]0;mine??second\n")) << text.out;
  const Outcome table = dolp("table scene.toml -o - --quiet");
  EXPECT_EQ(table.out.find('\x1b'), std::string::npos);
}

TEST_F(CommandLine, Json_NameThatIsNotUtf8_Works) {
  for (const char* name : {"\xff.csv", "\xc2\x9b.csv"}) {
    const Outcome outcome = succeeded(dolp({"eval", "scene.toml", "--points", "points.csv", "-o", name, "--json"}));
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
    for (const char* start : {"table scene.toml", "eval scene.toml --points points.csv"}) {
      const Outcome outcome = dolp(joined(start, {"-o", output}));  // a warning stands above the error
      EXPECT_EQ(outcome.status, kInput);
      EXPECT_TRUE(contains(outcome.err, "would overwrite an input"));
    }
  }
  EXPECT_EQ(content("index.csv"), index);
  EXPECT_EQ(content("light.csv"), light);
}

TEST_F(CommandLine, Output_ReadOnlyFile_IsKept) {
  put("out.csv", "kept\n");
  fs::permissions(at("out.csv"), fs::perms::owner_read);
  expect_refused(dolp(kEval), "out.csv: is read-only", kIo);
  EXPECT_EQ(content("out.csv"), "kept\n");
}

TEST_F(CommandLine, Interrupt_LongRun_Exit130AndNothingLeft) {
  put("out.nc", "kept\n");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    TerminalProcess process(command(joined(kTable, kLongRun)));
    ASSERT_TRUE(process.wait_for_output());  // the progress bar shows that the work has begun
    process.send_signal(signal);
    const Outcome outcome = process.finish();
    EXPECT_EQ(outcome.status, kInterrupted);
    EXPECT_TRUE(contains(outcome.err, "dolp: interrupted"));
    EXPECT_EQ(content("out.nc"), "kept\n");
    EXPECT_EQ(names(), (std::vector<std::string>{"out.nc", "points.csv", "scene.toml"}));
  }
}

/// Points whose results do not fit into the buffer of a pipe, so that a program waits while it writes them.
std::string many_points() {
  std::string points = "theta_deg,sigma,q\n";
  for (int i = 0; i < 2000; ++i) points += "60,0.1,2\n";
  return points;
}

TEST_F(CommandLine, Interrupt_WhileWriting_Exit130) {
  succeeded(dolp(kTable));
  put("many.csv", many_points());
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  for (const char* start : {"eval scene.toml", "lookup out.nc"}) {
    TerminalProcess process(command(joined(start, "--points many.csv -o pipe --evaluator cpu")));
    // open() returns when the program opens the pipe
    const Descriptor reader(::open(at("pipe").c_str(), O_RDONLY | O_CLOEXEC));
    process.send_signal(SIGINT);
    const Outcome outcome = process.finish();
    EXPECT_EQ(outcome.status, kInterrupted);
    EXPECT_TRUE(contains(outcome.err, "dolp: interrupted"));
  }
}

TEST_F(CommandLine, Hangup_Ignored_IsNoInterrupt) {
  put("many.csv", many_points());
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  Command wanted = command("eval scene.toml --evaluator cpu --points many.csv -o pipe");
  wanted.arguments.insert(wanted.arguments.begin(), "nohup");
  TerminalProcess process(wanted);
  {
    std::ifstream reader(at("pipe"));  // waits until the program opens the pipe
    process.send_signal(SIGHUP);
    const std::string written{std::istreambuf_iterator<char>(reader), {}};
    EXPECT_EQ(std::ranges::count(written, '\n'), 2001);
  }
  EXPECT_EQ(process.finish().status, kDone);
}

TEST_F(CommandLine, Interrupt_WaitingForInput_Ends) {
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  TerminalProcess process(command("eval scene.toml --points pipe -o out.csv"));
  const Descriptor writer(::open(at("pipe").c_str(), O_WRONLY | O_CLOEXEC));  // waits until the program opens the pipe
  process.send_signal(SIGINT);
  EXPECT_EQ(process.finish().status, -SIGINT);  // a shell reports status 130
  EXPECT_FALSE(fs::exists(at("out.csv")));
}

}  // namespace cli_failure_test
