#include <vector>

#include "cli/commands.hpp"
#include "report/report.hpp"
#include "scene/material_data.hpp"
#include "terminal/exit_status.hpp"

namespace dolp::cli {
namespace {

Report material_report(const Material& material) {
  const Spectrum range = known_range(material);
  Report report;
  report.line("{:<46}  {:>7} to {:<8} um  {}", key("name", material.name), key("from_um", range.min_um),
              key("to_um", range.max_um), key("source", material.source));
  return report;
}

}  // namespace

int run_materials(const Options& options) {
  std::vector<Report> materials;
  for (const Material& material : built_in_materials()) materials.push_back(material_report(material));
  Report report;
  report.add("materials", materials);
  report.print(options.json, false);
  return kExitDone;
}

}  // namespace dolp::cli
