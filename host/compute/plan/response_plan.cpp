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
  struct Part {
    Columns value;
    Columns apart;  ///< ColumnMoments::i_apart or q_apart
  };
  Responses(std::span<const Moments* const> moments, std::size_t responses) {
    const auto entries = static_cast<Eigen::Index>(moments.size());
    for (Columns* const part : {&i.value, &q.value, &i.apart, &q.apart, &error})
      *part = Columns::Zero(entries, static_cast<Eigen::Index>(responses));
    relative_error = Eigen::ArrayXd::Zero(entries);
    for (Eigen::Index row = 0; row < entries; ++row) {
      const std::vector<ColumnMoments>& columns = moments[static_cast<std::size_t>(row)]->columns;
      for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(columns.size()); ++j) {
        const ColumnMoments& column = columns[static_cast<std::size_t>(j)];
        i.value(row, j) = column.i;
        q.value(row, j) = column.q;
        i.apart(row, j) = column.i_apart;
        q.apart(row, j) = column.q_apart;
        error(row, j) = column.error;
      }
      if (!columns.empty()) relative_error(row) = columns.front().relative_error;
    }
  }
  Part i, q;
  Columns error;
  Eigen::ArrayXd relative_error;  ///< ColumnMoments::relative_error of each entry
};

/// A weighted sum of responses for each entry. The error bounds cover the errors of the responses, but not the
/// difference between a reflectance curve and its sum of polynomials.
struct Sums {
  Sums(const Responses& responses, const Responses::Part& part, const Columns& weights)
      : value(weighted_row_sums(weights, part.value)),
        error(weighted_row_sums(weights, part.apart).abs() + weighted_row_sums(weights.abs(), responses.error) +
              responses.relative_error * value.abs()) {}
  /// For the difference of two reflectance curves. If its sign changes, terms of a sum cancel. So relative errors refer
  /// to an upper bound of the sum: response 0, whose polynomial is 1, times the sum of all |weights|.
  void add_cancellation(const Responses& responses, const Columns& weights) {
    const Eigen::ArrayXd largest = responses.relative_error * responses.i.value.col(0);
    error += weighted_row_sums(weights.abs(), largest.replicate(1, weights.cols()));
  }
  Eigen::ArrayXd value, error;
};

/// The responses of some entries: for each pass, the moments that contain them and the same numbers as matrices.
struct Block {
  explicit Block(std::size_t passes) : moments(passes) {}
  void make_matrices(std::size_t count) {
    for (const std::vector<const Moments*>& pass : moments) responses.emplace_back(pass, count);
  }
  std::vector<std::vector<const Moments*>> moments;
  std::vector<Responses> responses;
  std::vector<double> cosine;   ///< cos(theta) of each entry
  std::vector<double> sharing;  ///< for each entry, how many entries share its responses
};

/// The sums of a block's responses with the weights of some indices.
class Combination {
 public:
  /// `weights`: one for each entry of the block, or one for all.
  Combination(const MomentsRequest& request, const Block& block, std::span<const ResponseWeights* const> weights)
      : request_(request), block_(block), weights_(weights), reference_weights_(request.basis->reference_weights()) {
    const auto rows = static_cast<Eigen::Index>(weights.size());
    absorbed_ = split_ = Columns(rows, static_cast<Eigen::Index>(request.basis->count()));
    for (Eigen::Index i = 0; i < rows; ++i) {
      const ResponseWeights& own = *weights[static_cast<std::size_t>(i)];
      absorbed_.row(i) = own.absorbed.transpose();
      split_.row(i) = own.split.transpose();
    }
    reflected_ = -absorbed_;
    reflected_.col(0) += 1.0;
  }

  /// Computes the moments of the block's entries. `entries`: where their moments are stored.
  void operator()(std::span<Moments* const> entries) const {
    add_reflected(entries);
    std::size_t pass = 1;
    if (request_.wants_direct) add_direct(pass++, entries);
    for (std::size_t k = 0; pass < block_.responses.size(); ++pass, ++k) add_sky(pass, k, entries);
  }

 private:
  /// Calls set(moments of an entry, its weights, its responses in a pass, its row).
  template <class Function>
  void for_all(std::size_t pass, std::span<Moments* const> entries, const Function& set) const {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const ResponseWeights& own = *weights_[std::min(i, weights_.size() - 1)];
      set(*entries[i], own, *block_.moments[pass][i], static_cast<Eigen::Index>(i));
    }
  }

  void add_reflected(std::span<Moments* const> entries) const {
    const Responses& all = block_.responses.front();
    const Sums i(all, all.i, reflected_), q(all, all.q, split_);
    // There are two ways to the moments of an index: a sum for its whole reflectance curve, or the moments of the
    // reference index plus a sum for the difference of the curves. The second is more accurate if the curves are
    // similar or if little light is absorbed.
    const Columns absorbed_apart = absorbed_.rowwise() - reference_weights_.absorbed.transpose().array();
    const Columns split_apart = split_.rowwise() - reference_weights_.split.transpose().array();
    Sums more_absorbed(all, all.i, absorbed_apart), more_split(all, all.q, split_apart);
    more_absorbed.add_cancellation(all, absorbed_apart);
    more_split.add_cancellation(all, split_apart);
    const auto passes = static_cast<double>(block_.responses.size());
    for_all(0, entries, [&](Moments& sum, const ResponseWeights& own, const Moments& from, Eigen::Index row) {
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

  void add_direct(std::size_t pass, std::span<Moments* const> entries) const {
    const Responses& all = block_.responses[pass];
    const Sums i(all, all.i, absorbed_), q(all, all.q, split_);
    for_all(pass, entries, [&](Moments& sum, const ResponseWeights& own, const Moments& from, Eigen::Index row) {
      const double projection = all.i.value(row, 0) + all.error(row, 0);
      sum.direct_i = i.value(row);
      sum.direct_q = -q.value(row);
      const double whole_error = from.direct_i_error * std::max(sum.direct_i / from.direct_i, 0.0);
      sum.direct_i_error = std::max(i.error(row) + own.absorbed_error * projection, whole_error);
      sum.direct_q_error = std::max(q.error(row) + i.error(row) + own.split_error * projection, whole_error);
    });
  }

  void add_sky(std::size_t pass, std::size_t function, std::span<Moments* const> entries) const {
    const Responses& all = block_.responses[pass];
    const Sums i(all, all.i, reflected_), q(all, all.q, split_);
    for_all(pass, entries, [&](Moments& sum, const ResponseWeights& own, const Moments& from, Eigen::Index row) {
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
  std::span<const ResponseWeights* const> weights_;
  const ResponseWeights& reference_weights_;
  Columns absorbed_, split_, reflected_;
};

ResponsePlan::Sources response_sources(const MomentsRequest& request) {
  std::vector<ResponsePlan::Source> sources(request.optics.size());
  parallel_for(sources.size(), 1, [&](std::size_t i) { sources[i] = request.basis->find_weights(request.optics[i]); });
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

/// Reads the responses of entries from the passes, or interpolates them, and adds them up.
class Combiner {
 public:
  /// `moments`: of all entries of the request.
  Combiner(const MomentsRequest& request, const ResponsePlan& plan, std::span<const std::vector<Moments>> passes,
           std::span<Moments> moments)
      : request_(request), plan_(plan), passes_(passes), moments_(moments) {
    for (const std::vector<Moments>& pass : passes) {
      if (plan.interpolation) panels_.push_back(panel_blocks(*plan.interpolation, pass));
    }
    if (!passes.empty()) users_.resize(plan.passes.front().bundles.size());
    for (std::size_t i = 0; i < plan.bundles.size(); ++i) {
      if (plan.bundles[i].other) continue;
      users_[plan.bundles[i].pass].push_back(i);
      const std::size_t count = request.bundles[i].count;
      for (std::size_t member = 0; member < count && (count == 1 || plan.interpolation); ++member)
        singles_.push_back({i, member});
    }
  }

  void combine() const {
    parallel_ranges(singles_.size(), kCombinedAtOnce, [&](std::size_t first, std::size_t last) {
      combine_singles(std::span(singles_).subspan(first, last - first));
    });
    parallel_for(plan_.interpolation ? 0 : users_.size(), 1, [&](std::size_t i) { combine_users(i); });
  }

 private:
  struct Single {
    std::size_t bundle, member;
  };

  double cosine(const Bundle& bundle) const { return cos_sin_deg(request_.theta_deg[bundle.direction]).cos; }
  const ResponseWeights* weights(const Bundle& bundle) const { return &*(*plan_.sources)[bundle.index]; }
  const Moments* known(std::size_t pass, std::size_t pass_bundle, std::size_t member) const {
    return &passes_[pass][plan_.passes[pass].bundles[pass_bundle].first_entry + member];
  }

  /// Combines the bundles that share the responses of a bundle of the passes, if they have several entries.
  void combine_users(std::size_t pass_bundle) const {
    const std::size_t count = plan_.passes.front().bundles[pass_bundle].count;
    const std::vector<std::size_t>& users = users_[pass_bundle];
    if (count == 1) return;
    Block block(passes_.size());
    block.cosine.assign(count, cosine(request_.bundles[users.front()]));
    block.sharing.assign(count, static_cast<double>(users.size()));
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      for (std::size_t i = 0; i < count; ++i) block.moments[pass].push_back(known(pass, pass_bundle, i));
    }
    block.make_matrices(request_.basis->count());
    std::vector<Moments*> entries(count);
    for (const std::size_t user : users) {
      const Bundle& bundle = request_.bundles[user];
      const ResponseWeights* const own = weights(bundle);
      for (std::size_t i = 0; i < count; ++i) entries[i] = &moments_[bundle.first_entry + i];
      Combination(request_, block, {&own, 1})(entries);
    }
  }

  void combine_singles(std::span<const Single> singles) const {
    Block block(passes_.size());
    std::vector<const ResponseWeights*> own;
    std::vector<Moments*> entries;
    std::vector<std::vector<Moments>> interpolated(passes_.size());
    for (std::vector<Moments>& pass : interpolated) pass.reserve(singles.size());  // keeps the addresses
    const Bundle* before = nullptr;
    for (const auto& [number, member] : singles) {
      const Bundle& bundle = request_.bundles[number];
      const std::uint32_t pass_bundle = plan_.bundles[number].pass;
      own.push_back(weights(bundle));
      entries.push_back(&moments_[bundle.first_entry + member]);
      block.cosine.push_back(cosine(bundle));
      block.sharing.push_back(static_cast<double>(users_[pass_bundle].size()));
      const bool is_repeated = before != nullptr && bundle.count == 1 && bundle.has_geometry(*before);
      for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
        std::vector<const Moments*>& moments = block.moments[pass];
        if (plan_.interpolation && !is_repeated)
          interpolated[pass].push_back(interpolate(*plan_.interpolation, panels_[pass],
                                                   request_.theta_deg[bundle.direction],
                                                   request_.bundle_shapes(bundle)[member]));
        moments.push_back(plan_.interpolation ? &interpolated[pass].back() : known(pass, pass_bundle, member));
      }
      before = &bundle;
    }
    block.make_matrices(request_.basis->count());
    Combination(request_, block, own)(entries);
  }

  const MomentsRequest& request_;
  const ResponsePlan& plan_;
  std::span<const std::vector<Moments>> passes_;
  std::span<Moments> moments_;
  std::vector<std::vector<ShapeBlock>> panels_;  ///< for each pass
  std::vector<std::vector<std::size_t>> users_;  ///< for each bundle of a pass, the bundles that use its responses
  std::vector<Single> singles_;  ///< entries that are combined together: of bundles with one entry, or interpolated
};

}  // namespace

std::size_t response_passes(bool wants_direct, std::size_t sky_functions) {
  return 1 + (wants_direct ? 1 : 0) + sky_functions;
}

std::optional<ResponsePlan> response_plan(const MomentsRequest& request, ResponsePlan::Sources known) {
  ResponsePlan plan{.sources = known ? std::move(known) : response_sources(request)};
  plan.interpolation = point_plan(request);
  MomentsRequest passes = request.without_entries(), others = passes;
  others.basis = nullptr;
  passes.optics = {request.basis->reference()};
  using GeometryKey = std::array<std::uint32_t, 3>;
  std::unordered_map<GeometryKey, std::uint32_t, boost::hash<GeometryKey>> known_passes;
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
  const auto share_geometry = [&](MomentsRequest& part) {
    part.theta_deg = request.theta_deg;
    part.shapes = request.shapes;
    part.members = request.members;
  };
  if (plan.interpolation) passes = plan.interpolation->shapes.nodes;
  const std::size_t pass_count = response_passes(request.wants_direct, request.sky ? request.sky->size() : 0);
  if (request.is_scattered && request.size() < kLeastResponseGain * passes.size() * pass_count) return std::nullopt;
  if (others.size() > 0) share_geometry(plan.others.emplace(std::move(others)));
  if (!plan.interpolation) share_geometry(passes);
  if (reached > 0) add_passes(plan, request, std::move(passes));
  return plan;
}

std::vector<Moments> combined(const MomentsRequest& request, const ResponsePlan& plan,
                              std::span<const std::vector<Moments>> passes, std::span<const Moments> others) {
  std::vector<Moments> moments(request.size());
  for (std::size_t i = 0; i < request.bundles.size(); ++i) {
    const std::optional<std::uint32_t>& other = plan.bundles[i].other;
    if (!other) continue;
    const auto from = others.begin() + static_cast<std::ptrdiff_t>(plan.others->bundles[*other].first_entry);
    std::copy_n(from, request.bundles[i].count,
                moments.begin() + static_cast<std::ptrdiff_t>(request.bundles[i].first_entry));
  }
  Combiner(request, plan, passes, moments).combine();
  return moments;
}

}  // namespace dolp
