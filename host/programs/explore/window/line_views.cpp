#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "explore/readout.hpp"
#include "explore/window/views.hpp"

namespace dolp::explore {
namespace {

constexpr std::size_t kSlopeCount = 181;
constexpr std::size_t kMaterialCount = 240;
constexpr std::size_t kResponseParts = 240;
constexpr float kLineWidth = 2.0F;

Scale values_range(const std::vector<NamedLine>& lines, bool is_log) {
  std::vector<double> all;
  for (const NamedLine& line : lines) all.insert(all.end(), line.values.begin(), line.values.end());
  return value_scale(std::move(all), is_log);
}

/// Draws lines, with gaps at missing values. The names of the lines are above the plot if `is_above`, otherwise in it.
void draw_lines(const Plot& plot, const std::vector<double>& xs, const std::vector<NamedLine>& lines,
                bool is_above = false) {
  plot.clip();
  for (const NamedLine& line : std::views::reverse(lines)) {  // the first line is drawn last, on top
    std::vector<ImVec2> points;
    for (std::size_t i = 0; i < xs.size(); ++i)
      points.push_back(plot.can_show(xs[i], line.values[i]) ? plot.at(xs[i], line.values[i]) : kGap);
    draw_line(plot.list(), points, line.style, kLineWidth);
  }
  plot.unclip();
  const float height = ImGui::GetTextLineHeight();
  ImVec2 right{plot.max().x - 0.6F * height, plot.min().y + (is_above ? -1.1F : 0.8F) * height};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const NamedLine& line = lines[is_above ? lines.size() - 1 - i : i];
    draw_label(plot.list(), right, {1.0F, 0.5F}, kTextColour, line.name);
    const float end = right.x - ImGui::CalcTextSize(shown(line.name).c_str()).x - 0.6F * height;
    draw_line(plot.list(), {{end - 2.0F * height, right.y}, {end, right.y}}, line.style, kLineWidth);
    right = is_above ? ImVec2{end - 3.0F * height, right.y} : ImVec2{right.x, right.y + 1.3F * height};
  }
}

/// Marks a wavelength, a band, or the response of the camera, whose largest value has the height of the plot.
void mark_spectrum(const Plot& plot, const Scene& scene) {
  const auto [from_um, to_um] = spectrum_um(scene);
  const std::size_t parts = scene.word("spectrum.response_file") ? kResponseParts : 1;
  const double step_um = (to_um - from_um) / static_cast<double>(parts);
  std::vector<double> responses;
  for (std::size_t i = 0; i < parts; ++i)
    responses.push_back(scene.response(from_um + (static_cast<double>(i) + 0.5) * step_um));
  plot.clip();
  for (std::size_t i = 0; i < parts; ++i) {
    const double start_um = from_um + static_cast<double>(i) * step_um;
    const float from = plot.x_pixel(start_um), to = plot.x_pixel(start_um + step_um);
    const auto height = static_cast<float>(responses[i] / std::ranges::max(responses));
    plot.list()->AddRectFilled({from, std::lerp(plot.max().y, plot.min().y, height)},
                               {std::max(to, parts == 1 ? from + 1.5F : to), plot.max().y},
                               band_colour(current_style()));
  }
  plot.unclip();
}

/// The line of a quantity over the zeniths or wavelengths of `sweep`, with gaps where the model fails. The line is
/// faint while its points are outdated.
NamedLine sweep_line(const Sweep& sweep, Plotted quantity, const CurveStyle& style, const std::string& name) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  NamedLine line{name, sweep.is_finished() ? style : stale(style), {}};
  const PlottedDescription& description = described(quantity);
  double last = kNone;
  for (const Point& point : sweep.points()) {
    const double value = point.is_good() ? description.shown(point) : kNone;
    line.values.push_back(description.jumps(last, value) ? kNone : value);
    last = value;
  }
  return line;
}

/// Draws lines over the axis of the view. A drag sets the number on this axis, unless the scene has a band instead.
void draw_over_axis(const char* id, Session& session, AxisEditor& editor, ImVec2 size,
                    const std::vector<NamedLine>& lines, PlotAxis values) {
  const MapAxis axis = session.sweep_axis();
  if (!axis.scale.refusal().empty()) return coloured_text(kDimColour, "n and k are known at only one wavelength.");
  const Sweep& sweep = session.view().panel == Panel::kSmooth ? session.smooth_spectrum() : session.sweep();
  values.scale = session.view().range(View::kSweepValues).value_or(values.scale);
  const Plot plot(id, size, {axis.label, axis.scale}, values);
  const std::optional<double> value = session.scene().number(axis.key);
  axis.name == "wavelength" ? mark_spectrum(plot, session.scene()) : plot.draw_cursor(*value);
  draw_lines(plot, sweep.at(), lines, true);
  const Scene& scene = session.sweep_scene();
  const auto change = editor.draw(axis.label, plot.x_numbers(), axis.scale,
                                  [&](const Scale& range) { return refusal(scene, axis, range); });
  if (change) set_range(session, axis, *change);
  if (const auto typed = editor.draw("view: " + values.label, plot.y_numbers(), values.scale)) {
    View view = session.view();
    view.set_range(View::kSweepValues, typed->range);
    view.is_log = typed->is_log;
    session.set_view(view);
  }
  if (plot.is_dragged() && value) session.set(axis.key, axis.scale.rounded(plot.mouse_x()));
}

}  // namespace

void draw_slopes(const Session& session, ImVec2 size) {
  const Scene& scene = session.scene();
  const std::optional<Scene> other = with_other_distribution(scene);
  const std::vector<double> all_deg = Scale{0.0, 89.5}.values(kSlopeCount);
  const auto densities = [&](const Scene& shape) {
    std::vector<double> values;
    for (const double alpha_deg : all_deg)
      values.push_back(slope_density(shape, alpha_deg) * std::cos(alpha_deg * kDegree));
    return values;
  };
  std::vector<NamedLine> lines = {{slopes_name(scene), current_style(), densities(scene)}};
  const Scale range = values_range(lines, session.view().is_log);
  if (other) lines.push_back({slopes_name(*other) + ", same D(0)", overlay_style(), densities(*other)});
  const Plot plot("slopes", size, {"angle of the facets α [°]", {0.0, 90.0}}, {"D(α) cos α [1/sr]", range});
  draw_lines(plot, all_deg, lines);
}

void draw_material(const Session& session, ImVec2 size) {
  const MaterialCurve curve = material_curve(session.scene(), kMaterialCount);
  if (curve.wavelength_um.size() < 2) return coloured_text(kDimColour, "n and k are known at only one wavelength.");
  const std::vector<NamedLine> lines = {{"n", current_style(), curve.n}, {"k", overlay_style(), curve.k}};
  const Scale wavelengths{curve.wavelength_um.front(), curve.wavelength_um.back(), true};
  const Plot plot("material", size, {"wavelength λ [µm]", wavelengths},
                  {"n, k", values_range(lines, session.view().is_log)});
  mark_spectrum(plot, session.scene());
  draw_lines(plot, curve.wavelength_um, lines);
}

void draw_sweep(Session& session, AxisEditor& editor, ImVec2 size) {
  const PlottedDescription& quantity = described(session.view().quantity);
  const NamedLine line = sweep_line(session.sweep(), quantity.quantity, current_style(), sweep_name(session));
  draw_over_axis("sweep", session, editor, size, {line}, {quantity.label(), sweep_values(session)});
}

void draw_smooth(Session& session, AxisEditor& editor, ImVec2 size) {
  const ImVec2 half{size.x, 0.5F * (size.y - ImGui::GetStyle().ItemSpacing.y)};
  const auto both_lines = [&](const Sweep& sweep) {
    return std::vector<NamedLine>{sweep_line(sweep, Plotted::kRhoS, current_style(), "R_s"),
                                  sweep_line(sweep, Plotted::kRhoP, overlay_style(), "R_p")};
  };
  const std::vector<NamedLine> over_angle = both_lines(session.smooth()), over = both_lines(session.smooth_spectrum());
  const bool is_band = !session.scene().numbers("spectrum.band_um").empty();
  const Plot plot(
      "smooth", half, {"local angle of incidence β [°]", {0.0, 90.0}},
      {is_band ? "R_s, R_p, mean over the band" : "R_s, R_p", values_range(over_angle, session.view().is_log)});
  if (plot.is_dragged()) session.set_theta(plot.x().value(plot.mouse_x()));
  draw_lines(plot, session.smooth().at(), over_angle, true);
  plot.draw_cursor(session.theta_deg());
  draw_over_axis(
      "smooth spectrum", session, editor, half, over,
      {fmt::format("R_s, R_p at β = {:.4g}°", session.theta_deg()), values_range(over, session.view().is_log)});
}

}  // namespace dolp::explore
