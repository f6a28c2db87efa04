#include "table/table_file.hpp"

#include <fmt/format.h>
#include <dolp/errors.hpp>

#include <algorithm>
#include <bit>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "base/parallel_ranges.hpp"
#include "base/text.hpp"
#include "table/table_store.hpp"

namespace dolp {
namespace {

constexpr std::size_t kRowsAtOnce = 4096;         // rows that a thread converts to text in one step
constexpr std::size_t kBlock = 16 * kRowsAtOnce;  // rows whose text is in memory at a time

namespace fs = std::filesystem;

std::vector<Axis> present_axes(const Axes& axes) {
  std::vector<Axis> present;
  std::ranges::copy_if(kAllAxes, std::back_inserter(present), [&](Axis axis) { return !axes[axis].empty(); });
  return present;
}

template <class Use>
void each_coordinate(const Axes& axes, std::size_t position, const Use& use) {
  const PerAxis on_axes = positions_on_axes(position, axis_counts(axes));
  for (const Axis axis : kAllAxes) {
    if (!axes[axis].empty()) use(axis, axes[axis][on_axes[axis]]);
  }
}

std::size_t longest_label(const TableHead& head, Axis axis) {
  std::size_t longest = 1;
  for (const std::string& label : head.labels[axis]) longest = std::max(longest, label.size());
  return longest;
}

std::string value_text(const Attribute& attribute) {
  if (const auto* number = std::get_if<double>(&attribute.value)) return number_text(*number);
  std::vector<std::string> lines;
  std::ranges::transform(split_lines(std::get<std::string>(attribute.value)), std::back_inserter(lines),
                         printable_line);
  return fmt::format("{}", fmt::join(lines, "\n#   "));
}

/// The names of the columns, then attributes as comments. numpy.genfromtxt(names=True) takes its names from the first
/// line, even if this is a comment.
std::string csv_header(const TableLayout& layout) {
  std::string text;
  for (const Axis axis : present_axes(layout.head.axes)) (text += describe(axis).column) += ',';
  text += fmt::format("{}\n", fmt::join(variable_names(layout), ","));
  for (const Attribute& attribute : layout.head.attributes)
    text += "# " + attribute.name + ": " + value_text(attribute) + "\n";
  return text + "# units of stokes: " + layout.head.stokes_units + "\n";
}

std::string csv_rows(const TableValues& part, const TableLayout& layout) {
  return result_rows(part, 0, part.size(), layout.quantities, [&](std::string& text, std::size_t position) {
    each_coordinate(part.axes, position, [&](Axis axis, double value) {
      if (describe(axis).has_labels) {
        text += '"' + layout.head.label(axis, value) + '"';
      } else {
        append_number(text, value);
      }
      text += ',';
    });
  });
}

/// Format: NumPy enhancement proposal "A Simple File Format for NumPy Arrays", version 1.0.
std::string npy_header(const TableLayout& layout) {
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kPreambleSize = 10;
  std::string fields, shape;
  for (const Axis axis : present_axes(layout.head.axes)) {
    const AxisDescription& described = describe(axis);
    const std::string type = described.has_labels ? fmt::format("S{}", longest_label(layout.head, axis)) : "<f8";
    fields += fmt::format("('{}', '{}'), ", described.column, type);
    shape += fmt::format("{}{}", shape.empty() ? "" : ", ", layout.head.axes[axis].size());
  }
  for (const std::string& name : variable_names(layout))
    fields += fmt::format("('{}', '{}'), ", name, name == "status" ? "<u4" : "<f8");
  std::string header = "{'descr': [" + fields + "], 'fortran_order': False, 'shape': (" + shape + "), }";
  const std::size_t unpadded = kPreambleSize + header.size() + 1;
  header.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  header += '\n';
  std::string preamble("\x93NUMPY\x01\x00", 8);
  preamble += static_cast<char>(header.size() % 256);
  preamble += static_cast<char>(header.size() / 256);
  return preamble + header;
}

template <typename Number>
void append_bytes(std::string& bytes, Number value) {
  static_assert(std::endian::native == std::endian::little, "the header says little-endian");
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string npy_rows(const TableValues& part, const TableLayout& layout) {
  std::string bytes;
  for (std::size_t position = 0; position < part.size(); ++position) {
    each_coordinate(part.axes, position, [&](Axis axis, double value) {
      if (!describe(axis).has_labels) return append_bytes(bytes, value);
      std::string label = layout.head.label(axis, value);
      label.resize(longest_label(layout.head, axis));
      bytes += label;
    });
    for_each_variable(layout, [&](const auto& of, std::size_t) { append_bytes(bytes, of(part)[position]); });
  }
  return bytes;
}

}  // namespace

std::string result_rows(const ResultColumns& results, std::size_t first, std::size_t last, const Quantities& quantities,
                        const RowStart& start) {
  std::vector<std::string> pieces((last - first + kRowsAtOnce - 1) / kRowsAtOnce);
  parallel_ranges(last - first, kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::string& text = pieces[begin / kRowsAtOnce];
    const auto add = [&](double value) {
      append_number(text, value);
      text += ',';
    };
    for (std::size_t row = first + begin; row < first + end; ++row) {
      start(text, row);
      for (const Quantity quantity : quantities) add(results[quantity][row]);
      for (const DerivativeColumn& column : results.derivatives) add(column.values[row]);
      if (!results.status.empty()) text += std::to_string(results.status[row]) + ',';
      text.back() = '\n';
    }
  });
  std::string rows;
  for (const std::string& piece : pieces) rows += piece;
  return rows;
}

Quantities in_csv_order(const Quantities& quantities) {
  Quantities ordered;
  std::ranges::copy_if(kCsvOrder, std::back_inserter(ordered),
                       [&](Quantity quantity) { return std::ranges::count(quantities, quantity) > 0; });
  return ordered;
}

ResultCsv::ResultCsv(const std::filesystem::path& path, const std::string& columns, const TableLayout& layout,
                     RowStart start)
    : quantities_(in_csv_order(layout.quantities)), start_(std::move(start)) {
  if (path != "-") file_.emplace(path);
  const TableLayout ordered{.quantities = quantities_, .derivatives = layout.derivatives};
  write(fmt::format("{},{}\n", columns, fmt::join(variable_names(ordered), ",")));
}

void ResultCsv::append(const ResultColumns& results) {
  const std::size_t rows = results.status.size();
  const RowStart start = [&](std::string& text, std::size_t row) { start_(text, done_ + row); };
  for (std::size_t first = 0; first < rows; first += kBlock)
    write(result_rows(results, first, std::min(first + kBlock, rows), quantities_, start));
  done_ += rows;
}

void ResultCsv::commit() { file_ ? file_->commit() : write_text_atomically("-", text_); }

void ResultCsv::write(const std::string& text) { file_ ? file_->append(text) : void(text_ += text); }

TableFormat table_format(const fs::path& path) {
  const std::string suffix = path.extension().string();
  if (suffix == ".nc") return TableFormat::kNetcdf;
  if (suffix == ".csv" || path == "-") return TableFormat::kCsv;
  if (suffix == ".npy") return TableFormat::kNpy;
  throw InputError(path.string() + ": the name of a table must end in .nc, .csv or .npy");
}

void check_output_path(const fs::path& path) {
  table_format(path);
  check_writable(path);
}

std::string table_start(const TableLayout& layout, TableFormat format) {
  return format == TableFormat::kCsv ? csv_header(layout) : npy_header(layout);
}

std::string table_rows(const TableValues& part, const TableLayout& layout, TableFormat format) {
  return format == TableFormat::kCsv ? csv_rows(part, layout) : npy_rows(part, layout);
}

void write_table(const TableValues& table, const fs::path& path) {
  const TableFormat format = table_format(path);
  const TableLayout layout = values_layout(table);
  if (format != TableFormat::kNetcdf && !layout.responses.empty())
    throw InputError(path.string() + ": the name of a response table must end in .nc");
  if (format != TableFormat::kNetcdf)
    return write_text_atomically(path, table_start(layout, format) + table_rows(table, layout, format));
  AtomicFile file(path);
  TableStore store(layout, file);
  store.finish({}, store.write(table, {}));
  file.commit();
}

}  // namespace dolp
