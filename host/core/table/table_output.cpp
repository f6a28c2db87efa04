#include "table/table_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/atomic_file.hpp"
#include "base/hash.hpp"
#include "base/temporary_folder.hpp"
#include "base/text.hpp"
#include "table/table_file.hpp"
#include "table/table_store.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kConvertedRowsAtOnce = std::size_t{1} << 17U;  // that a .csv or .npy is made of
constexpr std::string_view kIdentityEnd = "; ";

// Beside the file itself, not beside a link to it, which may be on another file system.
fs::path partial_path(const fs::path& path) { return follow_links(path).string() + ".partial"; }
fs::path progress_path(const fs::path& path) { return partial_path(path).string() + ".txt"; }

/// A line of a progress file: its text and, before it, a hash of that, so that damage is seen.
std::string progress_line(std::uint64_t hash, std::string_view text) {
  return fmt::format("{:016x} {}\n", hashed(hash, text), text);
}

/// The text of the first line, if progress_line made it.
std::optional<std::string_view> first_text(std::string_view lines, std::uint64_t hash) {
  constexpr std::size_t kHashSize = 17;
  const std::string_view line = lines.substr(0, lines.find('\n') + 1);
  if (line.size() <= kHashSize) return std::nullopt;
  const std::string_view text = line.substr(kHashSize, line.size() - kHashSize - 1);
  return line == progress_line(hash, text) ? std::optional(text) : std::nullopt;
}

/// Takes the pieces of a text one by one.
std::string_view next_piece(std::string_view& text, std::string_view separator) {
  const std::size_t end = text.find(separator);
  const std::string_view piece = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + separator.size());
  return piece;
}

}  // namespace

std::optional<std::string> difference(const std::string& identity, const std::string& wanted) {
  std::string_view theirs = identity, ours = wanted;
  while (!theirs.empty() || !ours.empty()) {
    const std::string_view own = next_piece(theirs, kIdentityEnd);
    const std::string_view other = next_piece(ours, kIdentityEnd);
    if (own == other) continue;
    const std::size_t value = std::min(other.find(' '), other.size() - 1) + 1;
    return fmt::format("{}, not {}", own.empty() ? "nothing" : one_line(own), one_line(other.substr(value)));
  }
  return std::nullopt;
}

struct TableOutput::Impl {
  Job job;
  TableFormat format;
  std::optional<AtomicFile> file;  // has the values; none for a .csv or .npy of one part
  std::optional<TableStore> store;
  std::optional<AtomicFile> progress;  // text of the finished parts of a resumable table
  TableValues only_part;
  ValueSums sums;
  std::size_t parts_done = 0;
  std::string note;

  explicit Impl(Job of_run) : job(std::move(of_run)), format(format_of(job.path)) {
    check_output_path(job.path);
    if (is_resumable()) {
      check_writable(progress_path(job.path));
      file.emplace(job.path, partial_path(job.path));
    } else if (format == TableFormat::kNetcdf) {
      file.emplace(job.path);
    } else if (job.parts.size() != 1) {
      file.emplace(job.path == "-" ? temporary_files() / "dolp" : job.path);
    }
    const bool was_empty = file && file->size() == 0;
    try {
      if (file) store.emplace(job.layout, *file);
      if (is_resumable()) open_progress();
    } catch (...) {
      if (was_empty) file->discard();
      throw;
    }
  }

  bool is_resumable() const { return !job.identity.empty() && job.parts.size() > 1 && job.path != "-"; }

  void open_progress() {
    if (fs::exists(fs::symlink_status(progress_path(job.path)))) progress.emplace(job.path, progress_path(job.path));
    const std::uint64_t kept = job.is_resumed && progress ? reuse_finished_parts() : 0;
    if (progress) progress->resize(kept);
    if (parts_done == 0) file->resize(0);
  }

  /// Reuses the parts that are there. Returns the length of their lines in the progress file.
  std::uint64_t reuse_finished_parts() {
    std::string text(progress->size(), '\0');
    progress->read_at(0, text.data(), text.size());
    const std::optional<std::string_view> identity = first_text(text, kHashStart);
    if (!identity) return 0;
    if (const auto differs = difference(std::string(*identity), job.identity)) {
      throw InputError(fmt::format("{}: is of another run: it has {}; remove it, or leave out --resume",
                                   partial_path(job.path).string(), *differs));
    }
    std::size_t taken = text.find('\n') + 1;
    while (parts_done < job.parts.size() && taken < text.size()) {
      if (job.progress && !job.progress(0, job.layout.head.size()))
        throw Cancelled(partial_path(job.path).string() + " is as it was: the same command with --resume goes on");
      const std::optional<ValueSums> of_part = store->measured(job.parts[parts_done]);
      const auto own_note = first_text(std::string_view(text).substr(taken), of_part ? part_hash(*of_part) : 0);
      if (!of_part || !own_note) break;
      add(sums, *of_part);
      note = *own_note;
      ++parts_done;
      taken = text.find('\n', taken) + 1;
    }
    return parts_done > 0 ? taken : 0;
  }

  /// The hash of the next part in the progress file.
  std::uint64_t part_hash(const ValueSums& of_part) const {
    std::uint64_t hash = hashed(hashed(kHashStart, job.identity), std::uint64_t{parts_done});
    for (const std::uint64_t sum : of_part) hash = hashed(hash, sum);
    return hash;
  }

  void write(const TableValues& part, const PerAxis& first, const std::string& own_note) {
    const ValueSums of_part = store->write(part, first);
    add(sums, of_part);
    if (is_resumable()) {
      if (!progress) progress.emplace(job.path, progress_path(job.path));
      const std::string start = progress->size() == 0 ? progress_line(kHashStart, job.identity) : "";
      progress->append(start + progress_line(part_hash(of_part), own_note));
    }
    ++parts_done;
  }

  void write_rows() {
    AtomicFile* target = nullptr;
    std::optional<AtomicFile> own;
    if (job.path != "-") target = &own.emplace(job.path);
    const auto put = [&](const std::string& bytes) {
      if (target) return target->append(bytes);
      write_text_atomically("-", bytes);
    };
    put(table_start(job.layout, format));
    if (!store) put(table_rows(only_part, job.layout, format));
    if (store) {
      for (const TableBox& box : boxes_in_order(job.layout.head.counts(), kConvertedRowsAtOnce))
        put(table_rows(store->read(box), job.layout, format));
    }
    if (target) target->commit();
  }

  void discard() {
    if (file) file->discard();
    if (progress) progress->discard();
  }
};

TableOutput::TableOutput(Job job) : impl_(std::make_unique<Impl>(std::move(job))) {}

TableOutput::~TableOutput() {
  if (impl_->parts_done == 0) impl_->discard();  // nothing is in them
}

std::size_t TableOutput::parts_done() const { return impl_->parts_done; }
const std::string& TableOutput::note() const { return impl_->note; }

void TableOutput::write(TableValues part, const PerAxis& first, const std::string& note) {
  if (impl_->store) {
    impl_->write(part, first, note);
  } else {
    impl_->only_part = std::move(part);
    impl_->parts_done = 1;
  }
}

void TableOutput::finish(const std::vector<Attribute>& more) {
  Impl& own = *impl_;
  std::vector<Attribute>& attributes = own.job.layout.head.attributes;
  attributes.insert(attributes.end(), more.begin(), more.end());
  if (own.format == TableFormat::kNetcdf) {
    own.store->finish(more, own.sums);
    own.file->commit();
  } else {
    own.write_rows();
  }
  own.parts_done = 0;
}

std::optional<std::string> TableOutput::rest() const {
  if (!impl_->is_resumable() || impl_->parts_done == 0) return std::nullopt;
  return fmt::format("{} of {} parts are in {}: the same command with --resume goes on", impl_->parts_done,
                     impl_->job.parts.size(), partial_path(impl_->job.path).string());
}

}  // namespace dolp
