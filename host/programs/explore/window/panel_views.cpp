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
constexpr std::size_t kCutCount = 181;
constexpr float kLineWidth = 2.0F;

/// The range of values of all lines.
Scale values_range(const std::vector<NamedLine>& lines, bool is_log) {
  std::vector<double> all;
  for (const NamedLine& line : lines) all.insert(all.end(), line.values.begin(), line.values.end());
  return range_of(std::move(all), is_log);
}

/// Draws lines with gaps where they have no value. Their names are in the upper right corner, or in a row above.
void draw_lines(const Plot& plot, const std::vector<double>& xs, const std::vector<NamedLine>& lines,
                bool is_above = false) {
  plot.clip();
  for (const NamedLine& line : std::views::reverse(lines)) {  // so that the first line is on top
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

std::string distribution_name(const Scene& scene) {
  const std::string name = scene.word("surface.distribution").value();
  const std::string q = name == "cauchy" ? fmt::format(" q {:.4g}", scene.number("surface.q").value()) : "";
  return fmt::format("{} σ {:.4g}{}", name, scene.number("surface.sigma").value(), q);
}

void draw_reason(const std::string& reason) { coloured_text(kDimColour, reason); }

/// Marks the scene's wavelength or band on an axis of wavelengths.
void mark_spectrum(const Plot& plot, const Scene& scene) {
  const auto [from_um, to_um] = spectrum_um(scene);
  const float from = plot.at_position(plot.x().position(from_um), 0.0).x;
  const float to = plot.at_position(plot.x().position(to_um), 0.0).x;
  plot.clip();
  plot.list()->AddRectFilled({from, plot.min().y}, {std::max(to, from + 1.5F), plot.max().y},
                             band_colour(current_style()));
  plot.unclip();
}

/// A quantity along a sweep, with gaps where the model fails. Dim while the sweep belongs to an earlier scene.
NamedLine line_of(const Sweep& sweep, Plotted quantity, const CurveStyle& style, const std::string& name) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  NamedLine line{name, sweep.is_finished() ? style : stale(style), {}};
  const PlottedDescription& description = described(quantity);
  for (const Point& point : sweep.points()) line.values.push_back(point.is_good() ? description.shown(point) : kNone);
  return line;
}

/// The largest magnitude of one element in a cut.
double largest_magnitude(const ScatteringCut& cut, std::size_t element) {
  double largest = 0.0;
  for (const MuellerMatrix& matrix : cut.matrices) {
    if (std::isfinite(matrix[element])) largest = std::max(largest, std::abs(matrix[element]));
  }
  return largest;
}

/// A half circle above the centre of a surface.
struct HalfCircle {
  ImVec2 middle;
  float radius;

  /// The point at a share of the radius and an angle from the normal. Positive angles are on the right.
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

/// The lobe of an element: solid where positive, dashed where negative.
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

constexpr int kCells = 56;  // cells across a sphere, each a few pixels large

/// A colour for the angle of polarisation, equal at 0 and 180 degrees.
ImU32 angle_colour(double angle_deg) {
  float r = 0.0F, g = 0.0F, b = 0.0F;
  ImGui::ColorConvertHSVtoRGB(static_cast<float>(angle_deg / 180.0), 0.65F, 0.95F, r, g, b);
  return ImGui::ColorConvertFloat4ToU32({r, g, b, 1.0F});
}

/// The colours of an image, which shows DOLP or the angle of polarisation.
struct Colours {
  Scale dolp;  ///< range from the darkest colour to the lightest
  bool is_angle = false;

  ImU32 colour(const std::optional<ImagePolarisation>& polarisation) const {
    if (!polarisation) return kBadColour;
    return is_angle ? angle_colour(polarisation->angle_deg) : viridis(dolp.position(polarisation->dolp));
  }
};

/// The range of DOLP. It begins at 0, or with `from_least` at the smallest value.
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
      list->AddRectFilled(
          corner, {corner.x + cell, corner.y + cell},
          colours.colour(polarisation_at(session.curve().points(), std::asin(sine) / kDegree, azimuth_deg)));
    }
  }
}

/// A square plate seen from afar, with a line along its polarisation.
void draw_plate(const Session& session, ImVec2 middle, float radius, double azimuth_deg, const Colours& colours) {
  const std::optional<ImagePolarisation> polarisation =
      polarisation_at(session.curve().points(), session.theta_deg(), azimuth_deg);
  const double azimuth = azimuth_deg * kDegree;
  const double shortened = std::max(0.02, std::cos(session.theta_deg() * kDegree));
  const auto at = [&](double along, double across) {
    // Perspective shortens the side along the tilt.
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

/// A colour bar with a word at each end.
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

/// A sky as a disc. The zenith is in the centre; azimuth 0, the side of the view, is on the right.
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
  // Anti-aliased edges would be visible as seams.
  const ImDrawListFlags flags = std::exchange(list->Flags, ImDrawListFlags_None);
  const double half_deg = 0.5 * SourceSky::azimuth_deg(1);
  for (std::size_t i = 0; i < SourceSky::kAzimuths; ++i) {
    const std::vector<Point>& ring = sky.at(i);
    for (std::size_t j = 0; j + 1 < ring.size(); ++j) {
      const ImU32 colour = ring[j].is_good() ? viridis(colours.dolp.position(ring[j][Quantity::kDolp])) : kBadColour;
      const double inner = ring[j].theta_deg, outer = ring[j + 1].theta_deg;
      for (const double side : {1.0, -1.0}) {
        const double from = side * (SourceSky::azimuth_deg(i) - half_deg);
        const double to = side * (SourceSky::azimuth_deg(i) + half_deg);
        list->AddQuadFilled(at(inner, from), at(outer, from), at(outer, to), at(inner, to), colour);
      }
    }
  }
  list->Flags = flags;
}

/// Circles at some zeniths, a ring for the scene's source, a square for its view.
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

void cell(const std::string& text, ImU32 colour = kTextColour) {
  ImGui::TableNextColumn();
  coloured_text(colour, text);
}

/// The influence in points of DOLP: a bound for a dropped effect, an estimate for a kept one.
std::string influence_text(const Effect& row) {
  if (!row.bound && !row.influence) return "";
  const double points = 100.0 * row.bound.value_or(row.influence.value_or(0.0));
  if (points == 0.0) return "0";
  return fmt::format("{} {} points", row.bound ? "≤" : "≈",
                     points >= 10.0 ? fmt::format("{:.0f}", points) : fmt::format("{:.2g}", points));
}

/// True if the effects belong to an earlier scene.
bool is_stale(const Session& session) { return !session.effects().empty() && !session.curve().is_finished(); }

void draw_row(const Session& session, const Effect& row) {
  const bool is_absent = row.state == EffectState::kAbsent;
  const ImU32 colour = is_absent || is_stale(session) ? kDimColour : kTextColour;
  // Without the slopes the surface is smooth.
  const bool is_slopes = row.name == "distribution";
  const std::string removed = is_slopes ? "roughness" : row.name;
  const std::string without = is_absent ? "" : without_text(session, removed);
  cell(row.name, colour);
  cell(row.state == EffectState::kNotNeeded ? "not needed" : name_of(row.state), colour);
  cell(influence_text(row), colour);
  cell(is_slopes && !without.empty() ? "smooth: " + without : without, colour);
  if (const std::string words = without_words(session, removed); !words.empty()) tooltip(words);
  cell(row.reason, colour);
  if (!row.needs.empty()) tooltip("needs: " + row.needs);
}

/// One line per minimum and one per kind of interval. Returns the minimum that was clicked.
std::optional<std::size_t> draw_minima(const Fit& fit, std::optional<std::size_t> current) {
  std::optional<std::size_t> clicked;
  const int columns = static_cast<int>(fit.parameters.size()) + 2;
  if (!ImGui::BeginTable("minima", columns, ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV)) return clicked;
  ImGui::TableSetupColumn("minimum");
  ImGui::TableSetupColumn(shown("χ²").c_str());
  for (const FitParameter& one : fit.parameters) ImGui::TableSetupColumn(shown(control(one.key).label).c_str());
  ImGui::TableHeadersRow();
  for (std::size_t i = 0; i < fit.minima.size(); ++i) {
    ImGui::TableNextColumn();
    const std::string name = fmt::format("{}{}", i + 1, i == 0 ? ", lowest" : "");
    if (ImGui::Selectable(name.c_str(), current == i, ImGuiSelectableFlags_SpanAllColumns)) clicked = i;
    name_item(fmt::format("minimum {}", i + 1));
    cell(fmt::format("{:.5g}", fit.minima[i].chi_square));
    for (const double value : fit.minima[i].values) cell(fmt::format("{:.5g}", value));
  }
  for (const auto& [name, interval] :
       {std::pair{"68 %", &FitParameter::interval_68}, {"95 %", &FitParameter::interval_95}}) {
    cell(name);
    ImGui::TableNextColumn();
    for (const FitParameter& one : fit.parameters) cell(interval_text(one.*interval));
  }
  ImGui::EndTable();
  return clicked;
}

/// The lines of the report that interpret the result. The table above has the numbers.
void draw_words(const Fit& fit) {
  constexpr std::array<std::string_view, 9> kShown = {"minimum",    "misfit",     "scale",  "scaled", "pieces",
                                                      "correlated", "degenerate", "status", "model"};
  for (const auto& [label, text] : fit.report.rows) {
    if (std::ranges::count(kShown, label) == 0) continue;
    const ImU32 colour = label == "misfit" || label == "status" ? kErrorColour : kTextColour;
    coloured_text(colour, fmt::format("{}: {}", label, text));
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
    // The sigma or q of the overlay is outside the model, so the plot has one line.
  }
  const std::vector<double> all_deg = zeniths(0.0, 89.5, kSlopeCount);
  const auto densities = [&](const Scene& one) {
    std::vector<double> values;
    for (const double alpha_deg : all_deg)
      values.push_back(slope_density(one, alpha_deg) * std::cos(alpha_deg * kDegree));
    return values;
  };
  std::vector<NamedLine> lines = {{distribution_name(scene), current_style(), densities(scene)}};
  const Scale range = values_range(lines, session.view().is_log);
  if (other) lines.push_back({distribution_name(*other) + ", same D(0)", overlay_style(), densities(*other)});
  const Plot plot("slopes", size, {"angle of the facets α [°]", {0.0, 90.0}}, {"D(α) cos α [1/sr]", range});
  draw_lines(plot, all_deg, lines);
}

void draw_material(const Session& session, ImVec2 size) {
  const MaterialCurve curve = material_curve(session.scene(), kMaterialCount);
  if (curve.wavelength_um.size() < 2) return draw_reason("n and k are known at only one wavelength.");
  const std::vector<NamedLine> lines = {{"n", current_style(), curve.n}, {"k", overlay_style(), curve.k}};
  const Scale wavelengths{curve.wavelength_um.front(), curve.wavelength_um.back(), true};
  const Plot plot("material", size, {"wavelength λ [µm]", wavelengths},
                  {"n, k", values_range(lines, session.view().is_log)});
  mark_spectrum(plot, session.scene());
  draw_lines(plot, curve.wavelength_um, lines);
}

void SweepViews::draw_wavelengths(const char* id, Session& session, ImVec2 size, const std::vector<NamedLine>& lines,
                                  const Sweep& sweep, const PlotAxis& values) {
  const MapAxis axis = session.wavelengths();
  if (!axis.scale.refusal().empty()) return draw_reason("n and k are known at only one wavelength.");
  const Plot plot(id, size, {axis.label, axis.scale}, values);
  mark_spectrum(plot, session.scene());
  draw_lines(plot, sweep.at(), lines, true);
  const Scene& scene = session.spectral_scene();
  const auto change = axis_editor_.draw(axis.label, plot.x_numbers(), axis.scale,
                                        [&](const Scale& range) { return refusal(scene, axis, range); });
  if (change) set_range(session, axis, *change);
  const bool has_wavelength = session.scene().numbers("spectrum.band_um").empty();
  if (plot.is_dragged() && has_wavelength) session.set(axis.key, axis.scale.rounded(plot.mouse_x()));
}

void SweepViews::draw_spectrum(Session& session, ImVec2 size) {
  const PlottedDescription& quantity = described(session.view().quantity);
  const NamedLine line =
      line_of(session.spectrum(), quantity.quantity, current_style(), fmt::format("θ = {:.4g}°", session.theta_deg()));
  draw_wavelengths("spectrum", session, size, {line}, session.spectrum(),
                   {quantity.label(), range_of(line.values, session.view().is_log)});
}

void SweepViews::draw_smooth(Session& session, ImVec2 size) {
  const ImVec2 half{size.x, 0.5F * (size.y - ImGui::GetStyle().ItemSpacing.y)};
  const auto lines_of = [&](const Sweep& sweep) {
    return std::vector<NamedLine>{line_of(sweep, Plotted::kRhoS, current_style(), "R_s"),
                                  line_of(sweep, Plotted::kRhoP, overlay_style(), "R_p")};
  };
  const std::vector<NamedLine> over_angle = lines_of(session.smooth()), over = lines_of(session.smooth_spectrum());
  const bool is_band = !session.scene().numbers("spectrum.band_um").empty();
  const Plot plot(
      "smooth", half, {"local angle of incidence β [°]", {0.0, 90.0}},
      {is_band ? "R_s, R_p, mean over the band" : "R_s, R_p", values_range(over_angle, session.view().is_log)});
  if (plot.is_dragged()) session.set_theta(plot.x().value(plot.mouse_x()));
  draw_lines(plot, session.smooth().at(), over_angle, true);
  const float x = plot.at_position(plot.x().position(session.theta_deg()), 0.0).x;
  plot.list()->AddLine({x, plot.min().y}, {x, plot.max().y}, kCursorColour, scaled(1.0F));
  draw_wavelengths(
      "smooth spectrum", session, half, over, session.smooth_spectrum(),
      {fmt::format("R_s, R_p at β = {:.4g}°", session.theta_deg()), values_range(over, session.view().is_log)});
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
  // The mark of the source.
  const ImVec2 source = circle.at(1.0, -session.theta_deg());
  list->AddLine(source, circle.middle, kCursorColour, scaled(1.0F));
  list->AddCircleFilled(source, scaled(4.0F), kCursorColour);
}

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

void draw_effects(const Session& session) {
  struct Column {
    const char* name;
    const char* meaning;
    float width;  ///< in units of the font size
  };
  const std::array<Column, 5> columns = {
      {{is_stale(session) ? "the scene before" : "effect", "a part of the scene", 6.8F},
       {"plan", "kept, dropped, absent, or not needed by what is kept", 4.2F},
       {"at cursor", "what it adds to DOLP at the cursor: a bound (≤) where it is dropped, else an estimate", 6.0F},
       {"Q/I → without it",
        "Q/I at the maximum of the curve with all effects → without this one; their difference is its part", 9.4F},
       {"why", "the reason of the plan", 14.0F}}};
  const float em = ImGui::GetFontSize();
  const bool is_narrow = ImGui::GetContentRegionAvail().x < 36.0F * em;
  ImGuiTableFlags flags =
      ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingFixedFit;
  if (is_narrow) flags |= ImGuiTableFlags_ScrollX;
  if (!ImGui::BeginTable(is_narrow ? "narrow effects" : "effects", static_cast<int>(columns.size()), flags)) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const Column& column : columns) {
    const bool is_stretched = &column == &columns.back() && !is_narrow;
    ImGui::TableSetupColumn(column.name,
                            is_stretched ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
                            is_stretched ? 0.0F : column.width * em);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const Column& column : columns) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(column.name);
    tooltip(column.meaning);
  }
  for (const Effect& row : session.effects()) {
    ImGui::TableNextRow();
    draw_row(session, row);
  }
  ImGui::EndTable();
}

void draw_fit_result(Session& session) {
  ImGui::BeginChild("fit result");
  if (const std::optional<Fit>& fit = session.last_fit()) {
    const std::optional<std::size_t> current = session.minimum();
    const std::optional<std::size_t> clicked = draw_minima(*fit, current);
    coloured_text(kDimColour, current ? "A click moves the sliders to a minimum."
                                      : "The scene has changed since the fit. A click brings a minimum back.");
    draw_words(*fit);
    if (clicked) session.visit_minimum(*clicked);
  } else {
    coloured_text(kDimColour,
                  "No fit yet: load measured points (Ctrl+O), mark the numbers that vary in the boxes beside their "
                  "sliders, then press Ctrl+F.");
  }
  ImGui::EndChild();
}

}  // namespace dolp::explore
