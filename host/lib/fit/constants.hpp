// Constants for the cost or the accuracy of fits. The objective is chi^2, or the sum of another loss. The scale is the
// rise of the objective one standard deviation from a minimum. The growth is (objective - minimum) / scale. Tests gave
// all values, except one that is marked "Proved". Three numbers beside a constant are costs: the number of parameter
// sets that a fit evaluates with half the constant, with the constant, and with twice the constant. Each is a mean over
// the 20 problems of `dolp-bench fit --first-set 900 --entries 20`. In all three cases the fits find all global minima.
// A constant has no numbers if half of it and twice of it change no result.
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
/// A parameter belongs to an undetermined combination if its component is above this share of the largest component.
inline constexpr double kInDirection = 0.1;
inline constexpr double kDoubtfulBelow = 0.05;  ///< a fit is doubtful if its p-value is below this
inline constexpr double kBadBelow = 0.001;      ///< a fit is bad if its p-value is below this

/// The first, the smallest and the largest step of finite differences, in coordinates (0 to 1 over the range).
inline constexpr double kFirstStep = 0.01;  // 1354, 1421, 1425
inline constexpr double kLeastStep = 1e-6;
inline constexpr double kMostStep = 0.05;  // 1363, 1421, 1354
/// A step of finite differences should change the model's values by at most the larger of two numbers: kSeenShare times
/// the smallest uncertainty, and kErrorsOfAChange times the numerical error of the values.
inline constexpr double kSeenShare = 0.2;          // 1398, 1421, 1425
inline constexpr double kErrorsOfAChange = 100.0;  // 1416, 1421, 1379
/// Largest factor between the steps of finite differences in one linearisation and in the next.
inline constexpr double kMostChangeOfStep = 10.0;  // 1414, 1421, 1415

/// Limits for the ratio of the true to the predicted decrease of the objective. A descent accepts a step with a ratio
/// above kLeastRatio. Broyden's update of the derivatives needs a ratio from kPredictedRatio to 1 / kPredictedRatio.
inline constexpr double kLeastRatio = 1e-3;         // 1421, 1421, 1421
inline constexpr double kPredictedRatio = 0.5;      // 1402, 1421, 1505
inline constexpr double kRadiusOfNeighbours = 1.0;  // 1400, 1421, 1412
/// A path counts as straight if derivatives at its start predict the residuals at its end well enough: the squared
/// error of this prediction is below kBent * (squared change of the residuals along the path + scale).
inline constexpr double kBent = 0.05;  // 1458, 1421, 1381

/// Number of points of the Sobol sequence for each start of a descent.
inline constexpr std::size_t kPointsOfAStart = 8;  // 1324, 1421, 1593
/// Number of steps of the first curve of a fit with one parameter, for each start.
inline constexpr std::size_t kStepsOfAStart = 4;
inline constexpr int kStepsOfARound = 3;  // 1334, 1421, 1573
inline constexpr int kMostRounds = 15;    // 1417, 1421, 1421
/// The search ends a descent if derivatives predict that a step lowers the objective by less than kCoarseGain * scale.
inline constexpr double kCoarseGain = 0.1;  // 1358, 1421, 1416
/// The search does not refine minima that are higher than the lowest one by more than this times the scale.
inline constexpr double kFarAbove = 30.0;  // 1413, 1421, 1428
inline constexpr int kPointsOfALine = 8;   // 1386, 1421, 1489

/// An interval ends where the growth reaches a limit. This is the largest relative error of sqrt(growth) at an end.
inline constexpr double kRootTolerance = 5e-3;  // 1435, 1421, 1404
/// In profiles, descents end if derivatives predict that a step lowers the objective by less than kProfileGain * scale.
inline constexpr double kProfileGain = 1e-3;  // 1442, 1421, 1401
/// Largest number of points that are computed to find one end of an interval. The first kProfileSecants steps follow
/// secants. The later steps are bisections, because secants fail where the profile is discontinuous.
inline constexpr int kMostProfilePoints = 25;  // 1415, 1421, 1421
inline constexpr int kProfileSecants = 8;      // 1415, 1421, 1416
/// A profile counts as discontinuous at an end if the last point below the limit of the growth and the first point
/// above it are closer together than kLeastGap * (distance to the minimum).
inline constexpr double kLeastGap = 1e-3;  // 1422, 1421, 1418
/// Largest factor by which one step along a profile increases the distance from the minimum.
inline constexpr double kMostGrowth = 3.0;  // 1414, 1421, 1427
/// A profile's descent computes derivatives at its end only if the growth there is above this share of the 68 % limit.
inline constexpr double kTrustedShare = 0.8;  // 1424, 1421, 1329
inline constexpr double kFirstProbe = 0.01;   // 1411, 1421, 1415
/// To find other branches of a valley, the search goes beyond an interval by this share of the interval's width.
inline constexpr double kBeyond = 0.02;  // 1425, 1421, 1410
/// A point beyond an end of an interval lies on another branch if its growth is below this share of the growth limit.
/// Proved: the growth at the end itself is not below. By kRootTolerance it is at least 0.99 of the limit.
inline constexpr double kClearlyLower = 0.97;  // 1421, 1421, 1793

/// A point of a profile is a lower minimum if it is below the best objective by more than this times the scale.
inline constexpr double kLowerMinimum = 0.01;

/// For contours, descents end if derivatives predict that a step lowers the objective by less than kNodeGain * scale.
inline constexpr double kNodeGain = 1e-2;
/// Step of the first grid of contours along each principal axis, in standard deviations along this axis. A standard
/// deviation counts as at least kLeastDeviation and at most kMostDeviation, in coordinates (0 to 1 over the range).
inline constexpr double kStepOfDeviation = 0.5;
inline constexpr double kLeastDeviation = 1e-4;
inline constexpr double kMostDeviation = 1.0 / 12.0;
/// If the growth at a node is below this number, its neighbours are computed too. The number is above the level of the
/// outer contour, because this contour may cross a cell whose corners all lie above the level.
inline constexpr double kSpreadGrowth = 9.0;
/// Largest number of grids of contours that are tried. Each grid has twice the step of the grid before.
inline constexpr std::size_t kMostGrids = 3;
/// The drawn grid of contours divides each step of the computed grid into this many steps.
inline constexpr int kPartsOfACell = 4;

}  // namespace dolp::fit
