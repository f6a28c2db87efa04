#include "explore/points.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

/// The scene with the axes of `list` as its grid. A further axis of the scene's grid gets the value of its key.
Scene with_grid(const Scene& scene, const PointList& list) {
  std::vector<Setting> axes;
  for (const auto& [name, values] : list.values) axes.push_back({name, values});
  for (const Axis axis : kAllAxes) {
    const std::string key = describe(axis).key, column = describe(axis).column;
    if (key.empty() || describe(axis).is_required || std::ranges::count(axes, column, &Setting::key) > 0) continue;
    if (!scene.numbers("grid." + column).empty()) axes.push_back({column, scene.number(key).value()});
  }
  const AxisLabels& labels = scene.labels();
  if (!labels[Axis::kMaterial].empty()) axes.push_back({"material", scene.word("surface.material").value()});
  if (!labels[Axis::kBand].empty()) axes.push_back({"band_um", scene.numbers("spectrum.band_um")});
  return scene.with_grid(axes);
}

template <Quantity kQuantity>
double point_value(const Point& point) {
  return point[kQuantity];
}
double u_over_i(const Point& point) { return point[Quantity::kStokesU] / point[Quantity::kStokesI]; }
double rho_s(const Point& point) { return point[Quantity::kRhoI] + point[Quantity::kRhoQ]; }
double rho_p(const Point& point) { return point[Quantity::kRhoI] - point[Quantity::kRhoQ]; }

/// The computed emissivity. If the scene has no emission, returns 1 - rho (Kirchhoff's law).
template <Quantity kQuantity, auto rho>
double emissivity(const Point& point) {
  return std::isnan(point[kQuantity]) ? 1.0 - rho(point) : point[kQuantity];
}

}  // namespace

const std::array<PlottedDescription, 9> kAllPlotted = {{
    {Plotted::kDolp, "DOLP", "√(Q² + U²)/I, in percent", "%", false, point_value<Quantity::kDolp>},
    {Plotted::kSignedDolp, "Q/I", "positive: s polarised, negative: p; in percent", "%", false,
     point_value<Quantity::kQOverI>, true},
    {Plotted::kUOverI, "U/I", "polarised at 45° (positive) or 135° from s; in percent", "%", false, u_over_i, true},
    {Plotted::kAolp, "AOLP", "atan2(U, Q)/2: 0° is s, 90° is p", "°", false, point_value<Quantity::kAolp>, false, true},
    {Plotted::kRhoS, "ρ_s", "ρ_I + ρ_Q, eq. (16)", "", true, rho_s},
    {Plotted::kRhoP, "ρ_p", "ρ_I − ρ_Q, eq. (16)", "", true, rho_p},
    {Plotted::kEmissivityS, "ε_s", "by the emission's model; without emission 1 − ρ_s (Kirchhoff)", "", true,
     emissivity<Quantity::kEmissivityS, rho_s>},
    {Plotted::kEmissivityP, "ε_p", "by the emission's model; without emission 1 − ρ_p (Kirchhoff)", "", true,
     emissivity<Quantity::kEmissivityP, rho_p>},
    {Plotted::kAlbedo, "albedo", "A(θ), ρ of perfectly reflecting facets", "", true, point_value<Quantity::kAlbedo>},
}};

Results evaluate(Evaluator& evaluator, const Scene& scene, const PointList& list, const RunOptions& options) {
  const Scene changed = list.changes.empty() ? scene : scene.with(list.changes);
  if (!list.is_grid) return evaluator.evaluate(changed, list.columns(), options);
  const Table table = evaluator.table(with_grid(changed, list), options);
  return {table.values(), table.values().quantities(), table.values().stokes_units};
}

std::vector<double>& PointList::operator[](const std::string& name) {
  const auto found = std::ranges::find(values, name, &decltype(values)::value_type::first);
  return found == values.end() ? values.emplace_back(name, std::vector<double>()).second : found->second;
}

std::size_t PointList::size() const {
  std::size_t size = 1;
  for (const auto& [name, column] : values) size = is_grid ? size * column.size() : std::max(size, column.size());
  return size;
}

bool has_wind(const Scene& scene) { return scene.number("surface.wind_m_s").has_value(); }

bool has_cross_slopes(const Scene& scene) {
  if (has_wind(scene)) return scene.word("surface.wind_model") == "directional";
  const std::optional<double> cross = scene.number("surface.sigma_cross");
  return cross && cross != scene.number("surface.sigma");
}

PointList points_at(const Scene& scene, std::vector<double> theta_deg) {
  const std::size_t count = theta_deg.size();
  PointList list{.values = {{"theta_deg", std::move(theta_deg)}}};
  for (const std::string name : {has_wind(scene) ? "wind_m_s" : "sigma", "q"})
    list[name].assign(count, scene.number("surface." + name).value());
  return list;
}

std::vector<Point> result_points(const PointList& list, const Results& results) {
  std::vector<Point> points;
  const std::vector<double>& theta_deg = list.values.front().second;
  for (std::size_t i = 0; i < results.status.size(); ++i)
    points.push_back({results.at(i), theta_deg[i < theta_deg.size() ? i : 0]});
  return points;
}

std::string status_text(std::uint32_t status) {
  constexpr std::array<const char*, kStatusBits.size()> kMeanings = {
      "ρ outside [0, 1]",           "tolerance missed",
      "outside the model's domain", "I ≤ 0",
      "tolerance of ρ missed",      "single scattering changes I or DOLP by over 5 %"};
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < kMeanings.size(); ++i) {
    if (status & kStatusBits[i].mask) texts.push_back(kMeanings[i]);
  }
  return texts.empty() ? "good" : join(texts);
}

}  // namespace dolp::explore
