#include "table/table_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/hash.hpp"
#include "base/temporary_folder.hpp"
#include "base/text.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kConvertedRowsAtOnce = std::size_t{1} << 17U;  // rows of a .csv or .npy in memory at a time
constexpr std::string_view kIdentityEnd = "; ";

// If `path` is a link, the partial file is beside the link's target: a rename works only within one file system.
fs::path partial_path(const fs::path& path) { return follow_links(path).string() + ".partial"; }
fs::path progress_path(const fs::path& path) { return partial_path(path).string() + ".txt"; }

/// A line of a progress file: a hash of `text`, then `text`. The hash reveals damage. `hash`: start value of the hash.
std::string progress_line(std::uint64_t hash, std::string_view text) {
  return fmt::format("{:016x} {}\n", hashed(hash, text), text);
}

/// The text of the first line of `lines`; nullopt if the hash in the line is wrong. `hash`: as for progress_line().
std::optional<std::string_view> first_text(std::string_view lines, std::uint64_t hash) {
  constexpr std::size_t kHashSize = 17;
  const std::string_view line = lines.substr(0, lines.find('\n') + 1);
  if (line.size() <= kHashSize) return std::nullopt;
  const std::string_view text = line.substr(kHashSize, line.size() - kHashSize - 1);
  return line == progress_line(hash, text) ? std::optional(text) : std::nullopt;
}

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
    const std::string_view their_piece = next_piece(theirs, kIdentityEnd);
    const std::string_view other = next_piece(ours, kIdentityEnd);
    if (their_piece == other) continue;
    const std::size_t value = std::min(other.find(' '), other.size() - 1) + 1;
    return fmt::format("{}, not {}", their_piece.empty() ? "nothing" : one_line(their_piece),
                       one_line(other.substr(value)));
  }
  return std::nullopt;
}

TableOutput::TableOutput(Job job) : job_(std::move(job)), format_(table_format(job_.path)) {
  check_output_path(job_.path);
  if (is_resumable()) {
    check_writable(progress_path(job_.path));
    file_.emplace(job_.path, partial_path(job_.path));
  } else if (format_ == TableFormat::kNetcdf) {
    file_.emplace(job_.path);
  } else if (job_.parts.size() != 1) {
    file_.emplace(job_.path == "-" ? temporary_files() / "dolp" : job_.path);
  }
  const bool was_empty = file_ && file_->size() == 0;
  try {
    const std::string earlier = is_resumable() ? earlier_parts() : "";
    const TableStore::Earlier values = earlier.empty() ? TableStore::Earlier::kRemoved : TableStore::Earlier::kKept;
    if (file_) store_.emplace(job_.layout, *file_, values);
    const std::size_t kept = reuse_finished_parts(earlier);
    if (progress_) progress_->resize(kept);
  } catch (...) {
    if (was_empty) file_->discard();
    throw;
  }
}

TableOutput::~TableOutput() {
  if (parts_done_ > 0) return;
  for (std::optional<AtomicFile>* empty : {&file_, &progress_})
    if (*empty) (*empty)->discard();
}

/// Opens the progress file if it exists. Returns its lines, or nothing if no part can be reused.
std::string TableOutput::earlier_parts() {
  if (fs::exists(fs::symlink_status(progress_path(job_.path)))) progress_.emplace(job_.path, progress_path(job_.path));
  if (!job_.is_resumed || !progress_) return {};
  std::string lines(progress_->size(), '\0');
  progress_->read_at(0, lines.data(), lines.size());
  const std::optional<std::string_view> identity = first_text(lines, kHashStart);
  if (!identity) return {};
  if (const auto differs = difference(std::string(*identity), job_.identity)) {
    throw InputError(fmt::format("{}: is of another run: it has {}; remove it, or leave out --resume",
                                 partial_path(job_.path).string(), *differs));
  }
  return lines;
}

/// Reuses parts that `lines` of the progress file list. Returns the length of the lines up to the last reused part.
std::size_t TableOutput::reuse_finished_parts(const std::string& lines) {
  std::size_t taken = lines.find('\n') + 1;
  while (parts_done_ < job_.parts.size() && taken < lines.size()) {
    if (job_.progress && !job_.progress(0, job_.layout.head.size()))
      throw Cancelled(partial_path(job_.path).string() + " is as it was: the same command with --resume goes on");
    const std::optional<ValueSums> part_sums = store_->measured(job_.parts[parts_done_]);
    const auto part_note = first_text(std::string_view(lines).substr(taken), part_sums ? part_hash(*part_sums) : 0);
    if (!part_sums || !part_note) break;
    add(sums_, *part_sums);
    note_ = *part_note;
    ++parts_done_;
    taken = lines.find('\n', taken) + 1;
  }
  return parts_done_ > 0 ? taken : 0;
}

/// Start value of the hash in the progress line of part number parts_done_. `part_sums`: checksums of the part.
std::uint64_t TableOutput::part_hash(const ValueSums& part_sums) const {
  std::uint64_t hash = hashed(hashed(kHashStart, job_.identity), std::uint64_t{parts_done_});
  for (const std::uint64_t sum : part_sums) hash = hashed(hash, sum);
  return hash;
}

void TableOutput::write(TableValues part, const PerAxis& first, const std::string& note) {
  if (!store_) {
    only_part_ = std::move(part);
    parts_done_ = 1;
    return;
  }
  const ValueSums part_sums = store_->write(part, first);
  add(sums_, part_sums);
  if (is_resumable()) {
    if (!progress_) progress_.emplace(job_.path, progress_path(job_.path));
    const std::string start = progress_->size() == 0 ? progress_line(kHashStart, job_.identity) : "";
    progress_->append(start + progress_line(part_hash(part_sums), note));
  }
  ++parts_done_;
}

void TableOutput::finish(const std::vector<Attribute>& more) {
  std::vector<Attribute>& attributes = job_.layout.head.attributes;
  attributes.insert(attributes.end(), more.begin(), more.end());
  if (format_ == TableFormat::kNetcdf) {
    store_->finish(more, sums_);
    file_->commit();
  } else {
    write_rows();
  }
  parts_done_ = 0;
}

void TableOutput::write_rows() {
  std::optional<AtomicFile> target;  // nullopt for standard output
  if (job_.path != "-") target.emplace(job_.path);
  const auto put = [&](const std::string& bytes) {
    target ? target->append(bytes) : write_text_atomically("-", bytes);
  };
  put(table_start(job_.layout, format_));
  if (!store_) put(table_rows(only_part_, job_.layout, format_));
  if (store_) {
    for (const GridBox& box : grid_boxes(job_.layout.head.counts(), kConvertedRowsAtOnce))
      put(table_rows(store_->read(box), job_.layout, format_));
  }
  if (target) target->commit();
}

std::optional<std::string> TableOutput::rest() const {
  if (!is_resumable() || parts_done_ == 0) return std::nullopt;
  return fmt::format("{} of {} parts are in {}: the same command with --resume goes on", parts_done_, job_.parts.size(),
                     partial_path(job_.path).string());
}

}  // namespace dolp
