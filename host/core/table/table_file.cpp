#include "table/table_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <dolp/errors.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/atomic_file.hpp"
#include "base/number_text.hpp"
#include "base/parallel_ranges.hpp"
#include "base/printable_text.hpp"
#include "table/table_store.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRowsOfAThread = 4096;  // of a thread

/// The axes of a .csv or .npy, in the order of kTableAxes.
constexpr std::array<const char*, kTableAxes.size()> kAxisColumns = {"wavelength_um", "n",     "k",
                                                                     "theta_deg",     "sigma", "q"};

/// Those that the table has.
struct AxisColumn {
  const char* name;
  std::size_t axis;
};
std::vector<AxisColumn> axis_columns(const TableHead& head) {
  std::vector<AxisColumn> columns;
  for (std::size_t i = 0; i < kTableAxes.size(); ++i) {
    if (!(head.*kTableAxes[i]).empty()) columns.push_back({kAxisColumns[i], i});
  }
  return columns;
}

/// Calls row(position, values of the axes) for positions first, first + 1, ... of a table.
template <class Row>
void each_row(const TableHead& head, const std::vector<AxisColumn>& axes, std::size_t first, std::size_t last,
              const Row& row) {
  std::vector<double> values(axes.size());
  for (std::size_t position = first; position < last; ++position) {
    std::size_t rest = position;
    for (std::size_t i = axes.size(); i-- > 0;) {
      const std::vector<double>& axis = head.*kTableAxes[axes[i].axis];
      values[i] = axis[rest % axis.size()];
      rest /= axis.size();
    }
    row(position, values);
  }
}

std::string value_text(const Attribute& attribute) {
  if (const auto* number = std::get_if<double>(&attribute.value)) return number_text(*number);
  std::string_view lines = std::get<std::string>(attribute.value);
  while (lines.ends_with('\n')) lines.remove_suffix(1);
  std::string text;
  for (;;) {
    const std::size_t end = lines.find('\n');
    std::string_view line = lines.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    text += printable_line(line);
    if (end == std::string_view::npos) return text;
    text += "\n#   ";
    lines.remove_prefix(end + 1);
  }
}

std::string csv_header(const TableLayout& layout) {
  std::string text;
  for (const Attribute& attribute : layout.head.attributes)
    text += "# " + attribute.name + ": " + value_text(attribute) + "\n";
  text += "# units of stokes: " + layout.head.stokes_units + "\n";
  std::string names;
  for (const AxisColumn& axis : axis_columns(layout.head)) (names += ',') += axis.name;
  for (const TableVariable* variable : layout.variables) (names += ',') += variable->name;
  if (layout.has_status) names += ",status";
  return text + names.substr(1) + "\n";
}

std::string csv_rows(const Table& part, const TableVariables& variables) {
  const std::vector<AxisColumn> axes = axis_columns(part);
  std::vector<std::string> pieces((part.size() + kRowsOfAThread - 1) / kRowsOfAThread);
  parallel_ranges(part.size(), kRowsOfAThread, [&](std::size_t first, std::size_t last) {
    std::string& text = pieces[first / kRowsOfAThread];
    each_row(part, axes, first, last, [&](std::size_t position, const std::vector<double>& values) {
      std::string_view separator;
      for (const double value : values) {
        (text += separator) += number_text(value);
        separator = ",";
      }
      for (const TableVariable* variable : variables) (text += ',') += number_text((part.*variable->values)[position]);
      if (!part.status.empty()) (text += ',') += std::to_string(part.status[position]);
      text += '\n';
    });
  });
  std::string text;
  for (const std::string& piece : pieces) text += piece;
  return text;
}

/// Source: the NumPy enhancement proposal "A Simple File Format for NumPy Arrays", version 1.0.
std::string npy_header(const TableLayout& layout) {
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kPreambleSize = 10;
  std::string fields, shape;
  for (const AxisColumn& axis : axis_columns(layout.head)) {
    fields += fmt::format("('{}', '<f8'), ", axis.name);
    shape += fmt::format("{}{}", shape.empty() ? "" : ", ", (layout.head.*kTableAxes[axis.axis]).size());
  }
  for (const TableVariable* variable : layout.variables) fields += fmt::format("('{}', '<f8'), ", variable->name);
  if (layout.has_status) fields += "('status', '<u4'), ";
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

std::string npy_rows(const Table& part, const TableVariables& variables) {
  std::string bytes;
  each_row(part, axis_columns(part), 0, part.size(), [&](std::size_t position, const std::vector<double>& axes) {
    for (const double value : axes) append_bytes(bytes, value);
    for (const TableVariable* variable : variables) append_bytes(bytes, (part.*variable->values)[position]);
    if (!part.status.empty()) append_bytes(bytes, part.status[position]);
  });
  return bytes;
}

}  // namespace

TableFormat format_of(const fs::path& path) {
  const std::string suffix = path.extension().string();
  if (suffix == ".nc") return TableFormat::kNetcdf;
  if (suffix == ".csv" || path == "-") return TableFormat::kCsv;
  if (suffix == ".npy") return TableFormat::kNpy;
  throw InputError(path.string() + ": the name of a table must end in .nc, .csv or .npy");
}

void check_output_path(const fs::path& path) {
  format_of(path);
  check_writable(path);
}

std::string table_start(const TableLayout& layout, TableFormat format) {
  return format == TableFormat::kCsv ? csv_header(layout) : npy_header(layout);
}

std::string table_rows(const Table& part, const TableLayout& layout, TableFormat format) {
  return format == TableFormat::kCsv ? csv_rows(part, layout.variables) : npy_rows(part, layout.variables);
}

void write_table(const Table& table, const fs::path& path) {
  const TableFormat format = format_of(path);
  const TableLayout layout{static_cast<const TableHead&>(table), present_variables(table), !table.status.empty()};
  if (format != TableFormat::kNetcdf)
    return write_text_atomically(path, table_start(layout, format) + table_rows(table, layout, format));
  AtomicFile file(path);
  TableStore store(layout, file);
  store.write(table, {});
  store.finish({});
  file.commit();
}

}  // namespace dolp
