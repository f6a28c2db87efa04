#include "model/scene_entry.hpp"

#include <algorithm>
#include <numeric>

namespace dolp {
namespace {

// A grid is cut along theta first, because kernels share work among the entries of one direction.
constexpr std::array<Axis, kAxisCount> kCuttingOrder = {
    Axis::kViewZenith,    Axis::kRelativeAzimuth, Axis::kTheta, Axis::kMaterial,
    Axis::kBand,          Axis::kWavelength,      Axis::kN,     Axis::kK,
    Axis::kTemperature,   Axis::kSigma,           Axis::kQ,     Axis::kSigmaCross,
    Axis::kSurfaceAzimuth};

/// The member of the entry, or of its variant, that has the value on an axis of numbers.
double* value_at(SceneEntry& entry, SceneVariant& variant, Axis axis) {
  switch (axis) {
    case Axis::kTheta:
      return &entry.theta_deg;
    case Axis::kSigma:
      return &entry.shape.sigma;
    case Axis::kQ:
      return &entry.shape.q;
    case Axis::kSigmaCross:
      return &entry.shape.sigma_cross;
    case Axis::kSurfaceAzimuth:
      return &entry.shape.azimuth_deg;
    case Axis::kN:
      return &entry.index->n;
    case Axis::kK:
      return &entry.index->k;
    case Axis::kViewZenith:
      return &*entry.view_zenith_deg;
    case Axis::kRelativeAzimuth:
      return &*entry.relative_azimuth_deg;
    case Axis::kWavelength:
      return &*variant.wavelength_um;
    case Axis::kTemperature:
      return &*variant.temperature_K;
    default:
      return nullptr;
  }
}

}  // namespace

Axes make_axes(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q,
               std::vector<double> wavelength_um, std::vector<double> n, std::vector<double> k) {
  Axes axes;
  axes[Axis::kWavelength] = std::move(wavelength_um);
  axes[Axis::kN] = std::move(n);
  axes[Axis::kK] = std::move(k);
  axes[Axis::kTheta] = std::move(theta_deg);
  axes[Axis::kSigma] = std::move(sigma);
  axes[Axis::kQ] = std::move(q);
  return axes;
}

Axes axes_part(const Axes& axes, const GridBox& box) {
  Axes part;
  for (const Axis axis : kAllAxes) {
    const auto begin = axes[axis].begin() + static_cast<std::ptrdiff_t>(box.first[axis]);
    if (!axes[axis].empty()) part[axis] = {begin, begin + static_cast<std::ptrdiff_t>(box.count[axis])};
  }
  return part;
}

std::vector<GridBox> grid_boxes(const PerAxis& counts, std::size_t most, const std::array<Axis, kAxisCount>& order) {
  std::vector<GridBox> boxes;
  const std::function<void(GridBox, std::size_t)> cut_along = [&](GridBox box, std::size_t number) {
    const Axis axis = order[number];
    const std::size_t entries_per_value = grid_size(box.count) / box.count[axis];
    const std::size_t fit = std::clamp<std::size_t>(most / entries_per_value, 1, counts[axis]);
    for (std::size_t i = 0; i < counts[axis]; i += fit) {
      box.first[axis] = i;
      box.count[axis] = std::min(fit, counts[axis] - i);
      if (entries_per_value > most && number + 1 < order.size()) {
        cut_along(box, number + 1);
      } else {
        boxes.push_back(box);
      }
    }
  };
  if (grid_size(counts) > 0) cut_along({{}, counts}, 0);
  return boxes;
}

PerAxis positions_on_axes(std::size_t position, const PerAxis& counts) {
  PerAxis on_axes = {};
  for (std::size_t i = kAxisCount; i-- > 0 && position > 0;) {
    if (counts[i] == 1) continue;  // most tables lack most axes, and a division takes time
    on_axes[i] = position % counts[i];
    position /= counts[i];
  }
  return on_axes;
}

PerAxis axis_counts(const Axes& axes) {
  PerAxis counts;
  std::ranges::transform(axes, counts.begin(),
                         [](const auto& values) { return std::max<std::size_t>(values.size(), 1); });
  return counts;
}

std::size_t grid_size(const PerAxis& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::size_t{1}, std::multiplies<>());
}

void set_value(SceneVariant& variant, Axis axis, double value) {
  if (axis == Axis::kMaterial) variant.material = static_cast<std::uint32_t>(value);
  if (axis == Axis::kBand) variant.band = static_cast<std::uint32_t>(value);
  if (axis == Axis::kWavelength) variant.wavelength_um = value;
  if (axis == Axis::kTemperature) variant.temperature_K = value;
}

std::vector<SceneVariant> grid_variants(const Axes& axes) {
  std::vector<SceneVariant> variants = {{}};
  for (const Axis axis : kVariantAxes) {
    if (axes[axis].empty()) continue;
    std::vector<SceneVariant> product;
    for (const SceneVariant& variant : variants) {
      for (const double value : axes[axis]) set_value(product.emplace_back(variant), axis, value);
    }
    variants = std::move(product);
  }
  return variants;
}

SceneEntries SceneEntries::grid(Axes axes, const OpticalConstants& index, const CrossSlopes& slopes) {
  SceneEntries entries;
  entries.is_grid_ = true;
  entries.counts_ = axis_counts(axes);
  for (const Axis axis : kAllAxes) {
    if (describe(axis).is_required && axes[axis].empty()) entries.counts_ = {};
  }
  entries.variants_ = grid_variants(axes);
  entries.whole_ = entries.counts_;
  entries.whole_axes_ = std::make_shared<const Axes>(axes);
  entries.axes_ = std::move(axes);
  entries.index_ = index;
  entries.slopes_ = slopes;
  return entries;
}

SceneEntries SceneEntries::grid(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q) {
  return grid(make_axes(std::move(theta_deg), std::move(sigma), std::move(q)), {});
}

std::size_t SceneEntries::variant_at(const PerAxis& on_axes) const {
  std::size_t variant = 0;
  for (const Axis axis : kVariantAxes) variant = variant * counts_[axis] + on_axes[axis];
  return variant;
}

OpticalConstants SceneEntries::index_at(const PerAxis& on_axes) const {
  const auto at = [&](Axis axis, double scene_value) {
    return axes_[axis].empty() ? scene_value : axes_[axis][on_axes[axis]];
  };
  return {at(Axis::kN, index_.n), at(Axis::kK, index_.k)};
}

SceneEntry SceneEntries::grid_entry(const PerAxis& at) const {
  SceneEntry result;
  result.theta_deg = theta_deg()[at[Axis::kTheta]];
  result.shape = slopes_.shape(sigma()[at[Axis::kSigma]], q()[at[Axis::kQ]]);
  if (!axes_[Axis::kN].empty() || !axes_[Axis::kK].empty()) result.index = index_at(at);
  const auto take = [&](Axis axis, auto& member) {
    if (!axes_[axis].empty()) member = axes_[axis][at[axis]];
  };
  take(Axis::kSigmaCross, result.shape.sigma_cross);
  take(Axis::kSurfaceAzimuth, result.shape.azimuth_deg);
  take(Axis::kViewZenith, result.view_zenith_deg);
  take(Axis::kRelativeAzimuth, result.relative_azimuth_deg);
  result.variant = static_cast<std::uint32_t>(variant_at(at));
  return result;
}

SceneEntries SceneEntries::part(const GridBox& box) const {
  SceneEntries part = grid(axes_part(axes_, box), index_, slopes_);
  part.whole_ = whole_;
  part.whole_axes_ = whole_axes_;
  for (const Axis axis : kAllAxes) part.first_[axis] = first_[axis] + box.first[axis];
  return part;
}

bool SceneEntries::has_own_cross_slopes() const {
  if (is_grid_) return !axes_[Axis::kSigmaCross].empty();
  return std::ranges::any_of(points_, [](const SceneEntry& entry) { return entry.shape.sigma_cross > 0.0; });
}

bool SceneEntries::has_own_index() const {
  if (is_grid_) return !axes_[Axis::kN].empty() || !axes_[Axis::kK].empty();
  return std::ranges::any_of(points_, [](const SceneEntry& point) { return point.index.has_value(); });
}

std::vector<OpticalConstants> SceneEntries::own_indices() const {
  std::vector<OpticalConstants> indices;
  for (const SceneEntry& point : points_)
    if (point.index) indices.push_back(*point.index);
  PerAxis on_axes{};
  for (std::size_t n = 0; is_grid_ && has_own_index() && n < counts_[Axis::kN]; ++n) {
    for (std::size_t k = 0; k < counts_[Axis::kK]; ++k) {
      on_axes[Axis::kN] = n;
      on_axes[Axis::kK] = k;
      indices.push_back(index_at(on_axes));
    }
  }
  return indices;
}

void SceneEntries::for_each_run(const SceneEntries& whole, const std::function<void(const GridRun&)>& use) const {
  if (is_grid_) dolp::for_each_run({first_in(whole), counts_}, whole.counts_, use);
  if (!is_grid_) use({0, first_point_ - whole.first_point_, size()});
}

std::optional<std::size_t> SceneEntries::find_position(std::size_t in_whole) const {
  if (!is_grid_) {
    const bool is_here = in_whole >= first_point_ && in_whole - first_point_ < size();
    return is_here ? std::optional(in_whole - first_point_) : std::nullopt;
  }
  const PerAxis on_axes = positions_on_axes(in_whole, whole_);
  std::size_t position = 0;
  for (std::size_t i = 0; i < on_axes.size(); ++i) {
    if (on_axes[i] < first_[i] || on_axes[i] >= first_[i] + counts_[i]) return std::nullopt;
    position = position * counts_[i] + on_axes[i] - first_[i];
  }
  return position;
}

PerAxis SceneEntries::first_in(const SceneEntries& whole) const {
  PerAxis first = first_;
  for (std::size_t i = 0; i < first.size(); ++i) first[i] -= whole.first_[i];
  return first;
}

bool SceneEntries::has_values(Axis axis) const {
  const bool is_index = axis == Axis::kN || axis == Axis::kK;
  if (is_grid_) return is_index ? has_own_index() : describe(axis).is_required || !axes_[axis].empty();
  const auto all_have = [&](const auto member) {
    return std::ranges::all_of(points_, [&](const SceneEntry& point) { return (point.*member).has_value(); });
  };
  switch (axis) {
    case Axis::kN:
    case Axis::kK:
      return all_have(&SceneEntry::index);
    case Axis::kViewZenith:
      return all_have(&SceneEntry::view_zenith_deg);
    case Axis::kRelativeAzimuth:
      return all_have(&SceneEntry::relative_azimuth_deg);
    case Axis::kSigmaCross:
      return has_own_cross_slopes();
    case Axis::kWavelength:
      return variants_.front().wavelength_um.has_value();
    case Axis::kTemperature:
      return variants_.front().temperature_K.has_value();
    default:
      return true;
  }
}

double SceneEntries::value(const SceneEntry& entry, Axis axis) const {
  SceneEntry copy = entry;
  SceneVariant variant = variants_[entry.variant];
  return *value_at(copy, variant, axis);
}

SceneEntries SceneEntries::changed(Axis axis, const std::function<double(double)>& change) const {
  if (is_grid_) {
    Axes axes = axes_;
    OpticalConstants index = index_;
    std::ranges::transform(axes[axis], axes[axis].begin(), change);
    if (axis == Axis::kN) index.n = change(index.n);
    if (axis == Axis::kK) index.k = change(index.k);
    return grid(std::move(axes), index, slopes_);
  }
  SceneEntries entries = *this;
  const bool is_of_variant = std::ranges::find(kVariantAxes, axis) != kVariantAxes.end();
  SceneEntry none;
  SceneVariant unused;
  for (SceneVariant& variant : entries.variants_)
    if (is_of_variant) *value_at(none, variant, axis) = change(*value_at(none, variant, axis));
  for (SceneEntry& point : entries.points_)
    if (!is_of_variant) *value_at(point, unused, axis) = change(*value_at(point, unused, axis));
  const bool follows_wind = axis == Axis::kSigma && slopes_.wind_model == WindModel::kDirectional;
  for (SceneEntry& point : entries.points_)
    if (follows_wind) point.shape.sigma_cross = sigma_across_wind(point.shape.sigma);
  return entries;
}

SceneEntries SceneEntries::chosen(std::span<const std::size_t> positions) const {
  constexpr std::uint32_t kUnused = 0xffffffffU;
  std::vector<std::uint32_t> number(variants_.size(), kUnused);
  std::vector<SceneVariant> variants;
  std::vector<SceneEntry> points;
  points.reserve(positions.size());
  for (const std::size_t position : positions) {
    SceneEntry& point = points.emplace_back((*this)[position]);
    std::uint32_t& variant_number = number[point.variant];
    if (variant_number == kUnused) {
      variant_number = static_cast<std::uint32_t>(variants.size());
      variants.push_back(variants_[point.variant]);
    }
    point.variant = variant_number;
  }
  if (variants.empty()) variants = {{}};
  return {std::move(points), std::move(variants), slopes_.wind_model};
}

std::vector<SceneEntries> SceneEntries::parts(std::size_t most) const {
  if (empty()) return {};
  if (size() <= most) return {*this};
  std::vector<SceneEntries> parts;
  for (std::size_t first = 0; !is_grid_ && first < size(); first += most) {
    std::vector<std::size_t> positions(std::min(most, size() - first));
    std::iota(positions.begin(), positions.end(), first);
    parts.push_back(chosen(positions));
    parts.back().first_point_ = first_point_ + first;
    parts.back().whole_points_ = whole_size();
  }
  if (!is_grid_) return parts;
  for (const GridBox& box : grid_boxes(counts_, most, kCuttingOrder)) parts.push_back(part(box));
  return parts;
}

const SceneEntry& EntryReader::operator[](std::size_t position) {
  if (!entries_.is_grid()) return entry_ = entries_[position];
  const bool is_next = position_ && position == *position_ + 1;
  position_ = position;
  const PerAxis& counts = entries_.counts();
  std::size_t axis = kAxisCount;  // the slowest axis on which the position changes
  while (is_next && axis-- > 0 && ++on_axes_[axis] == counts[axis]) on_axes_[axis] = 0;
  if (!is_next) on_axes_ = entries_.axis_positions(position);
  const bool is_only_q = counts[Axis::kSigmaCross] * counts[Axis::kSurfaceAzimuth] == 1;  // not q after a later axis
  if (axis != static_cast<std::size_t>(Axis::kQ) || !is_only_q) return entry_ = entries_.grid_entry(on_axes_);
  entry_.shape.q = entries_.q()[on_axes_[axis]];
  return entry_;
}

void for_each_run(const GridBox& part, const PerAxis& whole, const std::function<void(const GridRun&)>& use) {
  const PerAxis& count = part.count;
  // Entries that differ only on `slowest` or later axes are consecutive: the part has all values of the later axes.
  std::size_t slowest = count.size() - 1;
  while (slowest > 0 && count[slowest] == whole[slowest]) --slowest;
  const auto from = static_cast<std::ptrdiff_t>(slowest);
  const std::size_t entries_per_run =
      std::accumulate(count.begin() + from, count.end(), std::size_t{1}, std::multiplies<>());
  const std::size_t runs = grid_size(count) / entries_per_run;
  for (std::size_t run = 0; run < runs; ++run) {
    PerAxis at = part.first;
    for (std::size_t i = slowest, rest = run; i-- > 0;) {
      at[i] += rest % count[i];
      rest /= count[i];
    }
    std::size_t in_whole = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) in_whole = in_whole * whole[i] + at[i];
    use({run * entries_per_run, in_whole, entries_per_run});
  }
}

}  // namespace dolp
