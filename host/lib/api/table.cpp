#include <algorithm>

#include "api/reports.hpp"
#include "api/results.hpp"
#include "api/table_impl.hpp"
#include "run/lookup_run.hpp"
#include "run/table_scene.hpp"
#include "table/table_file.hpp"
#include "run/scene_run.hpp"
#include "table/table_netcdf.hpp"

namespace dolp::api {

const TableLookup& Table::Impl::lookup() const {
  std::call_once(is_made, [&] {
    scene = table_scene(table, name);
    between.emplace(table, scene->accuracy.tolerance, name);
  });
  return *between;
}

Table Table::read(const std::filesystem::path& path) {
  return Table(std::make_shared<const Impl>(load_table(path.string()), path.string()));
}

std::vector<std::string> Table::axes() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kTableAxes.size(); ++i) {
    if (!(impl_->table.*kTableAxes[i]).empty()) names.emplace_back(kNetcdfAxes[i].name);
  }
  return names;
}

std::span<const double> Table::axis(std::string_view name) const {
  const auto found = std::ranges::find(kNetcdfAxes, name, &NetcdfAxis::name);
  const auto position = static_cast<std::size_t>(found - kNetcdfAxes.begin());
  if (found == kNetcdfAxes.end() || (impl_->table.*kTableAxes[position]).empty()) {
    throw InputError(impl_->name + ": the table has no axis " + std::string(name));
  }
  return impl_->table.*kTableAxes[position];
}

std::vector<Variable> Table::variables() const {
  std::vector<Variable> all;
  for (const TableVariable* variable : present_variables(impl_->table)) {
    all.push_back(variable_of(*variable, impl_->table.stokes_units));
  }
  return all;
}

std::span<const double> Table::values(std::string_view name) const {
  for (const TableVariable* variable : present_variables(impl_->table)) {
    if (variable->name == name) return impl_->table.*variable->values;
  }
  throw InputError(impl_->name + ": the table has no variable " + std::string(name));
}

std::span<const std::uint32_t> Table::status() const { return impl_->table.status; }

Results Table::lookup(const std::vector<Column>& points, const Progress& progress) const {
  const TableLookup& between = impl_->lookup();
  const Points at = points_of_columns(points, PointsKind::kDirections);
  dolp::begin(progress, at.size());
  return results_of(lookup_points(between, *impl_->scene, at, progress), between.extra_columns(), impl_->table);
}

void Table::write(const std::filesystem::path& path) const {
  dolp::write_table(impl_->table, path);
}

}  // namespace dolp::api
