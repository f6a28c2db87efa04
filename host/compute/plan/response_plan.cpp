#include "plan/response_plan.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/functional/hash.hpp>
#include <cmath>
#include <memory>
#include <unordered_map>
#include <utility>

#include "base/parallel_ranges.hpp"
#include "model/angles.hpp"
#include "model/sky_basis.hpp"
#include "plan/constants.hpp"
#include "plan/kernel_data.hpp"
#include "plan/weighted_sums.hpp"

namespace dolp {
namespace {

constexpr std::size_t kCombinedAtOnce = 64;  // entries that a thread combines in one step

using Columns = Eigen::ArrayXXd;  // a row for each entry, a column for each response

/// The responses of some entries.
struct Responses {
  Responses(std::span<const Moments* const> moments, std::size_t responses) {
    const auto entries = static_cast<Eigen::Index>(moments.size());
    for (Columns* const part : {&i, &q, &i_apart, &q_apart, &error})
      *part = Columns::Zero(entries, static_cast<Eigen::Index>(responses));
    relative_error = Eigen::ArrayXd::Zero(entries);
    for (Eigen::Index row = 0; row < entries; ++row) {
      const std::vector<ColumnMoments>& columns = moments[static_cast<std::size_t>(row)]->columns;
      for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(columns.size()); ++j) {
        const ColumnMoments& column = columns[static_cast<std::size_t>(j)];
        i(row, j) = column.i;
        q(row, j) = column.q;
        i_apart(row, j) = column.i_apart;
        q_apart(row, j) = column.q_apart;
        error(row, j) = column.error;
      }
      if (!columns.empty()) relative_error(row) = columns.front().relative_error;
    }
  }
  Columns i, q, i_apart, q_apart, error;
  Eigen::ArrayXd relative_error;  ///< ColumnMoments::relative_error of each entry
};

/// A weighted sum of responses for each entry. The error bounds cover the errors of the responses, but not the
/// difference between a reflectance curve and its sum of polynomials.
struct Sums {
  Sums(const Responses& responses, Columns Responses::*values, Columns Responses::*apart, const Columns& weights)
      : value(weighted_row_sums(weights, responses.*values)),
        error(weighted_row_sums(weights, responses.*apart).abs() + weighted_row_sums(weights.abs(), responses.error) +
              responses.relative_error * value.abs()) {}
  static Sums i(const Responses& responses, const Columns& weights) {
    return {responses, &Responses::i, &Responses::i_apart, weights};
  }
  static Sums q(const Responses& responses, const Columns& weights) {
    return {responses, &Responses::q, &Responses::q_apart, weights};
  }
  /// For the difference of two reflectance curves. If its sign changes, terms of a sum cancel. So relative errors refer
  /// to an upper bound of the sum: response 0, whose polynomial is 1, times the sum of all |weights|.
  void add_cancellation(const Responses& responses, const Columns& weights) {
    error += weights.abs().rowwise().sum() * responses.relative_error * responses.i.col(0);
  }
  Eigen::ArrayXd value, error;
};

/// Some entries that are sums of responses.
struct Block {
  std::vector<std::size_t> entries;             ///< their numbers in the request
  std::vector<const ResponseWeights*> weights;  ///< for each entry
  std::vector<double> cosine;                   ///< cos(theta) of each entry
  std::vector<double> sharing;                  ///< for each entry, how many entries share its responses
  std::vector<std::vector<const Moments*>> passes;  ///< for each pass, the responses of each entry
};

class Combination {
 public:
  Combination(const MomentsRequest& request, const Block& block)
      : request_(request), block_(block), reference_weights_(request.basis->reference_weights()) {
    const auto rows = static_cast<Eigen::Index>(block.weights.size());
    absorbed_ = split_ = Columns(rows, static_cast<Eigen::Index>(request.basis->count()));
    for (Eigen::Index i = 0; i < rows; ++i) {
      const ResponseWeights& own = *block.weights[static_cast<std::size_t>(i)];
      absorbed_.row(i) = own.absorbed.transpose();
      split_.row(i) = own.split.transpose();
    }
    reflected_ = -absorbed_;
    reflected_.col(0) += 1.0;
  }

  /// Computes the moments of the block's entries in `moments`, which has all entries of the request.
  void operator()(std::span<Moments> moments) const {
    add_reflected(moments);
    std::size_t pass = 1;
    if (request_.wants_direct) add_direct(block_.passes[pass++], moments);
    for (std::size_t k = 0; pass < block_.passes.size(); ++pass, ++k) add_sky(block_.passes[pass], k, moments);
  }

 private:
  /// Calls set(moments of an entry, its weights, its responses in `pass`, its row).
  template <class Function>
  void for_all(std::span<const Moments* const> pass, std::span<Moments> moments, const Function& set) const {
    for (std::size_t i = 0; i < pass.size(); ++i)
      set(moments[block_.entries[i]], *block_.weights[i], *pass[i], static_cast<Eigen::Index>(i));
  }

  void add_reflected(std::span<Moments> moments) const {
    const Responses all(block_.passes.front(), request_.basis->count());
    const Sums i = Sums::i(all, reflected_);
    const Sums q = Sums::q(all, split_);
    // There are two ways to the moments of an index: a sum for its whole reflectance curve, or the moments of the
    // reference index plus a sum for the difference of the curves. The second is more accurate if the curves are
    // similar or if little light is absorbed.
    const Columns absorbed_apart = absorbed_.rowwise() - reference_weights_.absorbed.transpose().array();
    const Columns split_apart = split_.rowwise() - reference_weights_.split.transpose().array();
    Sums more_absorbed = Sums::i(all, absorbed_apart);
    Sums more_split = Sums::q(all, split_apart);
    more_absorbed.add_cancellation(all, absorbed_apart);
    more_split.add_cancellation(all, split_apart);
    const auto passes = static_cast<double>(block_.passes.size());
    for_all(block_.passes.front(), moments,
            [&](Moments& sum, const ResponseWeights& own, const Moments& from, Eigen::Index row) {
              sum.albedo = from.albedo;
              sum.albedo_error = from.albedo_error;
              const double albedo = from.albedo + from.albedo_error;
              sum.r_i = i.value(row);
              sum.r_q = q.value(row);
              sum.r_i_error = i.error(row) + own.absorbed_error * albedo;
              sum.r_q_error = q.error(row) + i.error(row) + own.split_error * albedo;
              const double apart_error =
                  more_absorbed.error(row) + (own.absorbed_error + reference_weights_.absorbed_error) * albedo;
              if (from.r_i_error + apart_error < sum.r_i_error) {
                sum.r_i = from.r_i - more_absorbed.value(row);
                sum.r_q = from.r_q + more_split.value(row);
                sum.r_i_error = from.r_i_error + apart_error;
                sum.r_q_error = from.r_q_error + more_split.error(row) + more_absorbed.error(row) +
                                (own.split_error + reference_weights_.split_error) * albedo;
              }
              // The error estimate of a sum may be too small, because differences between rules cancel by chance. So
              // the relative error bound of r_i is at least the bound at the reference index.
              const double whole_error = from.r_i_error * std::max(sum.r_i / from.r_i, 0.0);
              sum.r_i_error = std::max(sum.r_i_error, whole_error);
              sum.r_q_error = std::max(sum.r_q_error, whole_error);
              sum.deficit = from.deficit + more_absorbed.value(row);
              sum.deficit_error = from.deficit_error + apart_error;
              const auto entry = static_cast<std::size_t>(row);
              sum.evaluations = passes * from.evaluations / block_.sharing[entry];
              take_complement(sum, block_.cosine[entry]);
            });
  }

  void add_direct(std::span<const Moments* const> pass, std::span<Moments> moments) const {
    const Responses all(pass, request_.basis->count());
    const Sums i = Sums::i(all, absorbed_);
    const Sums q = Sums::q(all, split_);
    for_all(pass, moments, [&](Moments& sum, const ResponseWeights& own, const Moments& from, Eigen::Index row) {
      const double projection = all.i(row, 0) + all.error(row, 0);
      sum.direct_i = i.value(row);
      sum.direct_q = -q.value(row);
      const double whole_error = from.direct_i_error * std::max(sum.direct_i / from.direct_i, 0.0);
      sum.direct_i_error = std::max(i.error(row) + own.absorbed_error * projection, whole_error);
      sum.direct_q_error = std::max(q.error(row) + i.error(row) + own.split_error * projection, whole_error);
    });
  }

  void add_sky(std::span<const Moments* const> pass, std::size_t function, std::span<Moments> moments) const {
    const Responses all(pass, request_.basis->count());
    const Sums i = Sums::i(all, reflected_);
    const Sums q = Sums::q(all, split_);
    for_all(pass, moments, [&](Moments& sum, const ResponseWeights& own, const Moments& from, Eigen::Index row) {
      // Light cancels, because the sky's function changes its sign. So relative errors refer to r_i, not to the sum.
      const double relative = all.relative_error(row) * std::abs(sum.r_i);
      sum.columns.resize(function + 1);
      sum.columns[function] = {i.value(row), q.value(row),
                               std::max(i.error(row), q.error(row)) + relative +
                                   std::max(own.absorbed_error, own.split_error) * (from.albedo + from.albedo_error)};
    });
  }

  const MomentsRequest& request_;
  const Block& block_;
  const ResponseWeights& reference_weights_;
  Columns absorbed_, split_, reflected_;
};

ResponsePlan::Sources response_sources(const MomentsRequest& request) {
  std::vector<ResponsePlan::Source> sources(request.optics.size());
  parallel_for(sources.size(), 1,
               [&](std::size_t i) { sources[i] = request.basis->find_weights(request.optics[i]); });
  return std::make_shared<const std::vector<ResponsePlan::Source>>(std::move(sources));
}

/// Adds passes for the entries of `reference`. `request`: the request of the plan.
void add_passes(ResponsePlan& plan, const MomentsRequest& request, MomentsRequest reference) {
  const ResponseBasis& basis = *request.basis;
  reference.basis = nullptr;
  reference.sky = nullptr;
  reference.wants_direct = false;
  reference.tolerance = request.finer_tolerance(plan.interpolation ? kPointNodeTolerance : kResponseTolerance);
  reference.response = {.count = basis.count(), .c0 = basis.c0(), .bend = basis.bend(), .of = Response::Of::kReflected};
  plan.passes.push_back(reference);
  if (request.wants_direct) {
    MomentsRequest& direct = plan.passes.emplace_back(reference);
    direct.wants_direct = true;
    direct.response->of = Response::Of::kDirect;
  }
  for (std::size_t k = 0; request.sky && k < request.sky->size(); ++k) {
    MomentsRequest& with_sky = plan.passes.emplace_back(reference);
    with_sky.sky = std::make_shared<const SkyBasis>(request.sky->only(k));
    with_sky.response->of = Response::Of::kSky;
  }
}

/// Reads the responses of entries from the passes, or interpolates them.
class ResponseReader {
 public:
  ResponseReader(const MomentsRequest& request, const ResponsePlan& plan,
                 std::span<const std::vector<Moments>> passes)
      : request_(request), plan_(plan), passes_(passes) {
    if (plan.passes.empty()) return;
    sharing_.assign(plan.passes.front().bundles.size(), 0.0);
    for (const ResponsePlan::BundleSource& bundle : plan.bundles) {
      if (!bundle.other) sharing_[bundle.pass] += 1.0;
    }
    for (const std::vector<Moments>& pass : passes) {
      if (plan.interpolation) panels_.push_back(panel_blocks(*plan.interpolation, pass));
    }
  }

  /// The block of entries that begins with the member `member` of a bundle. Both become those after the block.
  Block read(std::span<const std::size_t> entries, std::vector<std::vector<Moments>>& interpolated) const {
    Block block{.entries = {entries.begin(), entries.end()}, .passes = decltype(Block::passes)(passes_.size())};
    for (std::vector<Moments>& pass : interpolated) pass.reserve(entries.size());  // keeps the addresses
    std::size_t number = request_.find_bundle(entries.front());
    const Bundle* before = nullptr;
    for (const std::size_t entry : entries) {
      while (entry >= request_.bundles[number].first_entry + request_.bundles[number].count) ++number;
      const Bundle& bundle = request_.bundles[number];
      const std::uint32_t pass_bundle = plan_.bundles[number].pass;
      const double theta_deg = request_.theta_deg[bundle.direction];
      const std::size_t member = entry - bundle.first_entry;
      block.weights.push_back(&*(*plan_.sources)[bundle.index]);
      block.cosine.push_back(cos_sin_deg(theta_deg).cos);
      block.sharing.push_back(sharing_[pass_bundle]);
      for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
        std::vector<const Moments*>& known = block.passes[pass];
        if (!plan_.interpolation) {
          known.push_back(&passes_[pass][plan_.passes[pass].bundles[pass_bundle].first_entry + member]);
        } else if (before != nullptr && bundle.count == 1 && bundle.has_geometry(*before)) {
          known.push_back(known.back());
        } else {
          const std::uint32_t shape = request_.bundle_shapes(bundle)[member];
          interpolated[pass].push_back(interpolate(*plan_.interpolation, panels_[pass], theta_deg, shape));
          known.push_back(&interpolated[pass].back());
        }
      }
      before = &bundle;
    }
    return block;
  }

 private:
  const MomentsRequest& request_;
  const ResponsePlan& plan_;
  std::span<const std::vector<Moments>> passes_;
  std::vector<double> sharing_;                  ///< for each bundle of a pass, how many bundles share it
  std::vector<std::vector<ShapeBlock>> panels_;  ///< for each pass
};

}  // namespace

std::size_t response_passes(bool wants_direct, std::size_t sky_functions) {
  return 1 + (wants_direct ? 1 : 0) + sky_functions;
}

std::optional<ResponsePlan> response_plan(const MomentsRequest& request, ResponsePlan::Sources known) {
  ResponsePlan plan{.sources = known ? std::move(known) : response_sources(request)};
  plan.interpolation = point_plan(request);
  MomentsRequest passes = request, others = request;
  for (MomentsRequest* const part : {&passes, &others}) {
    part->basis = nullptr;
    part->bundles.clear();
    part->optics.clear();
  }
  passes.optics = {request.basis->reference()};
  using Geometry = std::array<std::uint32_t, 3>;
  std::unordered_map<Geometry, std::uint32_t, boost::hash<Geometry>> known_passes;
  std::unordered_map<std::uint32_t, std::uint32_t> known_others;  // from positions in request.optics to others.optics
  std::size_t reached = 0;
  for (const Bundle& bundle : request.bundles) {
    ResponsePlan::BundleSource& source = plan.bundles.emplace_back();
    const bool is_in_reach = !plan.interpolation || PointPlan::reaches(request.theta_deg[bundle.direction]);
    if (!(*plan.sources)[bundle.index] || !is_in_reach) {
      const auto [index, is_new] = known_others.try_emplace(bundle.index, others.optics.size());
      if (is_new) others.optics.push_back(request.optics[bundle.index]);
      source.other = static_cast<std::uint32_t>(others.bundles.size());
      others.add_bundle(bundle.direction, index->second, bundle.first, bundle.count);
      continue;
    }
    ++reached;
    if (plan.interpolation) continue;
    const auto [pass, is_new] = known_passes.try_emplace({bundle.direction, bundle.first, bundle.count},
                                                         static_cast<std::uint32_t>(passes.bundles.size()));
    if (is_new) passes.add_bundle(bundle.direction, 0, bundle.first, bundle.count);
    source.pass = pass->second;
  }
  if (plan.interpolation) passes = plan.interpolation->shapes.nodes;
  const std::size_t pass_count = response_passes(request.wants_direct, request.sky ? request.sky->size() : 0);
  if (request.is_scattered && request.size() < kLeastResponseGain * passes.size() * pass_count) return std::nullopt;
  if (others.size() > 0) plan.others = std::move(others);
  if (reached > 0) add_passes(plan, request, std::move(passes));
  return plan;
}

std::vector<Moments> combined(const MomentsRequest& request, const ResponsePlan& plan,
                              std::span<const std::vector<Moments>> passes, std::span<const Moments> others) {
  std::vector<Moments> moments(request.size());
  std::vector<std::size_t> reached;  // entries that are sums of responses
  for (std::size_t i = 0; i < request.bundles.size(); ++i) {
    const Bundle& bundle = request.bundles[i];
    const std::optional<std::uint32_t>& other = plan.bundles[i].other;
    for (std::size_t member = 0; member < bundle.count; ++member) {
      const std::size_t entry = bundle.first_entry + member;
      if (other) moments[entry] = others[plan.others->bundles[*other].first_entry + member];
      if (!other) reached.push_back(entry);
    }
  }
  const ResponseReader reader(request, plan, passes);
  parallel_ranges(reached.size(), kCombinedAtOnce, [&](std::size_t first, std::size_t last) {
    std::vector<std::vector<Moments>> interpolated(passes.size());
    const Block block = reader.read(std::span(reached).subspan(first, last - first), interpolated);
    Combination(request, block)(moments);
  });
  return moments;
}

}  // namespace dolp
