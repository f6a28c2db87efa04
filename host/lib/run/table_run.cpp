#include "run/table_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <dolp/errors.hpp>
#include <future>
#include <map>
#include <utility>

#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "run/scene_run.hpp"
#include "run/scene_table.hpp"
#include "run/table_scene.hpp"
#include "spectrum/spectral_rule.hpp"
#include "table/table_file.hpp"
#include "table/table_output.hpp"
#include "table/table_reader.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMergedAtOnce = std::size_t{1} << 19U;  // entries
constexpr const char* kShard = "shard";                       // attribute of a table that is one

// The axes that are cut. Sigma and q are not cut, because entries share work along them.
constexpr std::array kCutAxes = {Axis::kTheta, Axis::kWavelength, Axis::kN, Axis::kK};
using Cuts = std::array<std::size_t, kCutAxes.size()>;

/// Parts of each axis whose product is `count`, most of the first axes; false where there are none.
bool find_cuts(const PerAxis& counts, std::size_t count, std::size_t number, Cuts& cuts) {
  if (number == kCutAxes.size()) return count == 1;
  for (std::size_t parts = std::min(count, counts[kCutAxes[number]]); parts > 0; --parts) {
    if (count % parts != 0) continue;
    cuts[number] = parts;
    if (find_cuts(counts, count / parts, number + 1, cuts)) return true;
  }
  return false;
}

std::string shard_text(const Shard& shard) { return fmt::format("{}/{}", shard.number, shard.count); }

/// Where a part begins in the entries that it is a part of.
PerAxis place_in(const SceneEntries& entries, const SceneEntries& part) {
  PerAxis first = part.first();
  for (std::size_t i = 0; i < first.size(); ++i) first[i] -= entries.first()[i];
  return first;
}

std::string identity_of(const SceneValues& scene, const TableJob& job) {
  return identity_of(scene, job.evaluator, job.options.keep_all);
}

/// The properties that all parts of a file share: shards may be of different devices, a file is of one.
std::string identity_of_file(const std::string& identity, const Shard& shard, const EvaluationReport& evaluation) {
  return fmt::format("{}; shard {}; device {}, {}", identity, shard_text(shard), one_line(evaluation.device),
                     one_line(evaluation.driver));
}

std::vector<TableBox> boxes_of(const SceneEntries& entries, const std::vector<SceneEntries>& parts) {
  std::vector<TableBox> boxes;
  for (const SceneEntries& part : parts) boxes.push_back({place_in(entries, part), part.counts()});
  return boxes;
}

/// Writes each part while the next is computed.
class TableSink final : public Sink {
 public:
  TableSink(const SceneEntries& entries, const TableLayout& layout, TableOutput& output)
      : entries_(entries), layout_(layout), output_(output), parts_done_(output.parts_done()) {
    if (parts_done_ > 0) done_ = RunSummary::from_text(output.note()).value_or(RunSummary{});
  }
  TableSink(const TableSink&) = delete;
  TableSink& operator=(const TableSink&) = delete;
  ~TableSink() override {
    if (pending_.valid()) pending_.wait();
  }

  std::size_t parts_done() const override { return parts_done_; }
  RunSummary summary_of_done() const override { return done_; }

  void write(const SceneEntries& part, std::vector<PointResult> results, const RunSummary& so_far) override {
    TableValues table = table_part(layout_, part, results);
    finish();
    pending_ = std::async(std::launch::async,
                          [this, first = place_in(entries_, part), own = std::move(table),
                           note = so_far.text()]() mutable { output_.write(std::move(own), first, note); });
  }

  /// Waits for the last part. Errors: those of its writing.
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
  std::size_t parts_done_;
  RunSummary done_;
  std::future<void> pending_;
  double waited_s_ = 0.0;
};

/// Runs `body`; its errors also state how much of the file is there already.
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

/// A text attribute, empty where there is none.
std::string text_of(const TableHead& head, const char* name) {
  const auto found = std::ranges::find(head.attributes, name, &Attribute::name);
  const auto* text = found == head.attributes.end() ? nullptr : std::get_if<std::string>(&found->value);
  return text ? *text : "";
}

/// A number attribute from 0 on; 0 for anything else.
double number_of(const TableHead& head, const char* name) {
  const auto found = std::ranges::find(head.attributes, name, &Attribute::name);
  const auto* number = found == head.attributes.end() ? nullptr : std::get_if<double>(&found->value);
  return number && *number >= 0.0 ? *number : 0.0;
}

std::optional<Shard> shard_of(const TableHead& head) {
  Shard shard;
  const std::string text = text_of(head, kShard);
  const int found = std::sscanf(text.c_str(), "%zu/%zu", &shard.number, &shard.count);
  const bool is_shard = found == 2 && shard.number >= 1 && shard.number <= shard.count;
  return is_shard ? std::optional(shard) : std::nullopt;
}

/// The complete set of a table's shards.
struct ShardSet {
  SceneValues scene;
  TableLayout layout;
  std::size_t count = 0;
  std::map<std::size_t, std::string> paths;  ///< by number
  SelfCheck check;
  double model_change = 0.0;
  double wall_s = 0.0;
  std::string devices;
};

/// Refuses a shard that is not of the same table as the first.
void check_same_table(const ShardSet& set, const Shard& shard, const TableReader& reader, const std::string& path) {
  const TableHead& head = reader.head();
  const TableHead& first = set.layout.head;
  if (const auto differs = difference(text_of(head, kIdentity), text_of(first, kIdentity)))
    throw InputError(fmt::format("{}: is a shard of another table: it has {}", path, *differs));
  const bool has_same_curves = spectral_data_of(head) == spectral_data_of(first);
  if (shard.count != set.count || reader.quantities() != set.layout.quantities ||
      reader.has_status() != set.layout.has_status || head.stokes_units != first.stokes_units || !has_same_curves) {
    throw InputError(fmt::format("{}: is shard {}, of another table than {}: it has other variables or units", path,
                                 shard_text(shard), set.paths.begin()->second));
  }
}

Axes axes_of_shard(const SceneValues& scene, const Shard& shard, const std::string& path) {
  try {
    return shard_entries(scene, shard).axes();
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

void add_shard(ShardSet& set, const std::string& path) {
  const TableReader reader(path);
  const TableHead& head = reader.head();
  const std::optional<Shard> shard = shard_of(head);
  if (!shard) throw InputError(path + ": is no shard of a table (attribute shard)");
  if (text_of(head, kIdentity).empty()) throw InputError(path + ": has no text attribute " + kIdentity);
  if (set.paths.empty()) {
    set.scene = table_scene(head, path);
    set.layout = {head, reader.quantities(), reader.has_status()};
    set.layout.head.axes = set.scene.grid;
    fill_used(set.layout.head, set.scene);
    set.count = shard->count;
  } else {
    check_same_table(set, *shard, reader, path);
  }
  if (head.axes != axes_of_shard(set.scene, *shard, path))
    throw InputError(fmt::format("{}: does not have the axes of shard {}", path, shard_text(*shard)));
  const auto [place, is_new] = set.paths.emplace(shard->number, path);
  if (!is_new) throw InputError(fmt::format("{}: is shard {}, as {} is", path, shard_text(*shard), place->second));
  const double most = static_cast<double>(kMostTableEntries);
  set.check.entries += static_cast<std::size_t>(std::min(number_of(head, "self_check_entries"), most));
  set.check.worst_ratio = std::max(set.check.worst_ratio, number_of(head, "self_check_worst_ratio"));
  set.model_change = std::max(set.model_change, number_of(head, kModelChange));
  set.wall_s += number_of(head, "wall_time_s");
  const std::string device = text_of(head, "device");
  if (set.devices.find(device) == std::string::npos) set.devices += (set.devices.empty() ? "" : "; ") + device;
}

ShardSet shard_set(const std::vector<std::string>& paths) {
  constexpr std::size_t kMostNamed = 20;
  ShardSet set;
  for (const std::string& path : paths) add_shard(set, path);
  std::vector<std::string> missing;
  for (std::size_t i = 1; i <= set.count && missing.size() < kMostNamed; ++i) {
    if (!set.paths.contains(i)) missing.push_back(shard_text({i, set.count}));
  }
  const std::size_t unnamed = set.count - set.paths.size() - missing.size();
  if (unnamed > 0) missing.push_back(fmt::format("{} more", unnamed));
  if (!missing.empty()) throw InputError("missing shards: " + join(missing));
  return set;
}

/// The attributes of a shard that also hold for the whole table; the others are those of `run`.
void keep_attributes(std::vector<Attribute>& attributes, const std::vector<Attribute>& run) {
  std::erase_if(attributes, [&](const Attribute& attribute) {
    return attribute.name == kShard || std::ranges::find(run, attribute.name, &Attribute::name) != run.end();
  });
}

}  // namespace

fs::path shard_path(const fs::path& path, const Shard& shard) {
  if (shard.is_none() || path == "-") return path;
  fs::path own = path;
  const std::string suffix = path.extension().string();
  own.replace_extension();
  return own.string() + fmt::format(".{}-of-{}", shard.number, shard.count) + suffix;
}

SceneEntries shard_entries(const SceneValues& scene, const Shard& shard) {
  if (shard.is_none()) return grid_entries(scene);
  if (shard.number < 1 || shard.number > shard.count)
    throw InputError(fmt::format("shard {}: the first number must be one from 1 to the second", shard_text(shard)));
  const SceneEntries whole = grid_entries(scene);
  PerAxis count = whole.counts();
  Cuts cuts{};
  if (!find_cuts(count, shard.count, 0, cuts)) {
    throw InputError(
        fmt::format("shard {}: {} values of theta, {} of wavelength, {} of n and {} of k cannot be cut into {} parts",
                    shard_text(shard), count[Axis::kTheta], count[Axis::kWavelength], count[Axis::kN], count[Axis::kK],
                    shard.count));
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
  return whole.part(first, count);
}

RunOutcome write_table(const SceneValues& scene, const TableJob& job, const EvaluatorMaker& make_evaluator) {
  Run run(scene, shard_entries(scene, job.shard), job.options, make_evaluator);
  const std::string identity = identity_of(scene, job);
  TableLayout layout = table_layout(scene, run.plan(), run.entries().axes());
  layout.head.attributes.push_back({kIdentity, identity});
  if (!job.shard.is_none()) layout.head.attributes.push_back({kShard, shard_text(job.shard)});
  TableOutput output({.path = job.path,
                      .layout = layout,
                      .parts = boxes_of(run.entries(), run.parts()),
                      .identity = identity_of_file(identity, job.shard, run.evaluation()),
                      .is_resumed = job.options.resume,
                      .progress = job.options.progress});
  RunOutcome outcome;
  with_rest(output, [&] {
    TableSink sink(run.entries(), layout, output);
    outcome = run.compute(sink);
    sink.finish();
    const auto start = std::chrono::steady_clock::now();
    output.finish(attributes_of(scene, outcome, job.options.history));
    outcome.file_s = sink.waited_s() + seconds_since(start);
  });
  outcome.wall_s = run.wall_s();
  return outcome;
}

bool is_there(const SceneValues& scene, const TableJob& job) {
  std::error_code error;
  if (job.path == "-" || format_of(job.path) != TableFormat::kNetcdf || !fs::is_regular_file(job.path, error))
    return false;
  try {
    const TableReader reader(job.path);
    const TableHead& head = reader.head();
    if (difference(text_of(head, kIdentity), identity_of(scene, job)) || text_of(head, kShard) != shard_text(job.shard))
      return false;
    // Refuses values that are not those that were written.
    static_cast<void>(reader.read_entries({}, job.options.progress));
    return head.axes == shard_entries(scene, job.shard).axes();
  } catch (const InputError&) {
    return false;
  }
}

std::size_t merge_shards(const std::vector<std::string>& shards, const fs::path& path,
                         const std::string& command_line) {
  ShardSet set = shard_set(shards);
  const TableHead& head = set.layout.head;
  std::vector<Attribute> run = {{"history", history_text(command_line)},
                                {"device", set.devices},
                                {"driver", text_of(head, "driver")},
                                {"evaluator", text_of(head, "evaluator")},
                                {"precision", text_of(head, "precision")},
                                {"effects", text_of(head, "effects")},
                                {"rule", text_of(head, "rule")},
                                {kModelChange, set.model_change},
                                {"self_check_entries", static_cast<double>(set.check.entries)},
                                {"self_check_worst_ratio", set.check.worst_ratio},
                                {"wall_time_s", set.wall_s}};
  keep_attributes(set.layout.head.attributes, run);
  TableOutput output({.path = path, .layout = set.layout});
  for (const auto& [number, own_path] : set.paths) {
    const TableReader reader(own_path);
    const SceneEntries own = shard_entries(set.scene, {number, set.count});
    ValueSums sums;
    for (const TableBox& box : boxes_in_order(own.counts(), kMergedAtOnce)) {
      TableValues part = reader.read(box);
      add(sums, reader.sums_of(part, box));
      PerAxis first = own.first();
      for (std::size_t axis = 0; axis < first.size(); ++axis) first[axis] += box.first[axis];
      output.write(std::move(part), first, "");
    }
    reader.check_hash(sums);
  }
  output.finish(run);
  return set.layout.head.size();
}

}  // namespace dolp
