// Constants that steer the cost or the accuracy of fits. They are chosen, except one that is marked "Proved". Three
// numbers beside a constant are costs: the parameter sets that a fit evaluates with half the constant, with the
// constant, and with twice the constant. They are means over the sets 900 to 919 of the study (`dolp-bench fit
// --first-set 900 --entries 20`). With all these values the fits find all global minima. Constants without numbers
// change no result when they are halved or doubled. The scale is the change of the objective by one standard deviation.
#pragma once

#include <cstddef>

namespace dolp::fit {

/// Tolerance of the model's values, divided by the smallest uncertainty: kFineShare for the final values, kCoarseShare
/// during the search. kMostTolerance is the largest tolerance of the search.
inline constexpr double kFineShare = 1e-2;      // 1412, 1421, 1448
inline constexpr double kCoarseShare = 0.25;    // 1410, 1421, 1420
inline constexpr double kMostTolerance = 1e-3;  // 1350, 1421, 1425
/// Uncertainty from which the tolerances follow if the data have no uncertainties.
inline constexpr double kAssumedUncertainty = 1e-3;

/// A parameter counts as at its bound if its coordinate is closer than this to an end of its range.
inline constexpr double kAtBound = 1e-6;
/// The description of a direction names the parameters whose component exceeds this share of the largest one.
inline constexpr double kInDirection = 0.1;
inline constexpr double kDoubtfulBelow = 0.05;  ///< a fit is doubtful if its p-value is below this
inline constexpr double kBadBelow = 0.001;      ///< a fit is bad if its p-value is below this

/// Steps of finite differences, in coordinates (0 to 1): the first step, the smallest and the largest.
inline constexpr double kFirstStep = 0.01;  // 1354, 1421, 1425
inline constexpr double kLeastStep = 1e-6;
inline constexpr double kMostStep = 0.05;  // 1363, 1421, 1354
/// A step should change the model's values by at most this share of an uncertainty or, if that is more, by this
/// multiple of the numerical error of the values.
inline constexpr double kSeenShare = 0.2;          // 1398, 1421, 1425
inline constexpr double kErrorsOfAChange = 100.0;  // 1416, 1421, 1379
/// Largest factor by which a step changes from one linearisation to the next.
inline constexpr double kMostChangeOfStep = 10.0;  // 1414, 1421, 1415

/// Ratios of the decrease of the objective to the decrease that derivatives promise. A step is taken if its ratio is
/// above kLeastRatio. Above kPredictedRatio, derivatives may be updated from the step.
inline constexpr double kLeastRatio = 1e-3;         // 1421, 1421, 1421
inline constexpr double kPredictedRatio = 0.5;      // 1402, 1421, 1505
inline constexpr double kRadiusOfNeighbours = 1.0;  // 1400, 1421, 1412
/// A path is straight if the squared error of its predicted residuals is below this share of their squared change.
inline constexpr double kBent = 0.05;  // 1458, 1421, 1381

/// Number of points of the Sobol sequence per start.
inline constexpr std::size_t kPointsOfAStart = 8;  // 1324, 1421, 1593
inline constexpr int kStepsOfARound = 3;           // 1334, 1421, 1573
inline constexpr int kMostRounds = 15;             // 1417, 1421, 1421
/// A descent of the search ends when derivatives promise a decrease of the objective below this times the scale.
inline constexpr double kCoarseGain = 0.1;  // 1358, 1421, 1416
/// Minima higher than the lowest one by more than this times the scale are left as the search found them.
inline constexpr double kFarAbove = 30.0;  // 1413, 1421, 1428
/// The line between two minima is divided into so many parts.
inline constexpr int kPointsOfALine = 8;  // 1386, 1421, 1489

/// Largest relative error that the square root of the growth of the objective has at an end of an interval.
inline constexpr double kRootTolerance = 5e-3;  // 1435, 1421, 1404
/// A descent of a profile ends when derivatives promise a decrease of the objective below this times the scale.
inline constexpr double kProfileGain = 1e-3;  // 1442, 1421, 1401
/// Largest number of points that a side of a profile tries for each rise. After kProfileSecants secants it halves the
/// distances, which a profile that jumps needs.
inline constexpr int kMostProfilePoints = 25;  // 1415, 1421, 1421
inline constexpr int kProfileSecants = 8;      // 1415, 1421, 1416
/// A profile jumps between two points if their distances from the minimum differ by less than this share.
inline constexpr double kLeastGap = 1e-3;  // 1422, 1421, 1418
/// Largest factor between the distances of two consecutive points from the minimum.
inline constexpr double kMostGrowth = 3.0;  // 1414, 1421, 1427
/// Below this share of the first rise, derivatives may be updated from steps.
inline constexpr double kTrustedShare = 0.8;  // 1424, 1421, 1329
inline constexpr double kFirstProbe = 0.01;   // 1411, 1421, 1415
/// Other branches are searched at this distance beyond an end, as a multiple of the width of the interval.
inline constexpr double kBeyond = 0.02;  // 1425, 1421, 1410
/// A point beyond an end lies on another branch if its growth is below this share of the rise. Proved: at the end
/// itself the growth is at most the share 2 kRootTolerance, or 0.01, below the rise.
inline constexpr double kClearlyLower = 0.97;  // 1421, 1421, 1793

// The study draws no contours, so it does not cover the constants below.

/// A descent of a node ends when derivatives promise a decrease of the objective below this times the scale.
inline constexpr double kNodeGain = 1e-2;
/// Step of the first grid along each axis, in standard deviations. A standard deviation counts as at least
/// kLeastDeviation and at most kMostDeviation of the range.
inline constexpr double kStepOfDeviation = 0.5;
inline constexpr double kLeastDeviation = 1e-4;
inline constexpr double kMostDeviation = 1.0 / 12.0;
/// The neighbours of a node are computed if its growth is below this. It is above the higher level, because the line of
/// that level may cross a cell whose corners all lie above it.
inline constexpr double kSpreadGrowth = 9.0;
/// Largest number of grids that are tried. Each has twice the step of the one before.
inline constexpr std::size_t kMostGrids = 3;
/// Number of points of the drawn grid per step of the computed grid.
inline constexpr int kPartsOfACell = 4;

}  // namespace dolp::fit
