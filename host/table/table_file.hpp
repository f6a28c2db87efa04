// Tables as files. The suffix chooses the format; every file is whole or not there.
#pragma once

#include <filesystem>

#include "table/table.hpp"

namespace dolp {

/// Refuses an output path for a table, before anything is computed for it.
///
/// Domain: a name ending in .nc, .csv or .npy in a folder that can be written to, or "-" (CSV on standard output).
/// Errors: InputError for another suffix, IoError for a folder or file that cannot be written.
void check_output_path(const std::filesystem::path& path);

/// Writes a table.
///
/// .nc: NetCDF-4, CF-1.8, coordinates theta, sigma, q; status is an int (CF-1.8 has no unsigned int). Nothing is
/// compressed.
/// .csv and "-": one row per entry, `theta_deg,sigma,q` and the variables; attributes as `# name: value` lines before
/// the header, a newline inside a value going on with `#   `. Numbers are the shortest text that reads back as the same
/// double.
/// .npy: a structured array of shape (theta, sigma, q) with the named fields of the .csv, so that `t["dolp"][i, j, k]`
/// and `t["theta_deg"][:, 0, 0]` work. The format has no attributes.
/// Errors: those of check_output_path; IoError when writing fails, after which the target is as it was.
void write_table(const Table& table, const std::filesystem::path& path);

/// Reads a table that write_table wrote as .nc.
///
/// Errors: InputError when the file cannot be opened, is not such a table, has more than kMostTableEntries entries, or
/// claims more values than a file of its size can hold.
Table read_table(const std::filesystem::path& path);

}  // namespace dolp
