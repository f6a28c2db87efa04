#include "api/reports.hpp"
#include "api/results.hpp"
#include "api/table_impl.hpp"
#include "run/lookup_run.hpp"
#include "run/scene_run.hpp"
#include "run/table_scene.hpp"
#include "table/table_file.hpp"

namespace dolp {

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

const Axes& Table::axes() const { return impl_->table.axes; }
const ResultColumns& Table::results() const { return impl_->table; }
const std::string& Table::stokes_units() const { return impl_->table.stokes_units; }

Results Table::lookup(const std::vector<Column>& points, const Progress& progress) const {
  const TableLookup& between = impl_->lookup();
  const Points at = points_of_columns(points, PointsKind::kDirections);
  begin(progress, at.size());
  return results_of(lookup_points(between, *impl_->scene, at, progress), between.quantities(), impl_->table);
}

void Table::write(const std::filesystem::path& path) const { write_table(impl_->table, path); }

}  // namespace dolp
