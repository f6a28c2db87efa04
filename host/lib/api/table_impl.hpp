// Implementation of the public table.
#pragma once

#include <dolp/dolp.hpp>

#include <mutex>
#include <optional>

#include "scene/scene.hpp"
#include "table/table.hpp"
#include "table/table_lookup.hpp"

namespace dolp {

struct Table::Impl {
  Impl(TableValues own, std::string own_name) : table(std::move(own)), name(std::move(own_name)) {}
  /// Made at the first request. Errors: those of table_scene and TableLookup.
  const TableLookup& lookup() const;

  const TableValues table;
  const std::string name;  ///< for messages

  mutable std::once_flag is_made;
  mutable std::optional<SceneValues> scene;  ///< its own; with `between` from the first lookup on
  mutable std::optional<TableLookup> between;
};

}  // namespace dolp
