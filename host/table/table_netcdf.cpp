#include "table/table_netcdf.hpp"

#include <fmt/format.h>
#include <netcdf.h>
#include <netcdf_mem.h>

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "table/table_file.hpp"

namespace dolp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kConventions = "CF-1.8";
constexpr std::size_t kExpectedOverhead = 65536;
// deflate, which other tools apply, leaves no less than a 1032nd of the bytes.
constexpr std::size_t kMostShrinking = 1032;

struct Axis {
  const char* name;
  const char* long_name;
  const char* units;
  std::vector<double> Table::*values;
};
constexpr std::array<Axis, 3> kAxes = {{
    {"theta", "zenith angle", "degree", &Table::theta_deg},
    {"sigma", "roughness sigma of the slope distribution", "1", &Table::sigma},
    {"q", "exponent q of the slope distribution", "1", &Table::q},
}};
using Dimensions = std::array<int, kAxes.size()>;

// CF-1.8 has no unsigned int, and wants masks of the variable's own type.
constexpr std::array<int, 4> kFlagMasks = {1, 2, 4, 8};
constexpr const char* kFlagMeanings =
    "reflectance_outside_zero_to_one tolerance_not_met outside_model_domain intensity_not_positive";

/// An open NetCDF file; every call that fails throws `Error` with the file's name.
template <typename Error>
class NetcdfFile {
 public:
  NetcdfFile(fs::path shown, int id) : shown_(std::move(shown)), id_(id) {}
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;
  ~NetcdfFile() {
    if (id_ >= 0) nc_abort(id_);
  }
  int id() const { return id_; }
  const fs::path& shown() const { return shown_; }
  void check(int code, const char* what) const {
    if (code != NC_NOERR) throw Error(shown_.string() + ": " + what + ": " + nc_strerror(code));
  }
  NetcdfBytes close_to_bytes() {
    NC_memio memory{};
    check(nc_close_memio(std::exchange(id_, -1), &memory), "cannot finish");
    return {memory.memory, memory.size};
  }

 private:
  fs::path shown_;
  int id_;
};
using OutputFile = NetcdfFile<IoError>;
using InputFile = NetcdfFile<InputError>;

void put_text(const OutputFile& file, int variable, const char* name, const std::string& text) {
  file.check(nc_put_att_text(file.id(), variable, name, text.size(), text.data()), "cannot write an attribute");
}

void put_attributes(const OutputFile& file, const std::vector<Attribute>& attributes) {
  put_text(file, NC_GLOBAL, "Conventions", kConventions);
  for (const Attribute& attribute : attributes) {
    if (const auto* text = std::get_if<std::string>(&attribute.value)) {
      put_text(file, NC_GLOBAL, attribute.name.c_str(), *text);
    } else {
      file.check(nc_put_att_double(file.id(), NC_GLOBAL, attribute.name.c_str(), NC_DOUBLE, 1,
                                   &std::get<double>(attribute.value)),
                 "cannot write an attribute");
    }
  }
}

std::array<int, kAxes.size()> define_axes(const OutputFile& file, const Table& table, Dimensions& dimensions) {
  std::array<int, kAxes.size()> variables{};
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    const Axis& axis = kAxes[i];
    file.check(nc_def_dim(file.id(), axis.name, (table.*axis.values).size(), &dimensions[i]), "cannot define an axis");
    file.check(nc_def_var(file.id(), axis.name, NC_DOUBLE, 1, &dimensions[i], &variables[i]), "cannot define an axis");
    put_text(file, variables[i], "long_name", axis.long_name);
    put_text(file, variables[i], "units", axis.units);
  }
  return variables;
}

// Uncompressed: zlib saves half of the file and takes longer than all the rest of a table.
int define_variable(const OutputFile& file, const char* name, nc_type type, const Dimensions& dimensions) {
  int variable = 0;
  file.check(nc_def_var(file.id(), name, type, static_cast<int>(dimensions.size()), dimensions.data(), &variable),
             "cannot define a variable");
  return variable;
}

std::vector<std::pair<int, const TableVariable*>> define_variables(const OutputFile& file, const Table& table,
                                                                   const Dimensions& dimensions) {
  constexpr double kFill = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::pair<int, const TableVariable*>> defined;
  for (const TableVariable& variable : table_variables()) {
    if ((table.*variable.values).empty()) continue;
    const int id = define_variable(file, variable.name, NC_DOUBLE, dimensions);
    file.check(nc_put_att_double(file.id(), id, "_FillValue", NC_DOUBLE, 1, &kFill), "cannot write an attribute");
    put_text(file, id, "long_name", variable.long_name);
    put_text(file, id, "units", variable.has_stokes_units ? table.stokes_units : "1");
    if (*variable.ancillary != '\0') put_text(file, id, "ancillary_variables", variable.ancillary);
    defined.emplace_back(id, &variable);
  }
  return defined;
}

int define_status(const OutputFile& file, const Dimensions& dimensions) {
  const int id = define_variable(file, "status", NC_INT, dimensions);
  put_text(file, id, "long_name", "status bits of the entry; 0 where nothing is wrong");
  put_text(file, id, "units", "1");
  file.check(nc_put_att_int(file.id(), id, "flag_masks", NC_INT, kFlagMasks.size(), kFlagMasks.data()),
             "cannot write an attribute");
  put_text(file, id, "flag_meanings", kFlagMeanings);
  return id;
}

bool has(const InputFile& file, const char* name, int& variable) {
  return nc_inq_varid(file.id(), name, &variable) == NC_NOERR;
}

/// Errors: InputError for more than `most` values.
std::vector<double> read_axis(const InputFile& file, const Axis& axis, std::size_t most, int& dimension) {
  constexpr const char* kNoTable = "is not a table of dolp (no axis theta, sigma or q)";
  int variable = 0;
  std::size_t length = 0;
  file.check(nc_inq_dimid(file.id(), axis.name, &dimension), kNoTable);
  file.check(nc_inq_dimlen(file.id(), dimension, &length), kNoTable);
  file.check(nc_inq_varid(file.id(), axis.name, &variable), kNoTable);
  int rank = 0;
  int only = 0;
  file.check(nc_inq_varndims(file.id(), variable, &rank), kNoTable);
  if (rank == 1) file.check(nc_inq_vardimid(file.id(), variable, &only), kNoTable);
  file.check(rank == 1 && only == dimension && length > 0 ? NC_NOERR : NC_EBADDIM, kNoTable);
  if (length > most) {
    throw InputError(fmt::format("{}: axis {}: {} values; a table has at most {} entries", file.shown().string(),
                                 axis.name, length, kMostTableEntries));
  }
  std::vector<double> values(length);
  file.check(nc_get_var_double(file.id(), variable, values.data()), "cannot read an axis");
  return values;
}

/// Refuses variables that the file cannot hold, before memory is taken for them.
void check_size(const InputFile& file, const Table& table) {
  std::size_t variables = 0;
  int id = 0;
  for (const TableVariable& variable : table_variables()) variables += has(file, variable.name, id) ? 1 : 0;
  const std::size_t claimed = variables * table.size() * sizeof(double);
  const std::size_t bytes = fs::file_size(file.shown());
  if (claimed / kMostShrinking <= bytes) return;
  throw InputError(fmt::format("{}: claims {} variables of {} entries, which {} bytes cannot hold",
                               file.shown().string(), variables, table.size(), bytes));
}

void check_shape(const InputFile& file, int variable, const Dimensions& dimensions) {
  int rank = 0;
  file.check(nc_inq_varndims(file.id(), variable, &rank), "cannot read a variable");
  Dimensions own{};
  const bool same_rank = rank == static_cast<int>(own.size());
  if (same_rank) file.check(nc_inq_vardimid(file.id(), variable, own.data()), "cannot read a variable");
  file.check(same_rank && own == dimensions ? NC_NOERR : NC_EBADDIM,
             "is not a table of dolp (a variable is not over theta, sigma, q)");
}

std::string read_text(const InputFile& file, int variable, const char* name) {
  std::size_t length = 0;
  file.check(nc_inq_attlen(file.id(), variable, name, &length), "cannot read an attribute");
  std::string text(length, '\0');
  file.check(nc_get_att_text(file.id(), variable, name, text.data()), "cannot read an attribute");
  return text;
}

/// Other writers store text that is not ASCII in this form.
std::string read_string(const InputFile& file, const char* name) {
  char* text = nullptr;
  file.check(nc_get_att_string(file.id(), NC_GLOBAL, name, &text), "cannot read an attribute");
  std::string copy = text ? text : "";
  file.check(nc_free_string(1, &text), "cannot read an attribute");
  return copy;
}

std::vector<Attribute> read_attributes(const InputFile& file) {
  int count = 0;
  file.check(nc_inq_natts(file.id(), &count), "cannot read the attributes");
  std::vector<Attribute> attributes;
  for (int i = 0; i < count; ++i) {
    std::array<char, NC_MAX_NAME + 1> name{};
    nc_type type = NC_NAT;
    std::size_t length = 0;
    file.check(nc_inq_attname(file.id(), NC_GLOBAL, i, name.data()), "cannot read an attribute");
    file.check(nc_inq_att(file.id(), NC_GLOBAL, name.data(), &type, &length), "cannot read an attribute");
    if (std::string_view(name.data()) == "Conventions") continue;
    if (type == NC_CHAR) {
      attributes.push_back({name.data(), read_text(file, NC_GLOBAL, name.data())});
    } else if (type == NC_STRING && length == 1) {
      attributes.push_back({name.data(), read_string(file, name.data())});
    } else if (type != NC_STRING && length == 1) {
      double value = 0.0;
      file.check(nc_get_att_double(file.id(), NC_GLOBAL, name.data(), &value), "cannot read an attribute");
      attributes.push_back({name.data(), value});
    }
  }
  return attributes;
}

}  // namespace

NetcdfBytes netcdf_bytes(const Table& table, const fs::path& path) {
  int id = -1;
  // Room for the whole table, so that the image does not grow piece by piece.
  const std::size_t expected_bytes = kExpectedOverhead + table.size() * (table_variables().size() + 1) * sizeof(double);
  if (const int code = nc_create_mem(path.c_str(), NC_NETCDF4, expected_bytes, &id); code != NC_NOERR) {
    throw IoError(path.string() + ": cannot create: " + nc_strerror(code));
  }
  OutputFile file(path, id);
  int fill_mode = 0;
  // Every variable is written whole; to fill it first would write it twice.
  file.check(nc_set_fill(file.id(), NC_NOFILL, &fill_mode), "cannot create");
  put_attributes(file, table.attributes);
  Dimensions dimensions{};
  const auto axes = define_axes(file, table, dimensions);
  const auto variables = define_variables(file, table, dimensions);
  const int status = table.status.empty() ? -1 : define_status(file, dimensions);
  file.check(nc_enddef(file.id()), "cannot write");
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    file.check(nc_put_var_double(file.id(), axes[i], (table.*kAxes[i].values).data()), "cannot write an axis");
  }
  for (const auto& [variable, description] : variables) {
    file.check(nc_put_var_double(file.id(), variable, (table.*description->values).data()), "cannot write a variable");
  }
  if (status >= 0) {
    file.check(nc_put_var_uint(file.id(), status, table.status.data()), "cannot write a variable");
  }
  return file.close_to_bytes();
}

Table read_table(const fs::path& path) {
  if (!fs::exists(path)) throw InputError(path.string() + ": there is no such file");
  int id = -1;
  if (const int code = nc_open(path.c_str(), NC_NOWRITE, &id); code != NC_NOERR) {
    if (code == EACCES) throw InputError(path.string() + ": cannot be read: Permission denied");
    throw InputError(path.string() + ": is not a NetCDF table of dolp: " + nc_strerror(code));
  }
  const InputFile file(path, id);
  Table table;
  Dimensions dimensions{};
  std::size_t most = kMostTableEntries;
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    table.*kAxes[i].values = read_axis(file, kAxes[i], most, dimensions[i]);
    most /= (table.*kAxes[i].values).size();
  }
  check_size(file, table);
  bool has_values = false;
  int id_of = 0;
  for (const TableVariable& variable : table_variables()) {
    if (!has(file, variable.name, id_of)) continue;
    check_shape(file, id_of, dimensions);
    std::vector<double>& values = table.*variable.values;
    values.resize(table.size());
    file.check(nc_get_var_double(file.id(), id_of, values.data()), "cannot read a variable");
    if (variable.has_stokes_units) table.stokes_units = read_text(file, id_of, "units");
    has_values = true;
  }
  if (has(file, "status", id_of)) {
    check_shape(file, id_of, dimensions);
    table.status.resize(table.size());
    file.check(nc_get_var_uint(file.id(), id_of, table.status.data()), "cannot read a variable");
  }
  if (!has_values) throw InputError(path.string() + ": is not a table of dolp (none of its variables is there)");
  table.attributes = read_attributes(file);
  return table;
}

}  // namespace dolp
