// The constants of plan/ that steer cost or accuracy, in one table. Each has a mark:
//   proved  the formula stands beside it
//   fitted  the command stands beside it that finds it; kModels of rule.cpp too: `dolp-calibrate fit`
//   chosen  everything else. Where numbers stand beside it, they are the mean evaluations of an entry with half, with
//           it and with double, of 150 ordinary entries of each masking concerned at 1e-4 (`dolp-calibrate check`); no
//           bound was below its error in any of them. "Corners" means that ordinary entries see no difference. Those
//           of interpolation, rows and refinement are millions of evaluations of a table instead, `dolp table` of
//           32 x 32 x 32 entries at 1e-4 (theta to 85 degrees, sigma 0.05 to 1, q 1.75 to 6), integral and then smith.
#pragma once

#include <cstddef>
#include <cstdint>

namespace dolp {

// ---- Rules (rule.cpp) ----------------------------------------------------------------------------------------------

/// Proved: coarse_order of shaders/physics/orders.glsl, the share of the finer rule's nodes that the coarser has.
inline constexpr double kCoarseShare = 0.8;
/// Nodes that a piece has for each digit, roughly, for what a cusp or line spoils without a split.
inline constexpr double kNodesPerDigit = 1.2;  // chosen: 502, 461, 425
/// Share of the tolerance that a line may spoil without being split off: it spoils both rules of a pair alike, so that
/// their distance does not show it.
inline constexpr double kLineShare = 0.1;  // chosen: 471, 461, 452
/// A singularity |x|^p at an end costs a rule n^-(p + 2); a cluster of its nodes there squares that. Below this q, for
/// each digit, the line of `integral`, p = 2q - 1, would want more nodes than a cluster takes.
inline constexpr double kClusterBelowQ = 0.3;  // chosen: 563, 608, 609
/// The line of the gaussian is smooth but steep for rough surfaces: sigma from which on it is split, for few digits and
/// for more.
inline constexpr double kLineSigma = 0.6;       // chosen: 632, 608, 542
inline constexpr double kTightLineSigma = 0.3;  // chosen: for more than 8 digits alone
inline constexpr double kTightDigits = 8.0;     // chosen: 632, 608, 608
/// Proved: 2q of the cauchy with q = 2, which the gaussian's cusp resembles.
inline constexpr double kGaussianCuspPower = 4.0;
/// Largest orders: for few digits, and for each digit beyond.
inline constexpr int kPlainOrder = 64;         // chosen
inline constexpr double kOrderPerDigit = 8.0;  // chosen: 629, 629, 631
/// Kinks where the beams of a groove end matter less after more bounces: each split gains about this many digits.
inline constexpr double kDigitsPerSplit = 2.0;  // chosen: 2350, 1765, 1394; flagged 5, 11, 23 %
/// Nodes of the slope axis and of the azimuth for each fringe that films have between grazing and normal incidence.
inline constexpr double kNodesOfFringe = 2.0;  // chosen
/// Roundings of the place in a table of reflectances.
inline constexpr double kCurveRoundings = 4.0;  // chosen
/// Of the tolerance: far below the reflection of the darkest surfaces.
inline constexpr double kDimmest = 1e-10;  // chosen: corners

// ---- Slopes (breakpoints.cpp, kernel_data.cpp) ---------------------------------------------------------------------

/// Share of the tolerance that the slopes beyond the cut may carry.
inline constexpr double kCutShare = 0.01;  // chosen: 631, 629, 628
/// From a plain breakpoint to a horizon that is worth one, as a factor.
inline constexpr double kLongWay = 300.0;  // chosen: corners
/// Scale of the masking table, the width of the slope distribution if it can be. The end of the table, 5e8 scales away,
/// must lie far beyond slope 1, where p is a power law, unless the tail there is negligible (q >= kLightTailQ).
inline constexpr double kSmallestHeavyTableScale = 1e-4;  // chosen: corners
inline constexpr double kLightTailQ = 1.5;                // chosen: corners
inline constexpr double kLargestTableScale = 0.5;         // chosen: corners
/// From a breakpoint of steep grooves to the next, in bounces.
inline constexpr double kSteepStep = 16.0;  // chosen: 1773, 1765, 1759
/// Bounces whose critical line splits the slopes.
inline constexpr int kCriticalBounces = 3;  // chosen
/// Tolerance of a pass with responses, over the request's: bounds grow by the weights. Tuned. Million evaluations for
/// 50 wavelengths of water at 0.1, this and 0.5: smith 6.6, 6.9, 9.2; integral 8.3, 7.4, 8.5.
inline constexpr double kResponseTolerance = 0.25;
/// Roundings of the abscissa of a response's polynomial.
inline constexpr double kResponseRoundings = 4.0;  // chosen

// ---- Skies (sky_table.cpp) -----------------------------------------------------------------------------------------
// Numbers are the mean evaluations of an entry under the 19 rows of `dolp-bench effects`, integral; smith: `dolp table`
// of 16 x 6 x 6 entries at 1e-4 (theta to 85 degrees, sigma 0.05 to 0.5, q 1.76 to 3). Under clear-sky none differs.

/// Cells of a function, at least, and of all functions of a sky together, at most; tolerances below kTightSky may have
/// more, which not all devices can hold.
inline constexpr std::uint32_t kLeastSkyCells = 512;            // chosen: no difference
inline constexpr std::uint32_t kMostSkyCells = 1U << 15U;       // chosen: a texel buffer holds 65,536 at least
inline constexpr std::uint32_t kMostTightSkyCells = 1U << 18U;  // chosen
inline constexpr double kTightSky = 1e-5;                       // chosen
/// Of the tolerance, for the distance of a table from its function.
inline constexpr double kSkyTableShare = 0.05;  // chosen: no difference
/// Largest distance in a cell over that in its middle.
inline constexpr double kSkyTableSafety = 1.25;  // chosen: 690, 690, 690; 465, 465, 479
/// Change of the slope in u = sqrt(1 - cos(theta_r)) from which on a function of a sky has a corner.
inline constexpr double kLeastBend = 1e-2;  // chosen: no difference
/// Bends of the corners that do not split, together, over the tolerance; and their error over r_i and these bends.
inline constexpr double kMostBends = 2e4;      // chosen: 837, 690, 693; 742, 465, 485
inline constexpr double kUnsplitBends = 1e-4;  // chosen: 658, 690, 747; 450, 465, 587
/// Roundings of cos(theta_r), and of a value of a table, in units of the roundoff.
inline constexpr double kSkyCosineRoundings = 8.0;  // chosen: no difference
inline constexpr double kSkyRoundings = 4.0;        // chosen: no difference

// ---- Bounds (error_bounds.cpp) -------------------------------------------------------------------------------------

/// Of the interpolation error of G relative to the albedo (quintic Hermite, 8 and 64 cells an octave).
inline constexpr double kMaskingTableErrorFloat = 3e-8;    // chosen
inline constexpr double kMaskingTableErrorDouble = 1e-12;  // chosen: corners
/// Of smith's, over 2q - 3, next to the end of its domain.
inline constexpr double kDivergingSlope = 0.06;  // chosen
/// Rounding errors in units of the roundoff.
inline constexpr double kRoundings = 20.0;                // chosen: 629 each
inline constexpr double kHeavyTailRoundings = 80.0;       // chosen: corners
inline constexpr double kHeavyTailQ = 1.1;                // chosen: corners
inline constexpr double kHeavyTailSmithQ = 1.6;           // chosen: corners
inline constexpr double kExtremeTailRoundings = 400.0;    // chosen: corners
inline constexpr double kExtremeTailQ = 1.01;             // chosen: corners
inline constexpr double kCriticalRoundings = 300.0;       // chosen
inline constexpr double kMostCriticalRoundings = 3000.0;  // chosen
inline constexpr double kSmoothM = 0.05;                  // chosen
/// Error of the finer rule over its distance from the coarser one: smooth, with a masking table, in grooves, where
/// beams of many bounces end at kinks that are not split, and beside a critical line, which lies where rounding leaves
/// it.
inline constexpr double kPairFactor = 4.0;         // chosen
inline constexpr double kTablePairFactor = 8.0;    // chosen
inline constexpr double kGroovePairFactor = 10.0;  // chosen
inline constexpr double kCriticalFactor = 2.0;     // chosen
/// Of the tolerance that a rule is made for: no bound of a sum is below it.
inline constexpr double kLeastShareOfTolerance = 0.1;  // chosen
/// Rounding in grooves, in units of the roundoff and of the cosine: the last bounces may be grazing, where even weak
/// reflectors reflect everything.
inline constexpr double kGrooveRoundings = 4.0;  // chosen
/// Error of taking many bounces in a groove as one, over the cosine and the share of these grooves. It is largest for
/// the best conductors, where light reflects very often. Fitted: the steep cases of
/// tests/compute/grooves_test.cpp.
inline constexpr double kManyBouncesError = 1e-3;
inline constexpr double kVeryManyBounces = 1024.0;  // chosen
inline constexpr double kVeryManyBouncesError = 1e-2;
/// Share of a ray's bounces with cos(beta) >= a/2, at least. Proved: sin(chi) >= 1/2 on 2/3 of the
/// fan, less its ends.
inline constexpr double kNotGrazing = 0.6;

// ---- pBRDF of grooves (further_bounces.cpp) ------------------------------------------------------------------------

/// Chosen: the work of a beam goes as its square. At theta_r = theta_i what is left of f of 10 + 60i, q 2.02, is 1e-5.
inline constexpr int kMostBouncesOfBeam = 1000;
/// Chosen: of the accuracy, for the bounces that are not followed.
inline constexpr double kNegligibleBounces = 0.01;
/// Chosen: of 2q - 3, below which absorption ends the sum and not the fall of the slope density.
inline constexpr double kSlowestFall = 0.1;

// ---- Interpolation between slope distributions (shape_axis.cpp, shape_plan.cpp) -------------------------------------

/// Nodes of an axis: fewer coefficients show no reliable decay; for any number of digits.
inline constexpr double kLeastShapeNodes = 6.0;  // chosen: 1.87, 1.87, 1.87; 1.81, 1.81, 1.81
inline constexpr double kFirstShapeNodes = 3.0;  // chosen: 1.87, 1.87, 2.44; 1.70, 1.81, 2.37
/// Values for each node, and entries of a direction and index for each node, from which on it is worth it.
inline constexpr double kLeastAxisGain = 1.25;     // chosen: 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
inline constexpr std::size_t kLeastShapeGain = 2;  // chosen: 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
/// Of the request's tolerance: bounds grow by the interpolant's weights; digits of the interpolation beyond it.
inline constexpr double kShapeNodeTolerance = 0.125;  // chosen: 2.03, 1.87, 1.75; 1.86, 1.81, 1.78
inline constexpr double kExtraShapeDigits = 1.0;      // chosen: 1.84, 1.87, 2.33; 1.75, 1.81, 2.32
/// Error bound over the largest of so many last coefficients, where these fall fast; their fall at the slowest, over
/// those before them.
inline constexpr double kShapeTail = 3.0;         // chosen: 1.87, 1.87, 1.89; 1.80, 1.81, 2.00
inline constexpr int kLastShapeCoefficients = 3;  // chosen
inline constexpr double kSlowestShapeFall = 0.9;  // chosen: 1.87, 1.87, 1.87; 1.81, 1.81, 1.81

// ---- Rows (rows.cpp) -----------------------------------------------------------------------------------------------

/// Between the exponents of a chunk, as a factor of q - 1: shapes further apart would want nodes in different places.
inline constexpr double kMostRowSpread = 6.0;  // chosen: no difference
/// Rows are not for grids that would leave more of the members unused. At a half, rows still take less time than their
/// members alone; a quarter slows such grids, at nine tenths few grids have rows.
inline constexpr double kLeastRowUse = 0.5;  // chosen: 1.87, 1.87, 5.63; 1.81, 1.81, 5.60

// ---- Refinement (refinement.cpp) -----------------------------------------------------------------------------------

/// The next level is tighter than the miss requires by this; otherwise it may miss the tolerance by a little again. A
/// level is tighter than the one before by so many decades.
inline constexpr double kRefinementSafety = 1.5;  // chosen: 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kLeastDecades = 0.5;      // chosen: 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kMostDecades = 5.0;       // chosen: no difference

// ---- Effects (effects.cpp) -----------------------------------------------------------------------------------------

/// Chosen: of the tolerance, for all dropped effects together.
inline constexpr double kDroppedShare = 0.1;

}  // namespace dolp
