#include "run/points_csv.hpp"

#include <algorithm>
#include <vector>

#include "base/parallel_ranges.hpp"

namespace dolp {
namespace {

constexpr std::size_t kRowsAtOnce = 4096;         // of a thread
constexpr std::size_t kBlock = 16 * kRowsAtOnce;  // rows that are text in memory at a time

}  // namespace

PointsCsv::PointsCsv(const std::filesystem::path& path, const Points& points, const ExtraColumns& extra)
    : points_(points), extra_(extra) {
  if (path != "-") file_.emplace(path);
  write(points.header + ',' + result_header(extra) + '\n');
}

void PointsCsv::append(std::span<const PointResult> results) {
  while (!results.empty()) {
    const std::span<const PointResult> block = results.first(std::min(kBlock, results.size()));
    std::vector<std::string> parts((block.size() + kRowsAtOnce - 1) / kRowsAtOnce);
    parallel_ranges(block.size(), kRowsAtOnce, [&](std::size_t first, std::size_t last) {
      std::string& part = parts[first / kRowsAtOnce];
      for (std::size_t i = first; i < last; ++i) {
        part += points_.rows[done_ + i];
        part += ',';
        append_result_cells(part, block[i], extra_);
        part += '\n';
      }
    });
    for (const std::string& part : parts) write(part);
    done_ += block.size();
    results = results.subspan(block.size());
  }
}

void PointsCsv::commit() { file_ ? file_->commit() : write_text_atomically("-", text_); }

void PointsCsv::write(const std::string& text) { file_ ? file_->append(text) : void(text_ += text); }

}  // namespace dolp
