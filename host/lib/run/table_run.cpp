#include "run/table_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <dolp/errors.hpp>
#include <future>
#include <utility>

#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "run/scene_table.hpp"
#include "run/table_scene.hpp"
#include "spectrum/spectral_rule.hpp"
#include "table/table_file.hpp"
#include "table/table_output.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMergedAtOnce = std::size_t{1} << 19U;  // entries
constexpr const char* kShard = "shard";                       // attribute of a file with one shard (part) of a table

// Shards divide the values of these axes among them, but not sigma and q, along which entries share work.
constexpr std::array kCutAxes = {Axis::kViewZenith, Axis::kRelativeAzimuth, Axis::kTheta, Axis::kMaterial, Axis::kBand,
                                 Axis::kWavelength, Axis::kTemperature,     Axis::kN,     Axis::kK};
using Cuts = std::array<std::size_t, kCutAxes.size()>;

/// Finds the number of parts of each axis for `count` shards: large for the first axes. False if it is impossible.
bool find_cuts(const PerAxis& counts, std::size_t count, std::size_t number, Cuts& cuts) {
  if (number == kCutAxes.size()) return count == 1;
  for (std::size_t parts = std::min(count, counts[kCutAxes[number]]); parts > 0; --parts) {
    if (count % parts != 0) continue;
    cuts[number] = parts;
    if (find_cuts(counts, count / parts, number + 1, cuts)) return true;
  }
  return false;
}

/// The numbers of shards next to `count`, below and above, into which the values can be cut.
std::vector<std::size_t> possible_counts(const PerAxis& counts, std::size_t count) {
  std::size_t most = 1;
  for (const Axis axis : kCutAxes) most *= counts[axis];
  Cuts cuts{};
  std::vector<std::size_t> possible;
  std::size_t below = std::min(count - 1, most);
  while (!find_cuts(counts, below, 0, cuts)) --below;
  possible.push_back(below);
  if (count > most) return possible;
  std::size_t above = count + 1;
  while (!find_cuts(counts, above, 0, cuts)) ++above;
  possible.push_back(above);
  return possible;
}

/// The axes of `table`. On the axes of materials and bands, the values become positions in the lists of the scene.
Axes scene_axes(TableHead table, const SceneValues& scene, const std::string& name) {
  use_scene_labels(table, scene, name);
  return table.axes;
}

std::string shard_text(const Shard& shard) { return fmt::format("{}/{}", shard.number, shard.count); }

std::string run_identity(const SceneValues& scene, const TableJob& job) {
  return run_identity(scene, job.evaluator, job.options);
}

/// Text that must be equal in all parts of a file: identity, shard and device. Shards may have different devices.
std::string identity_of_file(const std::string& identity, const Shard& shard, const EvaluationReport& evaluation) {
  return fmt::format("{}; shard {}; device {}, {}", identity, shard_text(shard), one_line(evaluation.device),
                     one_line(evaluation.driver));
}

std::vector<GridBox> part_boxes(const SceneEntries& entries, const std::vector<SceneEntries>& parts) {
  std::vector<GridBox> boxes;
  for (const SceneEntries& part : parts) boxes.push_back({part.first_in(entries), part.counts()});
  return boxes;
}

/// Writes the parts of a table on another thread, while the run computes the next part.
class TableSink {
 public:
  TableSink(const SceneEntries& entries, const TableLayout& layout, TableOutput& output)
      : entries_(entries), layout_(layout), output_(output) {}
  TableSink(const TableSink&) = delete;
  TableSink& operator=(const TableSink&) = delete;
  ~TableSink() {
    if (pending_.valid()) pending_.wait();
  }

  void write(const SceneEntries& part, RunResults results, const RunSummary& so_far) {
    TableValues table = table_part(layout_, part, std::move(results));
    finish();
    pending_ = std::async(std::launch::async,
                          [this, first = part.first_in(entries_), values = std::move(table),
                           note = so_far.text()]() mutable { output_.write(std::move(values), first, note); });
  }

  void finish() {
    const auto start = std::chrono::steady_clock::now();
    if (pending_.valid()) pending_.get();
    waited_s_ += seconds_since(start);
  }
  double waited_s() const { return waited_s_; }

 private:
  const SceneEntries& entries_;
  const TableLayout& layout_;
  TableOutput& output_;
  std::future<void> pending_;
  double waited_s_ = 0.0;
};

/// Runs `body`. If it throws, adds to the error message how much of the file is already on disk.
template <class Body>
void with_rest(const TableOutput& output, const Body& body) {
  const auto more = [&] {
    const std::optional<std::string> rest = output.rest();
    return rest ? "; " + *rest : std::string();
  };
  try {
    body();
  } catch (const Cancelled&) {
    if (const auto rest = output.rest()) throw Cancelled(*rest);
    throw;
  } catch (const IoError& error) {
    throw IoError(error.what() + more());
  } catch (const DeviceError& error) {
    throw DeviceError(error.what() + more());
  }
}

std::string head_text(const TableHead& head, const char* name) {
  const auto* text = find_attribute<std::string>(head, name);
  return text ? *text : "";
}

double head_number(const TableHead& head, const char* name) {
  const auto* number = find_attribute<double>(head, name);
  return number && *number >= 0.0 ? *number : 0.0;
}

std::optional<Shard> head_shard(const TableHead& head) {
  Shard shard;
  const std::string text = head_text(head, kShard);
  const int found = std::sscanf(text.c_str(), "%zu/%zu", &shard.number, &shard.count);
  const bool is_shard = found == 2 && shard.number >= 1 && shard.number <= shard.count;
  return is_shard ? std::optional(shard) : std::nullopt;
}

Axes axes_of_shard(const SceneValues& scene, const Shard& shard, const std::string& path) {
  try {
    return shard_entries(scene, shard).axes();
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

void add_run(RunRecord& whole, const TableHead& shard) {
  const double most = static_cast<double>(kMostTableEntries);
  whole.check.entries += static_cast<std::size_t>(std::min(head_number(shard, "self_check_entries"), most));
  whole.check.worst_ratio = std::max(whole.check.worst_ratio, head_number(shard, "self_check_worst_ratio"));
  whole.model_change.add(ModelChange{head_number(shard, kModelChange), head_number(shard, kModelChangeDolp)});
  whole.wall_s += head_number(shard, "wall_time_s");
  note_precision(whole.evaluation.precision, head_text(shard, "precision"));
  const std::string device = head_text(shard, "device");
  std::string& devices = whole.evaluation.device;
  if (devices.find(device) == std::string::npos) devices += (devices.empty() ? "" : "; ") + device;
}

/// The attributes of a shard without those that hold only for this shard or its run.
std::vector<Attribute> without_run(std::vector<Attribute> attributes) {
  const std::vector<Attribute> run = RunRecord().attributes("");
  std::erase_if(attributes, [&](const Attribute& attribute) {
    return attribute.name == kShard || std::ranges::find(run, attribute.name, &Attribute::name) != run.end();
  });
  return attributes;
}

void merge_shard(TableOutput& output, const TableReader& reader, const SceneEntries& shard) {
  ValueSums sums;
  for (const GridBox& box : grid_boxes(shard.counts(), kMergedAtOnce)) {
    TableValues part = reader.read(box);
    add(sums, reader.value_sums(part, box));
    PerAxis first = shard.first();
    for (std::size_t axis = 0; axis < first.size(); ++axis) first[axis] += box.first[axis];
    output.write(std::move(part), first, "");
  }
  reader.check_hash(sums);
}

}  // namespace

fs::path shard_path(const fs::path& path, const Shard& shard) {
  if (shard.is_none() || path == "-") return path;
  fs::path shard_file = path;
  const std::string suffix = path.extension().string();
  shard_file.replace_extension();
  return shard_file.string() + fmt::format(".{}-of-{}", shard.number, shard.count) + suffix;
}

SceneEntries shard_entries(const SceneValues& scene, const Shard& shard) {
  if (shard.is_none()) return grid_entries(scene);
  if (shard.number < 1 || shard.number > shard.count)
    throw InputError(fmt::format("shard {}: the first number must be one from 1 to the second", shard_text(shard)));
  const SceneEntries whole = grid_entries(scene);
  PerAxis count = whole.counts();
  Cuts cuts{};
  if (!find_cuts(count, shard.count, 0, cuts)) {
    std::vector<std::string> values;
    for (const Axis axis : kCutAxes)
      if (count[axis] > 1) values.push_back(fmt::format("{} of {}", count[axis], describe(axis).name));
    throw InputError(fmt::format("shard {}: the values of the axes, {}, cannot be cut into {} parts, but into {}",
                                 shard_text(shard),
                                 values.empty() ? "1 of theta" : fmt::format("{}", fmt::join(values, ", ")),
                                 shard.count, fmt::join(possible_counts(count, shard.count), " or ")));
  }
  PerAxis first{};
  std::size_t rest = shard.number - 1;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const Axis axis = kCutAxes[i];
    const std::size_t all = count[axis];
    const std::size_t part = rest % cuts[i];
    rest /= cuts[i];
    first[axis] = all * part / cuts[i];
    count[axis] = all * (part + 1) / cuts[i] - first[axis];
  }
  return whole.part({first, count});
}

RunOutcome write_table(const SceneValues& scene, const TableJob& job, const EvaluatorMaker& make_evaluator) {
  Run run(scene, shard_entries(scene, job.shard), job.options, make_evaluator);
  const std::string identity = run_identity(scene, job);
  TableLayout layout = table_layout(scene, run);
  choose_variables(layout, job.options.quantities);
  layout.head.attributes.push_back({kIdentity, identity});
  if (!job.shard.is_none()) layout.head.attributes.push_back({kShard, shard_text(job.shard)});
  TableOutput output({.path = job.path,
                      .layout = layout,
                      .parts = part_boxes(run.entries(), run.parts()),
                      .identity = identity_of_file(identity, job.shard, run.evaluation()),
                      .is_resumed = job.options.resume,
                      .progress = job.options.progress});
  RunOutcome outcome;
  with_rest(output, [&] {
    Finished finished{output.parts_done()};
    if (finished.parts > 0) finished.summary = RunSummary::from_text(output.note()).value_or(RunSummary{});
    TableSink sink(run.entries(), layout, output);
    const auto write = [&](const SceneEntries& part, RunResults results, const RunSummary& so_far) {
      sink.write(part, std::move(results), so_far);
    };
    outcome = run.compute(write, finished);
    sink.finish();
    const auto start = std::chrono::steady_clock::now();
    output.finish(run_attributes(scene, outcome, job.options.history));
    outcome.file_s = sink.waited_s() + seconds_since(start);
  });
  outcome.wall_s = run.wall_s();
  return outcome;
}

bool is_there(const SceneValues& scene, const TableJob& job) {
  std::error_code error;
  if (job.path == "-" || table_format(job.path) != TableFormat::kNetcdf || !fs::is_regular_file(job.path, error))
    return false;
  try {
    const TableReader reader(job.path);
    const TableHead& head = reader.head();
    if (difference(head_text(head, kIdentity), run_identity(scene, job)) ||
        head_text(head, kShard) != shard_text(job.shard))
      return false;
    // Reading all values checks their hash. It throws if a value has changed since it was written.
    static_cast<void>(reader.read_entries({}, job.options.progress));
    return scene_axes(head, scene, job.path.string()) == shard_entries(scene, job.shard).axes();
  } catch (const InputError&) {
    return false;
  }
}

ShardSet::ShardSet(const std::vector<std::string>& paths) {
  constexpr std::size_t kMostNamed = 20;
  for (const std::string& path : paths) {
    const TableReader reader(path);
    if (paths_.empty()) begin(reader, path);
    const std::size_t number = checked_number(reader, path);
    const auto [known, is_new] = paths_.emplace(number, path);
    if (!is_new)
      throw InputError(fmt::format("{}: is shard {}, as {} is", path, shard_text({number, count_}), known->second));
  }
  std::vector<std::string> missing;
  for (std::size_t i = 1; i <= count_ && missing.size() < kMostNamed; ++i) {
    if (!paths_.contains(i)) missing.push_back(shard_text({i, count_}));
  }
  const std::size_t unnamed = count_ - paths_.size() - missing.size();
  if (unnamed > 0) missing.push_back(fmt::format("{} more", unnamed));
  if (!missing.empty()) throw InputError("missing shards: " + join(missing));
}

void ShardSet::begin(const TableReader& first, const std::string& path) {
  const std::optional<Shard> shard = head_shard(first.head());
  if (!shard) return;
  scene_ = table_scene(first.head(), path);
  layout_ = first.layout();
  layout_.head.axes = scene_.grid;
  layout_.head.labels = scene_.labels;
  fill_used(layout_.head, scene_);
  count_ = shard->count;
}

std::size_t ShardSet::checked_number(const TableReader& reader, const std::string& path) const {
  const TableHead& head = reader.head();
  const TableHead& first = layout_.head;
  const std::optional<Shard> shard = head_shard(head);
  if (!shard) throw InputError(path + ": is no shard of a table (attribute shard)");
  const std::string identity = head_text(head, kIdentity);
  if (identity.empty()) throw InputError(path + ": has no text attribute " + kIdentity);
  if (const auto differs = difference(identity, head_text(first, kIdentity)))
    throw InputError(fmt::format("{}: is a shard of another table: it has {}", path, *differs));
  const bool has_same_curves = spectral_data_text(head) == spectral_data_text(first);
  if (shard->count != count_ || reader.layout().quantities != layout_.quantities ||
      reader.layout().derivatives.size() != layout_.derivatives.size() ||
      reader.layout().has_status != layout_.has_status || head.stokes_units != first.stokes_units || !has_same_curves) {
    throw InputError(fmt::format("{}: is shard {}, of another table than {}: it has other variables or units", path,
                                 shard_text(*shard), paths_.begin()->second));
  }
  if (scene_axes(head, scene_, path) != axes_of_shard(scene_, *shard, path))
    throw InputError(fmt::format("{}: does not have the axes of shard {}", path, shard_text(*shard)));
  return shard->number;
}

std::size_t ShardSet::merge(const fs::path& path, const std::string& command_line) const {
  TableLayout layout = layout_;
  layout.head.attributes = without_run(layout_.head.attributes);
  TableOutput output({.path = path, .layout = std::move(layout)});
  const TableHead& first = layout_.head;
  RunRecord run{{}, head_text(first, "effects"), head_text(first, "rule")};
  run.evaluation.driver = head_text(first, "driver");
  run.evaluation.evaluator = head_text(first, "evaluator");
  for (const auto& [number, own_path] : paths_) {
    const TableReader reader(own_path);
    const std::size_t is_now = checked_number(reader, own_path);
    if (is_now != number)
      throw InputError(fmt::format("{}: is shard {} now, and was {}", own_path, shard_text({is_now, count_}), number));
    add_run(run, reader.head());
    merge_shard(output, reader, shard_entries(scene_, {number, count_}));
  }
  output.finish(run.attributes(command_line));
  return first.size();
}

}  // namespace dolp
