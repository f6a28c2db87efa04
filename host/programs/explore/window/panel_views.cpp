#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "explore/window/views.hpp"

namespace dolp::explore {
namespace {

constexpr std::size_t kSlopeCount = 181;
constexpr std::size_t kMaterialCount = 240;
constexpr std::size_t kCutCount = 181;
constexpr float kLineWidth = 2.0F;

/// The values of a line over positions that all lines of a plot share.
struct NamedLine {
  std::string name;
  CurveStyle style;
  std::vector<double> values;
};

/// A range from 0, or from `least` where it is logarithmic, with room for names above the largest value.
Scale values_range(const std::vector<NamedLine>& lines, double largest_part, double least, bool is_log) {
  double largest = 0.0;
  for (const NamedLine& line : lines) {
    for (const double value : line.values) {
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
  }
  if (!(largest > 0.0)) largest = 1.0;
  return {is_log ? std::max(least, largest_part * largest) : 0.0, (is_log ? 2.0 : 1.15) * largest, is_log};
}

/// Draws lines, with gaps where they have no value, and their names in the upper right corner.
void draw_lines(const Plot& plot, const std::vector<double>& xs, const std::vector<NamedLine>& lines) {
  for (const NamedLine& line : std::views::reverse(lines)) {  // the first lies over the others
    std::vector<ImVec2> points;
    for (std::size_t i = 0; i < xs.size(); ++i)
      points.push_back(plot.can_show(xs[i], line.values[i]) ? plot.at(xs[i], line.values[i]) : kGap);
    draw_line(plot.list(), points, line.style, kLineWidth);
  }
  const float height = ImGui::GetTextLineHeight();
  const float right = plot.max().x - 0.6F * height;
  float y = plot.min().y + 0.8F * height;
  for (const NamedLine& line : lines) {
    draw_label(plot.list(), {right, y}, {1.0F, 0.5F}, kTextColour, line.name);
    const float end = right - ImGui::CalcTextSize(shown(line.name).c_str()).x - 0.6F * height;
    draw_line(plot.list(), {{end - 2.0F * height, y}, {end, y}}, line.style, kLineWidth);
    y += 1.3F * height;
  }
}

std::string distribution_name(const Scene& scene) {
  const std::string name = scene.word("surface.distribution").value();
  const std::string q = name == "cauchy" ? fmt::format(" q {:.4g}", scene.number("surface.q").value()) : "";
  return fmt::format("{} σ {:.4g}{}", name, scene.number("surface.sigma").value(), q);
}

void draw_reason(const std::string& reason) { coloured_text(kDimColour, reason); }

/// The largest magnitude of an element in a cut.
double largest_magnitude(const ScatteringCut& cut, std::size_t element) {
  double largest = 0.0;
  for (const MuellerMatrix& matrix : cut.matrices) {
    if (std::isfinite(matrix[element])) largest = std::max(largest, std::abs(matrix[element]));
  }
  return largest;
}

/// A half circle above the middle of a surface.
struct HalfCircle {
  ImVec2 middle;
  float radius;

  /// The point at a part of the radius and an angle from the normal, positive to the right.
  ImVec2 at(double part, double angle_deg) const {
    const double angle = angle_deg * kDegree;
    return {middle.x + radius * static_cast<float>(part * std::sin(angle)),
            middle.y - radius * static_cast<float>(part * std::cos(angle))};
  }
};

/// Rings of equal magnitude and rays of equal zenith.
void draw_polar_grid(ImDrawList* list, const HalfCircle& circle, const Scale& magnitude) {
  for (const double tick : magnitude.ticks(4)) {
    const double part = magnitude.position(tick);
    list->PathArcTo(circle.middle, circle.radius * static_cast<float>(part), std::numbers::pi_v<float>,
                    2.0F * std::numbers::pi_v<float>);
    list->PathStroke(kGridColour, ImDrawFlags_None, 1.0F);
    draw_label(list, circle.at(part, 0.0), {0.5F, 0.5F}, kDimColour, tick_text(tick));
  }
  for (int degrees = -90; degrees <= 90; degrees += 30) {
    list->AddLine(circle.middle, circle.at(1.0, degrees), kGridColour);
    draw_text(list, circle.at(1.07, degrees), {0.5F, 0.5F}, kDimColour, fmt::format("{}°", std::abs(degrees)));
  }
}

/// The lobe of an element: positive parts full, negative parts dashed.
void draw_lobe(ImDrawList* list, const HalfCircle& circle, const ScatteringCut& cut, std::size_t element,
               double largest) {
  for (const bool is_negative : {false, true}) {
    std::vector<ImVec2> line;
    for (std::size_t i = 0; i < cut.matrices.size(); ++i) {
      const double value = cut.matrices[i][element];
      const bool is_shown = std::isfinite(value) && (value < 0.0) == is_negative;
      line.push_back(is_shown ? circle.at(std::abs(value) / largest, cut.theta_r_deg[i]) : kGap);
    }
    draw_line(list, line, is_negative ? overlay_style() : current_style(), kLineWidth);
  }
}

}  // namespace

void draw_slopes(const Session& session, ImVec2 size) {
  const Scene& scene = session.scene();
  if (!(scene.number("surface.sigma") > 0.0)) return draw_reason("A mirror: all facets lie in the mean plane.");
  std::optional<Scene> other;
  try {
    other = scene.with(other_distribution(scene));
  } catch (const InputError&) {
    // Its sigma or q is outside the model: the plot has one line.
  }
  const std::vector<double> all_deg = zeniths(0.0, 89.5, kSlopeCount);
  const auto densities = [&](const Scene& of) {
    std::vector<double> values;
    for (const double alpha_deg : all_deg)
      values.push_back(slope_density(of, alpha_deg) * std::cos(alpha_deg * kDegree));
    return values;
  };
  std::vector<NamedLine> lines = {{distribution_name(scene), current_style(), densities(scene)}};
  const Scale range = values_range(lines, 1e-6, 0.0, session.view().is_log);
  if (other) lines.push_back({distribution_name(*other) + ", same D(0)", overlay_style(), densities(*other)});
  const Plot plot("slopes", size, {"angle of the facets α [°]", {0.0, 90.0}}, {"D(α) cos α [1/sr]", range});
  plot.clip();
  draw_lines(plot, all_deg, lines);
  plot.unclip();
}

void draw_material(const Session& session, ImVec2 size) {
  const MaterialCurve curve = material_curve(session.scene(), kMaterialCount);
  if (curve.wavelength_um.size() < 2) return draw_reason("n and k are known at only one wavelength.");
  const std::vector<NamedLine> lines = {{"n", current_style(), curve.n}, {"k", overlay_style(), curve.k}};
  const Scale wavelengths{curve.wavelength_um.front(), curve.wavelength_um.back(), true};
  const Plot plot("material", size, {"wavelength λ [µm]", wavelengths},
                  {"n, k", values_range(lines, 0.0, 1e-4, session.view().is_log)});
  plot.clip();
  const auto [from_um, to_um] = spectrum_um(session.scene());
  const float from = plot.at_position(plot.x().position(from_um), 0.0).x;
  const float to = plot.at_position(plot.x().position(to_um), 0.0).x;
  plot.list()->AddRectFilled({from, plot.min().y}, {std::max(to, from + 1.5F), plot.max().y},
                             band_colour(current_style()));
  draw_lines(plot, curve.wavelength_um, lines);
  plot.unclip();
}

void ScatteringView::update(const Session& session) {
  const std::string key = fmt::format("{} {}", session.theta_deg(), session.curve().key());
  if (key == key_) return;
  key_ = key;
  reason_.clear();
  try {
    cut_ = scattering_cut(evaluator_, session.scene(), std::min(session.theta_deg(), 89.9), kCutCount);
  } catch (const InputError& error) {
    reason_ = error.what();
  }
}

void ScatteringView::draw(Session& session, ImVec2 size) {
  update(session);
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
  if (!reason_.empty()) return draw_reason(reason_);
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
  const HalfCircle circle{{corner.x + 0.5F * size.x, corner.y + 1.5F * line + radius}, radius};
  ImDrawList* const list = ImGui::GetWindowDrawList();
  if (!(largest > 0.0)) return draw_reason("0 in all of these directions");
  draw_polar_grid(list, circle, {0.0, largest});
  draw_lobe(list, circle, cut_, element, largest);
  // The source.
  const ImVec2 source = circle.at(1.0, -session.theta_deg());
  list->AddLine(source, circle.middle, kCursorColour, scaled(1.0F));
  list->AddCircleFilled(source, scaled(4.0F), kCursorColour);
}

}  // namespace dolp::explore
