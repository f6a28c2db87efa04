#include "api/results.hpp"

#include "base/number_text.hpp"
#include "table/result_csv.hpp"

namespace dolp {

Results results_of(const std::vector<PointResult>& points, const Quantities& quantities, const TableHead& head) {
  Results results{{columns_of(points, quantities)}, quantities, head.stokes_units};
  for (const Attribute& attribute : head.attributes) {
    results.attributes.push_back({attribute.name, attribute.value});
  }
  return results;
}

std::string to_csv(const std::vector<Column>& points, const Results& results) {
  const Quantities quantities = in_csv_order(results.given);
  std::string header;
  for (const Column& column : points) header += column.name + ',';
  return header + result_header(quantities) + '\n' +
         result_rows(results, results.status.size(), quantities, [&](std::string& text, std::size_t row) {
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
