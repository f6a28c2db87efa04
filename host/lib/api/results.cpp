#include "api/impl.hpp"

#include <fmt/format.h>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "table/result_csv.hpp"

namespace dolp {

Results results_of(const std::vector<PointResult>& points, const Quantities& quantities, const TableHead& head) {
  return {{columns_of(points, quantities)}, quantities, head.stokes_units, head.attributes};
}

std::string to_csv(const std::vector<Column>& points, const Results& results) {
  const Quantities quantities = in_csv_order(results.given);
  const std::size_t count = results.status.size();
  const auto check = [&](const std::string& name, std::size_t size, bool may_be_one) {
    if (size == count || (may_be_one && size == 1)) return;
    throw InputError(fmt::format("{}: {} values for {} results", one_line(name), size, count));
  };
  for (const Column& column : points) check(column.name, column.values.size(), true);
  for (const Quantity quantity : quantities) check(description_of(quantity).name, results[quantity].size(), false);
  std::string header;
  for (const Column& column : points) header += column.name + ',';
  return header + result_header(quantities) + '\n' +
         result_rows(results, count, quantities, [&](std::string& text, std::size_t row) {
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
  return points_of(columns, count, kind);
}

}  // namespace dolp
