// Constants that steer cost or accuracy. If a value is proved or fitted, its comment names the proof or the command.
// All other values are tuned by hand.
//
// Three numbers behind a constant are the mean evaluations per entry with half the value, with the value, and with
// double the value, for 150 ordinary entries of each masking concerned at the tolerance 1e-4 (`dolp-calibrate check`).
// The sections on skies and grids name their entries. No bound was below the true error in these runs. A constant
// without numbers changes the work by less than 1 %, or matters only for extreme entries.
#pragma once

#include <cstddef>
#include <cstdint>

namespace dolp {

// ---- Rules (rule.cpp; `dolp-calibrate fit` finds kModels there)

inline constexpr double kCoarseShare = 0.8;  // share of the finer rule's nodes, proved: coarse_order of orders.glsl
/// Rough number of nodes per digit on a piece that contains a cusp or line of the masking and is not split there.
inline constexpr double kNodesPerDigit = 1.2;  // 502, 461, 425
/// Pieces are split at a line of the masking if the error without this split would exceed this share of the tolerance.
/// The difference between the two rules of a piece would not show this error, because both rules would make it.
inline constexpr double kLineShare = 0.1;  // 471, 461, 452
/// At an end of a rule with n nodes, |x|^p causes the error n^-(p + 2). A cluster of nodes there squares the error, but
/// costs nodes. At the line b = pi/2 of `integral`, where p = 2q - 1, it pays if q is below this times the digits.
inline constexpr double kClusterBelowQ = 0.3;  // 563, 608, 609
/// With Gaussian slopes G is smooth at the line b = pi/2 of `integral`, but steep on rough surfaces. The line splits
/// pieces if sigma exceeds kLineSigma, or kTightLineSigma if the rules need more than kTightDigits digits.
inline constexpr double kLineSigma = 0.6;  // 632, 608, 542
inline constexpr double kTightLineSigma = 0.3;
inline constexpr double kTightDigits = 8.0;  // 632, 608, 608
/// Smith's cusp leaves an error of n^-2q for n nodes (proved). The Gaussian's cusp resembles a Cauchy cusp with q = 2.
inline constexpr double kGaussianCuspPower = 4.0;
/// The largest order of a rule is kPlainOrder, or kOrderPerDigit times the digits if this is more.
inline constexpr int kPlainOrder = 64;
inline constexpr double kOrderPerDigit = 8.0;
/// In grooves the azimuths are split where the beam of k bounces ends, for k up to the digits divided by this value.
/// With half the value, the value and double, 5, 11 and 23 % of the entries miss the tolerance.
inline constexpr double kDigitsPerSplit = 2.0;  // 2350, 1765, 1394
/// Nodes for each interference fringe that films have from normal to grazing incidence, on both axes.
inline constexpr double kNodesOfFringe = 2.0;
inline constexpr double kCurveRoundings = 4.0;  // rounding of a position in a table of reflectances, in unit roundoffs
/// Light in a groove is neglected below this share of the tolerance; even the darkest surfaces reflect far more.
inline constexpr double kDimmest = 1e-10;

// ---- Slopes (breakpoints.cpp, kernel_data.cpp)

inline constexpr double kCutShare = 0.01;  // leaving out the steepest slopes may cost this share of the tolerance
/// A plain breakpoint (breakpoints.cpp) is used if the largest slope exceeds it by more than this factor.
inline constexpr double kLongWay = 300.0;
/// Limits of the scale of the masking table, which otherwise is the width of the slope distribution. The table ends at
/// 5e8 scales. If q < kLightTailQ, the tail matters there, so this end must lie where the slope density is a power law.
inline constexpr double kSmallestHeavyTableScale = 1e-4;
inline constexpr double kLightTailQ = 1.5;
inline constexpr double kLargestTableScale = 0.5;
inline constexpr double kSteepStep = 16.0;  // ratio of the bounces at neighbouring breakpoints of steep grooves
inline constexpr int kCriticalBounces = 3;  // the critical line of each bounce up to this number splits the slopes
/// Tolerance of the responses divided by the tolerance of the request: below 1, because their weights increase bounds.
/// Million evaluations for 50 wavelengths of water with 0.1, 0.25, 0.5: smith 6.6, 6.9, 9.2; integral 8.3, 7.4, 8.5.
inline constexpr double kResponseTolerance = 0.25;
inline constexpr double kResponseRoundings = 4.0;  // rounding of a response's x (chebyshev_at), in unit roundoffs

// ---- Skies (sky_table.cpp). The numbers are for two sets of entries: first the 19 rows of `dolp-bench effects` with
// integral masking, then `dolp table` with smith masking and 16 x 6 x 6 entries at 1e-4 (theta to 85 degrees, sigma
// 0.05 to 0.5, q 1.76 to 3).

/// Fewest cells of one function, and most cells of all functions of a sky together. Every device has room for 65,536
/// cells in a texel buffer. Tolerances below kTightSky need a device with room for more.
inline constexpr std::uint32_t kLeastSkyCells = 512;
inline constexpr std::uint32_t kMostSkyCells = 1U << 15U;
inline constexpr std::uint32_t kMostTightSkyCells = 1U << 18U;
inline constexpr double kTightSky = 1e-5;
inline constexpr double kSkyTableShare = 0.05;  // a table may differ from its function by this share of the tolerance
/// Largest error of a sky's table in a cell, divided by the table's error in the middle of the cell.
inline constexpr double kSkyTableSafety = 1.25;  // 690, 690, 690; 465, 465, 479
/// A function of a sky has a corner where its slope in u = sqrt(1 - cos(theta_r)) changes (bends) by at least this.
inline constexpr double kLeastBend = 1e-2;
/// The sharpest corners split the integral, until b <= kMostBends times the tolerance, where b is the root of the sum
/// of squares of the bends of the other corners. The others cause an error of at most kUnsplitBends times r_i times b.
inline constexpr double kMostBends = 2e4;      // 837, 690, 693; 742, 465, 485
inline constexpr double kUnsplitBends = 1e-4;  // 658, 690, 747; 450, 465, 587
/// Rounding errors of cos(theta_r) and of a value from the table, in unit roundoffs.
inline constexpr double kSkyCosineRoundings = 8.0;
inline constexpr double kSkyRoundings = 4.0;

// ---- Bounds (error_bounds.cpp)

/// Interpolation error of G in the masking table, relative to the albedo: 8 cells per octave in float, 64 in double.
inline constexpr double kMaskingTableErrorFloat = 3e-8;
inline constexpr double kMaskingTableErrorDouble = 1e-12;
/// The interpolation error of smith's G grows near q = 3/2 by the factor 1 + kDivergingSlope / (2q - 3).
inline constexpr double kDivergingSlope = 0.06;
/// Relative rounding errors of sums, in unit roundoffs: kHeavyTailRoundings for q < kHeavyTailQ (smith:
/// kHeavyTailSmithQ), kExtremeTailRoundings for q < kExtremeTailQ, else kRoundings. At critical lines the error begins
/// at kCriticalRoundings and grows if m < kSmoothM or near the horizon, up to kMostCriticalRoundings.
inline constexpr double kRoundings = 20.0;
inline constexpr double kHeavyTailRoundings = 80.0;
inline constexpr double kHeavyTailQ = 1.1;
inline constexpr double kHeavyTailSmithQ = 1.6;
inline constexpr double kExtremeTailRoundings = 400.0;
inline constexpr double kExtremeTailQ = 1.01;
inline constexpr double kCriticalRoundings = 300.0;
inline constexpr double kMostCriticalRoundings = 3000.0;
inline constexpr double kSmoothM = 0.05;
/// Factor from the difference between the results of two rules to the error bound of the finer rule, for smooth
/// integrands, with a masking table, and in grooves, where kinks of beams with many bounces are not split. A critical
/// line, which rounding displaces, multiplies it by kCriticalFactor.
inline constexpr double kPairFactor = 4.0;
inline constexpr double kTablePairFactor = 8.0;
inline constexpr double kGroovePairFactor = 10.0;
inline constexpr double kCriticalFactor = 2.0;
/// The error bound of a sum is at least this share of the tolerance for which its rules were chosen.
inline constexpr double kLeastShareOfTolerance = 0.1;
/// The rounding error in grooves is at most this times the unit roundoff times cos(theta). It is not relative to the
/// reflected light: the last bounces may be grazing, and then even weak reflectors reflect everything.
inline constexpr double kGrooveRoundings = 4.0;
/// Error of treating several bounces in a groove as one, divided by cos(theta) and by the share of such grooves. From
/// kVeryManyBounces bounces kVeryManyBouncesError holds. Fitted to the steep cases of
/// tests/compute/evaluate/grooves_test.cpp.
inline constexpr double kManyBouncesError = 1e-3;
inline constexpr double kVeryManyBounces = 1024.0;
inline constexpr double kVeryManyBouncesError = 1e-2;
/// At least this share of a ray's bounces has cos(beta) = a sin(chi) >= a/2 (physics/README.md, section 3). Proved:
/// sin(chi) >= 1/2 on 2/3 of the unfolded groove, less its ends.
inline constexpr double kNotGrazing = 0.6;

// ---- pBRDF of grooves (further_bounces.cpp)

/// The work grows as the square of this. For N = 10 + 60i, q = 2.02 and theta_r = theta_i, later bounces add 1e-5 of f.
inline constexpr int kMostBouncesOfBeam = 1000;
inline constexpr double kNegligibleBounces = 0.01;  // share of the wanted accuracy that the omitted bounces may take
/// Smallest 2q - 3 in the bound of the omitted bounces. Below, absorption ends the sum before the slope density does.
inline constexpr double kSlowestFall = 0.1;

// ---- Grids (shape_plan.cpp, rows.cpp, refinement.cpp). The numbers are million evaluations of `dolp table` for 32 x
// 32 x 32 entries at 1e-4 (theta to 85 degrees, sigma 0.05 to 1, q 1.75 to 6), first with integral, then with smith
// masking.

/// Fewest nodes of an axis (fewer coefficients show no reliable decay), and nodes in addition to those for the digits.
inline constexpr double kLeastShapeNodes = 6.0;
inline constexpr double kFirstShapeNodes = 3.0;  // 1.87, 1.87, 2.44; 1.70, 1.81, 2.37
/// An interpolated axis has at least this many values per node; an interpolated grid has this many entries per node.
inline constexpr double kLeastAxisGain = 1.25;     // 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
inline constexpr std::size_t kLeastShapeGain = 2;  // 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
/// Tolerance of the nodes divided by the tolerance of the request: below 1, because the weights of an interpolation
/// increase bounds. kExtraShapeDigits is added to the digits of the tolerance.
inline constexpr double kShapeNodeTolerance = 0.125;  // 2.03, 1.87, 1.75; 1.86, 1.81, 1.78
inline constexpr double kExtraShapeDigits = 1.0;      // 1.84, 1.87, 2.33; 1.75, 1.81, 2.32
/// The error bound of an interpolation is kShapeTail * l / (1 - f). l is the largest of the last kLastShapeCoefficients
/// Chebyshev coefficients. f is l divided by the largest of as many before them, at most kSlowestShapeFall.
inline constexpr double kShapeTail = 3.0;  // 1.87, 1.87, 1.89; 1.80, 1.81, 2.00
inline constexpr int kLastShapeCoefficients = 3;
inline constexpr double kSlowestShapeFall = 0.9;
/// Largest ratio of two values of q - 1 in a chunk (plan/rows.hpp). Shapes that differ more need nodes at other slopes.
inline constexpr double kMostRowSpread = 6.0;
/// Grids are computed in rows of kRowWidth members if their shapes fill more than this share of such rows. Half-filled
/// rows still take less time than rows of one member. A quarter makes sparser grids slower; few grids fill nine tenths.
inline constexpr double kLeastRowUse = 0.5;  // 1.87, 1.87, 5.63; 1.81, 1.81, 5.60
/// If an entry misses its tolerance by a factor f, its next level is tighter by f times kRefinementSafety, so that it
/// does not narrowly miss again, but by at least kLeastDecades and at most kMostDecades.
inline constexpr double kRefinementSafety = 1.5;  // 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kLeastDecades = 0.5;      // 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kMostDecades = 5.0;

// ---- Effects (effects.cpp)

inline constexpr double kDroppedShare = 0.1;  // all dropped effects may change DOLP by this share of the tolerance

}  // namespace dolp
