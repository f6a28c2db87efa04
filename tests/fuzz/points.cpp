// Fuzzes the readers of both kinds of points: directions, and geometries for `dolp mueller`.
#include "scene/points.hpp"
#include "fuzz.hpp"

void dolp::fuzz::read(const std::string& text) {
  for (const auto kind : {dolp::PointsKind::kDirections, dolp::PointsKind::kGeometries}) {
    refused([&] { dolp::parse_points(text, "points.csv", kind); });
  }
}
