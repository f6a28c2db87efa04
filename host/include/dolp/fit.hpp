// Measured data, options of a fit, and its results.
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
  double theta_deg = 0.0;  ///< in bistatic mode: zenith of the source
  double value = 0.0;
  std::optional<double> uncertainty;    ///< one standard deviation
  std::optional<double> wavelength_um;  ///< empty: the scene's wavelength
};

/// A set of measured data, with settings that change the scene for these data.
struct DOLP_EXPORT MeasuredData {
  std::string name = "data";  ///< name of its file, for messages
  std::vector<Setting> settings = {};
  std::string zenith_column = "theta_deg";  ///< or theta_i_deg, which needs the bistatic mode
  bool has_uncertainties = false;           ///< whether all measurements have an uncertainty
  std::vector<Measurement> measurements = {};
  std::vector<std::string> remarks = {};  ///< one line for each unit that was probably meant differently

  /// Reads a CSV. Columns: theta_deg or theta_i_deg; dolp, or q_over_i (signed), or emissivity_s and emissivity_p or
  /// one of them; and any of uncertainty, wavelength_um. dolp must not be negative. Values are fractions, not percent.
  /// Lines that begin with # are comments. Errors: InputError; its one line names file, line, column, value and what is
  /// allowed.
  static MeasuredData from_csv(const std::string& csv, const std::string& name = "data",
                               std::vector<Setting> settings = {});
  /// Reads "FILE" or "FILE:KEY=VALUE,KEY=VALUE"; FILE "-" is stdin. Errors: InputError.
  static MeasuredData read(const std::string& argument);
};

/// A number of the scene, and the range in which a fit searches for it.
///
/// Its coordinate runs from 0 at `low` to 1 at `high`: logarithmically if the range is positive and spans a decade or
/// more, otherwise linearly.
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

/// Values of a key for which separate fits are made and ranked.
struct DOLP_EXPORT Comparison {
  std::string key;
  std::vector<std::string> words;

  /// Reads "KEY=WORD,WORD,...". Errors: InputError.
  static Comparison from_text(const std::string& argument);
};

/// The contribution of a residual r to the objective: r^2 or, for points more than one uncertainty away, less.
enum class Loss { kSquares, kHuber, kSoftL1, kCauchy, kTukey };

/// "squares", "huber", "soft-l1", "cauchy", "tukey", in the order of Loss.
DOLP_EXPORT const std::vector<std::string>& loss_names();

/// A systematic error of the model that a fit allows for.
enum class ModelError {
  kNone,
  /// The truth may lie anywhere in the model's bracket (emission.bracket), independently at each point. A residual is
  /// the distance to the nearer end. An interval contains the values at which chi^2 itself is below its quantile, with
  /// as many degrees of freedom as points.
  kBracket,
};

/// "none", "bracket", in the order of ModelError.
DOLP_EXPORT const std::vector<std::string>& model_error_names();

inline constexpr std::size_t kMostStarts = 10'000;

/// Options of a fit.
struct FitOptions {
  std::vector<FitRange> vary;
  std::size_t starts = 24;                             ///< number of descents that search for minima: 1 to kMostStarts
  std::uint64_t seed = 1;                              ///< seed of the starting points
  Progress progress = {};                              ///< counts the items of a phase; may be empty
  std::function<void(const std::string&)> phase = {};  ///< gets the name of each phase before it begins; may be empty
  Loss loss = Loss::kSquares;                          ///< all except squares need uncertainties
  ModelError model_error = ModelError::kNone;          ///< kBracket needs uncertainties
  std::vector<Comparison> compare = {};                ///< all combinations are fitted and ranked
  std::filesystem::path output = {};  ///< file for the scene with the results; "-" is stdout; empty: none
  /// .png, .pdf or .svg with data, model and residuals, drawn by Matplotlib; empty: none
  std::filesystem::path plot = {};
};

/// A profile-likelihood interval: from the smallest to the largest value that the data do not exclude, over all minima.
/// An end is empty if the range ends before the data exclude values.
struct FitInterval {
  std::optional<double> low, high;
  /// The pieces of the interval in ascending order. There are several if the data exclude values between minima.
  std::vector<std::pair<std::optional<double>, std::optional<double>>> pieces = {};
  bool is_empty = false;  ///< the data exclude all values, even with the model's bracket
};

/// A fitted number.
struct FitParameter {
  std::string key;
  double value = 0.0;
  std::optional<double> standard_error;  ///< from the covariance; parameters at a bound stay there
  FitInterval interval_68, interval_95;  ///< 68.27 % and 95 %; both ends are empty if the residuals have no scale
  /// If the fit is doubtful or bad: the intervals with all uncertainties multiplied by sqrt(reduced chi^2).
  std::optional<FitInterval> scaled_68 = {}, scaled_95 = {};
  bool is_at_bound = false;
  std::string why_no_error = {};  ///< why standard_error is empty, in words
};

/// A local minimum of a fit.
struct FitMinimum {
  std::vector<double> values;  ///< in the order of FitOptions::vary
  double chi_square = 0.0;
};

/// The numbers of a fit.
struct FitNumbers {
  std::vector<FitParameter> parameters = {};  ///< in the order of FitOptions::vary
  double chi_square = 0.0;                    ///< sum of the squares of the residuals, or of their loss
  /// number of points minus number of parameters; with a model error the number of points
  std::size_t degrees_of_freedom = 0;
  std::optional<double> p_value = {};          ///< only with uncertainties and the loss "squares"
  std::string fit_quality = {};                ///< "good", "doubtful" (p < 0.05) or "bad" (p < 0.001); empty without p
  std::vector<FitMinimum> minima = {};         ///< all minima found, the best first
  std::vector<std::string> degeneracies = {};  ///< combinations that the data do not determine, in words
};

}  // namespace dolp
