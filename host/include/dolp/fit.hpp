// Measured data, options of fits of a scene's numbers to them, and results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dolp/errors.hpp>
#include <dolp/setting.hpp>

namespace dolp {

/// A measured quantity: a column of the data, and a quantity of the model.
enum class Observable { kDolp, kQOverI, kEmissivityS, kEmissivityP };

/// "dolp", "q_over_i" (signed), "emissivity_s", "emissivity_p".
DOLP_EXPORT const char* name_of(Observable observable);

/// A measured number.
struct Measurement {
  Observable observable = Observable::kDolp;
  double theta_deg = 0.0;  ///< in bistatic mode the zenith of the source
  double value = 0.0;
  std::optional<double> uncertainty;    ///< one standard deviation
  std::optional<double> wavelength_um;  ///< none: the scene's
};

/// A set of measured data, with settings of the scene of its own.
struct DOLP_EXPORT MeasuredData {
  std::string name = "data";  ///< of its file, for messages
  std::vector<Setting> settings = {};
  std::string zenith_column = "theta_deg";  ///< or theta_i_deg, which asks for the bistatic mode
  bool has_uncertainties = false;           ///< all measurements have one
  std::vector<Measurement> measurements = {};
  std::vector<std::string> remarks = {};  ///< on units that were probably meant otherwise, one line each

  /// Reads a CSV. Columns: theta_deg or theta_i_deg; dolp, or q_over_i (signed), or emissivity_s and emissivity_p or
  /// one of them; and any of uncertainty, wavelength_um. dolp is not negative. Values are fractions, not percent. Lines
  /// that begin with # are comments. Errors: InputError, one line that names file, line, column, value and what is
  /// allowed.
  static MeasuredData from_csv(const std::string& csv, const std::string& name = "data",
                               std::vector<Setting> settings = {});
  /// Reads "FILE" or "FILE:KEY=VALUE,KEY=VALUE"; FILE "-" is stdin. Errors: InputError.
  static MeasuredData read(const std::string& argument);
};

/// A number of the scene, and the range in which it is looked for.
///
/// Its coordinate runs from 0 at `low` to 1 at `high`: along the logarithm where a positive range spans a decade or
/// more, else along the value.
struct DOLP_EXPORT FitRange {
  std::string key;
  double low = 0.0;
  double high = 1.0;
  std::optional<double> start = std::nullopt;

  bool is_logarithmic() const { return low > 0.0 && high >= 10.0 * low; }
  double at(double coordinate) const;
  double coordinate(double value) const;
  /// d value / d coordinate.
  double slope(double value) const;

  /// Reads "KEY=LOW:HIGH" or "KEY=LOW:HIGH:START". Errors: InputError.
  static FitRange from_text(const std::string& argument);
};

/// Values of a key that are fitted one after the other, and ranked.
struct DOLP_EXPORT Comparison {
  std::string key;
  std::vector<std::string> words;

  /// Reads "KEY=WORD,WORD,...". Errors: InputError.
  static Comparison from_text(const std::string& argument);
};

/// The part of a residual r in the objective: r^2, or less where a point lies off by more than one uncertainty.
enum class Loss { kSquares, kHuber, kSoftL1, kCauchy, kTukey };

/// "squares", "huber", "soft-l1", "cauchy", "tukey", in the order of Loss.
DOLP_EXPORT const std::vector<std::string>& loss_names();

/// A systematic error of the model that a fit allows for.
enum class ModelError {
  kNone,
  kBracket,  ///< the truth may lie anywhere in the model's bracket (emission.bracket), independently at each point: a
             ///< residual counts from the nearer end, and an interval holds the values at which chi^2
             ///< itself is below its quantile for as many degrees of freedom as there are points
};

/// "none", "bracket", in the order of ModelError.
DOLP_EXPORT const std::vector<std::string>& model_error_names();

inline constexpr std::size_t kMostStarts = 10'000;

/// Options of a fit.
struct FitOptions {
  std::vector<FitRange> vary;
  std::size_t starts = 24;                             ///< descents that look for minima: 1 to kMostStarts
  std::uint64_t seed = 1;                              ///< of where they begin
  Progress progress = {};                              ///< counts what a phase consists of; may be empty
  std::function<void(const std::string&)> phase = {};  ///< gets its name before it begins; may be empty
  Loss loss = Loss::kSquares;                          ///< others need uncertainties
  ModelError model_error = ModelError::kNone;          ///< another one needs uncertainties
  std::vector<Comparison> compare = {};                ///< all combinations are fitted and ranked
  std::filesystem::path output = {};  ///< file for the scene with what was found; "-" is stdout; empty: none
  std::filesystem::path plot = {};    ///< .png, .pdf or .svg of data, model and residuals, by Matplotlib; empty: none
};

/// A profile-likelihood interval, from the least to the largest value that the data do not rule out, over all minima;
/// an end is none where the range ends before the data rule values out.
struct FitInterval {
  std::optional<double> low, high;
  /// The ranges of which it consists, ascending: several where the data rule out values between minima.
  std::vector<std::pair<std::optional<double>, std::optional<double>>> pieces = {};
  bool is_empty = false;  ///< the data rule out all values, the model's bracket included
};

/// A fitted number.
struct FitParameter {
  std::string key;
  double value = 0.0;
  std::optional<double> standard_error;  ///< from the covariance, with parameters at their bounds held there
  FitInterval interval_68, interval_95;  ///< 68.27 % and 95 %; both ends none without a scale of the residuals
  /// Where the fit is doubtful or bad: the intervals if all uncertainties are sqrt(reduced chi^2) times as large.
  std::optional<FitInterval> scaled_68 = {}, scaled_95 = {};
  bool is_at_bound = false;
  std::string why_no_error = {};  ///< why standard_error is none, in words
};

/// A local minimum of a fit.
struct FitMinimum {
  std::vector<double> values;  ///< in the order of FitOptions::vary
  double chi_square = 0.0;
};

/// The numbers of a fit.
struct FitNumbers {
  std::vector<FitParameter> parameters = {};   ///< in the order of FitOptions::vary
  double chi_square = 0.0;                     ///< sum over the squares of the residuals, or over their loss
  std::size_t degrees_of_freedom = 0;          ///< points less parameters; with a model error the points
  std::optional<double> p_value = {};          ///< with uncertainties and the loss "squares"
  std::string fit_quality = {};                ///< "good", "doubtful" (p < 0.05), "bad" (p < 0.001); empty without p
  std::vector<FitMinimum> minima = {};         ///< all that were found, the best first
  std::vector<std::string> degeneracies = {};  ///< combinations that the data do not determine, in words
};

}  // namespace dolp
