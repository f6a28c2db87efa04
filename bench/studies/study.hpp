// The studies of dolp-bench. Each is one function in a separate file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dolp::bench {

/// The parsed command line.
struct StudyOptions {
  std::string json_path;             ///< empty: no JSON. "-" is stdout, and then no table is printed.
  std::string device;                ///< Vulkan device: position or part of the name, empty for the default
  std::vector<std::string> cases;    ///< empty: all
  std::vector<std::string> methods;  ///< empty: all
  std::size_t entries = 1024;        ///< entries per call of a batched method
  /// number of the first set of fits; constants were chosen on sets with lower numbers
  std::size_t first_set = 1000;
  bool quick = false;
  bool quiet = false;                  ///< no progress bar
  std::vector<std::string> arguments;  ///< arguments of the program, with its name
};

/// `dolp-bench accuracy`: error against time per entry, for every method and setting.
///
/// The error is max(|d r_i|, |d r_q|)/r_i of the case, against the independent reference at its tightest setting; for
/// random methods the rms over the repeats. The time is the median over repeats of the time of a call divided by its
/// entries. Errors: InputError for an unknown case or method; DeviceError if `device` is given and not available;
/// IoError; Cancelled.
void run_accuracy(const StudyOptions& options);

/// `dolp-bench effects`: time per entry with each single effect on and off, on one grid, and what the plan drops.
///
/// `cases` are names of effects; `entries` is the size of the grid. The error of an effect is the largest |change of
/// DOLP| that dropping causes, against the scene with everything kept. Errors: InputError for an unknown effect;
/// DeviceError without a usable device; IoError; Cancelled.
void run_effects(const StudyOptions& options);

/// `dolp-bench throughput`: entries and integrand evaluations per second on the grid of the stainless-steel scene, the
/// time with twice the entries, the share of the device's arithmetic peak, and the scaling with cores and vector width.
///
/// `cases` are parts of the study; `entries` is the size of the largest grid. lavapipe reads cores and vector width
/// from its environment only once, so each setting runs in a separate process. Errors: InputError for an unknown part;
/// DeviceError without a usable device; IoError; Cancelled.
void run_throughput(const StudyOptions& options);

/// `dolp-bench peers`: for every method the cheapest setting whose measured error meets a tolerance on a sample of a
/// grid's entries, its time per entry, and the ratio to the kernels of dolp in float.
///
/// `cases` are maskings. Errors: InputError for an unknown case or method; DeviceError if `device` is given and not
/// available; IoError; Cancelled.
void run_peers(const StudyOptions& options);

/// `dolp-bench scale`: time and peak memory of `dolp table` from 10^4 to 10^8 entries, and of shards that run at the
/// same time.
///
/// `entries` is the size of the largest table. The temporary folder needs 200 bytes per entry. Errors: InputError for
/// fewer than 10^4 entries; IoError; Cancelled.
void run_scale(const StudyOptions& options);
/// `dolp-bench fit`: fits of synthetic measurements with a known truth. Reports how often intervals contain the truth,
/// whether the global minimum is found, and the time of a fit, against SciPy's least_squares around `dolp eval` if
/// SciPy is installed. `entries` is the number of sets. Errors: DeviceError without a usable device; IoError;
/// Cancelled.
void run_fit_study(const StudyOptions& options);

/// `dolp-bench window`: curves and frames per second while real events drag a slider of the window, on a private
/// display of 1920 x 1080 (Xvfb, xdotool).
///
/// `cases` are drags. A curve is fresh if it belongs to the slider's value in the same frame. Errors: InputError for an
/// unknown drag; DeviceError without a usable device or Xvfb; IoError; Cancelled.
void run_window(const StudyOptions& options);

}  // namespace dolp::bench
