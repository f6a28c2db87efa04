// Table files: values that are written and read again do not change.
#include "table/table.hpp"

#include <gtest/gtest.h>
#include <netcdf.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <dolp/errors.hpp>
#include <filesystem>
#include <iostream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "base/text.hpp"
#include "error_text.hpp"
#include "table/table_file.hpp"
#include "table/table_output.hpp"
#include "table/table_reader.hpp"
#include "table_support.hpp"

namespace table_test {

using namespace dolp;
namespace fs = std::filesystem;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// ---- NetCDF ---------------------------------------------------------------------------------------------------------

TEST_F(TableFiles, NetcdfRoundTrip_AnyShape_GivesTheSameTable) {
  for (const auto& shape : {std::array<std::size_t, 3>{1, 1, 1}, {5, 3, 2}, {1, 4, 1}, {20, 16, 16}}) {
    const TableValues table = sample_table(shape[0], shape[1], shape[2]);
    write_table(table, at("t.nc"));
    expect_same(read_table(at("t.nc")), table);
  }
  EXPECT_EQ(names(), std::vector<std::string>{"t.nc"});
}

TEST_F(TableFiles, NetcdfRoundTrip_AbsentVariables_StayAbsent) {
  TableValues table = sample_table(3, 2, 2);
  table[Quantity::kStokesV].clear();
  table[Quantity::kAlbedo].clear();
  table.status.clear();
  table.stokes_units = "W m-2";
  write_table(table, at("t.nc"));
  expect_same(read_table(at("t.nc")), table);
}

TableValues labelled_table() {
  TableValues table = sample_table(2, 1, 1);
  table.axes[Axis::kMaterial] = {0.0, 1.0};
  table.axes[Axis::kBand] = {0.0, 1.0, 2.0};
  table.labels[Axis::kMaterial] = {"gold (Ordal)", "\u00e9mail"};
  table.labels[Axis::kBand] = {"8-14", "3.5-5", "0.0001-100000"};
  for (const Quantity quantity : kAllQuantities) table[quantity].assign(table.size(), 0.5);
  table.status.assign(table.size(), 0);
  return table;
}

TEST_F(TableFiles, NetcdfRoundTrip_Labels_AreKept_AndBandsAreNumbersToo) {
  const TableValues table = labelled_table();
  write_table(table, at("t.nc"));
  const TableValues read = read_table(at("t.nc"));
  expect_same(read, table);
  EXPECT_EQ(read.labels, table.labels);
  int file = 0, low = 0;
  ASSERT_EQ(nc_open(at("t.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
  std::array<double, 3> low_um{};
  ASSERT_EQ(nc_inq_varid(file, "band_low", &low), NC_NOERR);
  EXPECT_EQ(nc_get_var_double(file, low, low_um.data()), NC_NOERR);
  EXPECT_EQ(low_um, (std::array<double, 3>{8.0, 3.5, 1e-4}));
  EXPECT_EQ(nc_close(file), NC_NOERR);
}

// The files were written by dolp 0.2 as NetCDF-4. read_table() checks the hash of their values.
TEST_F(TableFiles, ReadTable_FilesOfDolp02_AreRead) {
  const fs::path folder = fs::path(DOLP_TEST_DATA_DIR) / "tables_0.2";
  const TableValues materials = read_table(folder / "materials.nc");
  EXPECT_EQ(materials.labels[Axis::kMaterial], (std::vector<std::string>{"gold (Ordal)", "iron"}));
  EXPECT_EQ(materials.size(), 6U);
  const TableValues bands = read_table(folder / "bands.nc");
  EXPECT_EQ(bands.labels[Axis::kBand], (std::vector<std::string>{"8-12", "3.5-5"}));
  const TableValues response = read_table(folder / "response.nc");
  EXPECT_EQ(response.responses[ResponseVariable::kResponseI].size(), response.size() * 24);
}

// netCDF-C takes names of this kind for addresses or options.
TEST_F(TableFiles, NetcdfRoundTrip_NamesLikeAddresses_AreFiles) {
  const fs::path before = fs::current_path();
  const TableValues table = sample_table(2, 1, 1);
  fs::current_path(at("."));
  for (const char* name : {"a#mode=zarr.nc", "file:a.nc", "http:a.nc", "[mode=bytes]a.nc"}) {
    write_table(table, name);
    expect_same(read_table(name), table);
  }
  fs::current_path(before);
  EXPECT_EQ(names().size(), 4U);
}

// The file has a hole where the values would be.
TEST_F(TableFiles, Netcdf_VariableAbove4GiB_IsOf64BitData) {
  const TableValues part = sample_table(1, 1, 1);
  TableLayout layout{part, {Quantity::kDolp}, false};
  layout.head.wind_m_s.clear();
  layout.head.axes[Axis::kSigma].resize(30'000);
  layout.head.axes[Axis::kQ].resize(30'000);
  AtomicFile file(at("t.nc"));
  TableStore store(layout, file);
  const PerAxis last = [&] {
    PerAxis at = layout.head.counts();
    for (std::size_t& position : at) --position;
    return at;
  }();
  const ValueSums sums = store.write(part, last);
  EXPECT_EQ(store.measured({last, part.counts()}), std::optional(sums));
  store.finish({}, sums);
  file.commit();
  int id = 0, format = 0;
  ASSERT_EQ(nc_open(at("t.nc").c_str(), NC_NOWRITE, &id), NC_NOERR);
  EXPECT_EQ(nc_inq_format(id, &format), NC_NOERR);
  EXPECT_EQ(format, NC_FORMAT_CDF5);
  EXPECT_EQ(nc_close(id), NC_NOERR);
  const TableReader reader(at("t.nc"));
  EXPECT_EQ(reader.value_sums(reader.read({last, part.counts()}), {last, part.counts()}), sums);
}

/// A file without values. Its axes have the given lengths. Its variable dolp has only the first `axes` axes.
struct BareFile {
  BareFile(const fs::path& path, const std::array<std::size_t, 3>& lengths, int axes = 3) {
    const std::array<const char*, 3> names = {"theta", "sigma", "q"};
    std::array<int, 3> dimensions{};
    EXPECT_EQ(nc_create(path.c_str(), NC_NETCDF4, &file), NC_NOERR);
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_EQ(nc_def_dim(file, names[i], lengths[i], &dimensions[i]), NC_NOERR);
      EXPECT_EQ(nc_def_var(file, names[i], NC_DOUBLE, 1, &dimensions[i], &variables[i]), NC_NOERR);
      const std::size_t chunk = std::min<std::size_t>(lengths[i], 1000);
      EXPECT_EQ(nc_def_var_chunking(file, variables[i], NC_CHUNKED, &chunk), NC_NOERR);
    }
    EXPECT_EQ(nc_def_var(file, "dolp", NC_DOUBLE, axes, dimensions.data(), &variables[3]), NC_NOERR);
    const std::array<std::size_t, 3> chunks = {1, 1, 1};
    EXPECT_EQ(nc_def_var_chunking(file, variables[3], NC_CHUNKED, chunks.data()), NC_NOERR);
  }
  ~BareFile() { EXPECT_EQ(nc_close(file), NC_NOERR); }
  BareFile(const BareFile&) = delete;
  BareFile& operator=(const BareFile&) = delete;

  int file = 0;
  std::array<int, 4> variables{};
};

TEST_F(TableFiles, ReadTable_VariableOverOtherAxes_IsRefused) {
  { const BareFile file(at("flat.nc"), {2, 2, 2}, 2); }
  EXPECT_THROW(read_table(at("flat.nc")), InputError);
}

TEST_F(TableFiles, ReadTable_SizesThatNoTableHas_AreRefusedByName) {
  struct Claim {
    std::array<std::size_t, 3> lengths;
    const char* message;
  };
  // In 64 bits the number of entries of the first case overflows to 3456.
  for (const Claim& claim : {Claim{{6365383, 1165742, 2485952}, "theta: 50923064 bytes are claimed, which a file of"},
                             Claim{{1ULL << 60U, 1, 1}, "theta: 1152921504606846976 values"},
                             Claim{{262144, 262144, 2}, "q: 2 values; a table has at most 68719476736 entries"},
                             Claim{{4096, 4000, 1}, "dolp: 131072000 bytes are claimed, which a file of"}}) {
    { const BareFile file(at("claim.nc"), claim.lengths); }
    const std::string message = error_text([&] { read_table(at("claim.nc")); });
    EXPECT_NE(message.find(claim.message), std::string::npos) << message;
  }
}

TEST_F(TableFiles, Netcdf_LongTexts_AreKept) {
  TableValues table = sample_table(3, 2, 2);
  for (Attribute& attribute : table.attributes) {
    if (attribute.name == "scene") attribute.value = std::string(100'000, '#') + "\n";
  }
  std::swap(*std::ranges::find(table.attributes, "scene", &Attribute::name), table.attributes.back());
  write_table(table, at("t.nc"));
  expect_same(read_table(at("t.nc")), table);
}

TEST_F(TableFiles, Netcdf_FlippedBit_IsFoundOrChangesNothing) {
  const TableValues table = sample_table(12, 6, 4);
  write_table(table, at("t.nc"));
  const std::string bytes = read_file(at("t.nc"));
  constexpr std::uint64_t kSeed = 4;
  std::cout << "seed " << kSeed << '\n';
  std::mt19937_64 random(kSeed);
  int found = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    std::string damaged = bytes;
    char& byte = damaged[random() % damaged.size()];
    byte = static_cast<char>(byte ^ (1 << random() % 8));
    put("damaged.nc", damaged);
    try {
      TableValues read = read_table(at("damaged.nc"));
      // The hash is over all numbers and labels, but not over texts such as the title.
      read.attributes = table.attributes;
      read.stokes_units = table.stokes_units;
      expect_same(read, table);
      if (HasFailure()) return;
    } catch (const InputError&) {
      ++found;
    }
  }
  EXPECT_GT(found, 500);
}

TEST_F(TableFiles, ReadTable_Pipe_IsRefused) {
  ASSERT_EQ(::mkfifo(at("t.nc").c_str(), 0600), 0);
  EXPECT_THROW(read_table(at("t.nc")), InputError);
}

// ---- CSV and NPY ----------------------------------------------------------------------------------------------------

TEST_F(TableFiles, ReadTable_AttributeOfTypeString_IsText) {
  const char* text = "10.6 \u00b5m";
  {
    const BareFile bare(at("string.nc"), {1, 1, 1});
    const double value = 0.5;
    for (const int variable : bare.variables) EXPECT_EQ(nc_put_var_double(bare.file, variable, &value), NC_NOERR);
    EXPECT_EQ(nc_put_att_string(bare.file, NC_GLOBAL, "scene", 1, &text), NC_NOERR);
  }
  EXPECT_EQ(TableReader(at("string.nc")).head().attributes, (std::vector<Attribute>{{"scene", std::string(text)}}));
}

TEST_F(TableFiles, Csv_Rows_ReadBackAsTheSameDoubles) {
  const TableValues table = sample_table(3, 2, 2);
  write_table(table, at("t.csv"));
  std::istringstream lines(read_file(at("t.csv")));
  std::string names, line, comments;
  std::getline(lines, names);
  while (lines.peek() == '#' && std::getline(lines, line)) comments += line + "\n";
  EXPECT_NE(comments.find("# scene: a = 1\n#   b = 2\n# driver: \n"), std::string::npos) << comments;
  EXPECT_NE(comments.find("# tolerance: 1e-04\n"), std::string::npos) << comments;
  EXPECT_EQ(names,
            "theta_deg,sigma,q,dolp,q_over_i,aolp_deg,stokes_i,stokes_q,stokes_u,stokes_v,rho_i,rho_q,rho_u,"
            "albedo,emissivity_s,emissivity_p,dolp_low,dolp_high,error_estimate,rho_error_estimate,status");
  for (std::size_t i = 0; i < table.size(); ++i) {
    ASSERT_TRUE(std::getline(lines, line));
    std::istringstream cells(line);
    const auto number = [&] {
      std::string cell;
      std::getline(cells, cell, ',');
      return std::stod(cell);
    };
    EXPECT_EQ(number(), table.axes[Axis::kTheta][i / 4]);
    EXPECT_EQ(number(), table.axes[Axis::kSigma][i / 2 % 2]);
    EXPECT_EQ(number(), table.axes[Axis::kQ][i % 2]);
    for (const Quantity quantity : kAllQuantities)
      expect_same({number()}, {table[quantity][i]}, describe(quantity).name);
    EXPECT_EQ(number(), table.status[i]);
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST_F(TableFiles, Npy_Bytes_AreAStructuredArray) {
  TableValues table = sample_table(3, 1, 2);
  table[Quantity::kStokesU].clear();
  write_table(table, at("t.npy"));
  const std::string bytes = read_file(at("t.npy"));
  ASSERT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t start = 10 + static_cast<unsigned char>(bytes[8]) + 256 * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ(start % 64, 0u);
  const std::string header = bytes.substr(10, start - 10);
  EXPECT_NE(header.find("'shape': (3, 1, 2)"), std::string::npos) << header;
  EXPECT_NE(header.find("('q', '<f8'), ('dolp', '<f8')"), std::string::npos) << header;
  EXPECT_NE(header.find("('status', '<u4')"), std::string::npos) << header;
  EXPECT_EQ(header.find("stokes_u"), std::string::npos) << header;
  constexpr std::size_t kReals = 3 + kQuantityCount - 1;
  constexpr std::size_t kRecord = kReals * sizeof(double) + sizeof(std::uint32_t);
  ASSERT_EQ(bytes.size() - start, table.size() * kRecord);
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::array<double, kReals> record{};
    std::memcpy(record.data(), bytes.data() + start + i * kRecord, sizeof record);
    expect_same({record[0], record[1], record[2], record[3], record[6]},
                {table.axes[Axis::kTheta][i / 2], table.axes[Axis::kSigma][0], table.axes[Axis::kQ][i % 2],
                 table[Quantity::kDolp][i], table[Quantity::kStokesI][i]},
                "record");
  }
}

TEST(NumberText, Doubles_ReadBack) {
  for (const double value : {0.1, 1.0 / 3.0, -2.5e-308, 5e-324, 1.7976931348623157e308, 90.0, 1e-4})
    EXPECT_EQ(std::strtod(number_text(value).c_str(), nullptr), value) << number_text(value);
  EXPECT_EQ(number_text(90.0), "90");
  EXPECT_EQ(number_text(-kNan), "nan");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(PrintableLine, WhatATerminalObeys_IsReplaced) {
  EXPECT_EQ(printable_line("10.6 \u00b5m, \u03c3\t\u20ac \U0001d70c"), "10.6 \u00b5m, \u03c3\t\u20ac \U0001d70c");
  EXPECT_EQ(printable_line("\x1b]0;title\a\r\n\x7f"), "?]0;title????");
  EXPECT_EQ(printable_line("\u009b31m\u2028\u202e\u2066"), "?31m???");
  // Invalid UTF-8: a stray byte, a cut character, overlong characters, a surrogate.
  EXPECT_EQ(printable_line("a\x80z\xc3"), "a?z?");
  EXPECT_EQ(printable_line("\xc0\xaf\xe0\x80\xaf\xed\xa0\x80"), "????????");
  EXPECT_EQ(printable_line(std::string_view("\0", 1)), "?");
}
}  // namespace table_test
