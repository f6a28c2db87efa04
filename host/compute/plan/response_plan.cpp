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

constexpr std::size_t kCombinedAtOnce = 64;  // points that a thread combines in one step

/// The mask `wanted` of a second request, with other indices. Its index j must have each entry (direction and shape)
/// that `request` wants at any of its own indices in needed_by[j].
std::vector<char> wanted_mask(const MomentsRequest& request, const std::vector<std::vector<std::size_t>>& needed_by) {
  const std::size_t entries_per_index = request.theta_deg.size() * request.shapes();
  std::vector<char> wanted;
  for (const std::vector<std::size_t>& indices : needed_by) {
    for (std::size_t i = 0; !request.wanted.empty() && i < entries_per_index; ++i) {
      const auto wants = [&](std::size_t index) { return request.is_wanted(index * entries_per_index + i); };
      wanted.push_back(std::ranges::any_of(indices, wants) ? 1 : 0);
    }
  }
  return wanted;
}

/// Which pairs of an index and known responses are added up: all of them, or index i with the responses number i.
enum class Pairs : std::uint8_t { kAll, kEqual };

RowMajor products(Pairs pairs, const RowMajor& weights, const RowMajor& rows) {
  if (pairs == Pairs::kAll) return weighted_sums(weights, rows);
  return weights.cwiseProduct(rows.transpose()).rowwise().sum();
}

struct Responses {
  Responses(std::span<const Moments> moments, std::size_t responses, Pairs which) : all(kParts), pairs(which) {
    const auto shapes = static_cast<Eigen::Index>(moments.size());
    for (RowMajor& part : all) part = RowMajor::Zero(static_cast<Eigen::Index>(responses), shapes);
    relative_error = RowMajor::Zero(1, shapes);
    for (Eigen::Index shape = 0; shape < shapes; ++shape) {
      const std::vector<ColumnMoments>& columns = moments[static_cast<std::size_t>(shape)].columns;
      for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(columns.size()); ++j) {
        const ColumnMoments& column = columns[static_cast<std::size_t>(j)];
        all[kI](j, shape) = column.i;
        all[kQ](j, shape) = column.q;
        all[kIApart](j, shape) = column.i_apart;
        all[kQApart](j, shape) = column.q_apart;
        all[kError](j, shape) = column.error;
      }
      if (!columns.empty()) relative_error(shape) = columns.front().relative_error;
    }
  }
  enum Part : std::uint8_t { kI, kQ, kIApart, kQApart, kError, kParts };
  std::vector<RowMajor> all;  // one matrix (responses x shapes) per Part, for one direction
  RowMajor relative_error;    ///< ColumnMoments::relative_error of each shape
  Pairs pairs;
};

/// Weighted sums of responses, with a row for each index and, if all pairs are added up, a column for each shape. The
/// error bounds cover the errors of the responses, but not the difference between a reflectance curve and its sum of
/// polynomials.
struct Sums {
  Sums(const Responses& responses, Responses::Part of, Responses::Part apart, const RowMajor& weights)
      : value(products(responses.pairs, weights, responses.all[of])),
        error(products(responses.pairs, weights, responses.all[apart]).cwiseAbs() +
              products(responses.pairs, weights.cwiseAbs(), responses.all[Responses::kError])) {
    const auto relative = responses.relative_error.row(0);
    if (responses.pairs == Pairs::kAll) error += value.cwiseAbs() * relative.asDiagonal();
    if (responses.pairs == Pairs::kEqual) error += relative.asDiagonal() * value.cwiseAbs();
  }
  /// Sums for the difference of two reflectance curves. If its sign changes, terms of a sum cancel. So relative errors
  /// refer to an upper bound of the sum: response 0, whose polynomial is 1, times the sum of all |weights|.
  static Sums difference(const Responses& responses, Responses::Part of, Responses::Part apart,
                         const RowMajor& weights) {
    Sums sums(responses, of, apart, weights);
    const RowMajor largest = weights.cwiseAbs().rowwise().sum();
    sums.error +=
        products(responses.pairs, largest, responses.relative_error.cwiseProduct(responses.all[Responses::kI].row(0)));
    return sums;
  }
  RowMajor value;
  RowMajor error;
};

/// Places of a pair of an index and responses: its row and column in Sums, and the position of the responses.
struct Pair {
  Eigen::Index row = 0;
  Eigen::Index column = 0;
  std::size_t shape = 0;
};

class Combination {
 public:
  /// `weights`: for each index, its weights.
  Combination(const MomentsRequest& request, Pairs pairs, std::vector<const ResponseWeights*> weights)
      : request_(request), pairs_(pairs), weights_(std::move(weights)) {
    const ResponseWeights& reference = request.basis->reference_weights();
    const auto rows = static_cast<Eigen::Index>(weights_.size());
    absorbed_ = split_ = RowMajor(rows, static_cast<Eigen::Index>(request.basis->count()));
    for (Eigen::Index i = 0; i < rows; ++i) {
      const ResponseWeights& own = *weights_[static_cast<std::size_t>(i)];
      absorbed_.row(i) = own.absorbed.transpose();
      split_.row(i) = own.split.transpose();
    }
    absorbed_apart_ = absorbed_.rowwise() - reference.absorbed.transpose();
    split_apart_ = split_.rowwise() - reference.split.transpose();
    reflected_ = -absorbed_;
    if (rows > 0) reflected_.col(0).array() += 1.0;
  }

  std::size_t indices() const { return weights_.size(); }

  /// Computes `moments` (indices x shapes, or indices) from the moments in `passes`. `cosine`: of the directions of the
  /// shapes; only one if all pairs are added up.
  void operator()(std::span<const double> cosine, std::span<const std::span<const Moments>> passes,
                  std::span<Moments> moments) const {
    add_reflected(cosine, passes, moments);
    std::size_t pass = 1;
    if (request_.wants_direct) add_direct(passes[pass++], moments);
    for (std::size_t k = 0; pass < passes.size(); ++pass, ++k) add_sky(passes[pass], k, moments);
  }

 private:
  template <class Function>
  void for_all(std::size_t shapes, std::span<Moments> moments, const Function& set) const {
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (pairs_ == Pairs::kEqual) set(moments[i], *weights_[i], Pair{row, 0, i});
      for (std::size_t shape = 0; pairs_ == Pairs::kAll && shape < shapes; ++shape)
        set(moments[i * shapes + shape], *weights_[i], Pair{row, static_cast<Eigen::Index>(shape), shape});
    }
  }

  void add_reflected(std::span<const double> cosine, std::span<const std::span<const Moments>> passes,
                     std::span<Moments> moments) const {
    const std::span<const Moments> reference = passes.front();
    const Responses all(reference, request_.basis->count(), pairs_);
    const Sums i(all, Responses::kI, Responses::kIApart, reflected_);
    const Sums q(all, Responses::kQ, Responses::kQApart, split_);
    // There are two ways to the moments of an index: a sum for its whole reflectance curve, or the moments of the
    // reference index plus a sum for the difference of the curves. The second is more accurate if the curves are
    // similar or if little light is absorbed.
    const Sums more_absorbed = Sums::difference(all, Responses::kI, Responses::kIApart, absorbed_apart_);
    const Sums more_split = Sums::difference(all, Responses::kQ, Responses::kQApart, split_apart_);
    const ResponseWeights& reference_weights = request_.basis->reference_weights();
    const std::size_t sharing = pairs_ == Pairs::kAll ? weights_.size() : 1;
    const double evaluations_share = static_cast<double>(passes.size()) / static_cast<double>(sharing);
    for_all(reference.size(), moments, [&](Moments& sum, const ResponseWeights& own, const Pair& at) {
      const Moments& from = reference[at.shape];
      sum.albedo = from.albedo;
      sum.albedo_error = from.albedo_error;
      const double albedo = from.albedo + from.albedo_error;
      sum.r_i = i.value(at.row, at.column);
      sum.r_q = q.value(at.row, at.column);
      sum.r_i_error = i.error(at.row, at.column) + own.absorbed_error * albedo;
      sum.r_q_error = q.error(at.row, at.column) + i.error(at.row, at.column) + own.split_error * albedo;
      const double apart_error =
          more_absorbed.error(at.row, at.column) + (own.absorbed_error + reference_weights.absorbed_error) * albedo;
      if (from.r_i_error + apart_error < sum.r_i_error) {
        sum.r_i = from.r_i - more_absorbed.value(at.row, at.column);
        sum.r_q = from.r_q + more_split.value(at.row, at.column);
        sum.r_i_error = from.r_i_error + apart_error;
        sum.r_q_error = from.r_q_error + more_split.error(at.row, at.column) + more_absorbed.error(at.row, at.column) +
                        (own.split_error + reference_weights.split_error) * albedo;
      }
      // The error estimate of a sum may be too small, because differences between rules cancel by chance. So the
      // relative error bound of r_i is at least the bound at the reference index.
      const double whole_error = from.r_i_error * std::max(sum.r_i / from.r_i, 0.0);
      sum.r_i_error = std::max(sum.r_i_error, whole_error);
      sum.r_q_error = std::max(sum.r_q_error, whole_error);
      sum.deficit = from.deficit + more_absorbed.value(at.row, at.column);
      sum.deficit_error = from.deficit_error + apart_error;
      sum.evaluations = evaluations_share * from.evaluations;
      take_complement(sum, cosine[pairs_ == Pairs::kAll ? 0 : at.shape]);
    });
  }

  void add_direct(std::span<const Moments> pass, std::span<Moments> moments) const {
    const Responses all(pass, request_.basis->count(), pairs_);
    const Sums i(all, Responses::kI, Responses::kIApart, absorbed_);
    const Sums q(all, Responses::kQ, Responses::kQApart, split_);
    for_all(pass.size(), moments, [&](Moments& sum, const ResponseWeights& own, const Pair& at) {
      const auto column = static_cast<Eigen::Index>(at.shape);
      const double projection = all.all[Responses::kI](0, column) + all.all[Responses::kError](0, column);
      sum.direct_i = i.value(at.row, at.column);
      sum.direct_q = -q.value(at.row, at.column);
      const Moments& from = pass[at.shape];
      const double whole_error = from.direct_i_error * std::max(sum.direct_i / from.direct_i, 0.0);
      sum.direct_i_error = std::max(i.error(at.row, at.column) + own.absorbed_error * projection, whole_error);
      sum.direct_q_error =
          std::max(q.error(at.row, at.column) + i.error(at.row, at.column) + own.split_error * projection, whole_error);
    });
  }

  void add_sky(std::span<const Moments> pass, std::size_t function, std::span<Moments> moments) const {
    const Responses all(pass, request_.basis->count(), pairs_);
    const Sums i(all, Responses::kI, Responses::kIApart, reflected_);
    const Sums q(all, Responses::kQ, Responses::kQApart, split_);
    for_all(pass.size(), moments, [&](Moments& sum, const ResponseWeights& own, const Pair& at) {
      const Moments& from = pass[at.shape];
      // Light cancels, because the sky's function changes its sign. So relative errors refer to r_i, not to the sum.
      const double relative = all.relative_error(static_cast<Eigen::Index>(at.shape)) * std::abs(sum.r_i);
      sum.columns.resize(function + 1);
      sum.columns[function] = {i.value(at.row, at.column), q.value(at.row, at.column),
                               std::max(i.error(at.row, at.column), q.error(at.row, at.column)) + relative +
                                   std::max(own.absorbed_error, own.split_error) * (from.albedo + from.albedo_error)};
    });
  }

  const MomentsRequest& request_;
  Pairs pairs_;
  std::vector<const ResponseWeights*> weights_;
  RowMajor absorbed_, split_, absorbed_apart_, split_apart_, reflected_;
};

}  // namespace

ResponsePlan ResponsePlan::select_directions(std::span<const std::size_t> directions) const {
  ResponsePlan part{.sources = sources};
  for (const MomentsRequest& pass : passes) part.passes.push_back(pass.select_directions(directions));
  if (others) part.others = others->select_directions(directions);
  return part;
}

std::size_t response_passes(bool wants_direct, std::size_t sky_functions) {
  return 1 + (wants_direct ? 1 : 0) + sky_functions;
}

namespace {

std::vector<ResponsePlan::Source> response_sources(const ResponseBasis& basis, std::span<const FacetOptics> indices) {
  std::vector<ResponsePlan::Source> sources(indices.size());
  parallel_for(sources.size(), 1, [&](std::size_t i) { sources[i].weights = basis.find_weights(indices[i]); });
  return sources;
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

MomentsRequest without_entries(const MomentsRequest& request) {
  MomentsRequest empty = request;
  empty.basis = nullptr;
  for (std::vector<double>* const axis : {&empty.theta_deg, &empty.sigma, &empty.q}) axis->clear();
  empty.optics.clear();
  empty.wanted.clear();
  return empty;
}

struct HashOfPoint {
  std::size_t operator()(const FacetOptics& optics) const {
    std::size_t hash = 0;
    for (const double number : {optics.index.n, optics.index.k}) boost::hash_combine(hash, number);
    for (const Film& film : optics.films) boost::hash_combine(hash, film.thickness);
    return hash;
  }
  std::size_t operator()(const std::array<double, 3>& geometry) const { return boost::hash_value(geometry); }
};

std::optional<ResponsePlan> plan_of_points(const MomentsRequest& request) {
  ResponsePlan plan;
  plan.points.resize(request.size());
  plan.interpolation = point_plan(request);
  MomentsRequest passes = plan.interpolation ? plan.interpolation->shapes.nodes : without_entries(request);
  std::unordered_map<std::array<double, 3>, std::uint32_t, HashOfPoint> known;
  for (std::uint32_t i = 0; i < request.size(); ++i) {
    if (request.continues(i)) {
      plan.points[i].pass = plan.points[i - 1].pass;
    } else if (plan.interpolation) {
      plan.points[i].pass = i;
    } else {
      const auto position = static_cast<std::uint32_t>(passes.size());
      const auto [pass, is_new] = known.try_emplace({request.theta_deg[i], request.sigma[i], request.q[i]}, position);
      if (is_new) passes.append({request.theta_deg[i], {request.sigma[i], request.q[i]}, request.basis->reference()});
      plan.points[i].pass = pass->second;
    }
  }
  const std::size_t pass_count = response_passes(request.wants_direct, request.sky ? request.sky->size() : 0);
  if (request.size() < kLeastResponseGain * passes.size() * pass_count) return std::nullopt;

  std::unordered_map<FacetOptics, std::uint32_t, HashOfPoint> numbers;
  std::vector<FacetOptics> indices;
  for (std::size_t i = 0; i < request.size(); ++i) {
    const auto number = static_cast<std::uint32_t>(indices.size());
    const auto [source, is_new] = numbers.try_emplace(request.optics[i], number);
    if (is_new) indices.push_back(request.optics[i]);
    plan.points[i].source = source->second;
  }
  std::vector<ResponsePlan::Source> sources = response_sources(*request.basis, indices);
  MomentsRequest others = without_entries(request);
  for (std::size_t i = 0; i < request.size(); ++i) {
    const bool is_in_reach = !plan.interpolation || PointPlan::reaches(request.theta_deg[i]);
    if (sources[plan.points[i].source].weights && is_in_reach) continue;
    plan.points[i].other = static_cast<std::uint32_t>(others.size());
    others.append(request[i]);
  }
  plan.sources = std::make_shared<const std::vector<ResponsePlan::Source>>(std::move(sources));
  if (others.size() > 0) plan.others = std::move(others);
  add_passes(plan, request, std::move(passes));
  return plan;
}

ResponsePlan plan_of_grid(const MomentsRequest& request) {
  ResponsePlan plan;
  std::vector<ResponsePlan::Source> sources = response_sources(*request.basis, request.optics);
  MomentsRequest others = request;
  others.basis = nullptr;
  others.optics.clear();
  std::vector<std::size_t> reached;
  std::vector<std::vector<std::size_t>> beyond;
  for (std::size_t i = 0; i < request.optics.size(); ++i) {
    if (sources[i].weights) {
      reached.push_back(i);
      continue;
    }
    sources[i].other = others.optics.size();
    others.optics.push_back(request.optics[i]);
    beyond.push_back({i});
  }
  plan.sources = std::make_shared<const std::vector<ResponsePlan::Source>>(std::move(sources));
  others.wanted = wanted_mask(request, beyond);
  if (!others.optics.empty()) plan.others = std::move(others);
  if (reached.empty()) return plan;
  MomentsRequest reference = request;
  reference.optics = {request.basis->reference()};
  reference.wanted = wanted_mask(request, {reached});
  add_passes(plan, request, std::move(reference));
  return plan;
}

/// Reads the moments of a point from the passes, or interpolates them.
class PointReader {
 public:
  PointReader(const MomentsRequest& request, const ResponsePlan& plan, std::span<const std::vector<Moments>> passes)
      : request_(request), plan_(plan), passes_(passes), sharing_(request.size(), 0.0) {
    for (const ResponsePlan::PointSource& point : plan.points) sharing_[point.pass] += 1.0;
    for (const std::vector<Moments>& pass : passes) {
      if (plan.interpolation) panels_.push_back(panel_blocks(*plan.interpolation, pass));
    }
  }

  Moments read(std::size_t pass, std::size_t point) const {
    const std::size_t position = plan_.points[point].pass;
    if (plan_.interpolation)
      return interpolate(*plan_.interpolation, panels_[pass], request_.theta_deg[point], position);
    Moments moments = passes_[pass][position];
    moments.evaluations /= sharing_[position];
    return moments;
  }

 private:
  const MomentsRequest& request_;
  const ResponsePlan& plan_;
  std::span<const std::vector<Moments>> passes_;
  std::vector<double> sharing_;                  ///< for each position in a pass, how many points share it
  std::vector<std::vector<ShapeBlock>> panels_;  ///< for each pass
};

std::vector<Moments> combined_points(const MomentsRequest& request, const ResponsePlan& plan,
                                     std::span<const std::vector<Moments>> passes, std::span<const Moments> others) {
  std::vector<Moments> moments(request.size());
  std::vector<std::size_t> reached;  // points that are sums of responses
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const std::optional<std::uint32_t>& other = plan.points[i].other;
    if (other) moments[i] = others[*other];
    if (!other) reached.push_back(i);
  }
  const PointReader reader(request, plan, passes);
  parallel_ranges(reached.size(), kCombinedAtOnce, [&](std::size_t first, std::size_t last) {
    const std::span<const std::size_t> points = std::span(reached).subspan(first, last - first);
    std::vector<const ResponseWeights*> weights;
    std::vector<double> cosine;
    std::vector<std::vector<Moments>> read(passes.size());
    for (std::size_t j = 0; j < points.size(); ++j) {
      const ResponsePlan::PointSource& point = plan.points[points[j]];
      weights.push_back(&*(*plan.sources)[point.source].weights);
      cosine.push_back(cos_sin_deg(request.theta_deg[points[j]]).cos);
      const bool is_known = j > 0 && point.pass == plan.points[points[j - 1]].pass;
      for (std::size_t pass = 0; pass < passes.size(); ++pass)
        read[pass].push_back(is_known ? read[pass].back() : reader.read(pass, points[j]));
    }
    std::vector<Moments> own(points.size());
    const std::vector<std::span<const Moments>> known(read.begin(), read.end());
    Combination(request, Pairs::kEqual, std::move(weights))(cosine, known, own);
    for (std::size_t j = 0; j < own.size(); ++j) moments[points[j]] = std::move(own[j]);
  });
  return moments;
}

}  // namespace

std::optional<ResponsePlan> response_plan(const MomentsRequest& request) {
  return request.layout == MomentsRequest::Layout::kList ? plan_of_points(request) : plan_of_grid(request);
}

std::vector<Moments> combined(const MomentsRequest& request, const ResponsePlan& plan,
                              std::span<const std::vector<Moments>> passes, std::span<const Moments> others) {
  if (request.layout == MomentsRequest::Layout::kList) return combined_points(request, plan, passes, others);
  std::vector<const ResponseWeights*> weights;
  for (const ResponsePlan::Source& source : *plan.sources) {
    if (source.weights) weights.push_back(&*source.weights);
  }
  const Combination combine(request, Pairs::kAll, std::move(weights));
  const std::size_t shapes = request.shapes();
  const std::size_t directions = request.theta_deg.size();
  std::vector<Moments> moments(request.size());
  parallel_ranges(directions, 1, [&](std::size_t first, std::size_t last) {
    std::vector<Moments> own(combine.indices() * shapes);
    for (std::size_t theta = first; theta < last; ++theta) {
      std::vector<std::span<const Moments>> pass_moments;
      for (const std::vector<Moments>& pass : passes)
        pass_moments.push_back(std::span(pass).subspan(theta * shapes, shapes));
      const double cosine = cos_sin_deg(request.theta_deg[theta]).cos;
      if (!pass_moments.empty()) combine({&cosine, 1}, pass_moments, own);
      std::size_t position = 0;
      for (std::size_t i = 0; i < plan.sources->size(); ++i) {
        const ResponsePlan::Source& source = (*plan.sources)[i];
        const auto from = source.weights ? std::span<const Moments>(own).subspan(position++ * shapes, shapes)
                                         : others.subspan((source.other * directions + theta) * shapes, shapes);
        std::ranges::copy(from, moments.begin() + static_cast<std::ptrdiff_t>((i * directions + theta) * shapes));
      }
    }
  });
  return moments;
}

}  // namespace dolp
