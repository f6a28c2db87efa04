// Constants that steer the cost or the accuracy of fits. All are chosen, except where "proved" stands beside one.
// The numbers beside a constant are the parameter sets that a fit evaluates with half the constant, with it, and with
// twice the constant: the mean of the 20 sets 900 to 919 of the study
// (`dolp-bench fit --first-set 900 --entries 20`). All settings find all global minima. Constants without numbers
// change no result when they are halved or doubled.
#pragma once

#include <cstddef>

namespace dolp::fit {

// ---- Tolerances (fit.cpp) ------------------------------------------------------------------------------------------

/// Tolerances of the model's values over the smallest uncertainty: final, and during the search.
inline constexpr double kFineShare = 1e-2;      // 1412, 1421, 1448
inline constexpr double kCoarseShare = 0.25;    // 1410, 1421, 1420
inline constexpr double kMostTolerance = 1e-3;  // 1350, 1421, 1425
/// Uncertainty from which the tolerances follow where the data have none.
inline constexpr double kAssumedUncertainty = 1e-3;

// ---- Words of a fit (fit.cpp) --------------------------------------------------------------------------------------

/// A parameter whose coordinate is as near to an end of its range is at its bound.
inline constexpr double kAtBound = 1e-6;
/// Components of a direction, over the largest one, that its words name.
inline constexpr double kInDirection = 0.1;
/// P-values below which a fit is doubtful and bad: the usual levels.
inline constexpr double kDoubtfulBelow = 0.05;
inline constexpr double kBadBelow = 0.001;

// ---- Derivatives (residuals.cpp) -----------------------------------------------------------------------------------

/// Steps of differences, in coordinates.
inline constexpr double kFirstStep = 0.01;  // 1354, 1421, 1425
inline constexpr double kLeastStep = 1e-6;
inline constexpr double kMostStep = 0.05;  // 1363, 1421, 1354
/// A step changes a value by this share of an uncertainty, or by this multiple of the value's error.
inline constexpr double kSeenShare = 0.2;          // 1398, 1421, 1425
inline constexpr double kErrorsOfAChange = 100.0;  // 1416, 1421, 1379
/// Largest factor between the steps of two linearisations.
inline constexpr double kMostChangeOfStep = 10.0;  // 1414, 1421, 1415

// ---- Descent (descent.cpp) -----------------------------------------------------------------------------------------

/// Decrease of the objective over the promised decrease: a step is taken above the first ratio, and derivatives may be
/// updated from the steps above the second.
inline constexpr double kLeastRatio = 1e-3;         // 1421, 1421, 1421
inline constexpr double kPredictedRatio = 0.5;      // 1402, 1421, 1505
inline constexpr double kRadiusOfNeighbours = 1.0;  // 1400, 1421, 1412
/// A way is straight if derivatives miss less than this share of the squared change of the residuals.
inline constexpr double kBent = 0.05;  // 1458, 1421, 1381

// ---- Search (search.cpp) -------------------------------------------------------------------------------------------

/// Points of the Sobol sequence for each start.
inline constexpr std::size_t kPointsOfAStart = 8;  // 1324, 1421, 1593
inline constexpr int kStepsOfARound = 3;           // 1334, 1421, 1573
inline constexpr int kMostRounds = 15;             // 1417, 1421, 1421
/// Promised gain, in standard deviations squared, that ends a descent of the search.
inline constexpr double kCoarseGain = 0.1;  // 1358, 1421, 1416
/// Minima that lie higher, in standard deviations squared, are left as the search found them.
inline constexpr double kFarAbove = 30.0;  // 1413, 1421, 1428
/// Points on the line between two minima.
inline constexpr int kPointsOfALine = 8;  // 1386, 1421, 1489

// ---- Profiles (profile.cpp) ----------------------------------------------------------------------------------------

/// Relative error of the root of the growth at an end.
inline constexpr double kRootTolerance = 5e-3;  // 1435, 1421, 1404
/// Promised gain, in standard deviations squared, that ends a descent of a profile.
inline constexpr double kProfileGain = 1e-3;  // 1442, 1421, 1401
/// Points of a side for each rise, and how many of them are secants; a profile that jumps needs halves.
inline constexpr int kMostProfilePoints = 25;  // 1415, 1421, 1421
inline constexpr int kProfileSecants = 8;      // 1415, 1421, 1416
/// Two points whose distances from the minimum agree to this share enclose a jump.
inline constexpr double kLeastGap = 1e-3;  // 1422, 1421, 1418
/// Largest factor between the distances of two points from the minimum.
inline constexpr double kMostGrowth = 3.0;  // 1414, 1421, 1427
/// Share of the first rise below which derivatives may be updated from steps.
inline constexpr double kTrustedShare = 0.8;  // 1424, 1421, 1329
inline constexpr double kFirstProbe = 0.01;   // 1411, 1421, 1415
/// Distance beyond an end at which other branches are looked for, over the width of the interval.
inline constexpr double kBeyond = 0.02;  // 1425, 1421, 1410
/// A point below this share of a rise lies on another branch. Proved: 2 kRootTolerance are 0.01 of it.
inline constexpr double kClearlyLower = 0.97;  // 1421, 1421, 1793

// ---- Contours (contours.cpp), which the study does not draw --------------------------------------------------------

/// Promised gain, in standard deviations squared, that ends a descent of a node.
inline constexpr double kNodeGain = 1e-2;
/// Step of the first grid in standard deviations along its axis, which lie between these shares of the range.
inline constexpr double kStepOfDeviation = 0.5;
inline constexpr double kLeastDeviation = 1e-4;
inline constexpr double kMostDeviation = 1.0 / 12.0;
/// Growth up to which the neighbours of nodes are computed. Above the higher level, because its line may cross a cell
/// between corners that lie above.
inline constexpr double kSpreadGrowth = 9.0;
/// Grids that are tried, each of twice the step of the one before.
inline constexpr std::size_t kMostGrids = 3;
/// Points of the drawn grid for each step.
inline constexpr int kPartsOfACell = 4;

}  // namespace dolp::fit
