// The ends of an axis as numbers that are typed.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "explore/window/fields.hpp"
#include "explore/window/plot.hpp"

namespace dolp::explore {

/// A small window for one axis at a time, which a double click on the numbers of an axis opens.
class AxisEditor {
 public:
  /// A change of the axis: ends that were typed, or none for those that follow from the data.
  struct Change {
    std::optional<Scale> range;
    bool is_log = false;
  };
  /// Why a range is refused, or nothing.
  using Check = std::function<std::string(const Scale& range)>;

  /// Draws the window if it is that of the axis of this label, whose numbers are in an area.
  std::optional<Change> draw(const std::string& label, const Area& numbers, const Scale& now, const Check& check);

  bool is_open() const { return !shown_.empty(); }
  /// The last drawn area of the box for a logarithmic axis.
  const Area& log_box() const { return log_box_; }

 private:
  std::string take(const std::string& end, const std::string& text, const Scale& now, const Check& check,
                   std::optional<Change>& change) const;

  NumberFields fields_;
  std::string shown_;  ///< label of the axis; empty: none
  bool is_opening_ = false;
  Area log_box_;
};

}  // namespace dolp::explore
