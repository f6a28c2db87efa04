// dolp-doubts: writes what host/calibrate/fit_doubts.py fits the coefficients of the error model to.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "calibrate/doubts.hpp"

namespace {

using dolp::Distribution;
using dolp::Masking;

// Columns: digits, excess of both, features of both; binary doubles of this machine.
void write_samples(const std::filesystem::path& path, const std::vector<dolp::DoubtSample>& samples) {
  static_assert(sizeof(dolp::DoubtSample) == (3 + 2 * dolp::kDoubtFeatures) * sizeof(double));
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(samples.data()),
             static_cast<std::streamsize>(samples.size() * sizeof(dolp::DoubtSample)));
  if (!file.flush()) throw dolp::IoError(path.string() + ": cannot write");
}

void write_description(const std::filesystem::path& path) {
  std::ofstream file(path);
  for (const double knot : dolp::doubt_knots()) file << knot << ' ';
  file << '\n';
  for (const std::string_view name : dolp::doubt_feature_names()) file << name << '\n';
  if (!file.flush()) throw dolp::IoError(path.string() + ": cannot write");
}

void run(const std::filesystem::path& folder, const std::vector<std::string>& files, std::size_t draws,
         std::uint64_t seed) {
  std::vector<dolp::StoredCase> cases;
  for (const std::string& file : files) {
    for (const dolp::StoredCase& stored : dolp::read_stored_cases(file)) cases.push_back(stored);
  }
  std::filesystem::create_directories(folder);
  write_description(folder / "features.txt");
  for (std::uint32_t m = 0; m < 4; ++m) {
    for (std::uint32_t d = 0; d < 2; ++d) {
      const auto distribution = static_cast<Distribution>(d);
      const auto masking = static_cast<Masking>(m);
      std::vector<dolp::DoubtSample> samples = dolp::doubt_samples(distribution, masking, draws, seed);
      for (const dolp::DoubtSample& stored : dolp::doubt_samples(distribution, masking, cases)) {
        samples.push_back(stored);
      }
      write_samples(folder / (std::to_string(m) + std::to_string(d) + ".bin"), samples);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Writes random entries' errors over their doubts, for host/calibrate/fit_doubts.py.");
  std::string folder;
  std::vector<std::string> files;
  std::size_t draws = 14000;
  std::uint64_t seed = 1;
  app.add_option("FOLDER", folder, "made if it is not there")->required();
  app.add_option("--stored", files, "CSV files that dolp-reference-values wrote, whose cases are added");
  app.add_option("--draws", draws, "entries for each model and number of digits")->capture_default_str();
  app.add_option("--seed", seed, "of the entries")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    run(folder, files, draws, seed);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dolp-doubts: %s\n", error.what());
    return 4;
  }
  return 0;
}
