// The studies of dolp-bench; each is one function in a file of its own.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dolp::bench {

/// The parsed command line.
struct StudyOptions {
  std::string json_path;             ///< empty: no JSON; - is stdout, the table is then left out
  std::string device;                ///< Vulkan device: position or part of the name, empty for the default
  std::vector<std::string> cases;    ///< empty: all
  std::vector<std::string> methods;  ///< empty: all
  std::size_t entries = 1024;        ///< of one call of a batched method
  std::size_t first_set = 1000;      ///< of fits, whose constants were chosen on sets below
  bool quick = false;
  bool quiet = false;                  ///< no progress bar
  std::vector<std::string> arguments;  ///< of the program, its name included
};

/// `dolp-bench accuracy`: error against time per entry, for every method at every setting of its own.
///
/// The error is max(|d r_i|, |d r_q|)/r_i at the case itself, against the independent reference at its tightest
/// setting; random methods: its rms over the repeats. The time is that of a whole call over its entries, the median of
/// repeats. Errors: InputError for a case or method that there is not; DeviceError when `device` is given and cannot be
/// had; IoError; Cancelled.
void run_accuracy(const StudyOptions& options);

/// `dolp-bench effects`: time per entry with each effect alone on and off, on one grid, with what the plan drops.
///
/// `cases` are names of effects, `entries` those of the grid. The error of an effect is the largest |change of DOLP|
/// that dropping makes, against the same scene with everything kept. Errors: InputError for an effect that there is
/// not; DeviceError without a usable device; IoError; Cancelled.
void run_effects(const StudyOptions& options);

/// `dolp-bench throughput`: entries and integrand evaluations a second on the grid of the stainless-steel scene, its
/// time with twice the entries, the share of the device's arithmetic peak, and the scaling with cores and vector width.
///
/// `cases` are parts of it, `entries` those of the largest grid. Cores and vector width are lavapipe's, which reads
/// them from its environment once: they are measured in processes of their own. Errors: InputError for a part that
/// there is not; DeviceError without a usable device; IoError; Cancelled.
void run_throughput(const StudyOptions& options);

/// `dolp-bench peers`: for every method the cheapest setting whose measured error on a sample of a grid's entries meets
/// a tolerance, its time per entry, and the ratio to the kernels of dolp in float.
///
/// `cases` are maskings. Errors: InputError for a case or method that there is not; DeviceError when `device` is given
/// and cannot be had; IoError; Cancelled.
void run_peers(const StudyOptions& options);

/// `dolp-bench scale`: time and peak memory of `dolp table` from 10^4 to 10^8 entries, and of shards that run at once.
///
/// `entries` are those of the largest table, which takes 100 bytes each of the temporary folder, twice. Errors:
/// InputError for fewer than 10^4 entries; IoError; Cancelled.
void run_scale(const StudyOptions& options);
/// `dolp-bench fit`: synthetic measurements with a known truth, fitted: how often intervals hold the truth, whether the
/// global minimum is found; and how long a fit takes, against SciPy's least_squares around `dolp eval` where there is a
/// SciPy. `entries` are the sets. Errors: DeviceError without a usable device; IoError; Cancelled.
void run_fit_study(const StudyOptions& options);

/// `dolp-bench window`: curves and frames a second while a slider of the window is dragged, by real events on a display
/// of its own (Xvfb, xdotool) of 1920 x 1080.
///
/// `cases` are drags. A curve is fresh where it is that of the slider in the same frame. Errors: InputError for a drag
/// that there is not; DeviceError without a usable device or Xvfb; IoError; Cancelled.
void run_window(const StudyOptions& options);

}  // namespace dolp::bench
