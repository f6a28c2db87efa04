#include "table/table_file.hpp"

#include <bit>
#include <string>
#include <string_view>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/printable_text.hpp"
#include "table/table_netcdf.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

enum class Format { kNetcdf, kCsv, kNpy };

Format format_of(const fs::path& path) {
  const std::string suffix = path.extension().string();
  if (suffix == ".nc") return Format::kNetcdf;
  if (suffix == ".csv" || path == "-") return Format::kCsv;
  if (suffix == ".npy") return Format::kNpy;
  throw InputError(path.string() + ": the name of a table must end in .nc, .csv or .npy");
}

/// The variables that a table has.
std::vector<const TableVariable*> present_variables(const Table& table) {
  std::vector<const TableVariable*> present;
  for (const TableVariable& variable : table_variables()) {
    if (!(table.*variable.values).empty()) present.push_back(&variable);
  }
  return present;
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

std::string csv_header(const Table& table, const std::vector<const TableVariable*>& variables) {
  std::string text;
  for (const Attribute& attribute : table.attributes)
    text += "# " + attribute.name + ": " + value_text(attribute) + "\n";
  text += "# units of stokes: " + table.stokes_units + "\n";
  text += "theta_deg,sigma,q";
  for (const TableVariable* variable : variables) (text += ',') += variable->name;
  if (!table.status.empty()) text += ",status";
  return text + "\n";
}

std::string csv_text(const Table& table) {
  const std::vector<const TableVariable*> variables = present_variables(table);
  std::string text = csv_header(table, variables);
  std::size_t position = 0;
  for (const double theta_deg : table.theta_deg) {
    for (const double sigma : table.sigma) {
      const std::string start = number_text(theta_deg) + ',' + number_text(sigma) + ',';
      for (const double q : table.q) {
        text += start;
        text += number_text(q);
        for (const TableVariable* variable : variables)
          (text += ',') += number_text((table.*variable->values)[position]);
        if (!table.status.empty()) (text += ',') += std::to_string(table.status[position]);
        text += '\n';
        ++position;
      }
    }
  }
  return text;
}

/// Source: the NumPy enhancement proposal "A Simple File Format for NumPy Arrays", version 1.0.
std::string npy_header(const Table& table, const std::vector<const TableVariable*>& variables) {
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kPreambleSize = 10;
  std::string fields;
  for (const char* axis : {"theta_deg", "sigma", "q"}) fields += std::string("('") + axis + "', '<f8'), ";
  for (const TableVariable* variable : variables) fields += std::string("('") + variable->name + "', '<f8'), ";
  if (!table.status.empty()) fields += "('status', '<u4'), ";
  std::string header = "{'descr': [" + fields + "], 'fortran_order': False, 'shape': (" +
                       std::to_string(table.theta_deg.size()) + ", " + std::to_string(table.sigma.size()) + ", " +
                       std::to_string(table.q.size()) + "), }";
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

std::string npy_bytes(const Table& table) {
  const std::vector<const TableVariable*> variables = present_variables(table);
  std::string bytes = npy_header(table, variables);
  std::size_t position = 0;
  for (const double theta_deg : table.theta_deg) {
    for (const double sigma : table.sigma) {
      for (const double q : table.q) {
        for (const double value : {theta_deg, sigma, q}) append_bytes(bytes, value);
        for (const TableVariable* variable : variables) append_bytes(bytes, (table.*variable->values)[position]);
        if (!table.status.empty()) append_bytes(bytes, table.status[position]);
        ++position;
      }
    }
  }
  return bytes;
}

}  // namespace

void check_output_path(const fs::path& path) {
  format_of(path);
  check_writable(path);
}

void write_table(const Table& table, const fs::path& path) {
  switch (format_of(path)) {
    case Format::kNetcdf:
      return write_text_atomically(path, NetcdfImage(table).bytes());
    case Format::kCsv:
      return write_text_atomically(path, csv_text(table));
    case Format::kNpy:
      return write_text_atomically(path, npy_bytes(table));
  }
}

}  // namespace dolp
