#include "run/groove_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <ranges>

#include "base/parallel_ranges.hpp"
#include "model/chebyshev.hpp"
#include "plan/further_light.hpp"
#include "radiometry/radiometry.hpp"
#include "run/part_requests.hpp"

namespace dolp {
namespace {

// Shapes with a smaller sigma count as this one: only the tails of their slopes reach a second facet.
constexpr double kLeastSigma = 0.01;
constexpr double kLeastK = 0.01;              // differences of k far below this number do not change the reflection
constexpr double kLeastReflected = 1e-12;     // replaces i = 0 and 1 - i = 0, whose logits do not exist
constexpr std::size_t kWavelengthNodes = 32;  // of bare media, whose light changes slowly with the wavelength
constexpr std::size_t kOpticsAtOnce = 2;      // a thread's start takes as long as the light of about one
constexpr std::array kShapeAxes = {Axis::kSigma, Axis::kQ};

/// The nodes of an axis are Chebyshev-Lobatto points of `to(value)`; `from` is the inverse of `to`. An axis with at
/// most `most` values has its values as nodes.
struct Scale {
  std::size_t most = 1;
  std::function<double(double)> to, from;
};

Scale axis_scale(Axis axis) {
  const auto same = [](double x) { return x; };
  if (axis == Axis::kTheta) return {8, same, same};
  if (axis == Axis::kN) return {4, [](double n) { return std::log(n); }, [](double x) { return std::exp(x); }};
  if (axis == Axis::kQ)
    return {3, [](double q) { return std::log(q - 1.0); }, [](double x) { return 1.0 + std::exp(x); }};
  const double least = axis == Axis::kK ? kLeastK : 0.0;
  const double floor = axis == Axis::kSigma ? kLeastSigma : 0.0;
  return {4, [=](double value) { return std::log(std::max(value, floor) + least); },
          [=](double x) { return std::exp(x) - least; }};
}

GrooveTable::AxisNodes polynomial_nodes(const std::vector<double>& values, const Scale& scale) {
  std::vector<double> places;
  std::ranges::transform(values, std::back_inserter(places), scale.to);
  const auto [low, high] = std::ranges::minmax(places);
  const auto count = static_cast<Eigen::Index>(scale.most);
  const auto size = static_cast<Eigen::Index>(values.size());
  if (size <= count) {
    std::ranges::transform(places, places.begin(), scale.from);
    return {places, Eigen::MatrixXd::Identity(size, size)};
  }
  if (low == high) return {{scale.from(low)}, Eigen::MatrixXd::Ones(size, 1)};
  const std::vector<double> points = lobatto_points(count);
  GrooveTable::AxisNodes axis{{}, Eigen::MatrixXd(size, count)};
  for (const double point : points) axis.nodes.push_back(scale.from(std::lerp(low, high, 0.5 * (point + 1.0))));
  for (Eigen::Index i = 0; i < size; ++i) {
    const double place = places[static_cast<std::size_t>(i)];
    axis.weights.row(i) = cardinal_values(points, 2.0 * (place - low) / (high - low) - 1.0);
  }
  return axis;
}

}  // namespace

GrooveTable::GrooveTable(const SceneValues& scene, const SceneEntries& grid, const SpectralRules& rules)
    : zenith_axis_(moment_axis(scene)) {
  const Axes& axes = grid.whole_axes();
  for (const Axis axis : {Axis::kN, Axis::kK, Axis::kTheta, Axis::kSigma, Axis::kQ}) {
    std::vector<double> values = axes[axis == Axis::kTheta ? zenith_axis_ : axis];
    if (values.empty() && axis == Axis::kTheta) values = {scene.geometry.view_zenith_deg};
    if (values.empty()) values = {axis == Axis::kN ? grid.index().n : grid.index().k};
    axes_[axis] = polynomial_nodes(values, axis_scale(axis));
  }
  const PerAxis counts = axis_counts(axes);
  bands_ = counts[Axis::kBand];
  place_wavelengths(scene, grid);
  const std::size_t own_first = grid.first()[Axis::kWavelength], own_count = grid.counts()[Axis::kWavelength];
  std::vector<GroupOptics> all;
  for (std::size_t i = 0; i < counts[Axis::kMaterial] * bands_ * wavelength_nodes_.size(); ++i) {
    const std::size_t wavelength = wavelength_nodes_[i % wavelength_nodes_.size()];
    const std::size_t outer = i / wavelength_nodes_.size();
    SceneVariant variant;
    if (!axes[Axis::kMaterial].empty()) variant.material = static_cast<std::uint32_t>(outer / bands_);
    if (!axes[Axis::kBand].empty()) variant.band = static_cast<std::uint32_t>(outer % bands_);
    if (!axes[Axis::kWavelength].empty()) variant.wavelength_um = axes[Axis::kWavelength][wavelength];
    blocks_.emplace_back();
    const bool is_used = scene.surface.is_bare() || wavelength - own_first < own_count;
    if (is_used) add_optics(variant, grid, rules, all);
  }
  parallel_for(all.size(), kOpticsAtOnce, [&](std::size_t i) { fill(scene, all[i]); });
}

std::size_t GrooveTable::node_count(std::span<const Axis> axes) const {
  std::size_t count = 1;
  for (const Axis axis : axes) count *= axes_[axis].nodes.size();
  return count;
}

void GrooveTable::place_wavelengths(const SceneValues& scene, const SceneEntries& grid) {
  const std::vector<double>& um = grid.whole_axes()[Axis::kWavelength];
  const std::size_t size = std::max<std::size_t>(um.size(), 1);
  const bool is_bare = scene.surface.is_bare();
  std::size_t count = size;
  if (is_bare) count = grid.has_own_index() ? 1 : std::min(kWavelengthNodes, size);
  for (std::size_t i = 0; i < count; ++i) wavelength_nodes_.push_back(count == 1 ? 0 : i * (size - 1) / (count - 1));
  wavelengths_.resize(size);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const std::size_t first = wavelength_nodes_[i], last = wavelength_nodes_[i + 1];
    for (std::size_t j = first; j <= last; ++j) wavelengths_[j] = {i, (um[j] - um[first]) / (um[last] - um[first])};
  }
}

void GrooveTable::add_optics(const SceneVariant& variant, const SceneEntries& grid, const SpectralRules& rules,
                             std::vector<GroupOptics>& all) {
  Block& block = blocks_.back();
  const std::vector<FacetOptics> samples = rules.at(variant)->indices();
  std::size_t index_node = 0;
  for (const double n : axes_[Axis::kN].nodes) {
    for (const double k : axes_[Axis::kK].nodes) {
      const std::optional<OpticalConstants> index =
          grid.has_own_index() ? std::optional(OpticalConstants{n, k}) : std::nullopt;
      const std::vector<FacetOptics> own = with_index(samples, index);
      const std::vector<std::size_t> middles = middle_samples(own.size());
      block.groups = middles.size();
      for (std::size_t group = 0; group < middles.size(); ++group)
        all.push_back({blocks_.size() - 1, index_node, group, own[middles[group]]});
      ++index_node;
    }
  }
  block.logits.resize(node_count(kOuterAxes) * block.groups * node_count(kShapeAxes));
  block.quotients.resize(block.logits.size());
}

void GrooveTable::fill(const SceneValues& scene, const GroupOptics& own) {
  const GrooveFacet facet(own.optics);
  Block& block = blocks_[own.block];
  const std::vector<double>& thetas = axes_[Axis::kTheta].nodes;
  for (std::size_t i = 0; i < thetas.size(); ++i) {
    std::size_t at = ((own.index_node * thetas.size() + i) * block.groups + own.group) * node_count(kShapeAxes);
    for (const double sigma : axes_[Axis::kSigma].nodes) {
      for (const double q : axes_[Axis::kQ].nodes) {
        const FurtherLight light = further_light(scene.surface.distribution, thetas[i], {sigma, q}, facet);
        const double reflected = std::clamp(light.i, kLeastReflected, 1.0 - kLeastReflected);
        block.logits[at] = std::log(reflected / (1.0 - reflected));
        block.quotients[at++] = light.q / (reflected * (1.0 - reflected));
      }
    }
  }
}

void GrooveTable::Reader::begin_direction(const PerAxis& on) {
  const WavelengthPlace& wavelength = table_.wavelengths_[on[Axis::kWavelength]];
  const std::size_t outer = on[Axis::kMaterial] * table_.bands_ + on[Axis::kBand];
  const std::size_t before = outer * table_.wavelength_nodes_.size() + wavelength.node;
  groups_ = table_.blocks_[wavelength.share < 1.0 ? before : before + 1].groups;
  logits_.setZero(static_cast<Eigen::Index>(groups_ * table_.axes_[Axis::kSigma].nodes.size()),
                  static_cast<Eigen::Index>(table_.axes_[Axis::kQ].nodes.size()));
  quotients_.setZero(logits_.rows(), logits_.cols());
  if (wavelength.share < 1.0) add_block(table_.blocks_[before], 1.0 - wavelength.share, on);
  if (wavelength.share > 0.0) add_block(table_.blocks_[before + 1], wavelength.share, on);
}

void GrooveTable::Reader::add_block(const Block& block, double share, const PerAxis& on) {
  const auto size = static_cast<std::size_t>(logits_.size());
  for (std::size_t node = 0; node < table_.node_count(kOuterAxes); ++node) {
    double weight = share;
    std::size_t rest = node;
    for (const Axis axis : std::views::reverse(kOuterAxes)) {
      const Eigen::MatrixXd& weights = table_.axes_[axis].weights;
      weight *= weights(static_cast<Eigen::Index>(on[axis]), static_cast<Eigen::Index>(rest) % weights.cols());
      rest /= static_cast<std::size_t>(weights.cols());
    }
    if (weight == 0.0) continue;
    using Nodes = Eigen::Map<const RowMajor>;
    logits_ += weight * Nodes(block.logits.data() + node * size, logits_.rows(), logits_.cols());
    quotients_ += weight * Nodes(block.quotients.data() + node * size, logits_.rows(), logits_.cols());
  }
}

void GrooveTable::Reader::begin_row(std::size_t position) {
  const PerAxis part_first = part_.first();
  PerAxis on = part_.axis_positions(position);
  first_ = position - on[Axis::kQ];
  for (const Axis axis : kAllAxes) on[axis] += part_first[axis];
  PerAxis direction{};
  on[Axis::kTheta] = on[table_.zenith_axis_];
  for (const Axis axis : {Axis::kMaterial, Axis::kBand, Axis::kWavelength}) direction[axis] = on[axis];
  for (const Axis axis : kOuterAxes) direction[axis] = on[axis];
  if (direction_ != direction) begin_direction(*(direction_ = direction));
  const auto sigma = table_.axes_[Axis::kSigma].weights.row(static_cast<Eigen::Index>(on[Axis::kSigma]));
  const auto count = static_cast<Eigen::Index>(part_.q().size());
  const auto qs =
      table_.axes_[Axis::kQ].weights.middleRows(static_cast<Eigen::Index>(part_first[Axis::kQ]), count).transpose();
  const auto groups = static_cast<Eigen::Index>(groups_);
  row_.resize(part_.q().size() * groups_);
  for (Eigen::Index group = 0; group < groups; ++group) {
    const Eigen::Index first = group * sigma.cols();
    const Eigen::RowVectorXd logits = sigma * logits_.middleRows(first, sigma.cols());
    const Eigen::RowVectorXd quotients = sigma * quotients_.middleRows(first, sigma.cols());
    const Eigen::ArrayXd reflected = ((-(logits * qs).transpose()).array().exp() + 1.0).inverse();
    const Eigen::ArrayXd polarised = reflected * (1.0 - reflected) * (quotients * qs).transpose().array();
    for (Eigen::Index q = 0; q < count; ++q)
      row_[static_cast<std::size_t>(q * groups + group)] = {reflected[q], polarised[q]};
  }
}

std::span<const FurtherLight> GrooveTable::Reader::at(std::size_t position) {
  const std::size_t count = part_.q().size();
  if (!direction_ || position - first_ >= count) begin_row(position);
  return std::span(row_).subspan((position - first_) * groups_, groups_);
}

}  // namespace dolp
