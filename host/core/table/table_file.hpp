// Tables as files. The suffix chooses the format; every file is complete or absent.
#pragma once

#include <filesystem>
#include <string>

#include "table/table.hpp"

namespace dolp {

enum class TableFormat { kNetcdf, kCsv, kNpy };

/// The format that the suffix chooses. Errors: InputError for another suffix.
TableFormat format_of(const std::filesystem::path& path);

/// Refuses an output path for a table, before anything is computed for it.
///
/// Domain: a name ending in .nc, .csv or .npy in a folder that can be written to, or "-" (CSV on standard output).
/// Errors: InputError for another suffix, IoError for a folder or file that cannot be written.
void check_output_path(const std::filesystem::path& path);

/// Writes a table.
///
/// .nc: NetCDF-4, CF-1.8, coordinates wavelength, n, k where the table has them, theta, sigma, q; status is an int
/// (CF-1.8 has no unsigned int). Nothing is compressed. .csv and "-": one row per entry,
/// `wavelength_um,n,k,theta_deg,sigma,q` and the variables; attributes as `# name: value` lines before the header, a
/// newline inside a value going on with `#   `. Numbers are the shortest text that reads back as the same double. .npy:
/// a structured array of the shape of the axes with the named fields of the .csv, so that `t["dolp"][i, j, k]` and
/// `t["theta_deg"][:, 0, 0]` work. The format has no attributes. Errors: those of check_output_path; IoError when
/// writing fails, after which the target is as it was.
void write_table(const TableValues& table, const std::filesystem::path& path);

/// The start of a .csv or .npy, and the rows of a part of the table; the parts follow each other.
std::string table_start(const TableLayout& layout, TableFormat format);
std::string table_rows(const TableValues& part, const TableLayout& layout, TableFormat format);

/// Reads a table that was written as .nc, all of it. Errors: those of TableReader.
TableValues read_table(const std::filesystem::path& path);

}  // namespace dolp
