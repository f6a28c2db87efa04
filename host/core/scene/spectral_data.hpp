#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <dolp/number_range.hpp>
#include "scene/csv_columns.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Irradiance of the sun at the top of the atmosphere, at normal incidence, interpolated log-log in wavelength.
/// Source: host/data/sun.csv (Gueymard 2003). Units: W m-2 um-1.
SpectralTable sun_irradiance();

/// Reads a user's CSV with the columns wavelength_um and irradiance (W m-2 um-1), interpolated linearly. A file without
/// column names has these columns in this order. Errors: InputError if an irradiance is negative, or if the file has no
/// rows.
SpectralTable parse_irradiance(std::string_view text, const std::string& name);

/// The response of a camera from a CSV with the columns wavelength_um and response, in this order if they have no
/// names. Errors: InputError if the rows are not in the order of their wavelengths, if a response is negative, or if
/// all are 0.
SpectralTable parse_response(std::string_view text, const std::string& name);

/// A diffuse reflectance from a CSV with the columns wavelength_um and reflectance, or from a file of the ECOSTRESS
/// spectral library. Errors: InputError with file and line.
SpectralTable parse_diffuse(std::string_view text, const std::string& name);

/// The table as a CSV that parse_response() or parse_diffuse() reads. Empty without rows. `value`: name of the column.
std::string spectral_text(const SpectralTable* table, const char* value);

/// The spectrum of a camera with the response `table`: from the first to the last wavelength at which it is not 0.
Spectrum response_spectrum(SpectralTable table, ResponsePer per);

/// The largest value of `table` in the spectrum.
double largest_value(const SpectralTable& table, const Spectrum& spectrum);

struct NamedValue {
  const char* name;
  double value;
  NumberRange range;
};

/// Appends a row. Errors: InputError that begins with `where`, for a number out of range or a descending wavelength.
void append_row(SpectralTable& table, double wavelength_um, const NamedValue& value, const std::string& where);

struct SpectralRow {
  double wavelength_um;
  double value;
  std::size_t line;
};

/// Sorts `rows` by wavelength and appends them. Skips repeated rows and wavelengths outside kWavelengthUmRange.
/// `named`: name and range. Errors: InputError with file and line if values are out of range or differ at a wavelength.
void append_rows(SpectralTable& table, std::vector<SpectralRow> rows, const NamedValue& named, const std::string& file);

/// A row of a CSV that has values over an angle from 0 to 90 degrees and, in some files, over wavelength.
struct AngleRow {
  double wavelength_um = 0.0;  ///< 0 in a file without wavelengths
  double angle_deg = 0.0;
  std::vector<double> values;
  std::size_t line = 0;
};

/// Rows of a CSV, sorted by wavelength, then by angle. All wavelengths have the same angles, from 0 to 90 degrees.
/// `angle` and `values` are names of columns. `file` is for messages. Errors: InputError with file, line and column.
std::vector<AngleRow> read_angle_rows(CsvReader& row, const CsvColumns& columns, const std::string& angle,
                                      const std::vector<std::string>& values, const std::string& file);

/// A position between elements `first` and `first` + 1 of an ascending list. `share`: 0 at the first, 1 at the second.
struct Between {
  std::size_t first = 0;
  double share = 0.0;
};
/// Where `value` lies in `list`. A value outside the list gets the position of the nearest end.
Between between(const std::vector<double>& list, double value);

/// Refuses a table that lacks values in a part of the spectrum. The message begins with `prefix`.
void check_covers(const SpectralTable& table, const Spectrum& spectrum, const std::string& prefix);

/// "10.6 um" or "8 to 14 um".
std::string wavelength_text(double min_um, double max_um);

}  // namespace dolp
