#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "explore/window/views.hpp"

namespace dolp::explore {
namespace {

constexpr std::size_t kSlopeCount = 181;
constexpr std::size_t kMaterialCount = 240;
constexpr std::size_t kCutCount = 181;
constexpr float kLineWidth = 2.0F;

/// A line through the values at positions; it breaks where there is none.
void draw_values(const Plot& plot, const std::vector<double>& xs, const std::vector<double>& ys,
                 const CurveStyle& style) {
  std::vector<ImVec2> line;
  const auto finish = [&] {
    draw_line(plot.list(), line, style, kLineWidth);
    line.clear();
  };
  for (std::size_t i = 0; i < xs.size(); ++i) {
    if (!std::isfinite(ys[i]) || (plot.y().is_log && ys[i] <= 0.0)) {
      finish();
    } else {
      line.push_back(plot.at(xs[i], ys[i]));
    }
  }
  finish();
}

/// A name in a curve's style, in the upper right corner of a plot.
void draw_name(const Plot& plot, std::size_t row, const CurveStyle& style, const std::string& name) {
  const float line = ImGui::GetTextLineHeight();
  const float y = plot.min().y + (0.8F + 1.3F * static_cast<float>(row)) * line;
  const float right = plot.max().x - 0.6F * line;
  draw_label(plot.list(), {right, y}, {1.0F, 0.5F}, kTextColour, name);
  const float end = right - ImGui::CalcTextSize(shown(name).c_str()).x - 0.6F * line;
  draw_line(plot.list(), {{end - 2.0F * line, y}, {end, y}}, style, kLineWidth);
}

double largest_of(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  return largest > 0.0 ? largest : 1.0;
}

std::string distribution_name(const Scene& scene) {
  const std::string name = scene.word("surface.distribution").value();
  const std::string q = name == "cauchy" ? fmt::format(" q {:.4g}", scene.number("surface.q").value()) : "";
  return fmt::format("{} σ {:.4g}{}", name, scene.number("surface.sigma").value(), q);
}

void draw_reason(const std::string& reason) { coloured_text(kDimColour, reason); }

/// The element of a matrix, and the largest magnitude of it in a cut.
double largest_magnitude(const ScatteringCut& cut, std::size_t element) {
  double largest = 0.0;
  for (const MuellerMatrix& matrix : cut.matrices) {
    if (std::isfinite(matrix[element])) largest = std::max(largest, std::abs(matrix[element]));
  }
  return largest;
}

/// Rings of equal magnitude and rays of equal zenith around the middle of the surface.
void draw_polar_grid(ImDrawList* list, ImVec2 middle, float radius, const Scale& magnitude) {
  for (const double tick : magnitude.ticks(4)) {
    const float of_tick = radius * static_cast<float>(magnitude.position(tick));
    list->PathArcTo(middle, of_tick, std::numbers::pi_v<float>, 2.0F * std::numbers::pi_v<float>);
    list->PathStroke(kGridColour, ImDrawFlags_None, 1.0F);
    draw_label(list, {middle.x, middle.y - of_tick}, {0.5F, 0.5F}, kDimColour, tick_text(tick));
  }
  for (int degrees = -90; degrees <= 90; degrees += 30) {
    const float angle = static_cast<float>(degrees) * std::numbers::pi_v<float> / 180.0F;
    const ImVec2 end{middle.x + radius * std::sin(angle), middle.y - radius * std::cos(angle)};
    list->AddLine(middle, end, kGridColour);
    const ImVec2 at{middle.x + 1.07F * radius * std::sin(angle), middle.y - 1.07F * radius * std::cos(angle)};
    draw_text(list, at, {0.5F, 0.5F}, kDimColour, fmt::format("{}°", std::abs(degrees)));
  }
}

/// The lobe of an element: positive parts full, negative ones dashed.
void draw_lobe(ImDrawList* list, ImVec2 middle, float radius, const ScatteringCut& cut, std::size_t element,
               double largest) {
  for (const bool is_negative : {false, true}) {
    const CurveStyle style = is_negative ? overlay_style() : current_style();
    std::vector<ImVec2> line;
    for (std::size_t i = 0; i < cut.matrices.size(); ++i) {
      const double value = cut.matrices[i][element];
      if (!std::isfinite(value) || (value < 0.0) != is_negative) {
        draw_line(list, line, style, kLineWidth);
        line.clear();
        continue;
      }
      const float length = radius * static_cast<float>(std::abs(value) / largest);
      const float angle = static_cast<float>(cut.theta_r_deg[i]) * std::numbers::pi_v<float> / 180.0F;
      line.push_back({middle.x + length * std::sin(angle), middle.y - length * std::cos(angle)});
    }
    draw_line(list, line, style, kLineWidth);
  }
}

/// Where the light comes from.
void draw_incidence(ImDrawList* list, ImVec2 middle, float radius, double theta_i_deg) {
  const float angle = -static_cast<float>(theta_i_deg) * std::numbers::pi_v<float> / 180.0F;
  const auto at = [&](float part) {
    return ImVec2{middle.x + part * radius * std::sin(angle), middle.y - part * radius * std::cos(angle)};
  };
  list->AddLine(at(1.0F), at(0.0F), kCursorColour, scaled(1.0F));
  list->AddCircleFilled(at(1.0F), scaled(4.0F), kCursorColour);
}

}  // namespace

void draw_slopes(const Session& session, ImVec2 size) {
  const Scene& scene = session.scene();
  if (!(scene.number("surface.sigma") > 0.0)) return draw_reason("A mirror: all facets lie in the mean plane.");
  std::optional<Scene> other;
  try {
    other = scene.with(other_distribution(scene));
  } catch (const InputError&) {
    // Its sigma or q is outside the model.
  }
  // As far as the steepest thousandth of the density reaches.
  const std::vector<double> all_deg = zeniths(0.0, 89.5, kSlopeCount);
  const auto densities = [&](const Scene& of) {
    std::vector<double> values;
    for (const double alpha_deg : all_deg) {
      const double cosine = std::cos(alpha_deg * std::numbers::pi / 180.0);
      values.push_back(slope_density(of, alpha_deg) * cosine);
    }
    return values;
  };
  const std::vector<double> own = densities(scene);
  const double most = largest_of(own);
  const bool is_log = session.view().is_log;
  const Plot plot("slopes", size, {"angle of the facets α [°]", {0.0, 90.0}},
                  {"D(α) cos α [1/sr]", {is_log ? 1e-6 * most : 0.0, is_log ? 2.0 * most : 1.15 * most, is_log}});
  plot.clip();
  if (other) draw_values(plot, all_deg, densities(*other), overlay_style());
  draw_values(plot, all_deg, own, current_style());
  draw_name(plot, 0, current_style(), distribution_name(scene));
  if (other) draw_name(plot, 1, overlay_style(), distribution_name(*other) + ", same D(0)");
  plot.unclip();
}

void draw_material(const Session& session, ImVec2 size) {
  const MaterialCurve curve = material_curve(session.scene(), kMaterialCount);
  if (curve.wavelength_um.size() < 2) return draw_reason("n and k are known at one wavelength alone.");
  const double most = std::max(largest_of(curve.n), largest_of(curve.k));
  const bool is_log = session.view().is_log;
  const Scale wavelengths{curve.wavelength_um.front(), curve.wavelength_um.back(), true};
  const Plot plot("material", size, {"wavelength λ [µm]", wavelengths},
                  {"n, k", {is_log ? 1e-4 : 0.0, is_log ? 2.0 * most : 1.15 * most, is_log}});
  plot.clip();
  const auto [from_um, to_um] = spectrum_um(session.scene());
  const ImVec2 low = plot.at_position(plot.x().position(from_um), 1.0);
  const ImVec2 high = plot.at_position(plot.x().position(to_um), 0.0);
  plot.list()->AddRectFilled(low, {std::max(high.x, low.x + 1.5F), high.y}, band_colour(current_style()));
  draw_values(plot, curve.wavelength_um, curve.n, current_style());
  draw_values(plot, curve.wavelength_um, curve.k, overlay_style());
  draw_name(plot, 0, current_style(), "n");
  draw_name(plot, 1, overlay_style(), "k");
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
  if (view.mueller_row != session.view().mueller_row || view.mueller_column != session.view().mueller_column)
    session.set_view(view);
  ImGui::NewLine();
  if (!reason_.empty()) return draw_reason(reason_);
  const std::size_t element = 4 * session.view().mueller_row + session.view().mueller_column;
  const double largest = largest_magnitude(cut_, element);
  coloured_text(kDimColour, fmt::format("f{}{} [1/sr] at {:.4g} µm, light from {:.1f}° on the left; full: positive, "
                                        "dashed: negative",
                                        session.view().mueller_row, session.view().mueller_column, cut_.wavelength_um,
                                        session.theta_deg()));
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight();
  const float height = size.y - (ImGui::GetCursorPosY() - top) - 2.0F * line;
  const float radius = std::max(line, std::min(0.5F * size.x - 2.5F * line, height - 1.5F * line));
  const ImVec2 middle{corner.x + 0.5F * size.x, corner.y + 1.5F * line + radius};
  ImDrawList* const list = ImGui::GetWindowDrawList();
  if (!(largest > 0.0)) return draw_reason("0 in all of these directions");
  draw_polar_grid(list, middle, radius, {0.0, largest});
  draw_lobe(list, middle, radius, cut_, element, largest);
  draw_incidence(list, middle, radius, session.theta_deg());
}

}  // namespace dolp::explore
