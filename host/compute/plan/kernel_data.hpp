// All inputs of the kernel in double. The evaluators convert them to the kernel's precision.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "model/evaluator.hpp"
#include "model/moments.hpp"
#include "plan/sky_table.hpp"
#include "plan/slope_orders.hpp"

namespace dolp {

namespace kernel {
using real = double;
#include "interface.glsl"  // NOLINT: one source for host and shaders
}  // namespace kernel

template <class ToReal, class To, class FromReal, class From>
To convert_reals(const From& from) {
  constexpr std::size_t kCount = sizeof(From) / sizeof(FromReal);
  static_assert(kCount * sizeof(FromReal) == sizeof(From) && kCount * sizeof(ToReal) == sizeof(To));
  static_assert(std::is_trivially_copyable_v<From> && std::is_trivially_copyable_v<To>);
  const auto numbers = std::bit_cast<std::array<FromReal, kCount>>(from);
  std::array<ToReal, kCount> converted{};
  for (std::size_t i = 0; i < kCount; ++i) converted[i] = static_cast<ToReal>(numbers[i]);
  return std::bit_cast<To>(converted);
}

inline constexpr unsigned kRootAbove = 1;  ///< the integrand has a square root just above the breakpoint
inline constexpr unsigned kRootBelow = 2;  ///< the integrand has a square root just below the breakpoint

/// The pieces of the slope axis of one direction; ThetaNode has their ends.
struct Pieces {
  std::uint32_t count = 0;
  std::array<std::uint8_t, DOLP_MAX_PIECES + 3> roots{};  ///< bits kRootAbove, kRootBelow of each end
  /// Largest number of nodes of an arc, per piece. Drivers may stop an invocation after 65,535 iterations of loops,
  /// without an error and with wrong sums. With these numbers, all invocations end earlier.
  std::array<std::uint8_t, DOLP_MAX_PIECES + 1> most_nodes{};
  /// One number per piece. Pieces with equal numbers have equal loop bounds, see kLockstep in vulkan/tiles.hpp.
  std::array<std::uint16_t, DOLP_MAX_PIECES> lockstep{};
  bool has_split_line = false;  ///< a kink of the masking splits the pieces (DirectionVariant::has_line)
};

/// Positions of one entry in three lists of KernelData.
struct MomentsEntry {
  std::uint32_t theta = 0;
  std::uint32_t shape = 0;
  std::uint32_t index = 0;
};

/// Error bounds of the reflectance table (ReflectanceCurve) of one refractive index.
struct CurveError {
  double absolute = 0.0;
  double per_roundoff = 0.0;  ///< error divided by the unit roundoff of the kernel's precision
};

/// Inputs of one run of the kernel. `shapes`, `indices`, `members` and `bundles` follow the lists of the request.
/// `thetas` has the directions of the bundles, each once per DirectionVariant (plan/breakpoints.hpp) that it needs.
struct KernelData {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  Scattering scattering = Scattering::kSingle;
  bool has_direct = false;
  bool has_only_direct = false;  ///< MomentsRequest::has_only_direct(); then `masking` is none
  double tolerance = 1e-4;
  kernel::RuleNode rule{};
  int rule_order = 1;
  bool has_total_reflection = false;                  ///< true if total reflection begins at some angle for an index
  bool has_curves = false;                            ///< the kernel reads reflectances from tables
  std::vector<CurveError> curve_errors;               ///< per index; empty without reflectance tables
  std::vector<std::vector<double>> kinks_deg = {{}};  ///< different RowKinks::split_deg; the first is empty
  std::vector<std::uint32_t> index_kinks;             ///< for each index, a position in kinks_deg
  double curves_s = 0.0;                              ///< time that the reflectance tables took
  std::vector<Bundle> bundles;
  std::vector<std::uint32_t> members;
  std::vector<kernel::ThetaNode> thetas;
  std::vector<Pieces> pieces;  ///< one for each of `thetas`
  std::vector<kernel::ShapeNode> shapes;
  SlopeOrders orders;              ///< azimuthal orders for elliptic slope distributions; none if all are isotropic
  std::vector<SlopeShape> slopes;  ///< for each of `shapes`, whose m and scale are the widest and the narrowest
  std::vector<char> needs_line;    ///< for each shape: 1 if pieces must be split at the kink of its masking
  std::vector<kernel::IndexNode> indices;
  /// For each bundle, positions in `thetas`: for shapes without and with needs_line.
  std::vector<std::array<std::uint32_t, 2>> bundle_thetas;
  /// Nodes and weights of the rules. The list continues with the tables of the sky (SkyTable) and of the reflectances.
  std::vector<std::array<double, 2>> rule_nodes;
  std::size_t left_out_nodes = 0;  ///< nodes of reflectance tables that Tables::kCounted leaves out
  SkyTable sky;
  std::optional<Response> response;  ///< set if the columns are responses; null if they belong to the sky

  std::size_t column_count() const { return response ? response->count : sky.count; }
  bool needs_masking_table() const { return masking == Masking::kIntegral || masking == Masking::kSmith; }
  std::span<const std::uint32_t> bundle_shapes(std::size_t bundle) const {
    return std::span(members).subspan(bundles[bundle].first, bundles[bundle].count);
  }
  MomentsEntry entry(std::size_t bundle, std::uint32_t shape) const {
    return {bundle_thetas[bundle][needs_line[shape] != 0 ? 1 : 0], shape, bundles[bundle].index};
  }
};

struct RuleModel;

/// kCounted: all indices share the reflectance table of one of them. This suffices to count work.
enum class Tables : std::uint8_t { kComputed, kCounted };

/// The kernel's inputs for a request. `model` sets the numbers of nodes; the default is rule_model().
KernelData kernel_data(const MomentsRequest& request, Tables tables = Tables::kComputed);
KernelData kernel_data(const MomentsRequest& request, const RuleModel& model, Tables tables = Tables::kComputed);

/// How many numbers the kernels store for columns (physics/columns.glsl): per MomentsNode and per AzimuthNode.
inline std::size_t column_sums(const KernelData& data) { return DOLP_COLUMN_PARTS * data.column_count(); }
inline std::size_t column_azimuths(const KernelData& data) {
  return (data.orders.highest > 0 ? 3 : 2) * data.column_count();
}
/// Adds the columns of a piece of the slope axis to `sums`. A column of `piece` is i and q of the coarser rule, then i
/// and q of the finer rule. A column of `sums` is i and q of the finer rule, then their differences from the coarser
/// rule. If the columns belong to a sky, the larger difference and 0 replace these two differences.
template <class Real>
void add_columns(const KernelData& data, std::span<const Real> piece, std::span<double> sums) {
  for (std::size_t first = 0; first < piece.size(); first += DOLP_COLUMN_PARTS) {
    const double i = static_cast<double>(piece[first + 2]);
    const double q = static_cast<double>(piece[first + 3]);
    const double i_apart = i - static_cast<double>(piece[first]);
    const double q_apart = q - static_cast<double>(piece[first + 1]);
    sums[first] += i;
    sums[first + 1] += q;
    sums[first + 2] += data.response ? i_apart : std::max(std::abs(i_apart), std::abs(q_apart));
    sums[first + 3] += data.response ? q_apart : 0.0;
  }
}
inline std::uint32_t column_kind(const KernelData& data) {
  return data.response ? DOLP_COLUMNS_RESPONSE + static_cast<std::uint32_t>(data.response->of) : DOLP_COLUMNS_SKY;
}

std::uint32_t task_word(const Pieces& pieces, std::uint32_t piece, std::uint32_t members);

/// Number of pieces of the slope axis that begin below ShapeNode::cut, the end of the integral; at least one.
std::uint32_t piece_count(const KernelData& data, std::uint32_t theta, const kernel::ShapeNode& shape);

/// The slope of V-grooves in which a vertical ray bounces `bounces` times.
double slope_with_bounces(double bounces);

void add_piece(kernel::MomentsNode& sum, const kernel::MomentsNode& piece);

/// Computes the less accurate of r_i and deficit as cos(theta) minus the other moment: their sum is cos(theta).
void take_complement(Moments& moments, double cosine);

/// The unit roundoff that the error bounds of a device's float kernels need: larger than float's own if divisions and
/// square roots are not rounded correctly.
double float_roundoff(const Arithmetic& arithmetic);

/// Moments with error bounds, from the kernel's result `node` and DOLP_COLUMN_PARTS sums per column in `columns`.
Moments moments_from_kernel(const kernel::MomentsNode& node, const KernelData& data, const MomentsEntry& entry,
                            double unit_roundoff, std::span<const double> columns = {});

/// False if, in this direction, the masking table is too coarse for a slope distribution as narrow as `shape`.
bool table_resolves(const kernel::ShapeNode& shape, double cos_theta, double sin_theta);

}  // namespace dolp
