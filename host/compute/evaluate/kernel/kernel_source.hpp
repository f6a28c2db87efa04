// Compiles the kernel source as C++, in double if DOLP_DOUBLE is defined. The including file defines
// DOLP_KERNEL_NAMESPACE. To compute Moments::columns, it also defines DOLP_MOST_COLUMNS, the largest number of columns.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel_ranges.hpp"
#include "evaluate/kernel/cpu_kernel.hpp"

namespace dolp::DOLP_KERNEL_NAMESPACE {

#ifdef DOLP_DOUBLE
using real = double;
#else
using real = float;
#endif
using real2 = glm::vec<2, real>;
using real4 = glm::vec<4, real>;

using glm::abs;
using glm::ceil;
using glm::clamp;
using glm::floatBitsToUint;
using glm::floor;
using glm::frexp;
using glm::max;
using glm::min;
using glm::mod;
using glm::sqrt;
using glm::uint;
using glm::uintBitsToFloat;

// Returns x * 2^k. Domain: 2^k must be a normal number. The C library's ldexp takes ten times as long.
inline float ldexp(float x, int k) { return x * std::bit_cast<float>((k + 127) << 23); }
inline double ldexp(double x, int k) { return x * std::bit_cast<double>(static_cast<std::int64_t>(k + 1023) << 52); }

#include "physics/prelude.glsl"

/// The kernel source as the body of a class, whose members stand for the buffers and specialization constants.
struct KernelSource {
#include "interface.glsl"
#include "physics/all.glsl"

  uint kDistribution = DOLP_CAUCHY;
  uint kMasking = DOLP_MASKING_NONE;
  bool kTotalReflection = false;
  bool kHasCurves = false;
  bool kIsMultiple = false;
  bool kHasDirect = false;
  bool kHasOrders = false;
  uint kColumnCount = 0;
  uint kColumns = DOLP_COLUMNS_SKY;
  int log2_sky_cells = 0;
  int first_sky_cell = 0;
  int corners_of_sky = 0;
  int order_of_nodes = 1;
  std::vector<real2> rule_nodes;
  std::vector<real4> masking_table;

  static KernelSource of(const KernelData& data) {
    KernelSource source;
    source.kDistribution = static_cast<uint>(data.distribution);
    source.kMasking = static_cast<uint>(data.masking);
    source.kTotalReflection = data.has_total_reflection;
    source.kHasCurves = data.has_curves;
    source.kIsMultiple = data.scattering == Scattering::kMultiple;
    source.kHasDirect = data.has_direct;
    source.kHasOrders = data.orders.highest > 0;
    source.kColumnCount = static_cast<uint>(data.column_count());
    source.kColumns = column_kind(data);
    source.log2_sky_cells = static_cast<int>(data.sky.log2_cells);
    source.first_sky_cell = static_cast<int>(data.sky.start);
    source.corners_of_sky = static_cast<int>(data.sky.corners);
    source.order_of_nodes = data.rule_order;
    for (const auto& node : data.rule_nodes) source.rule_nodes.push_back(convert_reals<real, real2, double>(node));
    return source;
  }

  int largest_order() const { return order_of_nodes; }
  int sky_cells() const { return 1 << log2_sky_cells; }
  int pushed_corners() const { return corners_of_sky; }
  int sky_functions() const { return kColumns == DOLP_COLUMNS_SKY ? static_cast<int>(kColumnCount) : 1; }
  int sky_start() const { return first_sky_cell; }
  real2 rule_node(int i) const { return rule_nodes[static_cast<std::size_t>(i)]; }
  real2 table_node(int i) const { return rule_node(i); }
  real4 masking_node(uint i) const { return masking_table[i]; }
  void store_masking_node(uint i, real4 node) { masking_table[i] = node; }
  void store_column(uint position, real value) { columns_out()[position] = value; }
  std::span<real> columns_out() const {
    thread_local std::vector<real> columns;
    columns.resize(DOLP_COLUMN_PARTS * std::size_t{kColumnCount});
    return columns;
  }
};

class SourceKernel final : public CpuKernel {
 public:
  explicit SourceKernel(const KernelData& data)
      : data_(data),
        rule_(convert_reals<real, KernelSource::RuleNode, double>(data.rule)),
        source_(KernelSource::of(data)) {}

  void build_masking_tables(std::vector<std::uint32_t> shapes) override {
    shapes_ = std::move(shapes);
    source_.masking_table.resize(shapes_.size() * KernelSource::kMaskingNodes);
    constexpr std::size_t kShapesAtOnce = 64;
    parallel_for(shapes_.size(), kShapesAtOnce,
                 [&](std::size_t i) { source_.build_masking_table(shape_node(shapes_[i]), table_at(i)); });
  }

  kernel::MomentsNode moments(const MomentsEntry& entry, std::span<double> columns) override {
    const KernelSource::Row row{{shape_node(entry.shape)}, {table(entry.shape)}};
    const auto theta = convert_reals<real, KernelSource::ThetaNode, double>(data_.thetas[entry.theta]);
    const auto index = convert_reals<real, KernelSource::IndexNode, double>(data_.indices[entry.index]);
    kernel::MomentsNode moments{};
    for (std::uint32_t piece = 0; piece < piece_count(data_, entry.theta, data_.shapes[entry.shape]); ++piece) {
      const auto task = source_.with_slopes(source_.unpack_task(task_word(data_.pieces[entry.theta], piece, 1)), theta);
      const auto part = source_.piece_moments(rule_, theta, row, index, task);
      add_piece(moments, convert_reals<double, kernel::MomentsNode, real>(part.member[0]));
      add_columns(data_, std::span<const real>(source_.columns_out()), columns);
    }
    return moments;
  }

  kernel::AzimuthNode azimuths(const kernel::SlopeNode& slope, std::span<double> columns) override {
    const auto theta =
        convert_reals<real, KernelSource::ThetaNode, double>(data_.thetas[static_cast<std::size_t>(slope.theta)]);
    const auto index =
        convert_reals<real, KernelSource::IndexNode, double>(data_.indices[static_cast<std::size_t>(slope.index)]);
    const auto slope_node = convert_reals<real, KernelSource::SlopeNode, double>(slope);
    const auto result = source_.integrate_azimuths(rule_, theta, index, slope_node);
    for (std::size_t k = 0; k < data_.column_count(); ++k) copy_column(k, result.columns[0], columns);
    return convert_reals<double, kernel::AzimuthNode, real>(result.node[0]);
  }

 private:
  static uint table_at(std::size_t position) { return static_cast<uint>(position * KernelSource::kMaskingNodes); }
  uint table(std::uint32_t shape) const {
    return table_at(static_cast<std::size_t>(std::ranges::lower_bound(shapes_, shape) - shapes_.begin()));
  }

#if DOLP_MOST_COLUMNS > 0
  void copy_column(std::size_t k, const KernelSource::Columns& sums, std::span<double> columns) const {
    const std::size_t each = column_azimuths(data_) / data_.column_count();
    columns[each * k] = static_cast<double>(sums.i[k]);
    columns[each * k + 1] = static_cast<double>(sums.q[k]);
    if (each > 2) columns[each * k + 2] = static_cast<double>(sums.u[k]);
  }
#else  // slope_samples.cpp needs no columns
  void copy_column(std::size_t, const KernelSource::Columns&, std::span<double>) const {}
#endif

  KernelSource::ShapeNode shape_node(std::size_t shape) const {
    return convert_reals<real, KernelSource::ShapeNode, double>(data_.shapes[shape]);
  }

  const KernelData& data_;
  KernelSource::RuleNode rule_;
  KernelSource source_;
  std::vector<std::uint32_t> shapes_;  ///< the shapes that have a masking table
};

}  // namespace dolp::DOLP_KERNEL_NAMESPACE
