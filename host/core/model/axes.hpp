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

/// Where the entry at a position of a table is on each axis.
PerAxis place_of(std::size_t position, const PerAxis& counts);

/// Values on each axis, of one that is empty 1; and their product.
PerAxis counts_of(const Axes& axes);
std::size_t size_of(const PerAxis& counts);

}  // namespace dolp
