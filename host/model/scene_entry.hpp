// Where a scene is looked at: a grid or scattered points.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <ranges>
#include <utility>
#include <vector>

#include "model/optical_constants.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// One point of a table or of a list of points. Without an `index` of its own it has the scene's material.
struct SceneEntry {
  double theta_deg = 0.0;
  SlopeShape shape;
  std::optional<OpticalConstants> index;
};

/// The product of three axes in the order theta, sigma, q, the last one fastest, or a list of points. An entry is its
/// position; a grid has no list of them.
class SceneEntries {
 public:
  SceneEntries() = default;
  SceneEntries(std::vector<SceneEntry> points) : points_(std::move(points)) {}  // NOLINT: a list is entries
  SceneEntries(std::initializer_list<SceneEntry> points) : points_(points) {}
  static SceneEntries grid(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q);

  bool is_grid() const { return is_grid_; }
  std::size_t size() const { return is_grid_ ? theta_deg_.size() * sigma_.size() * q_.size() : points_.size(); }
  bool empty() const { return size() == 0; }
  SceneEntry operator[](std::size_t entry) const;
  auto all() const {
    return std::views::iota(std::size_t{0}, size()) |
           std::views::transform([this](std::size_t i) { return (*this)[i]; });
  }

  // Of a grid.
  const std::vector<double>& theta_deg() const { return theta_deg_; }
  const std::vector<double>& sigma() const { return sigma_; }
  const std::vector<double>& q() const { return q_; }

  /// Consecutive parts of at most `most` entries each: of a grid whole directions where one fits, else parts of one.
  std::vector<SceneEntries> parts(std::size_t most) const;

 private:
  bool is_grid_ = false;
  std::vector<double> theta_deg_, sigma_, q_;
  std::vector<SceneEntry> points_;
};

}  // namespace dolp
