#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "api/impl.hpp"
#include "base/text.hpp"
#include "run/scene_run.hpp"
#include "run/table_scene.hpp"
#include "table/table.hpp"
#include "table/table_file.hpp"

namespace dolp {
namespace {

void check_axes(const TableHead& table, const std::string& name) {
  for (const Axis axis : kAllAxes) {
    const AxisDescription& described = describe(axis);
    if (described.is_required && table.axes[axis].empty())
      throw InputError(fmt::format("{}: the axis {} is missing", name, described.name));
    for (const double value : table.axes[axis]) {
      if (described.has_labels && value >= static_cast<double>(table.labels[axis].size()))
        throw InputError(fmt::format("{}: {}: {} values and {} labels", name, described.name, table.axes[axis].size(),
                                     table.labels[axis].size()));
      if (described.range.contains(value)) continue;
      throw InputError(fmt::format("{}: {} = {}: out of range; must be a number in {}", name, described.name,
                                   format_number(value), described.range.text()));
    }
  }
}

/// Refuses invalid and repeated names.
void check_attributes(const std::vector<Attribute>& attributes, const std::string& name) {
  std::set<std::string_view> names;
  for (const Attribute& attribute : attributes) {
    const std::string& attribute_name = attribute.name;
    if (attribute_name.empty() || attribute_name.find('/') != std::string::npos || !names.insert(attribute_name).second)
      throw InputError(
          fmt::format("{}: attribute \"{}\": must have a name of its own without /", name, one_line(attribute_name)));
  }
}

/// A file names its derivatives in an attribute, by which its reader finds them.
void check_derivatives(const TableValues& table, const std::string& name) {
  const std::vector<DerivativeColumn> named = derivative_columns(derivative_keys(table));
  for (const DerivativeColumn& column : table.derivatives) {
    if (std::ranges::find(named, column.name, &DerivativeColumn::name) == named.end())
      throw InputError(
          fmt::format("{}: {}: the attribute {} does not name its key", name, one_line(column.name), kDerivativeKeys));
  }
}

void check_values(const TableValues& table, const std::string& name) {
  check_axes(table, name);
  const auto check_size = [&](const char* variable, std::size_t size, std::size_t expected) {
    if (size == expected) return;
    throw InputError(fmt::format("{}: {} has {} values; must be {}", name, variable, size, expected));
  };
  for (const Quantity quantity : table.quantities())
    check_size(describe(quantity).name, table[quantity].size(), table.size());
  if (!table.status.empty()) check_size("status", table.status.size(), table.size());
  check_derivatives(table, name);
  for (const DerivativeColumn& column : table.derivatives)
    check_size(column.name.c_str(), column.values.size(), table.size());
  check_attributes(table.attributes, name);
  for (const TableCurve& described : kTableCurves) {
    const Curve& curve = table.*described.curve;
    check_size(described.name, curve.values.size(), curve.wavelength_um.size());
    if (!curve.used.empty()) check_size(described.name, curve.used.size(), table.counts()[Axis::kWavelength]);
  }
}

}  // namespace

Table Table::read(const std::filesystem::path& path) { return Table(load_table(path.string())); }

Table Table::of(TableValues values, const std::string& name) {
  std::erase_if(values.attributes, [](const Attribute& attribute) {
    return attribute.name == kConventions || attribute.name == kValuesHash;
  });
  take_spectral_data(values, name);
  check_values(values, name);
  return Table(std::move(values));
}

std::vector<Attribute> Table::file_attributes() const {
  const TableValues& table = *values_;
  std::vector<Attribute> attributes = {{kConventions, kConventionsOfFiles}};
  attributes.insert(attributes.end(), table.attributes.begin(), table.attributes.end());
  if (const std::string data = spectral_data_text(table); !data.empty()) attributes.push_back({kSpectralData, data});
  const TableLayout layout = values_layout(table);
  attributes.push_back({kValuesHash, values_hash(layout, value_sums(table, layout, {}))});
  return attributes;
}

void Table::write(const std::filesystem::path& path) const { write_table(*values_, path); }

std::string to_csv(const std::vector<Column>& points, const Results& results) {
  TableLayout layout{.quantities = in_csv_order(results.given)};
  const std::size_t count = results.status.size();
  const auto check = [&](const std::string& name, std::size_t size, bool may_be_one) {
    if (size == count || (may_be_one && size == 1)) return;
    throw InputError(fmt::format("{}: {} values for {} results", one_line(name), size, count));
  };
  for (const Column& column : points) check(column.name, column.values.size(), true);
  for (const Quantity quantity : layout.quantities) check(describe(quantity).name, results[quantity].size(), false);
  std::string header;
  for (const Column& column : points) header += column.name + ',';
  for (const DerivativeColumn& column : results.derivatives) {
    check(column.name, column.values.size(), false);
    layout.derivatives.push_back({.name = column.name});
  }
  return fmt::format("{}{}\n", header, fmt::join(variable_names(layout), ",")) +
         result_rows(results, 0, count, layout.quantities, [&](std::string& text, std::size_t row) {
           for (const Column& column : points) {
             append_number(text, column.values[column.values.size() == 1 ? 0 : row]);
             text += ',';
           }
         });
}

Points points_of_columns(const std::vector<Column>& columns, PointsKind kind) {
  std::size_t count = 1;
  for (const Column& column : columns) {
    if (column.values.size() != 1) count = column.values.size();
  }
  return make_points(columns, count, kind);
}

}  // namespace dolp
