// SPDX-License-Identifier: Apache-2.0
#include "mpi/netcdf_file.hpp"

#include <pnetcdf.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"
#include "mpi/hash.hpp"
#include "mpi/plain_file.hpp"

namespace garrison::mpi {
namespace {

constexpr const char* kForm =
    "a netCDF file in a classic form; xarray writes one with to_netcdf(path, engine=\"scipy\")";

std::string shape(std::span<const std::int64_t> sizes) {
  std::string text;
  for (const std::int64_t size : sizes) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text.empty() ? "one number" : text;
}

std::ifstream opened(const std::string& path) {
  if (const std::string got = not_a_file(path); !got.empty())
    throw IoError(path + ": got " + got + ", expected " + kForm);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path + ": got " + std::strerror(errno) + ", expected " + kForm);
  return file;
}

/// Whole numbers and floating ones have names of their own; a text has none.
std::int64_t bytes_of(int type) {
  switch (type) {
    case NC_BYTE:
    case NC_UBYTE:
      return 1;
    case NC_SHORT:
    case NC_USHORT:
      return 2;
    case NC_INT:
    case NC_UINT:
    case NC_FLOAT:
      return 4;
    case NC_DOUBLE:
    case NC_INT64:
    case NC_UINT64:
      return 8;
    default:
      return 0;
  }
}

}  // namespace

NetcdfVariable::NetcdfVariable(const std::string& path, const std::string& name) : path_(path), name_(name) {
  open();
  try {
    describe();
    require_all_there();
  } catch (...) {
    ncmpi_close(file_);
    throw;
  }
}

NetcdfVariable::~NetcdfVariable() { ncmpi_close(file_); }

void NetcdfVariable::check(int code) const {
  if (code != NC_NOERR) refuse(where(), ncmpi_strerror(code), "numbers that can be read", "write it anew");
}

void NetcdfVariable::open() {
  std::array<char, 4> magic{};
  opened(path_).read(magic.data(), magic.size());
  const std::string_view begins(magic.data(), magic.size());
  if (begins == "\x89HDF") refuse(path_, "HDF5 (netCDF-4)", kForm);
  const bool classic = begins.starts_with("CDF") && (magic[3] == 1 || magic[3] == 2 || magic[3] == 5);
  if (!classic) refuse(path_, "something else", kForm);
  const int code = ncmpi_open(MPI_COMM_SELF, path_.c_str(), NC_NOWRITE, MPI_INFO_NULL, &file_);
  if (code != NC_NOERR)
    refuse(path_, ncmpi_strerror(code), kForm, "it may have been cut short: write it anew");
}

void NetcdfVariable::describe() {
  int variables = 0;
  check(ncmpi_inq_nvars(file_, &variables));
  if (ncmpi_inq_varid(file_, name_.c_str(), &id_) != NC_NOERR) {
    std::string known;
    for (int k = 0; k < variables; ++k) {
      std::array<char, NC_MAX_NAME + 1> name{};
      check(ncmpi_inq_varname(file_, k, name.data()));
      known += (known.empty() ? "" : ", ") + std::string(name.data());
    }
    refuse(path_, "no variable \"" + name_ + "\"", known.empty() ? "one" : "one; it has " + known,
           "name another: { file = .., variable = .. }");
  }
  int dimensions = 0;
  int unlimited = -1;
  check(ncmpi_inq_vartype(file_, id_, &type_));
  check(ncmpi_inq_varndims(file_, id_, &dimensions));
  check(ncmpi_inq_unlimdim(file_, &unlimited));
  std::vector<int> ids(static_cast<std::size_t>(dimensions));
  check(ncmpi_inq_vardimid(file_, id_, ids.data()));
  for (const int id : ids) {
    MPI_Offset size = 0;
    check(ncmpi_inq_dimlen(file_, id, &size));
    sizes_.push_back(size);
    if (size == 0) refuse(where(), "no numbers", "at least one row");
    if (id == unlimited) refuse(where(), "an unlimited dimension", "fixed ones");
  }
  if (bytes_of(type_) == 0) refuse(where(), "text", "numbers");
  for (const char* name : {"_FillValue", "missing_value"}) {
    MPI_Offset length = 0;
    if (ncmpi_inq_attlen(file_, id_, name, &length) != NC_NOERR) continue;
    std::vector<double> given(static_cast<std::size_t>(length));
    check(ncmpi_get_att_double(file_, id_, name, given.data()));
    missing_.insert(missing_.end(), given.begin(), given.end());
  }
  if (type_ == NC_DOUBLE || type_ == NC_FLOAT) missing_.push_back(NC_FILL_DOUBLE);  // never written
  for (const char* packed : {"scale_factor", "add_offset"}) {
    MPI_Offset length = 0;
    if (ncmpi_inq_attlen(file_, id_, packed, &length) == NC_NOERR)
      refuse(where(), std::string("packed numbers (") + packed + ")", "numbers as they are");
  }
}

/// A file that was cut reads as zeros behind its end.
void NetcdfVariable::require_all_there() const {
  MPI_Offset begin = 0;
  check(ncmpi_inq_varoffset(file_, id_, &begin));
  const std::int64_t numbers =
      std::accumulate(sizes_.begin(), sizes_.end(), std::int64_t{1}, std::multiplies<>());
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path_));
  if (numbers > (size - begin) / bytes_of(type_))
    refuse(where(), "a file of " + amount(size, "byte") + ", cut short",
           amount(numbers, "number") + " from byte " + std::to_string(begin) + " on", "write it anew");
}

void NetcdfVariable::require(std::span<const std::int64_t> sizes, bool whole,
                             const std::string& dimensions) const {
  const bool fits =
      std::equal(sizes.begin(), sizes.end(), sizes_.begin(), sizes_.end(),
                 [](std::int64_t asked, std::int64_t got) { return asked < 0 || asked == got; });
  if (!fits) refuse(where(), shape(sizes_) + " numbers", dimensions);
  if (whole && (type_ == NC_FLOAT || type_ == NC_DOUBLE))
    refuse(where(), "floating-point numbers", "whole ones", "write it as int32");
}

template <class Number, class Get>
void NetcdfVariable::read_rows(std::int64_t first, std::int64_t count, std::vector<Number>& out,
                               const Get& get) const {
  std::vector<MPI_Offset> start(sizes_.size(), 0);
  std::vector<MPI_Offset> counts(sizes_.begin(), sizes_.end());
  start.front() = first;
  counts.front() = count;
  check(get(file_, id_, start.data(), counts.data(), out.data()));
}
void NetcdfVariable::read(std::int64_t first, std::int64_t count, std::vector<int>& out) const {
  read_rows(first, count, out, ncmpi_get_vara_int_all);
  const auto numbers = static_cast<std::ptrdiff_t>(
      std::accumulate(sizes_.begin() + 1, sizes_.end(), count, std::multiplies<>()));
  const auto end = out.begin() + numbers;
  const auto found =
      std::find_first_of(out.begin(), end, missing_.begin(), missing_.end(),
                         [](int value, double missing) { return static_cast<double>(value) == missing; });
  if (found != end)
    refuse(where() + ", row " + std::to_string(first + (found - out.begin()) * count / numbers),
           std::to_string(*found) + ", which its _FillValue or missing_value says is missing", "numbers");
}
void NetcdfVariable::read(std::int64_t first, std::int64_t count, std::vector<double>& out) const {
  read_rows(first, count, out, ncmpi_get_vara_double_all);
  for (double& value : out)
    if (std::find(missing_.begin(), missing_.end(), value) != missing_.end()) value = kNaN;
}

std::uint64_t checksum_of_file(const std::string& path) {
  std::ifstream file = opened(path);
  std::vector<std::uint64_t> words(1 << 17);
  std::uint64_t sum = 0;
  while (file) {
    file.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(8 * words.size()));
    const auto bytes = static_cast<std::size_t>(file.gcount());
    auto* const end = reinterpret_cast<char*>(words.data()) + bytes;
    std::fill_n(end, (8 - bytes % 8) % 8, '\0');
    for (std::size_t k = 0; k < (bytes + 7) / 8; ++k) sum = mixed(sum ^ words[k]);
    sum = mixed(sum ^ bytes);
  }
  if (file.bad()) throw IoError(path + ": got " + std::strerror(errno) + ", expected to read it");
  return sum;
}

}  // namespace garrison::mpi
