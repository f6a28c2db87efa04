// The CSV of points and of what was found there.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "base/atomic_file.hpp"
#include "model/point_result.hpp"
#include "scene/points.hpp"
#include "table/result_csv.hpp"

namespace dolp {

/// Rows in the order of the points: their columns as they were given, then those of their results. The file is whole or
/// not there; into a file rows go as they come, to "-", standard output, when all are there.
class PointsCsv {
 public:
  /// `points` must outlive the object. Errors: IoError.
  PointsCsv(const std::filesystem::path& path, const Points& points, const ExtraColumns& extra);
  /// Results of the points after those before. Errors: IoError; Cancelled when interrupted().
  void append(std::span<const PointResult> results);
  /// Errors: likewise.
  void commit();

 private:
  void write(const std::string& text);

  const Points& points_;
  ExtraColumns extra_;
  std::optional<AtomicFile> file_;  ///< none for standard output
  std::string text_;                ///< for standard output
  std::size_t done_ = 0;
};

}  // namespace dolp
