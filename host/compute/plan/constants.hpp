// The constants of plan/ that steer cost or accuracy. Where the value is proved or fitted, a comment names the proof or
// the command. All others are tuned by hand.
//
// Three numbers behind a constant are its effect: the mean evaluations per entry with half the value, with the value
// and with double the value, for 150 ordinary entries of each masking concerned at 1e-4 (`dolp-calibrate check`). No
// bound was below its error in any of them. The sections on skies and grids have other entries, which they name. A
// constant without numbers makes less than 1 % difference, or matters only for extreme entries.
#pragma once

#include <cstddef>
#include <cstdint>

namespace dolp {

// ---- Rules (rule.cpp; `dolp-calibrate fit` also finds its kModels)

/// The coarser rule has this share of the finer rule's nodes. Proved: coarse_order of shaders/physics/orders.glsl.
inline constexpr double kCoarseShare = 0.8;
/// Nodes per digit, roughly, of a piece that a cusp or a line spoils because no split separates it.
inline constexpr double kNodesPerDigit = 1.2;  // 502, 461, 425
/// A line that spoils less than this share of the tolerance does not split a piece. It spoils both rules of a pair
/// equally, so their distance does not show it.
inline constexpr double kLineShare = 0.1;  // 471, 461, 452
/// A singularity |x|^p at an end costs a rule n^-(p + 2); a cluster of nodes there squares this. If q is below this
/// value times the digits, the line of `integral`, p = 2q - 1, needs more nodes than a cluster takes.
inline constexpr double kClusterBelowQ = 0.3;  // 563, 608, 609
/// The Gaussian line is smooth, but steep on rough surfaces. It splits pieces from this sigma; with more than
/// kTightDigits digits from kTightLineSigma.
inline constexpr double kLineSigma = 0.6;  // 632, 608, 542
inline constexpr double kTightLineSigma = 0.3;
inline constexpr double kTightDigits = 8.0;  // 632, 608, 608
/// The gaussian's cusp resembles the cauchy's with q = 2. Proved: 2q.
inline constexpr double kGaussianCuspPower = 4.0;
/// Largest order of a rule: this one, or for many digits this many per digit.
inline constexpr int kPlainOrder = 64;
inline constexpr double kOrderPerDigit = 8.0;
/// Digits gained by each split at a kink where beams of a groove end. Kinks matter less after more bounces. At half,
/// this and double, 5, 11 and 23 % of the entries miss the tolerance.
inline constexpr double kDigitsPerSplit = 2.0;  // 2350, 1765, 1394
/// Nodes of the slope axis and of the azimuth for each interference fringe of films between grazing and normal
/// incidence.
inline constexpr double kNodesOfFringe = 2.0;
/// Rounding errors of a position in a table of reflectances, in units of the roundoff.
inline constexpr double kCurveRoundings = 4.0;
/// Light below this share of the tolerance counts as none: the darkest surfaces reflect far more.
inline constexpr double kDimmest = 1e-10;

// ---- Slopes (breakpoints.cpp, kernel_data.cpp)

/// The slopes beyond the cut may carry this share of the tolerance.
inline constexpr double kCutShare = 0.01;
/// A plain breakpoint is worth it if the horizon is this factor away.
inline constexpr double kLongWay = 300.0;
/// Scale of the masking table, by default the width of the slope distribution. The table ends 5e8 scales away. That
/// must lie far beyond slope 1, where p is a power law, unless the tail there is negligible (q >= kLightTailQ).
inline constexpr double kSmallestHeavyTableScale = 1e-4;
inline constexpr double kLightTailQ = 1.5;
inline constexpr double kLargestTableScale = 0.5;
/// Factor between the bounces of neighbouring breakpoints in steep grooves.
inline constexpr double kSteepStep = 16.0;
/// Bounces whose critical line splits the slopes.
inline constexpr int kCriticalBounces = 3;
/// Tolerance of a pass with responses, over the request's: bounds grow by the weights. Million evaluations for 50
/// wavelengths of water at 0.1, this and 0.5: smith 6.6, 6.9, 9.2; integral 8.3, 7.4, 8.5.
inline constexpr double kResponseTolerance = 0.25;
/// Rounding errors of the abscissa of a response's polynomial, in units of the roundoff.
inline constexpr double kResponseRoundings = 4.0;

// ---- Skies (sky_table.cpp). Entries: the 19 rows of `dolp-bench effects` with integral; then with smith `dolp table`
// of 16 x 6 x 6 entries at 1e-4 (theta to 85 degrees, sigma 0.05 to 0.5, q 1.76 to 3)

/// Fewest cells of a function, and most cells of all functions of a sky. Texel buffers hold 65,536 on all devices, and
/// more on the devices that tolerances below kTightSky need.
inline constexpr std::uint32_t kLeastSkyCells = 512;
inline constexpr std::uint32_t kMostSkyCells = 1U << 15U;
inline constexpr std::uint32_t kMostTightSkyCells = 1U << 18U;
inline constexpr double kTightSky = 1e-5;
/// A table may differ from its function by this share of the tolerance.
inline constexpr double kSkyTableShare = 0.05;
/// Largest distance in a cell over the distance in its middle.
inline constexpr double kSkyTableSafety = 1.25;  // 690, 690, 690; 465, 465, 479
/// A function of a sky has a corner where its slope in u = sqrt(1 - cos(theta_r)) changes by at least this.
inline constexpr double kLeastBend = 1e-2;
/// Corners that do not split may bend, in sum, by this value times the tolerance. Their error is at most the second
/// value times r_i times their bends.
inline constexpr double kMostBends = 2e4;      // 837, 690, 693; 742, 465, 485
inline constexpr double kUnsplitBends = 1e-4;  // 658, 690, 747; 450, 465, 587
/// Rounding errors of cos(theta_r) and of a table's value, in units of the roundoff.
inline constexpr double kSkyCosineRoundings = 8.0;
inline constexpr double kSkyRoundings = 4.0;

// ---- Bounds (error_bounds.cpp)

/// Interpolation error of G relative to the albedo (quintic Hermite, 8 and 64 cells per octave).
inline constexpr double kMaskingTableErrorFloat = 3e-8;
inline constexpr double kMaskingTableErrorDouble = 1e-12;
/// Growth of smith's interpolation error near the end of its domain, times 2q - 3.
inline constexpr double kDivergingSlope = 0.06;
/// Rounding errors in units of the roundoff: ordinary ones; with heavy and extreme tails, below a q; at critical lines
/// of surfaces as smooth as kSmoothM.
inline constexpr double kRoundings = 20.0;
inline constexpr double kHeavyTailRoundings = 80.0;
inline constexpr double kHeavyTailQ = 1.1;
inline constexpr double kHeavyTailSmithQ = 1.6;
inline constexpr double kExtremeTailRoundings = 400.0;
inline constexpr double kExtremeTailQ = 1.01;
inline constexpr double kCriticalRoundings = 300.0;
inline constexpr double kMostCriticalRoundings = 3000.0;
inline constexpr double kSmoothM = 0.05;
/// Factor from the distance of the two rules to the error of the finer rule: for smooth integrands, with a masking
/// table, and in grooves, where kinks of beams with many bounces are not split. The last factor applies beside a
/// critical line, which rounding displaces.
inline constexpr double kPairFactor = 4.0;
inline constexpr double kTablePairFactor = 8.0;
inline constexpr double kGroovePairFactor = 10.0;
inline constexpr double kCriticalFactor = 2.0;
/// No error bound of a sum is below this share of the tolerance of its rule.
inline constexpr double kLeastShareOfTolerance = 0.1;
/// Rounding errors in grooves, in units of the roundoff and of the cosine: the last bounces may be grazing, where even
/// weak reflectors reflect everything.
inline constexpr double kGrooveRoundings = 4.0;
/// Error of taking many bounces in a groove as one, over the cosine and the share of these grooves. The best conductors
/// have the largest, because their light reflects very often. Fitted: the steep cases of
/// tests/compute/grooves_test.cpp.
inline constexpr double kManyBouncesError = 1e-3;
inline constexpr double kVeryManyBounces = 1024.0;
inline constexpr double kVeryManyBouncesError = 1e-2;
/// At least this share of a ray's bounces has cos(beta) >= a/2. Proved: sin(chi) >= 1/2 on 2/3 of the fan, less its
/// ends.
inline constexpr double kNotGrazing = 0.6;

// ---- pBRDF of grooves (further_bounces.cpp)

/// The work of a beam grows as the square of this. At theta_r = theta_i the bounces beyond it have 1e-5 of f (10 + 60i,
/// q 2.02).
inline constexpr int kMostBouncesOfBeam = 1000;
/// The bounces that are not followed may have this share of the accuracy.
inline constexpr double kNegligibleBounces = 0.01;
/// Below this 2q - 3, absorption ends the sum before the slope density does.
inline constexpr double kSlowestFall = 0.1;

// ---- Grids (shape_plan.cpp, rows.cpp, refinement.cpp). Numbers: million evaluations of `dolp table` for 32 x 32 x 32
// entries at 1e-4 (theta to 85 degrees, sigma 0.05 to 1, q 1.75 to 6), with integral and then with smith

/// Least number of nodes of an axis, because fewer coefficients show no reliable decay. The second value: nodes in
/// addition to the nodes for each digit.
inline constexpr double kLeastShapeNodes = 6.0;
inline constexpr double kFirstShapeNodes = 3.0;  // 1.87, 1.87, 2.44; 1.70, 1.81, 2.37
/// Interpolation needs this many values per node of an axis, and this many entries per node of a direction and index.
inline constexpr double kLeastAxisGain = 1.25;     // 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
inline constexpr std::size_t kLeastShapeGain = 2;  // 1.87, 1.87, 3.84; 1.81, 1.81, 2.66
/// Tolerance of the nodes over the tolerance of the request. It is below 1 because the interpolant's weights increase
/// bounds. The second value: digits of the interpolation beyond the tolerance of the request.
inline constexpr double kShapeNodeTolerance = 0.125;  // 2.03, 1.87, 1.75; 1.86, 1.81, 1.78
inline constexpr double kExtraShapeDigits = 1.0;      // 1.84, 1.87, 2.33; 1.75, 1.81, 2.32
/// Error bound over the largest of the last kLastShapeCoefficients coefficients, if these fall fast. kSlowestShapeFall
/// is the slowest fall that counts as fast, over the coefficients before.
inline constexpr double kShapeTail = 3.0;  // 1.87, 1.87, 1.89; 1.80, 1.81, 2.00
inline constexpr int kLastShapeCoefficients = 3;
inline constexpr double kSlowestShapeFall = 0.9;
/// The values of q - 1 in a chunk differ by this factor at most: other shapes need nodes in other places.
inline constexpr double kMostRowSpread = 6.0;
/// A grid is computed in rows if they use more than this share of their members. At half use, rows still take less time
/// than single members. A limit of a quarter slows such grids; with nine tenths few grids have rows.
inline constexpr double kLeastRowUse = 0.5;  // 1.87, 1.87, 5.63; 1.81, 1.81, 5.60
/// The next level is tighter than the miss requires by this factor, so that it does not narrowly miss the tolerance
/// again. Each level is tighter than the last by at least kLeastDecades and at most kMostDecades.
inline constexpr double kRefinementSafety = 1.5;  // 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kLeastDecades = 0.5;      // 1.87, 1.87, 1.87; 1.81, 1.81, 1.79
inline constexpr double kMostDecades = 5.0;

// ---- Effects (effects.cpp)

/// All dropped effects together may change DOLP by this share of the tolerance.
inline constexpr double kDroppedShare = 0.1;

}  // namespace dolp
