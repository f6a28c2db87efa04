// Implementations of the public classes Scene and Table, and what the calls of the public header share.
#pragma once

#include <dolp/dolp.hpp>

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "report/report.hpp"
#include "scene/points.hpp"
#include "scene/scene.hpp"
#include "table/table.hpp"
#include "table/table_lookup.hpp"

namespace dolp {

struct Scene::Impl {
  SceneValues scene;
};

struct Table::Impl {
  Impl(TableValues own, std::string own_name) : table(std::move(own)), name(std::move(own_name)) {}
  /// Made at the first request. Errors: those of table_scene and TableLookup.
  const TableLookup& lookup() const;

  const TableValues table;
  const std::string name;  ///< for messages

  mutable std::once_flag is_made;
  mutable std::optional<SceneValues> scene;  ///< the table's scene; given, as `between`, from the first lookup
  mutable std::optional<TableLookup> between;
};

/// `output`: the file that was written.
Report public_report(const ReportBuilder& report, bool is_good = true, const std::filesystem::path& output = {});

/// The files that a scene is read from.
std::vector<std::string> files_of(const SceneValues& scene);

/// Refuses to write over what is read. "-" is stdin and stdout. Errors: InputError.
void check_output_is_no_input(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// `head`: the head of the table that a run over the points would write, or of the table that was read.
Results results_of(const std::vector<PointResult>& points, const Quantities& quantities, const TableHead& head);

/// Points of columns, as many as the columns that have not one value for all; one where there is none.
/// Errors: InputError for a column that is unknown, has another length, or has a value out of range.
Points points_of_columns(const std::vector<Column>& columns, PointsKind kind);

}  // namespace dolp
