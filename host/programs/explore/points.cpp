#include "explore/points.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

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

std::vector<double>& PointList::operator[](const std::string& name) {
  const auto found = std::ranges::find(values, name, &decltype(values)::value_type::first);
  return found == values.end() ? values.emplace_back(name, std::vector<double>()).second : found->second;
}

std::size_t PointList::size() const {
  const auto column_size = [](const auto& column) { return column.second.size(); };
  return std::ranges::max(values | std::views::transform(column_size));
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
