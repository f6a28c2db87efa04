// Measured data for a fit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace dolp::fit {

/// What was measured: a column of the data, and a quantity of the model.
enum class Observable { kDolp, kQOverI, kEmissivityS, kEmissivityP };

/// "dolp", "q_over_i", ...
const char* name_of(Observable observable);

/// One measured number.
struct Observation {
  Observable observable = Observable::kDolp;
  double theta_deg = 0.0;               ///< in bistatic mode the zenith of the source
  std::optional<double> wavelength_um;  ///< none: the scene's
  double value = 0.0;
  std::optional<double> uncertainty;  ///< one standard deviation
};

/// A file of measured data with the scene keys of its own.
struct FitData {
  std::string name;                    ///< of the file, for messages
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string zenith_column;           ///< theta_deg, or theta_i_deg, which asks for the bistatic mode
  bool has_uncertainties = false;      ///< all observations have one
  std::vector<Observation> observations;
};

/// What names a file of measured data and its own scene keys.
struct DataArgument {
  std::string path;
  std::vector<std::string> overrides;  ///< KEY=VALUE
};
/// Takes "FILE" or "FILE:KEY=VALUE,KEY=VALUE" apart. Errors: InputError where FILE is empty.
DataArgument parse_data_argument(const std::string& argument);

/// Reads the text of such a file.
///
/// Columns: theta_deg or theta_i_deg; dolp, or q_over_i (signed), or emissivity_s and emissivity_p or one of them; and
/// any of uncertainty, wavelength_um. Values are fractions, not percent. Lines that begin with # are comments.
/// Errors: InputError, one line that names file, line, column, value and what is allowed.
FitData parse_fit_data(const std::string& text, const std::string& path_name);

}  // namespace dolp::fit
