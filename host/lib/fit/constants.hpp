// Constants that control the cost or the accuracy of fits. All except one, which is marked "Proved", are chosen by
// tests. Three numbers beside a constant are costs: how many parameter sets a fit evaluates at half the constant, at
// the constant and at twice the constant. They are means over the test problems 900 to 919 of `dolp-bench fit
// --first-set 900 --entries 20`. With all these values the fits find all global minima. If a constant has no numbers,
// half and double change no result. "The scale" is how much the objective (chi^2 or another loss) rises one standard
// deviation from a minimum. "Growth" is how much the objective exceeds its minimum, divided by the scale.
#pragma once

#include <cstddef>

namespace dolp::fit {

/// Tolerance of the model's values, as a share of the smallest uncertainty of the data: kFineShare for the final
/// values, kCoarseShare during the search. The tolerance of the search is at most kMostTolerance.
inline constexpr double kFineShare = 1e-2;      // 1412, 1421, 1448
inline constexpr double kCoarseShare = 0.25;    // 1410, 1421, 1420
inline constexpr double kMostTolerance = 1e-3;  // 1350, 1421, 1425
/// Uncertainty from which the tolerances are computed if the data have no uncertainties.
inline constexpr double kAssumedUncertainty = 1e-3;

/// A parameter counts as at its bound if its coordinate (0 to 1 over its range) is closer than this to 0 or 1.
inline constexpr double kAtBound = 1e-6;
/// A report names those parameters of an undetermined direction whose component exceeds this share of the largest.
inline constexpr double kInDirection = 0.1;
inline constexpr double kDoubtfulBelow = 0.05;  ///< a fit is doubtful if its p-value is below this
inline constexpr double kBadBelow = 0.001;      ///< a fit is bad if its p-value is below this

/// The first, the smallest and the largest step of finite differences, in coordinates (0 to 1 over the range).
inline constexpr double kFirstStep = 0.01;  // 1354, 1421, 1425
inline constexpr double kLeastStep = 1e-6;
inline constexpr double kMostStep = 0.05;  // 1363, 1421, 1354
/// How much a step of finite differences should change the model's values: at most this share of an uncertainty or, if
/// that is more, this multiple of the numerical error of the values.
inline constexpr double kSeenShare = 0.2;          // 1398, 1421, 1425
inline constexpr double kErrorsOfAChange = 100.0;  // 1416, 1421, 1379
/// Largest factor between the steps of finite differences in one linearisation and in the next.
inline constexpr double kMostChangeOfStep = 10.0;  // 1414, 1421, 1415

/// A descent takes a step if the true decrease of the objective, divided by the decrease that derivatives promise, is
/// above kLeastRatio. Above kPredictedRatio it may update derivatives from the step.
inline constexpr double kLeastRatio = 1e-3;         // 1421, 1421, 1421
inline constexpr double kPredictedRatio = 0.5;      // 1402, 1421, 1505
inline constexpr double kRadiusOfNeighbours = 1.0;  // 1400, 1421, 1412
/// A path is straight if the squared error of the predicted residuals is below this share of their squared change.
inline constexpr double kBent = 0.05;  // 1458, 1421, 1381

/// Number of points of the Sobol sequence for each start of a descent.
inline constexpr std::size_t kPointsOfAStart = 8;  // 1324, 1421, 1593
inline constexpr int kStepsOfARound = 3;           // 1334, 1421, 1573
inline constexpr int kMostRounds = 15;             // 1417, 1421, 1421
/// A descent of the search ends when derivatives predict a decrease of the objective below this times the scale.
inline constexpr double kCoarseGain = 0.1;  // 1358, 1421, 1416
/// The search does not refine minima that are higher than the lowest one by more than this times the scale.
inline constexpr double kFarAbove = 30.0;  // 1413, 1421, 1428
inline constexpr int kPointsOfALine = 8;   // 1386, 1421, 1489

/// Largest relative error of the square root of the growth of the objective at an end of an interval.
inline constexpr double kRootTolerance = 5e-3;  // 1435, 1421, 1404
/// A descent of a profile ends when derivatives predict a decrease of the objective below this times the scale.
inline constexpr double kProfileGain = 1e-3;  // 1442, 1421, 1401
/// Largest number of points on one side of a profile in the search for an end of an interval. The first kProfileSecants
/// steps are secants. The later steps halve the distance, because secants fail where a profile jumps.
inline constexpr int kMostProfilePoints = 25;  // 1415, 1421, 1421
inline constexpr int kProfileSecants = 8;      // 1415, 1421, 1416
/// If two points of a profile differ by less than this share in their distance from the minimum, the profile jumps.
inline constexpr double kLeastGap = 1e-3;  // 1422, 1421, 1418
/// Largest ratio of the distances from the minimum of two successive points of a profile.
inline constexpr double kMostGrowth = 3.0;  // 1414, 1421, 1427
/// Where the growth is below this share of the first of ProfileOptions::rises, derivatives may be updated from steps.
inline constexpr double kTrustedShare = 0.8;  // 1424, 1421, 1329
inline constexpr double kFirstProbe = 0.01;   // 1411, 1421, 1415
/// Other branches of a valley are searched at this share of the interval's width beyond an end of the interval.
inline constexpr double kBeyond = 0.02;  // 1425, 1421, 1410
/// A point beyond an end of an interval lies on another branch if its growth is below this share of the growth at the
/// end. Proved: kRootTolerance allows the growth at the end to be too small by a share of 0.01 at most.
inline constexpr double kClearlyLower = 0.97;  // 1421, 1421, 1793

/// A descent to a grid point of the contours ends when derivatives predict a decrease below this times the scale.
inline constexpr double kNodeGain = 1e-2;
/// Step of the first grid of contours along each principal axis, in standard deviations. Here a standard deviation is
/// at least kLeastDeviation and at most kMostDeviation of the range.
inline constexpr double kStepOfDeviation = 0.5;
inline constexpr double kLeastDeviation = 1e-4;
inline constexpr double kMostDeviation = 1.0 / 12.0;
/// The neighbours of a node are computed too if the growth at the node is below this. This limit is above the higher
/// contour level, because its contour may cross a cell whose corners all lie above the level.
inline constexpr double kSpreadGrowth = 9.0;
/// Largest number of grids of contours that are tried. Each grid has twice the step of the grid before.
inline constexpr std::size_t kMostGrids = 3;
/// Number of steps of the drawn grid of contours for one step of the computed grid.
inline constexpr int kPartsOfACell = 4;

}  // namespace dolp::fit
