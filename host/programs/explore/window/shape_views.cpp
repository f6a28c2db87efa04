#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "explore/readout.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {
namespace {

constexpr int kCells = 56;  // cells across a sphere, each a few pixels large

/// A colour of the angle of polarisation, the same at 0 and 180 degrees.
ImU32 angle_colour(double angle_deg) {
  float r = 0.0F, g = 0.0F, b = 0.0F;
  ImGui::ColorConvertHSVtoRGB(static_cast<float>(angle_deg / 180.0), 0.65F, 0.95F, r, g, b);
  return ImGui::ColorConvertFloat4ToU32({r, g, b, 1.0F});
}

/// The colours of an image: of DOLP, or of the angle of polarisation.
struct Colours {
  Scale dolp;  ///< range from the darkest colour to the lightest
  bool is_angle = false;

  ImU32 of(const std::optional<SeenPolarisation>& seen) const {
    if (!seen) return kBadColour;
    return is_angle ? angle_colour(seen->angle_deg) : viridis(dolp.position(seen->dolp));
  }
};

/// The range of DOLP from 0, or from the least value.
Scale dolp_range(const std::vector<Point>& points, double theta_max_deg, bool from_least) {
  constexpr double kLeastRange = 1e-6;
  Scale range{1.0, 0.0};
  for (const Point& point : points) {
    if (!point.is_good() || point.theta_deg > theta_max_deg) continue;
    range = {std::min(range.from, point[Quantity::kDolp]), std::max(range.to, point[Quantity::kDolp])};
  }
  if (!from_least || range.to < range.from) range.from = 0.0;
  return {range.from, std::max(range.to, range.from + kLeastRange)};
}

void draw_sphere(const Session& session, ImVec2 middle, float radius, const Colours& colours) {
  ImDrawList* const list = ImGui::GetWindowDrawList();
  const float cell = 2.0F * radius / kCells;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const float x = (static_cast<float>(column) + 0.5F) * cell - radius;
      const float y = radius - (static_cast<float>(row) + 0.5F) * cell;
      const double sine = static_cast<double>(std::hypot(x, y) / radius);
      if (sine >= 1.0) continue;
      const double azimuth_deg = std::atan2(static_cast<double>(y), static_cast<double>(x)) / kDegree;
      const ImVec2 corner{middle.x + x - 0.5F * cell, middle.y - y - 0.5F * cell};
      list->AddRectFilled(corner, {corner.x + cell, corner.y + cell},
                          colours.of(seen_at(session.curve().points(), std::asin(sine) / kDegree, azimuth_deg)));
    }
  }
}

/// A square plate seen from afar, with a line along its polarisation.
void draw_plate(const Session& session, ImVec2 middle, float radius, double azimuth_deg, const Colours& colours) {
  const std::optional<SeenPolarisation> seen = seen_at(session.curve().points(), session.theta_deg(), azimuth_deg);
  const double azimuth = azimuth_deg * kDegree;
  const double shortened = std::max(0.02, std::cos(session.theta_deg() * kDegree));
  const auto at = [&](double along, double across) {
    // The side along the tilt is shortened.
    const double x = along * shortened * std::cos(azimuth) - across * std::sin(azimuth);
    const double y = along * shortened * std::sin(azimuth) + across * std::cos(azimuth);
    return ImVec2{middle.x + radius * static_cast<float>(x), middle.y - radius * static_cast<float>(y)};
  };
  constexpr double kHalf = 0.75;
  ImDrawList* const list = ImGui::GetWindowDrawList();
  list->AddQuadFilled(at(-kHalf, -kHalf), at(kHalf, -kHalf), at(kHalf, kHalf), at(-kHalf, kHalf), colours.of(seen));
  list->AddQuad(at(-kHalf, -kHalf), at(kHalf, -kHalf), at(kHalf, kHalf), at(-kHalf, kHalf), kDimColour);
  if (!seen) return;
  const auto angle = static_cast<float>(seen->angle_deg * kDegree);
  const ImVec2 half{0.4F * radius * std::cos(angle), -0.4F * radius * std::sin(angle)};
  list->AddLine({middle.x - half.x, middle.y - half.y}, {middle.x + half.x, middle.y + half.y}, kTextColour,
                scaled(2.0F));
}

/// A bar of the colours with its ends in words.
void draw_bar(ImVec2 corner, float width, const Colours& colours) {
  const float line = ImGui::GetTextLineHeight();
  ImDrawList* const list = ImGui::GetWindowDrawList();
  const Area bar{corner, {corner.x + width, corner.y + 0.6F * line}};
  draw_colours(list, bar, false, [&](double part) {
    return colours.of(SeenPolarisation{colours.dolp.value(part), 180.0 * part});
  });
  const auto end_text = [&](double dolp, const char* angle) {
    return colours.is_angle ? angle : fmt::format("{:.3g} %", 100.0 * dolp);
  };
  const float below = corner.y + 0.7F * line;
  draw_text(list, {bar.min.x, below}, {0.0F, 0.0F}, kDimColour, end_text(colours.dolp.from, "0°"));
  draw_text(list, {bar.max.x, below}, {1.0F, 0.0F}, kDimColour, end_text(colours.dolp.to, "180°"));
  draw_text(list, {corner.x + 0.5F * width, below}, {0.5F, 0.0F}, kTextColour, colours.is_angle ? "angle" : "DOLP");
}

/// A sky as a disc: the zenith in the middle, azimuth 0, the side of the view, on the right.
struct SkyDisc {
  ImVec2 middle;
  float radius;

  ImVec2 operator()(double zenith_deg, double azimuth_deg) const {
    const auto length = radius * static_cast<float>(zenith_deg / 90.0);
    const auto angle = static_cast<float>(azimuth_deg * kDegree);
    return {middle.x + length * std::cos(angle), middle.y - length * std::sin(angle)};
  }
};

void draw_rings(const SourceSky& sky, const SkyDisc& at, const Colours& colours) {
  ImDrawList* const list = ImGui::GetWindowDrawList();
  // Smooth edges would show as seams.
  const ImDrawListFlags flags = std::exchange(list->Flags, ImDrawListFlags_None);
  const double half_deg = 0.5 * SourceSky::azimuth_deg(1);
  for (std::size_t i = 0; i < SourceSky::kAzimuths; ++i) {
    const std::vector<Point>& ring = sky.at(i);
    for (std::size_t j = 0; j + 1 < ring.size(); ++j) {
      const ImU32 colour = ring[j].is_good() ? viridis(colours.dolp.position(ring[j][Quantity::kDolp])) : kBadColour;
      const double inner = ring[j].theta_deg;
      const double outer = ring[j + 1].theta_deg;
      for (const double side : {1.0, -1.0}) {
        const double from = side * (SourceSky::azimuth_deg(i) - half_deg);
        const double to = side * (SourceSky::azimuth_deg(i) + half_deg);
        list->AddQuadFilled(at(inner, from), at(outer, from), at(outer, to), at(inner, to), colour);
      }
    }
  }
  list->Flags = flags;
}

/// Circles of zeniths; a ring for the scene's source, a square for its view.
void draw_sky_marks(const Scene& scene, double source_zenith_deg, const SkyDisc& at) {
  ImDrawList* const list = ImGui::GetWindowDrawList();
  for (const double zenith_deg : {30.0, 60.0, 90.0}) {
    list->AddCircle(at.middle, at.radius * static_cast<float>(zenith_deg / 90.0), kGridColour, 96);
  }
  draw_text(list, at(95.0, 0.0), {0.0F, 0.5F}, kDimColour, "0°");
  draw_text(list, at(95.0, 90.0), {0.5F, 1.0F}, kDimColour, "90°");
  draw_text(list, at(95.0, 180.0), {1.0F, 0.5F}, kDimColour, "180°");
  const double azimuth_deg = scene.number("geometry.relative_azimuth_deg").value();
  list->AddCircle(at(source_zenith_deg, azimuth_deg), scaled(5.0F), kTextColour, 0, scaled(2.0F));
  list->AddCircle(at(scene.number("geometry.view_zenith_deg").value(), 0.0), scaled(5.0F), kTextColour, 4,
                  scaled(2.0F));
}

std::vector<Point> all_points(const SourceSky& sky) {
  std::vector<Point> all;
  for (std::size_t i = 0; i < SourceSky::kAzimuths; ++i) all.insert(all.end(), sky.at(i).begin(), sky.at(i).end());
  return all;
}

}  // namespace

void ShapeView::draw(Session& session, ImVec2 size) {
  if (is_bistatic(session.scene())) {
    return coloured_text(kDimColour, "Bistatic mode has only one direction of view: see the view sky.");
  }
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("shapes", {std::max(size.x, 1.0F), std::max(size.y, 1.0F)});
  const float radius = std::max(line, std::min(0.25F * size.x - 0.8F * line, 0.25F * (size.y - 4.5F * line)));
  const float high = corner.y + 1.4F * line + radius;
  const float low = high + 2.0F * radius + 0.3F * line;
  const ImVec2 plate{corner.x + 0.25F * size.x, low};
  if (ImGui::IsItemActive()) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool is_left = mouse.x < corner.x + 0.5F * size.x;
    const auto x = static_cast<double>(mouse.x - plate.x - (is_left ? 0.0F : 0.5F * size.x));
    const auto y = static_cast<double>(plate.y - mouse.y);
    azimuth_deg_ = std::atan2(y, x) / kDegree;
    session.set_theta(std::asin(std::min(1.0, std::hypot(x, y) / static_cast<double>(radius))) / kDegree);
  }
  ImDrawList* const list = ImGui::GetWindowDrawList();
  draw_text(list, corner, {0.0F, 0.0F}, kTextColour,
            fmt::format("sphere, and a plate tilted by {:.1f}° (drag){}", session.theta_deg(),
                        remark(session, session.curve())));
  for (const bool is_angle : {false, true}) {
    const Colours colours{dolp_range(session.curve().points(), session.view().theta_max_deg, false), is_angle};
    const float x = plate.x + (is_angle ? 0.5F * size.x : 0.0F);
    draw_sphere(session, {x, high}, radius, colours);
    draw_plate(session, {x, low}, radius, azimuth_deg_, colours);
    draw_bar({x - radius, low + radius + 0.3F * line}, 2.0F * radius, colours);
  }
}

void draw_sky(const Session& session, ImVec2 size) {
  if (!is_bistatic(session.scene())) {
    return coloured_text(kDimColour, "This sky shows directions of a source: choose the mode bistatic.");
  }
  const SourceSky& sky = session.source_sky();
  const Colours colours{dolp_range(all_points(sky), 90.0, true)};
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float radius = std::max(line, std::min(0.5F * size.x - 2.0F * line, 0.5F * (size.y - 5.5F * line)));
  const ImVec2 middle{corner.x + 0.5F * size.x, corner.y + 2.8F * line + radius};
  ImDrawList* const list = ImGui::GetWindowDrawList();
  draw_text(
      list, corner, {0.0F, 0.0F}, kTextColour,
      fmt::format("DOLP over the source's direction, view at {:.4g}°{}",
                  session.scene().number("geometry.view_zenith_deg").value(), sky.is_finished() ? "" : ", refining"));
  const SkyDisc at{middle, radius};
  draw_rings(sky, at, colours);
  draw_sky_marks(session.scene(), session.theta_deg(), at);
  draw_bar({middle.x - radius, middle.y + radius + 0.5F * line}, 2.0F * radius, colours);
}

}  // namespace dolp::explore
