// The studies of dolp-bench. Each study is a function in a separate file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dolp::bench {

/// The parsed command line.
struct StudyOptions {
  std::string json_path;             ///< file for the JSON; empty: no file; "-": stdout, and no table of results
  std::string device;                ///< Vulkan device: position or part of the name, empty for the default
  std::vector<std::string> cases;    ///< empty means all
  std::vector<std::string> methods;  ///< empty means all
  std::size_t entries = 1024;        ///< meaning depends on the study, see below
  /// Number of the first data set of the study of fits. The fit algorithm was tuned on data sets with lower numbers.
  std::size_t first_set = 1000;
  bool quick = false;
  bool quiet = false;                  ///< no progress bar
  std::vector<std::string> arguments;  ///< argv; the first argument is the name of the program
};

/// `dolp-bench accuracy`: error against time per entry, for every method and setting.
///
/// The error is max(|d r_i|, |d r_q|)/r_i, where d r_i and d r_q are the differences from the reference. For random
/// methods it is the rms over the repeats. The time is the median time of a call, divided by its number of entries.
/// `entries` is the number of entries per call, for methods that compute many entries in one call. Errors: InputError
/// for an unknown case or method; DeviceError if `device` is given and not available; IoError; Cancelled.
void run_accuracy(const StudyOptions& options);

/// `dolp-bench throughput`: entries and integrand evaluations per second on grids of the stainless-steel scene, with
/// all axes; growth of the time with the number of entries.
///
/// `cases` are parts of the study; `entries` is the size of the largest grid. Errors: InputError for an unknown part;
/// DeviceError without a usable device; IoError; Cancelled.
void run_throughput(const StudyOptions& options);

/// `dolp-bench scale`: time and peak memory of `dolp table`, for tables of 10^4 to 10^8 entries and for shards that run
/// at the same time.
///
/// `entries` is the size of the largest table. The temporary folder needs 200 bytes per entry. Errors: InputError for
/// fewer than 10^4 entries; IoError; Cancelled.
void run_scale(const StudyOptions& options);

/// `dolp-bench fit`: fits of synthetic measurements with a known truth. Reports how often intervals contain the truth,
/// whether the global minimum is found, and the time of a fit. If SciPy is installed, also reports the time of SciPy's
/// least_squares, which calls `dolp.evaluate`.
///
/// `entries` is the number of random data sets. Errors: DeviceError without a usable device; IoError; Cancelled.
void run_fit_study(const StudyOptions& options);

/// `dolp-bench kernels`: registers, spilled values and instructions of kernels of all kinds, as the driver's compiler
/// reports them through VK_KHR_pipeline_executable_properties. Nothing runs on the device.
///
/// Errors: DeviceError without a device, or if its driver reports nothing; IoError; Cancelled.
void run_kernels(const StudyOptions& options);

}  // namespace dolp::bench
