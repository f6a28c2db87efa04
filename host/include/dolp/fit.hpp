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

/// A quantity that the data can contain (a column of the CSV) and that the model computes.
enum class Observable { kDolp, kQOverI, kEmissivityS, kEmissivityP };

/// "dolp", "q_over_i" (signed), "emissivity_s", "emissivity_p".
DOLP_EXPORT const char* to_name(Observable observable);

struct Measurement {
  Observable observable = Observable::kDolp;
  double theta_deg = 0.0;  ///< zenith angle of the view or, in bistatic mode, of the source
  double value = 0.0;
  std::optional<double> uncertainty;    ///< one standard deviation
  std::optional<double> wavelength_um;  ///< empty means the scene's wavelength
};

/// A set of measured data, with settings that change the scene for these data.
struct DOLP_EXPORT MeasuredData {
  std::string name = "data";  ///< name of the CSV file, for messages
  std::vector<Setting> settings = {};
  std::string zenith_column = "theta_deg";  ///< name of the zenith column; theta_i_deg only in bistatic scenes
  bool has_uncertainties = false;           ///< true if all measurements have an uncertainty
  std::vector<Measurement> measurements = {};
  std::vector<std::string> remarks = {};  ///< one line for each suspicious unit, such as percent or nm

  /// Reads a CSV with a zenith column, theta_deg or theta_i_deg, and a measured quantity: dolp (not negative), q_over_i
  /// (signed), emissivity_s, emissivity_p or both emissivities. The columns uncertainty and wavelength_um are optional.
  /// Measured values are fractions. Comment lines begin with #. Errors: InputError with file, line, column and value.
  static MeasuredData from_csv(const std::string& csv, const std::string& name = "data",
                               std::vector<Setting> settings = {});
  /// Reads "FILE" or "FILE:KEY=VALUE,KEY=VALUE": the CSV FILE ("-" is stdin), and settings. Errors: InputError.
  static MeasuredData read(const std::string& argument);
};

/// The range from `low` to `high` over which a fit varies the number of a key. The fit searches along a coordinate that
/// is 0 at `low` and 1 at `high`. It is linear in the number or, if is_logarithmic(), in the logarithm of the number.
struct DOLP_EXPORT FitRange {
  std::string key;
  double low = 0.0;
  double high = 1.0;
  std::optional<double> start = std::nullopt;

  bool is_logarithmic() const { return low > 0.0 && high >= 10.0 * low; }
  double at(double coordinate) const;
  double coordinate(double value) const;
  double slope(double value) const;  ///< derivative of the value with respect to the coordinate

  /// Reads "KEY=LOW:HIGH" or "KEY=LOW:HIGH:START". Errors: InputError.
  static FitRange from_text(const std::string& argument);
};

/// Alternative words for a key of the scene. The program fits the data with each word and ranks the fits.
struct DOLP_EXPORT Comparison {
  std::string key;
  std::vector<std::string> words;

  /// Reads "KEY=WORD,WORD,...". Errors: InputError.
  static Comparison from_text(const std::string& argument);
};

/// A fit minimises the objective, the sum of the losses of all residuals. The loss of a residual r is r^2 for kSquares.
/// The other losses need data with uncertainties. For large |r| they are below r^2, so that outliers count less.
enum class Loss { kSquares, kHuber, kSoftL1, kCauchy, kTukey };

/// "squares", "huber", "soft-l1", "cauchy", "tukey", in the order of Loss.
DOLP_EXPORT const std::vector<std::string>& loss_names();

/// The systematic error that a fit assumes in the model.
enum class ModelError {
  kNone,
  /// The true value may lie anywhere in the bracket: the range that is possible with all bounces of light (key
  /// emission.bracket). A residual is the distance of a measured value from the bracket. In the 95 % interval, chi^2 is
  /// below the 95 % quantile of the chi^2 distribution with one degree of freedom per point.
  kBracket,
};

/// "none", "bracket", in the order of ModelError.
DOLP_EXPORT const std::vector<std::string>& model_error_names();

inline constexpr std::size_t kMostStarts = 10'000;

struct FitOptions {
  std::vector<FitRange> vary;
  std::size_t starts = 24;                             ///< number of descents that search for minima: 1 to kMostStarts
  std::uint64_t seed = 1;                              ///< seed of the starting points
  Progress progress = {};                              ///< counts the items of each phase; may be empty
  std::function<void(const std::string&)> phase = {};  ///< gets the name of each phase before it begins; may be empty
  Loss loss = Loss::kSquares;                          ///< all except kSquares need data with uncertainties
  ModelError model_error = ModelError::kNone;          ///< kBracket needs data with uncertainties
  std::vector<Comparison> compare = {};                ///< the fit is repeated with each combination of words
  std::filesystem::path output = {};  ///< file for the scene with the fitted values; "-" is stdout; empty: no file
  /// File (.png, .pdf or .svg) for a picture with data, model and residuals, which Matplotlib draws. Empty: no picture.
  std::filesystem::path plot = {};
};

/// A profile-likelihood interval of a parameter: from the smallest to the largest value that agrees with the data. An
/// empty `low` or `high` means that the data agree with all values up to this end of the parameter's range.
struct FitInterval {
  std::optional<double> low, high;
  /// The pieces of the interval in ascending order. There are several if the data exclude values between them.
  std::vector<std::pair<std::optional<double>, std::optional<double>>> pieces = {};
  bool is_empty = false;  ///< true if no value agrees with the data; only with ModelError::kBracket
};

struct FitParameter {
  std::string key;
  double value = 0.0;
  std::optional<double> standard_error;  ///< from the covariance matrix, as if parameters at a bound were fixed
  /// 68.27 % and 95 % intervals. All ends are empty if data without uncertainties have no more points than parameters.
  FitInterval interval_68, interval_95;
  /// The intervals with all uncertainties multiplied by sqrt(reduced chi^2). Empty unless the p-value is below 0.05.
  std::optional<FitInterval> scaled_68 = {}, scaled_95 = {};
  bool is_at_bound = false;
  std::string why_no_error = {};  ///< why there is no standard error; empty if there is one
};

struct FitMinimum {
  std::vector<double> values;  ///< in the order of FitOptions::vary
  double chi_square = 0.0;
};

struct FitNumbers {
  std::vector<FitParameter> parameters = {};  ///< in the order of FitOptions::vary
  double chi_square = 0.0;                    ///< sum of the losses of all residuals; the loss kSquares is the square
  std::size_t degrees_of_freedom = 0;         ///< points minus parameters; with kBracket, the number of points
  std::optional<double> p_value = {};         ///< empty unless data have uncertainties and the loss is kSquares
  /// "good", "doubtful" (p < 0.05), "bad" (p < 0.001); empty without p_value. Also doubtful if light of further bounces
  /// can move the model by more than the uncertainty of a point, unless ModelError::kBracket accounts for it.
  std::string fit_quality = {};
  std::vector<FitMinimum> minima = {};         ///< all minima that the fit found, the best first
  std::vector<std::string> degeneracies = {};  ///< combinations of parameters that the data do not determine, in words
};

}  // namespace dolp
