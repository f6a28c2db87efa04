// Axes of grids and tables, and positions on them.
#pragma once

#include <dolp/axis.hpp>

#include <cstddef>
#include <vector>

namespace dolp {

Axes axes_of(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q,
             std::vector<double> wavelength_um = {}, std::vector<double> n = {}, std::vector<double> k = {});

/// The values first[axis], ..., first[axis] + count[axis] - 1 of each axis that is not empty.
Axes part_of(const Axes& axes, const PerAxis& first, const PerAxis& count);

/// Index on each axis of the entry at a position of a table.
PerAxis place_of(std::size_t position, const PerAxis& counts);

/// Number of values on each axis, 1 for an empty axis; and the product of these numbers.
PerAxis counts_of(const Axes& axes);
std::size_t size_of(const PerAxis& counts);

}  // namespace dolp
