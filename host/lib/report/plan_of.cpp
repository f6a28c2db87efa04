#include <fmt/format.h>

#include <algorithm>
#include <dolp/errors.hpp>

#include "base/processor.hpp"
#include "evaluate/kernel/slope_samples.hpp"
#include "model/choices.hpp"
#include "plan/kernel_data.hpp"
#include "report/plan_report.hpp"
#include "run/estimates.hpp"
#include "run/scene_run.hpp"

namespace dolp {
namespace {

/// The device that a run would use; without one, limits that every device keeps.
Device device_of(const std::string& choice, const SceneValues& scene, PlanReport& report) {
  const bool in_double = scene.accuracy.precision == Precision::kDouble;
  const DeviceList list = list_devices();
  try {
    if (list.devices.empty()) throw DeviceError(list.why_empty);
    const Device& device = list.devices[choose_device(list.devices, choice, in_double)];
    report.device = device.name;
    return device;
  } catch (const DeviceError& error) {
    if (!choice.empty()) throw;
    report.why_no_device = error.what();
    Device least = least_device();
    least.has_double = true;
    return least;
  }
}

void add_dispatches(PlanReport& report, const vulkan::DispatchCount& of_request) {
  report.dispatches.dispatches += of_request.dispatches;
  report.dispatches.tile_invocations = std::max(report.dispatches.tile_invocations, of_request.tile_invocations);
  report.dispatches.row_width = std::max(report.dispatches.row_width, of_request.row_width);
  report.dispatches.rows += of_request.rows;
  report.dispatches.block_shapes = std::max(report.dispatches.block_shapes, of_request.block_shapes);
  report.dispatches.device_bytes = std::max(report.dispatches.device_bytes, of_request.device_bytes);
}

/// `more`: further properties that distinguish the pipeline.
void add_pipeline(PlanReport& report, const char* kernel, Precision precision, const std::string& more = {}) {
  const Surface& surface = report.scene.surface;
  const std::string text = fmt::format("{}, {}: distribution {}, masking {}{}", kernel, name_of(precision),
                                       name_of(surface.distribution), name_of(surface.masking), more);
  if (std::ranges::find(report.pipelines, text) == report.pipelines.end()) report.pipelines.push_back(text);
}

void add_request(PlanReport& report, const MomentsRequest& request, const Device& device) {
  add_dispatches(report, count_dispatches(request, device));
  const KernelData data = kernel_data(request);
  report.rule = {data.rule.digits, data.rule_order};
  std::string more;
  if (request.scattering == Scattering::kMultiple) more += ", all bounces";
  if (request.wants_direct) more += ", direct emission";
  add_pipeline(report, has_slope_samples(request) ? "slopes" : "moments", request.precision, more);
  if (data.needs_masking_table()) add_pipeline(report, "masking_table", request.precision);
}

void add_request(PlanReport& report, const ScatteringRequest& request, const Device& device) {
  add_dispatches(report, count_dispatches(request, device));
  add_pipeline(report, "mueller", request.precision);
}

/// The evaluations were counted entry by entry; on the device those of a row are made once. Its nodes are those that
/// its hardest member needs, hence they are estimated.
void share_evaluations(PlanReport& report) {
  if (report.dispatches.row_width == 1) return;
  report.run.first_evaluations *= static_cast<double>(report.dispatches.rows) / static_cast<double>(report.run.moments);
  report.run.is_exact = false;
}

void add_forecast(PlanReport& report, const SceneEntries& entries, const Device& device) {
  report.run = predict_run(report.scene, entries, report.plan, device.has_double,
                           {[&](const MomentsRequest& request) { add_request(report, request, device); },
                            [&](const ScatteringRequest& request) { add_request(report, request, device); }});
  share_evaluations(report);
}

}  // namespace

PlanReport plan_of(const SceneValues& scene, const std::string& device, EffectPlan plan) {
  PlanReport report;
  report.scene = scene;
  const Device limits = device_of(device, scene, report);
  const std::size_t without_a_run = peak_resident_bytes();  // with the scene and the driver
  const SceneEntries entries = grid_entries(scene);
  report.plan = std::move(plan);
  report.effects = effects_of(scene, entries, report.plan);
  report.looked = add_influences(report.effects, scene, entries);
  report.model_change = estimated_model_change(scene, entries);
  add_forecast(report, entries, limits);
  report.lookup = lookup_forecast(scene, report.plan);
  report.run.host_bytes += static_cast<double>(without_a_run);
  return report;
}

}  // namespace dolp
