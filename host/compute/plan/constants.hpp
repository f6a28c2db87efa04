// Constants that steer cost or accuracy. They are tuned by hand unless a comment says otherwise.
// Three numbers behind a constant are the mean evaluations per entry with half the value, with the value, and with
// double the value, for 150 ordinary entries of each masking concerned at the tolerance 1e-4 (`dolp-calibrate check`).
// The sections on skies and grids name their entries. A constant without numbers changes the work by less than 1 %.
#pragma once

#include <cstddef>
#include <cstdint>

namespace dolp {

// ---- Rules (rule.cpp; `dolp-calibrate fit` finds kModels there)

inline constexpr double kCoarseShare = 0.8;  // nodes of the coarser rule divided by nodes of the finer rule
/// Estimated nodes per decimal digit on a piece of the slope axis that is not split at the kink of the masking G.
inline constexpr double kNodesPerDigit = 1.2;  // 502, 461, 425
/// Pieces are split at a kink of the masking G if the error without the split would exceed this share of the tolerance.
inline constexpr double kLineShare = 0.1;  // 471, 461, 452
/// Arcs cluster nodes at the kink of `integral` masking if q is below this value times the required digits.
inline constexpr double kClusterBelowQ = 0.3;  // 563, 608, 609
/// With Gaussian slopes, pieces are split at the line b = pi/2 of `integral` masking (arcs.glsl) if sigma exceeds
/// kLineSigma, or kTightLineSigma if more than kTightDigits digits are required.
inline constexpr double kLineSigma = 0.6;  // 632, 608, 542
inline constexpr double kTightLineSigma = 0.3;
inline constexpr double kTightDigits = 8.0;  // 632, 608, 608
/// With n nodes the cusp of smith masking leaves an error of n^-2q. For Gaussian slopes this value replaces 2q.
inline constexpr double kGaussianCuspPower = 4.0;
/// The largest order of a rule is kPlainOrder, or kOrderPerDigit times the required digits if that is more.
inline constexpr int kPlainOrder = 64;
inline constexpr double kOrderPerDigit = 8.0;
/// In grooves the azimuths are split where the beam of k bounces ends, for k up to the required digits divided by this
/// value. With half the value, the value and double the value, 5, 11 and 23 % of the entries miss the tolerance.
inline constexpr double kDigitsPerSplit = 2.0;  // 2350, 1765, 1394
/// Nodes that each interference fringe of a film adds to a rule, over slopes and over azimuths.
inline constexpr double kNodesOfFringe = 2.0;
inline constexpr double kCurveRoundings = 4.0;  // rounding of a position in a table of reflectances, in unit roundoffs
/// A ray in a groove is followed until less than this share of the tolerance is left of its light.
inline constexpr double kDimmest = 1e-10;

// ---- Slopes (breakpoints.cpp, kernel_data.cpp)

inline constexpr double kCutShare = 0.01;  // leaving out the steepest slopes may cost this share of the tolerance
/// One of kPlainBreakpoints (breakpoints.cpp) is used if the largest slope exceeds it by more than this factor.
inline constexpr double kLongWay = 300.0;
/// Limits of ShapeNode::table_scale, which otherwise is about the width m of the slope distribution. The lower limit
/// holds only for q < kLightTailQ.
inline constexpr double kSmallestHeavyTableScale = 1e-4;
inline constexpr double kLightTailQ = 1.5;
inline constexpr double kLargestTableScale = 0.5;
inline constexpr double kSteepStep = 16.0;  // ratio of numbers of bounces at neighbouring breakpoints of steep grooves
inline constexpr int kCriticalBounces = 3;  // slopes are split where total reflection begins, up to this bounce
/// Tolerance of the responses divided by the tolerance of the request: below 1, because sums of responses add errors.
inline constexpr double kResponseTolerance = 0.25;
inline constexpr double kResponseRoundings = 4.0;  // rounding of a response's x (chebyshev_at), in unit roundoffs

// ---- Skies (sky_table.cpp). The numbers are for two sets of entries: first the 19 rows of `dolp-bench effects` with
// integral masking, then `dolp table` with smith masking and 16 x 6 x 6 entries at 1e-4 (theta to 85 degrees, sigma
// 0.05 to 0.5, q 1.76 to 3).

/// Fewest cells in the table of one function of the sky (glossary: host/README.md); most cells of all tables together;
/// and this maximum for tolerances below kTightSky. Some devices have no room for the second maximum.
inline constexpr std::uint32_t kLeastSkyCells = 512;
inline constexpr std::uint32_t kMostSkyCells = 1U << 15U;
inline constexpr std::uint32_t kMostTightSkyCells = 1U << 18U;
inline constexpr double kTightSky = 1e-5;
inline constexpr double kSkyTableShare = 0.05;  // a table may differ from its function by this share of the tolerance
/// Largest error of a sky's table in a cell, divided by the table's error in the middle of the cell.
inline constexpr double kSkyTableSafety = 1.25;  // 690, 690, 690; 465, 465, 479
/// A function of a sky has a corner where its slope over u = sqrt(1 - cos(theta_r)) bends by at least this value.
inline constexpr double kLeastBend = 1e-2;
/// The sharpest corners split the azimuths, until b <= kMostBends times the tolerance. Here b is the root of the sum of
/// squares of the bends at the other corners. These cause an error of at most kUnsplitBends * b * r_i.
inline constexpr double kMostBends = 2e4;      // 837, 690, 693; 742, 465, 485
inline constexpr double kUnsplitBends = 1e-4;  // 658, 690, 747; 450, 465, 587
/// Rounding errors of cos(theta_r) and of a value from the table, in unit roundoffs.
inline constexpr double kSkyCosineRoundings = 8.0;
inline constexpr double kSkyRoundings = 4.0;

// ---- Bounds (error_bounds.cpp)

/// Interpolation error of the masking G in its table, relative to the albedo.
inline constexpr double kMaskingTableErrorFloat = 3e-8;
inline constexpr double kMaskingTableErrorDouble = 1e-12;
/// The interpolation error of smith's G grows near q = 3/2 by the factor 1 + kDivergingSlope / (2q - 3).
inline constexpr double kDivergingSlope = 0.06;
/// Relative rounding errors of sums, in unit roundoffs, for roundings() in error_bounds.cpp.
inline constexpr double kRoundings = 20.0;
inline constexpr double kHeavyTailRoundings = 80.0;
inline constexpr double kHeavyTailQ = 1.1;
inline constexpr double kHeavyTailSmithQ = 1.6;
inline constexpr double kExtremeTailRoundings = 400.0;
inline constexpr double kExtremeTailQ = 1.01;
inline constexpr double kCriticalRoundings = 300.0;
inline constexpr double kMostCriticalRoundings = 3000.0;
inline constexpr double kSmoothM = 0.05;
/// The error bound of a sum is the difference between its two rules times one of these factors: for smooth integrands,
/// with a masking table, and in grooves. Total reflection multiplies the factor by kCriticalFactor.
inline constexpr double kPairFactor = 4.0;
inline constexpr double kTablePairFactor = 8.0;
inline constexpr double kGroovePairFactor = 10.0;
inline constexpr double kCriticalFactor = 2.0;
/// The error bound of a sum is at least this share of the tolerance for which its rules were chosen.
inline constexpr double kLeastShareOfTolerance = 0.1;
/// The rounding error in grooves is at most this times the unit roundoff times cos(theta).
inline constexpr double kGrooveRoundings = 4.0;
/// Error of treating several bounces in a groove as one, divided by cos(theta) and by the share of such grooves.
/// kVeryManyBouncesError holds from kVeryManyBounces bounces. Fitted (tests/compute/evaluate/grooves_test.cpp).
inline constexpr double kManyBouncesError = 1e-3;
inline constexpr double kVeryManyBounces = 1024.0;
inline constexpr double kVeryManyBouncesError = 1e-2;
/// At least this share of the bounces of a ray in a groove is not grazing, see left_after() in error_bounds.cpp.
inline constexpr double kNotGrazing = 0.6;

// ---- pBRDF of grooves (further_bounces.cpp)

/// Most bounces whose light the pBRDF of grooves contains. The work grows as the square of this number.
inline constexpr int kMostBouncesOfBeam = 1000;
inline constexpr double kNegligibleBounces = 0.01;  // share of the wanted accuracy that the omitted bounces may take
/// Smallest 2q - 3 in the bound of the omitted bounces, see beyond_last() in further_bounces.cpp.
inline constexpr double kSlowestFall = 0.1;

// ---- Grids (shape_plan.cpp, rows.cpp, refinement.cpp). The numbers are million evaluations of `dolp table` for 32 x
// 32 x 32 entries at 1e-4 (theta to 85 degrees, sigma 0.05 to 1, q 1.75 to 6), first with integral, then with smith
// masking.

/// Fewest nodes of an interpolated axis (sigma or q), and nodes in addition to those that the digits need.
inline constexpr double kLeastShapeNodes = 6.0;
inline constexpr double kFirstShapeNodes = 3.0;  // 1.87, 1.87, 2.44; 1.70, 1.81, 2.37
/// An interpolated axis has at least this many values per node; an interpolated grid has this many entries per node.
inline constexpr double kLeastAxisGain = 1.25;     // 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
inline constexpr std::size_t kLeastShapeGain = 2;  // 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
/// Tolerance of the nodes divided by the tolerance of the request: below 1, because an interpolation adds errors. The
/// number of nodes is chosen for kExtraShapeDigits more digits than the tolerance has.
inline constexpr double kShapeNodeTolerance = 0.125;  // 2.03, 1.87, 1.75; 1.86, 1.81, 1.78
inline constexpr double kExtraShapeDigits = 1.0;      // 1.84, 1.87, 2.33; 1.75, 1.81, 2.32
/// Parameters of the error bound of an interpolation, see tails() in shape_plan.cpp.
inline constexpr double kShapeTail = 3.0;  // 1.87, 1.87, 1.89; 1.80, 1.81, 2.00
inline constexpr int kLastShapeCoefficients = 3;
inline constexpr double kSlowestShapeFall = 0.9;
/// Largest ratio of two values of q - 1 in a chunk (plan/rows.hpp). Shapes that differ more need nodes at other slopes.
inline constexpr double kMostRowSpread = 6.0;
/// Grids are computed in kernel rows of kRowWidth members if their shapes fill more than this share of such rows.
inline constexpr double kLeastRowUse = 0.5;  // 1.87, 1.87, 5.63; 1.81, 1.81, 5.60
/// An entry that misses its tolerance by a factor f is computed again with a tolerance tighter by f *
/// kRefinementSafety, but by at least kLeastDecades and at most kMostDecades powers of ten.
inline constexpr double kRefinementSafety = 1.5;  // 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kLeastDecades = 0.5;      // 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kMostDecades = 5.0;

// ---- Effects (effects.cpp)

inline constexpr double kDroppedShare = 0.1;  // all dropped effects may change DOLP by this share of the tolerance

}  // namespace dolp
