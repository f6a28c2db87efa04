#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "explore/readout.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {
namespace {

constexpr std::size_t kCutCount = 181;
constexpr float kLobeWidth = 2.0F;
constexpr std::size_t kRings = 45;     // cells of the sphere from the middle to the rim; each has a few pixels
constexpr std::size_t kSectors = 120;  // cells around the sphere

struct Disc {
  ImVec2 middle;
  float radius;

  /// The point at `share` times the radius from the middle. The angle counts counterclockwise from the right.
  ImVec2 at(double share, double angle_deg) const {
    const double angle = angle_deg * kDegree;
    return {middle.x + radius * static_cast<float>(share * std::cos(angle)),
            middle.y - radius * static_cast<float>(share * std::sin(angle))};
  }
};

double largest_magnitude(const ScatteringCut& cut, std::size_t element) {
  double largest = 0.0;
  for (const MuellerMatrix& matrix : cut.matrices) {
    if (std::isfinite(matrix[element])) largest = std::max(largest, std::abs(matrix[element]));
  }
  return largest;
}

/// Draws the grid of a polar plot: half circles of equal magnitude, and rays of equal zenith.
void draw_polar_grid(ImDrawList* list, const Disc& disc, const Scale& magnitude) {
  for (const double tick : magnitude.ticks(4)) {
    const double part = magnitude.position(tick);
    list->PathArcTo(disc.middle, disc.radius * static_cast<float>(part), std::numbers::pi_v<float>,
                    2.0F * std::numbers::pi_v<float>);
    list->PathStroke(kGridColour, ImDrawFlags_None, 1.0F);
    draw_label(list, disc.at(part, 90.0), {0.5F, 0.5F}, kDimColour, tick_text(tick));
  }
  for (int degrees = -90; degrees <= 90; degrees += 30) {
    list->AddLine(disc.middle, disc.at(1.0, 90.0 - degrees), kGridColour);
    draw_text(list, disc.at(1.07, 90.0 - degrees), {0.5F, 0.5F}, kDimColour, fmt::format("{}°", std::abs(degrees)));
  }
}

/// Draws a Mueller element over the directions of `cut`: a solid line where it is positive, a dashed line elsewhere.
void draw_lobe(ImDrawList* list, const Disc& disc, const ScatteringCut& cut, std::size_t element, double largest) {
  for (const bool is_negative : {false, true}) {
    std::vector<ImVec2> line;
    for (std::size_t i = 0; i < cut.matrices.size(); ++i) {
      const double value = cut.matrices[i][element];
      const bool is_shown = std::isfinite(value) && (value < 0.0) == is_negative;
      line.push_back(is_shown ? disc.at(std::abs(value) / largest, 90.0 - cut.theta_r_deg[i]) : kGap);
    }
    draw_line(list, line, is_negative ? overlay_style() : current_style(), kLobeWidth);
  }
}

ImU32 angle_colour(double angle_deg) {  // the colours for 0 and 180 degrees are equal
  float r = 0.0F, g = 0.0F, b = 0.0F;
  ImGui::ColorConvertHSVtoRGB(static_cast<float>(angle_deg / 180.0), 0.65F, 0.95F, r, g, b);
  return ImGui::ColorConvertFloat4ToU32({r, g, b, 1.0F});
}

struct Colours {
  Scale dolp;             ///< DOLP of the darkest and of the lightest colour
  bool is_angle = false;  ///< the image shows the angle of polarisation instead of DOLP

  ImU32 colour(const std::optional<ImagePolarisation>& polarisation) const {
    if (!polarisation) return kBadColour;
    return is_angle ? angle_colour(polarisation->angle_deg) : viridis(dolp.position(polarisation->dolp));
  }
};

Scale dolp_range(const std::vector<Point>& points, double theta_max_deg) {  // from 0 to the largest up to a zenith
  double largest = 1e-6;
  for (const Point& point : points) {
    if (point.is_good() && point.theta_deg <= theta_max_deg) largest = std::max(largest, point[Quantity::kDolp]);
  }
  return {0.0, largest};
}

/// Draws a disc of cells. Ring number i lies between the shares i and i + 1 of the radius, and has `sectors` cells.
/// `colour` gets the number of the ring and the azimuth of the middle of the cell.
void draw_cells(const Disc& disc, const std::vector<double>& shares, std::size_t sectors,
                const std::function<ImU32(std::size_t, double)>& colour) {
  ImDrawList* const list = ImGui::GetWindowDrawList();
  // Turns off anti-aliasing, which would show the edges between the cells.
  const ImDrawListFlags flags = std::exchange(list->Flags, ImDrawListFlags_None);
  const double half_deg = 180.0 / static_cast<double>(sectors);
  for (std::size_t ring = 0; ring + 1 < shares.size(); ++ring) {
    for (std::size_t sector = 0; sector < sectors; ++sector) {
      const double azimuth_deg = 2.0 * half_deg * static_cast<double>(sector);
      const double from = azimuth_deg - half_deg, to = azimuth_deg + half_deg;
      list->AddQuadFilled(disc.at(shares[ring], from), disc.at(shares[ring + 1], from), disc.at(shares[ring + 1], to),
                          disc.at(shares[ring], to), colour(ring, azimuth_deg));
    }
  }
  list->Flags = flags;
  // A line in the colour of the background, whose edges are anti-aliased, makes the rim smooth.
  list->AddCircle(disc.middle, disc.radius, kBackground, 128, scaled(3.0F));
}

void draw_sphere(const Session& session, const Disc& disc, const Colours& colours) {
  std::vector<double> shares;
  const std::vector<double> rings_deg = Scale{0.0, 90.0}.values(kRings + 1);
  for (const double zenith_deg : rings_deg) shares.push_back(std::sin(zenith_deg * kDegree));
  draw_cells(disc, shares, kSectors, [&](std::size_t ring, double azimuth_deg) {
    const double zenith_deg = 0.5 * (rings_deg[ring] + rings_deg[ring + 1]);
    return colours.colour(polarisation_at(session.curve().points(), zenith_deg, azimuth_deg));
  });
}

/// Draws a tilted square plate as seen from far away, with a line along the electric field of its light.
void draw_plate(const Session& session, ImVec2 middle, float radius, double azimuth_deg, const Colours& colours) {
  const std::optional<ImagePolarisation> polarisation =
      polarisation_at(session.curve().points(), session.theta_deg(), azimuth_deg);
  const double azimuth = azimuth_deg * kDegree;
  const double shortened = std::max(0.02, std::cos(session.theta_deg() * kDegree));
  const auto at = [&](double along, double across) {
    // The tilt shortens the image of the plate along the azimuth.
    const double x = along * shortened * std::cos(azimuth) - across * std::sin(azimuth);
    const double y = along * shortened * std::sin(azimuth) + across * std::cos(azimuth);
    return ImVec2{middle.x + radius * static_cast<float>(x), middle.y - radius * static_cast<float>(y)};
  };
  constexpr double kHalf = 0.75;
  ImDrawList* const list = ImGui::GetWindowDrawList();
  list->AddQuadFilled(at(-kHalf, -kHalf), at(kHalf, -kHalf), at(kHalf, kHalf), at(-kHalf, kHalf),
                      colours.colour(polarisation));
  list->AddQuad(at(-kHalf, -kHalf), at(kHalf, -kHalf), at(kHalf, kHalf), at(-kHalf, kHalf), kDimColour);
  if (!polarisation) return;
  const auto angle = static_cast<float>(polarisation->angle_deg * kDegree);
  const ImVec2 half{0.4F * radius * std::cos(angle), -0.4F * radius * std::sin(angle)};
  list->AddLine({middle.x - half.x, middle.y - half.y}, {middle.x + half.x, middle.y + half.y}, kTextColour,
                scaled(2.0F));
}

void draw_bar(ImVec2 corner, float width, const Colours& colours) {
  const float line = ImGui::GetTextLineHeight();
  ImDrawList* const list = ImGui::GetWindowDrawList();
  const Area bar{corner, {corner.x + width, corner.y + 0.6F * line}};
  draw_colours(list, bar, false, [&](double part) {
    return colours.colour(ImagePolarisation{colours.dolp.value(part), 180.0 * part});
  });
  const auto end_text = [&](double dolp, const char* angle) {
    return colours.is_angle ? angle : fmt::format("{:.3g} %", 100.0 * dolp);
  };
  const float below = corner.y + 0.7F * line;
  draw_text(list, {bar.min.x, below}, {0.0F, 0.0F}, kDimColour, end_text(colours.dolp.from, "0°"));
  draw_text(list, {bar.max.x, below}, {1.0F, 0.0F}, kDimColour, end_text(colours.dolp.to, "180°"));
  draw_text(list, {corner.x + 0.5F * width, below}, {0.5F, 0.0F}, kTextColour, colours.is_angle ? "angle" : "DOLP");
}

/// Draws the map over azimuth and zenith of the source as a disc. If the map ends at 180°, it mirrors the map.
void draw_rings(const HeatMap& sky, const MapField& field, const Disc& disc, const Colours& colours) {
  constexpr std::size_t kSectorsOfSky = 126;  // about two for each value of a half sky at the second level
  const double last_deg = sky.x().scale.to, steps = static_cast<double>(field.count) - 1.0;
  draw_cells(disc, Scale{0.0, 1.0}.values(field.count), kSectorsOfSky, [&](std::size_t ring, double azimuth_deg) {
    const double side_deg = azimuth_deg > last_deg ? 360.0 - azimuth_deg : azimuth_deg;
    const auto column = static_cast<std::size_t>(std::lround(steps * side_deg / last_deg));
    const double value = field.values[ring * field.count + column];
    return std::isnan(value) ? static_cast<ImU32>(kBadColour) : viridis(colours.dolp.position(value));
  });
}

/// Draws circles at three zeniths, a ring at the direction of the source, and a square at the direction of the view.
void draw_sky_marks(const Scene& scene, double source_zenith_deg, const Disc& disc) {
  ImDrawList* const list = ImGui::GetWindowDrawList();
  for (const double zenith_deg : {30.0, 60.0, 90.0}) {
    list->AddCircle(disc.middle, disc.radius * static_cast<float>(zenith_deg / 90.0), kGridColour, 96);
  }
  draw_text(list, disc.at(1.05, 0.0), {0.0F, 0.5F}, kDimColour, "0°");
  draw_text(list, disc.at(1.05, 90.0), {0.5F, 1.0F}, kDimColour, "90°");
  draw_text(list, disc.at(1.05, 180.0), {1.0F, 0.5F}, kDimColour, "180°");
  const double azimuth_deg = scene.number("geometry.relative_azimuth_deg").value();
  list->AddCircle(disc.at(source_zenith_deg / 90.0, azimuth_deg), scaled(5.0F), kTextColour, 0, scaled(2.0F));
  list->AddCircle(disc.at(scene.number("geometry.view_zenith_deg").value() / 90.0, 0.0), scaled(5.0F), kTextColour, 4,
                  scaled(2.0F));
}

}  // namespace

void ScatteringView::draw(Session& session, ImVec2 size) {
  const std::string key = fmt::format("{} {}", session.theta_deg(), session.curve().key());
  if (std::exchange(key_, key) != key) {
    reason_.clear();
    try {
      cut_ = scattering_cut(evaluator_, session.scene(), std::min(session.theta_deg(), 89.9), kCutCount);
    } catch (const InputError& error) {
      reason_ = error.what();
    }
  }
  View view = session.view();
  const float top = ImGui::GetCursorPosY();
  for (const auto& [name, position] : {std::pair{"row", &view.mueller_row}, {"column", &view.mueller_column}}) {
    ImGui::SetNextItemWidth(4.0F * ImGui::GetFontSize());
    auto value = static_cast<int>(*position);
    ImGui::Combo(name, &value,
                 "0: I\0"
                 "1: Q\0"
                 "2: U\0"
                 "3: V\0");
    *position = static_cast<std::size_t>(value);
    ImGui::SameLine();
  }
  if (view != session.view()) session.set_view(view);
  ImGui::NewLine();
  if (!reason_.empty()) return coloured_text(kDimColour, reason_);
  const std::size_t element = 4 * view.mueller_row + view.mueller_column;
  const double largest = largest_magnitude(cut_, element);
  coloured_text(kDimColour,
                fmt::format("f{}{} [1/sr] at {:.4g} µm, light from {:.1f}° on the left; full: positive, "
                            "dashed: negative",
                            view.mueller_row, view.mueller_column, cut_.wavelength_um, session.theta_deg()));
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight();
  const float height = size.y - (ImGui::GetCursorPosY() - top) - 2.0F * line;
  const float radius = std::max(line, std::min(0.5F * size.x - 2.5F * line, height - 1.5F * line));
  const Disc disc{{corner.x + 0.5F * size.x, corner.y + 1.5F * line + radius}, radius};
  ImDrawList* const list = ImGui::GetWindowDrawList();
  if (!(largest > 0.0)) return coloured_text(kDimColour, "0 in all of these directions");
  draw_polar_grid(list, disc, {0.0, largest});
  draw_lobe(list, disc, cut_, element, largest);
  const ImVec2 source = disc.at(1.0, 90.0 + session.theta_deg());
  list->AddLine(source, disc.middle, kCursorColour, scaled(1.0F));
  list->AddCircleFilled(source, scaled(4.0F), kCursorColour);
}

void ShapeView::draw(Session& session, ImVec2 size) {
  const float line = ImGui::GetTextLineHeight(), top = ImGui::GetCursorPosY();
  coloured_text(kTextColour, fmt::format("sphere, and a plate tilted by {:.1f}° (drag){}", session.theta_deg(),
                                         remark(session, session.curve())));
  if (has_sky_profile(session.scene())) {
    coloured_text(kDimColour,
                  "The sky turns with each element: its zenith is the element's normal, not that of the world. So the "
                  "colours are right only for horizontal surfaces.");
  }
  size.y -= ImGui::GetCursorPosY() - top;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("shapes", {std::max(size.x, 1.0F), std::max(size.y, 1.0F)});
  const float radius = std::max(line, std::min(0.25F * size.x - 0.8F * line, 0.25F * (size.y - 3.5F * line)));
  const float high = corner.y + 0.4F * line + radius;
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
  for (const bool is_angle : {false, true}) {
    const Colours colours{dolp_range(session.curve().points(), session.view().theta_max_deg), is_angle};
    const float x = plate.x + (is_angle ? 0.5F * size.x : 0.0F);
    draw_sphere(session, {{x, high}, radius}, colours);
    draw_plate(session, {x, low}, radius, azimuth_deg_, colours);
    draw_bar({x - radius, low + radius + 0.3F * line}, 2.0F * radius, colours);
  }
}

void draw_sky(const Session& session, ImVec2 size) {
  const MapField field = session.sky().field(Plotted::kDolp);
  const Scale dolp = field.min < field.max ? Scale{field.min, field.max} : Scale{0.0, 1.0};
  const Colours colours{dolp};
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float radius = std::max(line, std::min(0.5F * size.x - 2.0F * line, 0.5F * (size.y - 5.5F * line)));
  const ImVec2 middle{corner.x + 0.5F * size.x, corner.y + 2.8F * line + radius};
  ImDrawList* const list = ImGui::GetWindowDrawList();
  draw_text(list, corner, {0.0F, 0.0F}, kTextColour,
            fmt::format("DOLP over the source's direction, view at {:.4g}°{}",
                        session.scene().number("geometry.view_zenith_deg").value(),
                        session.sky().is_finished() ? "" : ", refining"));
  const Disc disc{middle, radius};
  if (field.count > 0) draw_rings(session.sky(), field, disc, colours);
  draw_sky_marks(session.scene(), session.theta_deg(), disc);
  draw_bar({middle.x - radius, middle.y + radius + 0.5F * line}, 2.0F * radius, colours);
}

}  // namespace dolp::explore
