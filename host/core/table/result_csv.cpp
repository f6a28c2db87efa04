#include "table/result_csv.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel_ranges.hpp"
#include "base/text.hpp"
#include "table/table.hpp"

namespace dolp {
namespace {

constexpr std::size_t kRowsAtOnce = 4096;         // of a thread
constexpr std::size_t kBlock = 16 * kRowsAtOnce;  // rows that are text in memory at a time

}  // namespace

std::string result_header(const Quantities& quantities, bool has_status) {
  std::string header;
  for (const Quantity quantity : quantities) (header += description_of(quantity).name) += ',';
  if (has_status) return header + "status";
  return header.substr(0, header.size() - 1);
}

std::string result_rows(const ResultColumns& results, std::size_t rows, const Quantities& quantities,
                        const RowStart& start) {
  std::vector<std::string> pieces((rows + kRowsAtOnce - 1) / kRowsAtOnce);
  parallel_ranges(rows, kRowsAtOnce, [&](std::size_t first, std::size_t last) {
    std::string& text = pieces[first / kRowsAtOnce];
    for (std::size_t row = first; row < last; ++row) {
      start(text, row);
      for (const Quantity quantity : quantities) {
        append_number(text, results[quantity][row]);
        text += ',';
      }
      results.status.empty() ? text.pop_back() : void(text += std::to_string(results.status[row]));
      text += '\n';
    }
  });
  std::string text;
  for (const std::string& piece : pieces) text += piece;
  return text;
}

Quantities in_csv_order(const Quantities& quantities) {
  Quantities ordered;
  for (const Quantity quantity : kCsvOrder) {
    if (std::ranges::find(quantities, quantity) != quantities.end()) ordered.push_back(quantity);
  }
  return ordered;
}

ResultCsv::ResultCsv(const std::filesystem::path& path, const std::string& columns, const Quantities& quantities,
                     RowStart start)
    : quantities_(in_csv_order(quantities)), start_(std::move(start)) {
  if (path != "-") file_.emplace(path);
  write(columns + ',' + result_header(quantities_) + '\n');
}

void ResultCsv::append(std::span<const PointResult> results) {
  while (!results.empty()) {
    const std::span<const PointResult> block = results.first(std::min(kBlock, results.size()));
    write(result_rows(columns_of(block, quantities_), block.size(), quantities_,
                      [&](std::string& text, std::size_t row) { start_(text, done_ + row); }));
    done_ += block.size();
    results = results.subspan(block.size());
  }
}

void ResultCsv::commit() { file_ ? file_->commit() : write_text_atomically("-", text_); }

void ResultCsv::write(const std::string& text) { file_ ? file_->append(text) : void(text_ += text); }

}  // namespace dolp
