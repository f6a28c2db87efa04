#include "table/table_output.hpp"

#include <fmt/format.h>

#include <dolp/errors.hpp>
#include <fstream>
#include <sstream>

#include "base/atomic_file.hpp"
#include "table/table_file.hpp"
#include "table/table_store.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kConvertedRowsAtOnce = std::size_t{1} << 17U;  // that a .csv or .npy is made of

// Beside the file itself, not beside a link to it, which may be on another file system.
fs::path partial_path(const fs::path& path) { return follow_links(path).string() + ".partial"; }
fs::path progress_path(const fs::path& path) { return partial_path(path).string() + ".txt"; }

/// Progress of a partial file.
struct ProgressFile {
  std::string identity;
  std::size_t parts = 0;
  ValuesHash::Sums sums;
  std::string note;

  std::string text() const {
    return fmt::format("dolp table under way\n{}\n{}\n{:x}\n{}\n", identity, parts, fmt::join(sums, " "), note);
  }

  /// Nothing where there is none.
  static std::optional<ProgressFile> read(const fs::path& path) {
    std::ifstream file(path);
    ProgressFile progress;
    std::string title, parts, sums;
    if (!std::getline(file, title) || !std::getline(file, progress.identity) || !std::getline(file, parts) ||
        !std::getline(file, sums) || !std::getline(file, progress.note)) {
      return std::nullopt;
    }
    std::istringstream(parts) >> progress.parts;
    std::istringstream words(sums);
    for (std::uint64_t sum = 0; words >> std::hex >> sum;) progress.sums.push_back(sum);
    return progress;
  }
};

}  // namespace

struct TableOutput::Impl {
  Job job;
  TableFormat format;
  std::optional<AtomicFile> file;  // with the values; none of a .csv or .npy of one part
  std::optional<TableStore> store;
  TableValues only_part;
  std::size_t written = 0;
  ProgressFile progress;

  explicit Impl(Job of_run) : job(std::move(of_run)), format(format_of(job.path)) {
    check_output_path(job.path);
    progress.identity = job.identity;
    if (is_named()) {
      file.emplace(job.path, partial_path(job.path));
    } else if (format == TableFormat::kNetcdf) {
      file.emplace(job.path);
    } else if (job.parts > 1) {
      file.emplace(job.path == "-" ? fs::temp_directory_path() / "dolp" : job.path);
    }
    if (file) store.emplace(job.layout, *file);
    if (is_named()) go_on();
  }

  bool is_named() const { return job.is_resumable && job.parts > 1 && job.path != "-"; }

  void go_on() {
    std::optional<ProgressFile> found;
    if (job.is_resumed) found = ProgressFile::read(progress_path(job.path));
    if (found && found->identity != job.identity) {
      throw InputError(fmt::format("{}: is of another run ({}); this one is {}: remove it, or leave out --resume",
                                   partial_path(job.path).string(), found->identity, job.identity));
    }
    if (!found || found->sums.size() != store->sums().size()) {
      file->resize(0);
      return;
    }
    progress = std::move(*found);
    store->set_sums(progress.sums);
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
};

TableOutput::TableOutput(Job job) : impl_(std::make_unique<Impl>(std::move(job))) {}

TableOutput::~TableOutput() {
  if (!impl_->is_named() || impl_->progress.parts > 0 || !impl_->file) return;
  impl_->file->discard();  // it is empty
}

std::size_t TableOutput::parts_done() const { return impl_->progress.parts; }
const std::string& TableOutput::note() const { return impl_->progress.note; }

void TableOutput::write(TableValues part, const PerAxis& first, const std::string& note) {
  Impl& own = *impl_;
  if (own.store) {
    own.store->write(part, first);
  } else {
    own.only_part = std::move(part);
  }
  ++own.progress.parts;
  if (!own.is_named()) return;
  own.progress.sums = own.store->sums();
  own.progress.note = note;
  write_text_atomically(progress_path(own.job.path), own.progress.text());
}

void TableOutput::finish(const std::vector<Attribute>& more) {
  Impl& own = *impl_;
  std::vector<Attribute>& attributes = own.job.layout.head.attributes;
  attributes.insert(attributes.end(), more.begin(), more.end());
  if (own.format == TableFormat::kNetcdf) {
    own.store->finish(more);
    own.file->commit();
  } else {
    own.write_rows();
    if (own.file) own.file->discard();
  }
  if (!own.is_named()) return;
  std::error_code ignored;
  fs::remove(progress_path(own.job.path), ignored);
  own.progress.parts = 0;
}

std::optional<std::string> TableOutput::rest() const {
  if (!impl_->is_named() || impl_->progress.parts == 0) return std::nullopt;
  return fmt::format("{} of {} parts are in {}: the same command with --resume goes on", impl_->progress.parts,
                     impl_->job.parts, partial_path(impl_->job.path).string());
}

}  // namespace dolp
