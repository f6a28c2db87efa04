#include "model/moments.hpp"

#include <algorithm>
#include <numeric>

namespace dolp {
namespace {

/// The position of `value` in `list`. Appends the value unless it is the last one.
template <class Value>
std::uint32_t last_position(std::vector<Value>& list, const Value& value) {
  if (list.empty() || !(list.back() == value)) list.push_back(value);
  return static_cast<std::uint32_t>(list.size() - 1);
}

}  // namespace

std::size_t MomentsRequest::find_bundle(std::size_t entry) const {
  const auto after = std::ranges::upper_bound(bundles, entry, {}, &Bundle::first_entry);
  return static_cast<std::size_t>(after - bundles.begin()) - 1;
}

MomentsPoint MomentsRequest::operator[](std::size_t entry) const {
  const Bundle& bundle = bundles[find_bundle(entry)];
  return {theta_deg[bundle.direction], shapes[members[bundle.first + entry - bundle.first_entry]],
          optics[bundle.index]};
}

double MomentsSettings::finer_tolerance(double share) const {
  const double finer = share * tolerance;
  return precision == Precision::kDouble ? finer : std::max(finer, std::min(kLeastFloatTolerance, tolerance));
}

bool MomentsRequest::has_elliptic_shapes() const { return std::ranges::any_of(shapes, is_elliptic); }

void MomentsRequest::set_grid() {
  bundles.clear();
  for (std::uint32_t index = 0; index < optics.size(); ++index) {
    for (std::uint32_t direction = 0; direction < theta_deg.size(); ++direction)
      bundles.push_back({.direction = direction, .index = index});
  }
  set_shapes(std::move(shapes));
}

void MomentsRequest::set_shapes(std::vector<SlopeShape> new_shapes) {
  shapes = std::move(new_shapes);
  members.resize(shapes.size());
  std::iota(members.begin(), members.end(), 0U);
  std::vector<Bundle> old;
  old.swap(bundles);
  for (const Bundle& bundle : old)
    add_bundle(bundle.direction, bundle.index, 0, static_cast<std::uint32_t>(shapes.size()));
}

void MomentsRequest::add_bundle(std::uint32_t direction, std::uint32_t index, std::uint32_t first,
                                std::uint32_t count) {
  bundles.push_back({direction, index, first, count, size()});
}

void MomentsRequest::append(const MomentsPoint& point) {
  has_lone_entries = true;
  const std::uint32_t shape = last_position(shapes, point.shape);
  if (members.size() < shapes.size()) members.push_back(shape);
  add_bundle(last_position(theta_deg, point.theta_deg), last_position(optics, point.index), shape, 1);
}

MomentsRequest MomentsRequest::without_entries() const {
  MomentsRequest empty;
  static_cast<MomentsSettings&>(empty) = *this;
  return empty;
}

MomentsRequest MomentsRequest::select_bundles(std::span<const std::size_t> positions) const {
  MomentsRequest part = *this;
  part.bundles.clear();
  for (const std::size_t i : positions)
    part.add_bundle(bundles[i].direction, bundles[i].index, bundles[i].first, bundles[i].count);
  return part;
}

MomentsRequest MomentsRequest::select_entries(std::span<const std::size_t> entries) const {
  MomentsRequest part = *this;
  part.bundles.clear();
  for (auto next = entries.begin(); next != entries.end();) {
    const Bundle& bundle = bundles[find_bundle(*next)];
    const auto first = static_cast<std::uint32_t>(part.members.size());
    for (; next != entries.end() && *next < bundle.first_entry + bundle.count; ++next)
      part.members.push_back(members[bundle.first + *next - bundle.first_entry]);
    const auto count = static_cast<std::uint32_t>(part.members.size()) - first;
    const bool is_whole = count == bundle.count;
    if (is_whole) part.members.resize(first);
    part.add_bundle(bundle.direction, bundle.index, is_whole ? bundle.first : first, count);
  }
  return part;
}

std::vector<SlopeShape> shape_product(std::span<const double> sigma, std::span<const double> q) {
  std::vector<SlopeShape> shapes;
  shapes.reserve(sigma.size() * q.size());
  for (const double own_sigma : sigma) {
    for (const double own_q : q) shapes.push_back({own_sigma, own_q});
  }
  return shapes;
}

}  // namespace dolp
