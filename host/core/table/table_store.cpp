#include "table/table_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <dolp/errors.hpp>
#include <dolp/status.hpp>
#include <limits>
#include <new>
#include <string>
#include <utility>

#include "base/interrupt.hpp"
#include "base/parallel_ranges.hpp"
#include "base/text.hpp"
#include "table/netcdf_file.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostVariableBytes = 0xFFFF'FFFC;  // of the format with 64-bit offsets
constexpr std::size_t kBufferBytes = std::size_t{1} << 16U;
// Room in the head for the attributes of finish(). If they need more, netCDF-C moves the values.
constexpr std::size_t kRoomForAttributes = std::size_t{1} << 13U;

std::size_t values_bytes(const TableLayout& layout) {
  const TableValues none;
  std::size_t bytes = 0;
  for_each_variable(
      layout, [&](const auto& of, std::size_t width) { bytes += layout.head.size() * width * sizeof(of(none)[0]); });
  return bytes;
}

bool has_large_variable(const TableLayout& layout) {
  std::size_t widest = 1;
  for_each_variable(layout, [&](const auto&, std::size_t width) { widest = std::max(widest, width); });
  return layout.head.size() * widest * sizeof(double) > kMostVariableBytes;
}

/// Names of the variables in the table with the quantity's error bound and status.
std::string present_qualifiers(const TableLayout& layout, Quantity quantity) {
  if (!layout.head.beta_deg.empty()) return kResponseQualifier;
  std::vector<std::string_view> present;
  for (const std::string_view name : split(describe(quantity).ancillary, ' ')) {
    const auto is_named = [name](Quantity other) { return name == describe(other).name; };
    const bool is_status = layout.has_status && name == kStatusQualifier;
    if (is_status || std::ranges::any_of(layout.quantities, is_named)) present.push_back(name);
  }
  return fmt::format("{}", fmt::join(present, " "));
}

/// The limits in um of a band with the label "LOW-HIGH".
std::array<double, 2> band_limits(const std::string& label) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::string_view> limits = split(label, '-');
  return {parse_number(limits.front()).value_or(kNan), parse_number(limits.back()).value_or(kNan)};
}

int put_values(const NetcdfFile& file, int variable, const Hyperslab& at, const double* values) {
  return file.call(nc_put_vara_double, variable, at.first.data(), at.count.data(), values);
}
int put_values(const NetcdfFile& file, int variable, const Hyperslab& at, const std::uint32_t* values) {
  return file.call(nc_put_vara_uint, variable, at.first.data(), at.count.data(), values);
}

}  // namespace

/// An open table file. Errors of all calls: IoError that begins with `path`; std::bad_alloc.
struct TableStore::Impl {
  TableLayout layout;
  std::string path;  // of the table, for messages
  NetcdfFile file;
  std::vector<int> variables;                                // in the order of for_each_variable
  std::vector<int> dimensions;                               // of the entries
  AxisArray<std::vector<int>> dimension;                     // empty if the table lacks the axis
  std::vector<std::pair<int, std::vector<double>>> numbers;  // coordinates to write when all is defined
  std::vector<std::pair<int, std::string>> letters;

  void check(int status) const {
    if (status == NC_NOERR) return;
    if (is_lack_of_memory(status)) throw std::bad_alloc();
    throw IoError(fmt::format("{}: cannot write: {}", path, nc_strerror(status)));
  }
  template <class Function, class... Arguments>
  void call(const Function& function, Arguments... arguments) const {
    check(file.call(function, arguments...));
  }

  void create(const std::string& name);
  void renew_head(AtomicFile& table);
  void define_axes();
  void define_names(Axis axis);
  void define_bands();
  void define_coordinates();
  void define_results();
  void define_status();

  int define_dimension(const char* name, std::size_t length) const {
    int id = 0;
    call(nc_def_dim, name, length, &id);
    return id;
  }
  int define(const char* name, nc_type type, const std::vector<int>& over) const {
    int id = 0;
    call(nc_def_var, name, type, static_cast<int>(over.size()), over.data(), &id);
    return id;
  }
  template <class Described>
  void define_numbers(const Described& described, const std::vector<int>& over, const std::vector<double>& values) {
    numbers.emplace_back(define(described.name, NC_DOUBLE, over), values);
    put_text(numbers.back().first, "long_name", described.long_name);
    put_text(numbers.back().first, "units", described.units);
  }
  /// `qualifiers`: names of variables with the error and the status of this one.
  template <class Described>
  void define_result(const Described& described, const std::vector<int>& over, const std::string& units,
                     const std::string& qualifiers) {
    const int id = define_over_entries(described.name, NC_DOUBLE, over);
    put_number(id, "_FillValue", std::numeric_limits<double>::quiet_NaN());
    put_text(id, "long_name", described.long_name);
    put_text(id, "units", units);
    if (!qualifiers.empty()) put_text(id, "ancillary_variables", qualifiers);
  }
  int define_over_entries(const std::string& name, nc_type type, const std::vector<int>& over) {
    variables.push_back(define(name.c_str(), type, over));
    if (const std::string names = coordinate_names(layout.head); !names.empty())
      put_text(variables.back(), "coordinates", names);
    return variables.back();
  }
  void put_text(int variable, const char* name, const std::string& text) const {
    call(nc_put_att_text, variable, name, text.size(), text.data());
  }
  void put_number(int variable, const char* name, double number) const {
    call(nc_put_att_double, variable, name, NC_DOUBLE, std::size_t{1}, &number);
  }
  void put_attributes(const std::vector<Attribute>& attributes) const {
    for (const Attribute& attribute : attributes) {
      const auto* text = std::get_if<std::string>(&attribute.value);
      if (text) put_text(NC_GLOBAL, attribute.name.c_str(), *text);
      if (!text) put_number(NC_GLOBAL, attribute.name.c_str(), std::get<double>(attribute.value));
    }
  }

  /// Calls use(variable, place of the box in it, values) for each variable.
  template <class Values, class Use>
  void each_variable(Values& part, const GridBox& box, const Use& use) const {
    std::size_t number = 0;
    for_each_variable(layout, [&](const auto& of, std::size_t width) {
      use(variables[number++], Hyperslab(layout.head, box, width), of(part));
    });
  }
};

/// Makes the file `name`, with all but the results.
void TableStore::Impl::create(const std::string& name) {
  const int format = has_large_variable(layout) ? NC_64BIT_DATA : NC_64BIT_OFFSET;
  std::size_t buffer_bytes = kBufferBytes;
  check(file.open([&](int* id) { return nc__create(name.c_str(), NC_CLOBBER | format, 0, &buffer_bytes, id); }));
  put_attributes({{kConventions, kConventionsOfFiles}});
  put_attributes(layout.head.attributes);
  if (const std::string data = spectral_data_text(layout.head); !data.empty()) put_attributes({{kSpectralData, data}});
  define_axes();
  define_coordinates();
  define_results();
  int before = 0;
  call(nc_set_fill, NC_NOFILL, &before);  // each value is written only once
  call(nc__enddef, kRoomForAttributes, sizeof(double), std::size_t{0}, sizeof(double));
  for (const auto& [id, values] : numbers) call(nc_put_var_double, id, values.data());
  for (const auto& [id, text] : letters) call(nc_put_var_text, id, text.data());
  call(nc_sync);
}

/// Writes the head of `table` again, because it may be damaged, or belong to a complete table. The values stay.
void TableStore::Impl::renew_head(AtomicFile& table) {
  AtomicFile fresh(table.path());
  create(fresh.open_path());
  check(file.close());  // makes the size of the file that of the whole table
  std::string head(fresh.size() - values_bytes(layout), '\0');
  fresh.read_at(0, head.data(), head.size());
  table.write_at(0, head.data(), head.size());
  if (table.size() > fresh.size()) table.resize(fresh.size());
  check(file.open([&](int* id) { return nc_open(table.open_path().c_str(), NC_WRITE, id); }));
}

void TableStore::Impl::define_axes() {
  for (const Axis axis : kAllAxes) {
    const std::vector<double>& values = layout.head.axes[axis];
    if (values.empty()) continue;
    dimensions.push_back(define_dimension(describe(axis).name, values.size()));
    dimension[axis] = {dimensions.back()};
    if (axis == Axis::kMaterial) define_names(axis);
    if (axis == Axis::kBand) define_bands();
    if (!describe(axis).has_labels) define_numbers(describe(axis), dimension[axis], values);
  }
}

void TableStore::Impl::define_names(Axis axis) {
  std::vector<std::string> names;
  for (const double value : layout.head.axes[axis]) names.push_back(layout.head.label(axis, value));
  std::size_t longest = 1;
  for (const std::string& name : names) longest = std::max(longest, name.size());
  const int id =
      define(kMaterialName.name, NC_CHAR, {dimension[axis].front(), define_dimension("name_length", longest)});
  put_text(id, "long_name", kMaterialName.long_name);
  put_text(id, "_Encoding", "utf-8");  // with it, xarray returns texts instead of bytes
  std::string& text = letters.emplace_back(id, "").second;
  for (std::string& name : names) {
    name.resize(longest, '\0');
    text += name;
  }
}

void TableStore::Impl::define_bands() {
  std::vector<double> low, high;
  for (const double value : layout.head.axes[Axis::kBand]) {
    const auto [low_um, high_um] = band_limits(layout.head.label(Axis::kBand, value));
    low.push_back(low_um);
    high.push_back(high_um);
  }
  define_numbers(kBandLow, dimension[Axis::kBand], low);
  define_numbers(kBandHigh, dimension[Axis::kBand], high);
}

void TableStore::Impl::define_coordinates() {
  const TableHead& head = layout.head;
  if (!head.wind_m_s.empty()) define_numbers(kWind, dimension[Axis::kSigma], head.wind_m_s);
  for (const TableCurve& described : kTableCurves) {
    const std::vector<double>& used = (head.*described.curve).used;
    if (!used.empty()) define_numbers(described, dimension[Axis::kWavelength], used);
  }
}

void TableStore::Impl::define_results() {
  const std::vector<double>& beta_deg = layout.head.beta_deg;
  std::vector<int> over_beta = dimensions;
  if (!beta_deg.empty()) {
    over_beta.push_back(define_dimension(kBeta.name, beta_deg.size()));
    define_numbers(kBeta, {over_beta.back()}, beta_deg);
  }
  for (const Quantity quantity : layout.quantities) {
    const QuantityDescription& described = describe(quantity);
    define_result(described, dimensions, quantity_units(quantity, layout.head.stokes_units),
                  present_qualifiers(layout, quantity));
  }
  for (const ResponseVariable variable : layout.responses) {
    const ResponseDescription& described = describe(variable);
    define_result(described, described.has_beta ? over_beta : dimensions, "1",
                  described.has_beta ? kResponseQualifier : "");
  }
  for (const DerivativeColumn& column : layout.derivatives) define_result(column, dimensions, column.units, "");
  if (layout.has_status) define_status();
}

// The status is int, because CF-1.8 has no unsigned int. The masks must have its type.
void TableStore::Impl::define_status() {
  const int id = define_over_entries("status", NC_INT, dimensions);
  std::array<int, kStatusBits.size()> masks{};
  std::array<const char*, kStatusBits.size()> meanings{};
  std::ranges::transform(kStatusBits, masks.begin(), [](const StatusBit& bit) { return static_cast<int>(bit.mask); });
  std::ranges::transform(kStatusBits, meanings.begin(), &StatusBit::meaning);
  put_text(id, "long_name", "status bits of the entry; 0 where nothing is wrong");
  put_text(id, "units", "1");
  call(nc_put_att_int, id, "flag_masks", NC_INT, masks.size(), masks.data());
  put_text(id, "flag_meanings", fmt::format("{}", fmt::join(meanings, " ")));
}

TableStore::TableStore(const TableLayout& layout, AtomicFile& file, Earlier earlier) : impl_(std::make_unique<Impl>()) {
  impl_->layout = layout;
  impl_->path = file.path().string();
  earlier == Earlier::kKept ? impl_->renew_head(file) : impl_->create(file.open_path());
}

TableStore::~TableStore() = default;

ValueSums TableStore::write(const TableValues& part, const PerAxis& first) {
  ValueSums sums;
  const auto write_values = [&] {
    impl_->each_variable(part, {first, part.counts()}, [&](int variable, const Hyperslab& at, const auto& values) {
      if (interrupted()) throw Cancelled();
      impl_->check(put_values(impl_->file, variable, at, values.data()));
    });
    impl_->call(nc_sync);
  };
  parallel_ranges(2, 1, [&](std::size_t task, std::size_t) {
    if (task == 0) write_values();
    if (task == 1) sums = value_sums(part, impl_->layout, first);
  });
  return sums;
}

TableValues TableStore::read(const GridBox& box) const {
  TableValues part{part_head(impl_->layout.head, box)};
  part.derivatives = impl_->layout.derivatives;
  for_each_variable(impl_->layout, [&](const auto& of, std::size_t width) { of(part).resize(part.size() * width); });
  impl_->each_variable(part, box, [&](int variable, const Hyperslab& at, auto& values) {
    impl_->check(get_values(impl_->file, variable, at, values.data()));
  });
  return part;
}

std::optional<ValueSums> TableStore::measured(const GridBox& box) const {
  try {
    return value_sums(read(box), impl_->layout, box.first);
  } catch (const IoError&) {  // for example if the disk is faulty
    return std::nullopt;
  }
}

void TableStore::finish(std::vector<Attribute> more, const ValueSums& sums) {
  more.push_back({kValuesHash, values_hash(impl_->layout, sums)});
  impl_->call(nc_redef);
  impl_->put_attributes(more);
  impl_->call(nc_enddef);
  impl_->check(impl_->file.close());
}

}  // namespace dolp
