// The constants of fit/ that steer cost or accuracy, in one table. All are chosen but where "proved" stands beside one.
// Where numbers stand beside it, they are the parameter sets that a fit evaluates with half, with it and with double,
// in the mean of the 20 sets 900 to 919 of the study (`dolp-bench fit --first-set 900 --entries 20`);
// all global minima are found with each.
#pragma once

#include <cstddef>

namespace dolp::fit {

// ---- Tolerances (fit.cpp) ------------------------------------------------------------------------------------------

/// Of an uncertainty: the tolerance of the model, and that of the search.
inline constexpr double kFineShare = 1e-2;                            // 1412, 1421, 1448
inline constexpr double kCoarseShare = 0.25;                          // 1410, 1421, 1420
inline constexpr double kLeastTolerance = 1e-9;                       // no difference
inline constexpr double kMostTolerance = 1e-3;                        // 1350, 1421, 1425
inline constexpr double kToleranceWithoutUncertainties = 1e-5;        // no difference
inline constexpr double kCoarseToleranceWithoutUncertainties = 1e-4;  // no difference
/// Of the largest value: a residual where nothing says better.
inline constexpr double kGuessedShare = 1e-2;  // no difference
/// A fit that found a lower minimum on a profile begins again, so often at most.
inline constexpr int kMostRestarts = 4;  // no difference
/// P-values of the words for a fit: the usual levels.
inline constexpr double kDoubtfulBelow = 0.05;
inline constexpr double kBadBelow = 0.001;

// ---- Words of a fit (fit.cpp): they change reports alone ------------------------------------------------------------

/// Of coordinates: a parameter is at its bound; an interval ends with the range.
inline constexpr double kAtBound = 1e-6;  // no difference
inline constexpr double kAtRange = 1e-9;  // no difference
/// Of the largest singular value: a direction that the data do not see.
inline constexpr double kNullShare = 1e-4;  // no difference
/// Standard deviations: a parameter whose range changes no residual by more.
inline constexpr double kUnseen = 1e-3;  // no difference
/// Of the largest component: a parameter that a direction names.
inline constexpr double kInDirection = 0.1;  // no difference

// ---- Derivatives (residuals.cpp) -----------------------------------------------------------------------------------

/// Steps of differences, in coordinates.
inline constexpr double kFirstStep = 0.01;  // 1354, 1421, 1425
inline constexpr double kLeastStep = 1e-6;  // no difference
inline constexpr double kMostStep = 0.05;   // 1363, 1421, 1354
/// Of the tolerance: smaller bounds leave out what they cannot know.
inline constexpr double kLeastErrorShare = 1e-3;  // no difference
/// Of an uncertainty: a change of a residual that is seen.
inline constexpr double kSeenShare = 0.2;          // 1398, 1421, 1425
inline constexpr double kErrorsOfAChange = 100.0;  // 1416, 1421, 1379
/// From one linearisation to the next.
inline constexpr double kMostChangeOfStep = 10.0;  // 1414, 1421, 1415

// ---- Descent (descent.cpp) -----------------------------------------------------------------------------------------
// Levenberg's damping is the scale over the radius. Marquardt's, by the derivatives, would allow leaps along directions
// that the data hardly constrain. The rules of the radius are those of Nielsen (1999).

/// Of coordinates in [0, 1].
inline constexpr double kLeastStepLength = 1e-7;  // no difference
/// Of the objective, relative.
inline constexpr double kLeastDecrease = 1e-8;  // no difference
/// Of the decrease to the promised one: less is no step; from which on derivatives may follow the steps.
inline constexpr double kLeastRatio = 1e-3;         // 1421, 1421, 1421
inline constexpr double kForetoldRatio = 0.5;       // 1402, 1421, 1505
inline constexpr double kLeastRadius = 1e-8;        // 1421, 1421, 1421
inline constexpr double kMostRadius = 1e8;          // no difference
inline constexpr double kRadiusOfNeighbours = 1.0;  // 1400, 1421, 1412
/// Of the squared change of the residuals: less than that off, a way is straight.
inline constexpr double kBent = 0.05;  // 1458, 1421, 1381

// ---- Search (search.cpp) -------------------------------------------------------------------------------------------

/// Of the Sobol sequence, for each start.
inline constexpr std::size_t kPointsOfAStart = 8;  // 1324, 1421, 1593
inline constexpr int kStepsOfARound = 3;           // 1334, 1421, 1573
inline constexpr int kMostRounds = 15;             // 1417, 1421, 1421
/// Of the scale: ends a descent that another one will finish.
inline constexpr double kCoarseGain = 0.1;     // 1358, 1421, 1416
inline constexpr int kStepsToTheBottom = 100;  // no difference
/// Standard deviations of the objective: more than the wider tolerance may hide.
inline constexpr double kFarAbove = 30.0;  // 1413, 1421, 1428
/// Of the largest eigenvalue of a normal matrix: the residuals do not change along axes with less. Proved: far above
/// its rounding, the square of the least singular value that counts.
inline constexpr double kFlatShare = 1e-12;  // no difference
/// Between two minima.
inline constexpr int kPointsOfALine = 8;  // 1386, 1421, 1489

// ---- Profiles (profile.cpp) ----------------------------------------------------------------------------------------

/// Of sqrt(rise).
inline constexpr double kRootTolerance = 5e-3;  // 1435, 1421, 1404
/// Of the scale.
inline constexpr double kProfileGain = 1e-3;  // 1442, 1421, 1401
/// Of the scale: below the minimum by more is another minimum.
inline constexpr double kLowerMinimum = 0.01;  // no difference
/// Of a side and rise, and how many of them are secants; a profile that jumps needs halves.
inline constexpr int kMostProfilePoints = 25;  // 1415, 1421, 1421
inline constexpr int kProfileSecants = 8;      // 1415, 1421, 1416
/// Of the distance: a jump.
inline constexpr double kLeastGap = 1e-3;  // 1422, 1421, 1418
/// Of the distance from the minimum, from one point to the next.
inline constexpr double kMostGrowth = 3.0;  // 1414, 1421, 1427
/// Of the first rise: smaller ones decide nothing.
inline constexpr double kTrustedShare = 0.8;  // 1424, 1421, 1329
/// In coordinates.
inline constexpr double kFirstProbe = 0.01;          // 1411, 1421, 1415
inline constexpr double kCoordinateRounding = 1e-9;  // no difference
/// Of the width of a stretch: where other branches are looked for, so often at most.
inline constexpr double kBeyond = 0.02;  // 1425, 1421, 1410
inline constexpr int kMostLooks = 4;     // no difference
/// Of a rise: below, there is another branch. Proved: 2 kRootTolerance are 0.01 of it.
inline constexpr double kClearlyLower = 0.97;  // 1421, 1421, 1793
/// Of the second rise: contours begin with the points below it.
inline constexpr double kKeptRise = 1.6;  // no difference

// ---- Contours (contours.cpp) ---------------------------------------------------------------------------------------
// The study draws none.

/// Of the scale: far below what a contour shows.
inline constexpr double kNodeGain = 1e-2;
/// Growth that decides nothing, and growth that no contour sees.
inline constexpr double kTrustedGrowth = 1.0;
inline constexpr double kFarGrowth = 12.0;
/// Of the grid, in coordinates.
inline constexpr double kLeastUnit = 1e-4;
inline constexpr double kMostUnit = 1.0 / 24.0;
/// In units of the grid.
inline constexpr double kFinestUnit = 0.25;
/// Second difference of residuals. Proved: the root of the growth is off by an eighth of it.
inline constexpr double kStraightCell = 0.4;
/// Of a cell in which lines are straight.
inline constexpr int kPartsOfACell = 6;
/// Of a guessed cost.
inline constexpr double kCostSafety = 1.25;
/// Of a growth: a neighbour that foretells less knows another way.
inline constexpr double kSuspiciousShare = 0.8;

}  // namespace dolp::fit
