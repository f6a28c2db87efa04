#include "run/table_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <dolp/errors.hpp>
#include <future>
#include <utility>

#include "base/stopwatch.hpp"
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

/// The properties that all parts of a file share, in one line.
std::string identity_of(const SceneValues& scene, const TableJob& job, const EvaluationReport& evaluation) {
  return fmt::format("dolp {}, scene {}, shard {}{}, {}, {}, {}", DOLP_VERSION, scene_hash(scene),
                     shard_text(job.shard), job.options.keep_all ? ", everything kept" : "", evaluation.evaluator,
                     evaluation.device, evaluation.driver);
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
    PerAxis first = part.first();
    for (std::size_t i = 0; i < first.size(); ++i) first[i] -= entries_.first()[i];
    TableValues table = table_part(layout_, part, results);
    finish();
    pending_ = std::async(std::launch::async, [this, first, own = std::move(table), note = so_far.text()]() mutable {
      output_.write(std::move(own), first, note);
    });
  }

  /// Waits for the last part. Errors: those of its writing.
  void finish() {
    if (pending_.valid()) pending_.get();
  }

 private:
  const SceneEntries& entries_;
  const TableLayout& layout_;
  TableOutput& output_;
  std::size_t parts_done_;
  RunSummary done_;
  std::future<void> pending_;
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

double number_of(const TableHead& head, const char* name) {
  const auto found = std::ranges::find(head.attributes, name, &Attribute::name);
  const auto* number = found == head.attributes.end() ? nullptr : std::get_if<double>(&found->value);
  return number ? *number : 0.0;
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
  std::vector<std::string> paths;  ///< by number
  SelfCheck check;
  double wall_s = 0.0;
  std::string devices;
};

void add_shard(ShardSet& set, const std::string& path) {
  const TableReader reader(path);
  const TableHead& head = reader.head();
  const std::optional<Shard> shard = shard_of(head);
  if (!shard) throw InputError(path + ": is no shard of a table (attribute shard)");
  if (set.paths.empty()) {
    set.scene = table_scene(head, path);
    set.layout = {head, reader.quantities(), reader.has_status()};
    set.paths.resize(shard->count);
    set.layout.head.axes = set.scene.grid;
  }
  const TableHead& first = set.layout.head;
  for (const char* name : {"scene_hash", "source"}) {
    if (text_of(head, name) == text_of(first, name)) continue;
    throw InputError(fmt::format("{}: is a shard of another table: its {} is {}, not {}", path, name,
                                 text_of(head, name), text_of(first, name)));
  }
  if (shard->count != set.paths.size() || reader.quantities() != set.layout.quantities) {
    throw InputError(fmt::format("{}: is shard {}, of another table than the {} shards before", path,
                                 shard_text(*shard), set.paths.size()));
  }
  if (head.axes != shard_entries(set.scene, *shard).axes())
    throw InputError(fmt::format("{}: does not have the axes of shard {}", path, shard_text(*shard)));
  std::string& place = set.paths[shard->number - 1];
  if (!place.empty()) throw InputError(fmt::format("{}: is shard {}, as {} is", path, shard_text(*shard), place));
  place = path;
  set.check.entries += static_cast<std::size_t>(number_of(head, "self_check_entries"));
  set.check.worst_ratio = std::max(set.check.worst_ratio, number_of(head, "self_check_worst_ratio"));
  set.wall_s += number_of(head, "wall_time_s");
  const std::string device = text_of(head, "device");
  if (set.devices.find(device) == std::string::npos) set.devices += (set.devices.empty() ? "" : "; ") + device;
}

ShardSet shard_set(const std::vector<std::string>& paths) {
  ShardSet set;
  for (const std::string& path : paths) add_shard(set, path);
  std::string missing;
  for (std::size_t i = 0; i < set.paths.size(); ++i) {
    if (set.paths[i].empty()) missing += fmt::format("{}{}/{}", missing.empty() ? "" : ", ", i + 1, set.paths.size());
  }
  if (!missing.empty()) throw InputError("missing shards: " + missing);
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
  if (shard.is_whole() || path == "-") return path;
  fs::path own = path;
  const std::string suffix = path.extension().string();
  own.replace_extension();
  return own.string() + fmt::format(".{}-of-{}", shard.number, shard.count) + suffix;
}

SceneEntries shard_entries(const SceneValues& scene, const Shard& shard) {
  if (shard.is_whole()) return grid_entries(scene);
  const SceneEntries whole = grid_entries(scene);
  PerAxis count = whole.counts();
  Cuts cuts{};
  if (!find_cuts(count, shard.count, 0, cuts)) {
    throw InputError(
        fmt::format("--shard {}: {} values of theta, {} of wavelength, {} of n and {} of k cannot be cut "
                    "into {} parts",
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
  TableLayout layout = table_layout(scene, run.plan(), run.entries().axes());
  if (!job.shard.is_whole()) layout.head.attributes.push_back({kShard, shard_text(job.shard)});
  TableOutput output({.path = job.path,
                      .layout = layout,
                      .parts = run.parts().size(),
                      .is_resumed = job.options.resume,
                      .identity = identity_of(scene, job, run.evaluation())});
  RunOutcome outcome;
  with_rest(output, [&] {
    TableSink sink(run.entries(), layout, output);
    outcome = run.compute(sink);
    sink.finish();
    output.finish(attributes_of(scene, outcome, job.options.history));
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
    return text_of(head, "scene_hash") == scene_hash(scene) && text_of(head, "source") == "dolp " DOLP_VERSION &&
           text_of(head, kShard) == shard_text(job.shard) && head.axes == shard_entries(scene, job.shard).axes();
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
                                {"self_check_entries", static_cast<double>(set.check.entries)},
                                {"self_check_worst_ratio", set.check.worst_ratio},
                                {"wall_time_s", set.wall_s}};
  keep_attributes(set.layout.head.attributes, run);
  TableOutput output({.path = path, .layout = set.layout, .parts = shards.size() + 1, .is_resumable = false});
  for (std::size_t i = 0; i < set.paths.size(); ++i) {
    const TableReader reader(set.paths[i]);
    const SceneEntries own = shard_entries(set.scene, {i + 1, set.paths.size()});
    ValuesHash::Sums sums;
    for (const TableBox& box : boxes_in_order(own.counts(), kMergedAtOnce)) {
      TableValues part = reader.read(box);
      const ValuesHash::Sums of_part = reader.sums_of(part, box);
      sums.resize(of_part.size(), 0);
      std::ranges::transform(sums, of_part, sums.begin(), std::plus<>());
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
