// Constants that steer cost or accuracy. They are tuned by hand unless a comment says otherwise.
// Three numbers behind a constant are evaluations per entry: with half its value, with its value and with double its
// value. They are means over 150 ordinary entries (`dolp-calibrate check`) of each masking that uses the constant, with
// tolerance 1e-4. Two sections state other entries. A constant without numbers changes the work by less than 1 %.
#pragma once

#include <cstddef>
#include <cstdint>

namespace dolp {

// ---- Rules (rule.cpp; `dolp-calibrate fit` finds kModels there)

inline constexpr double kCoarseShare = 0.8;  // nodes of the coarser rule divided by nodes of the finer rule
/// Estimated nodes per decimal digit of a result, on a piece of the slope axis that contains the kink of the masking.
inline constexpr double kNodesPerDigit = 1.2;  // 502, 461, 425
/// Pieces are split at a kink of the masking G if the error without the split would exceed this share of the tolerance.
inline constexpr double kLineShare = 0.1;  // 471, 461, 452
/// `integral` masking: nodes cluster at the azimuth of its kink if q is below this value times the required digits.
inline constexpr double kClusterBelowQ = 0.3;  // 563, 608, 609
/// Gaussian slopes with `integral` masking: pieces are split at the kink of the masking (needs_line() in rule.hpp) if
/// sigma exceeds kLineSigma, or kTightLineSigma where more than kTightDigits digits are required.
inline constexpr double kLineSigma = 0.6;  // 632, 608, 542
inline constexpr double kTightLineSigma = 0.3;
inline constexpr double kTightDigits = 8.0;  // 632, 608, 608
/// A rule with n nodes has the error n^(-2q) at the cusp of smith masking. For Gaussian slopes this value replaces 2q.
inline constexpr double kGaussianCuspPower = 4.0;
/// The largest number of nodes of a rule is kPlainOrder or, if larger, kOrderPerDigit times the required digits.
inline constexpr int kPlainOrder = 64;
inline constexpr double kOrderPerDigit = 8.0;
/// In grooves the azimuths are split where the number of bounces changes, up to (required digits) / kDigitsPerSplit
/// bounces. 11 % of the tested entries miss the tolerance; 5 % with half this constant, 23 % with twice this constant.
inline constexpr double kDigitsPerSplit = 2.0;  // 2350, 1765, 1394
/// Nodes that each interference fringe of a film adds: per piece of the slope axis, and per radian of azimuth.
inline constexpr double kNodesOfFringe = 2.0;
/// Tables of reflectances and skies are no finer than for this share of the scene's tolerance, even if a refinement
/// level has a far smaller tolerance. A table of 30 um of PMMA on aluminium, 7.5-13.5 um, clear-sky: 2.4 s, without
/// it 4.7 s.
inline constexpr double kTablesShareOfTolerance = 0.1;
inline constexpr double kCurveRoundings = 4.0;  // rounding of sqrt(cos(beta)) in a reflectance table, in unit roundoffs
/// A ray in a groove is followed until the rest of its light is below this share of the tolerance.
inline constexpr double kDimmest = 1e-10;

// ---- Slopes (breakpoints.cpp, kernel_data.cpp)

inline constexpr double kCutShare = 0.01;  // leaving out the steepest slopes costs about this share of the tolerance
/// A slope s of kPlainBreakpoints (breakpoints.cpp) is a breakpoint if the largest slope exceeds kLongWay * s.
inline constexpr double kLongWay = 300.0;
/// Limits of ShapeNode::table_scale, the scale of the slopes in a masking table. It is about the width m of the slope
/// distribution, but at most kLargestTableScale and, if q < kLightTailQ, at least kSmallestHeavyTableScale.
inline constexpr double kSmallestHeavyTableScale = 1e-4;
inline constexpr double kLightTailQ = 1.5;
inline constexpr double kLargestTableScale = 0.5;
inline constexpr double kSteepStep = 16.0;  // in steep grooves, the bounces at breakpoints grow by this factor
inline constexpr int kCriticalBounces = 3;  // last bounce at which the beginning of total reflection is a breakpoint
/// Responses (glossary of host/README.md) get this share of the tolerance, because a sum of responses adds errors.
inline constexpr double kResponseTolerance = 0.25;
/// A list uses responses if it has this many entries per kernel moment that the responses need.
inline constexpr std::size_t kLeastResponseGain = 2;
inline constexpr double kResponseRoundings = 4.0;  // rounding of x in chebyshev_at() (columns.glsl), in unit roundoffs

// ---- Skies (sky_table.cpp). The numbers are for two sets of entries: first a sky of 19 rows over 100 x 100 entries
// with integral masking, then `dolp table` with smith masking and 16 x 6 x 6 entries at 1e-4 (theta to 85 degrees,
// sigma 0.05 to 0.5, q 1.76 to 3).

inline constexpr std::uint32_t kLeastSkyCells = 512;            // fewest cells in the table of one function of a sky
inline constexpr std::uint32_t kMostSkyCells = 1U << 15U;       // most cells of the tables of all functions together
inline constexpr std::uint32_t kMostTightSkyCells = 1U << 18U;  // most cells at tolerances below kTightSky
inline constexpr double kTightSky = 1e-5;
inline constexpr double kSkyTableShare = 0.05;  // a table may differ from its function by this share of the tolerance
/// The error bound of a sky's table is this factor times the largest error found in the middle of cells and at corners.
inline constexpr double kSkyTableSafety = 1.25;  // 690, 690, 690; 465, 465, 479
/// A function f of a sky has a corner where df/du jumps by more than this, with u = sqrt(1 - cos(theta_r)).
inline constexpr double kLeastBend = 1e-2;
/// The azimuths are split at the sharpest corners. Let b^2 be the sum of the squared jumps at the other corners. Enough
/// corners are split if b <= kMostBends * tolerance. The other corners cause an error of r_i of at most
/// kUnsplitBends * b * r_i.
inline constexpr double kMostBends = 2e4;      // 837, 690, 693; 742, 465, 485
inline constexpr double kUnsplitBends = 1e-4;  // 658, 690, 747; 450, 465, 587
/// Rounding errors of cos(theta_r) and of a value from the table, in unit roundoffs.
inline constexpr double kSkyCosineRoundings = 8.0;
inline constexpr double kSkyRoundings = 4.0;

// ---- Measured reflectances (reflectance_curve.cpp)

/// A kink splits slopes and azimuths if its size exceeds this share of the tolerance, relative to reflectance_level().
inline constexpr double kLeastKink = 1.0;
/// The other kinks cause an error of the reflectance of at most kUnsplitKinks times their sizes, added in quadrature.
inline constexpr double kUnsplitKinks = 5e-3;

// ---- Bounds (error_bounds.cpp)

/// Interpolation error of the masking G in its table, relative to the albedo.
inline constexpr double kMaskingTableErrorFloat = 3e-8;
inline constexpr double kMaskingTableErrorDouble = 1e-12;
/// The interpolation error of smith's G grows near q = 3/2 by the factor 1 + kDivergingSlope / (2q - 3).
inline constexpr double kDivergingSlope = 0.06;
/// Relative rounding errors of the moments, in unit roundoffs. roundings() in error_bounds.cpp combines these numbers.
inline constexpr double kRoundings = 20.0;
inline constexpr double kHeavyTailRoundings = 80.0;
inline constexpr double kHeavyTailQ = 1.1;
inline constexpr double kHeavyTailSmithQ = 1.6;
inline constexpr double kExtremeTailRoundings = 400.0;
inline constexpr double kExtremeTailQ = 1.01;
inline constexpr double kCriticalRoundings = 300.0;
inline constexpr double kMostCriticalRoundings = 3000.0;
inline constexpr double kSmoothM = 0.05;
/// The unit roundoff of float grows by these factors for each unit by which the device's errors of divisions and square
/// roots exceed 0.5 (OperationErrors). Fitted: tests/faults/arithmetic.py prints errors over bounds.
inline constexpr double kDivisionGrowth = 1.8;
inline constexpr double kRootGrowth = 0.55;
/// Error of the azimuth of a split line, divided by the excess of the unit roundoff over the one of correct rounding.
/// Fitted: at zeniths of 89.999 to 90 degrees, 17 is needed if only square roots are inexact, and 10 if quotients are,
/// too. Grooves with all bounces need less than 1.
inline constexpr double kLineRoundings = 30.0;
/// The error bound of a sum is one of these factors times the difference between the finer and the coarser rule.
inline constexpr double kPairFactor = 4.0;
inline constexpr double kTablePairFactor = 8.0;    // with a masking table
inline constexpr double kGroovePairFactor = 10.0;  // in grooves
inline constexpr double kCriticalFactor = 2.0;     // total reflection, measured reflectances: an additional factor
/// The error bound of a sum is at least this share of the tolerance for which its rules were chosen.
inline constexpr double kLeastShareOfTolerance = 0.1;
/// Upper bound of the rounding error of moments in grooves, divided by the unit roundoff and by cos(theta).
inline constexpr double kGrooveRoundings = 4.0;
/// After many bounces of a ray in a groove, the kernel treats several bounces as one. The error that this causes is a
/// share of the light that enters: at most kManyBouncesError, and from kVeryManyBounces bounces on at most
/// kVeryManyBouncesError. These numbers are fitted (tests/compute/evaluate/grooves_test.cpp).
inline constexpr double kManyBouncesError = 1e-3;
inline constexpr double kVeryManyBounces = 1024.0;
inline constexpr double kVeryManyBouncesError = 1e-2;
/// At least this share of the bounces of a ray in a groove is not grazing, see left_after() in error_bounds.cpp.
inline constexpr double kNotGrazing = 0.6;

// ---- Grids (shape_plan.cpp, rows.cpp, refinement.cpp). The numbers are million evaluations of `dolp table` for 32^3
// entries at 1e-4 (theta to 85 degrees, sigma 0.05 to 1, q 1.75 to 6): with `integral`, then with smith masking.

/// Nodes of an interpolated axis (sigma or q): kFirstShapeNodes more than its digits need, at least kLeastShapeNodes.
inline constexpr double kLeastShapeNodes = 6.0;
inline constexpr double kFirstShapeNodes = 3.0;  // 1.87, 1.87, 2.44; 1.70, 1.81, 2.37
/// To be interpolated, an axis needs kLeastAxisGain values per node, and a grid kLeastShapeGain entries per node.
inline constexpr double kLeastAxisGain = 1.25;     // 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
inline constexpr std::size_t kLeastShapeGain = 2;  // 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
/// Moments at the nodes of an interpolation get this share of the tolerance, because the interpolation adds errors. The
/// number of nodes is chosen for kExtraShapeDigits more digits than the tolerance has.
inline constexpr double kShapeNodeTolerance = 0.125;  // 2.03, 1.87, 1.75; 1.86, 1.81, 1.78
inline constexpr double kExtraShapeDigits = 1.0;      // 1.84, 1.87, 2.33; 1.75, 1.81, 2.32
/// Parameters of the error bound of an interpolation, see tails() in shape_plan.cpp.
inline constexpr double kShapeTail = 3.0;  // 1.87, 1.87, 1.89; 1.80, 1.81, 2.00
inline constexpr int kLastShapeCoefficients = 3;
inline constexpr double kSlowestShapeFall = 0.9;
/// A list is interpolated only if it has at least kLeastPoints points, and kLeastPointGain points per node. With fewer
/// points the time that a driver needs for the kernels of the responses does not pay.
inline constexpr std::size_t kLeastPoints = 8192;
inline constexpr std::size_t kLeastPointGain = 4;
/// Responses at the nodes of points get this share of the tolerance, because the errors of high polynomials add up.
inline constexpr double kPointNodeTolerance = 0.0025;
/// Largest ratio of two values of q - 1 in a kernel row. Shapes that differ more need nodes at other slopes.
inline constexpr double kMostRowSpread = 6.0;
/// Kernel rows have kRowWidth places if the shapes of a request fill more than this share of them, otherwise one place.
inline constexpr double kLeastRowUse = 0.5;  // 1.87, 1.87, 5.63; 1.81, 1.81, 5.60
/// If the error of an entry is f times the tolerance, the entry is computed again. Its new tolerance is smaller by the
/// factor f * kRefinementSafety, but at least by 10^kLeastDecades and at most by 10^kMostDecades.
inline constexpr double kRefinementSafety = 1.5;  // 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kLeastDecades = 0.5;      // 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kMostDecades = 5.0;

// ---- Effects (effects.cpp)

inline constexpr double kDroppedShare = 0.1;  // all dropped effects may change DOLP by this share of the tolerance

}  // namespace dolp
