// SPDX-License-Identifier: Apache-2.0
// Variables of netCDF files in the classic forms (CDF-1, 2, 5), read by one rank on its own, part by part.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace garrison::mpi {

/// One variable of fixed sizes, open for reading. Errors name the file and the variable.
/// Threads: one at a time.
class NetcdfVariable {
 public:
  /// @throws IoError when the file cannot be read, InvalidInput when it is no such file, is cut short, or has
  /// no such variable of plain numbers
  NetcdfVariable(const std::string& path, const std::string& name);
  NetcdfVariable(const NetcdfVariable&) = delete;
  NetcdfVariable& operator=(const NetcdfVariable&) = delete;
  ~NetcdfVariable();

  /// Refuses other sizes than these (-1: any), and numbers that are not whole where `whole`; `dimensions`:
  /// these as people write them.
  void require(std::span<const std::int64_t> sizes, bool whole, const std::string& dimensions) const;
  std::int64_t rows() const { return sizes_.front(); }
  /// "FILE, variable "edges"", for messages.
  std::string where() const { return path_ + ", variable \"" + name_ + "\""; }

  /// Rows first..first+count-1 into `out`, which has room for them. @throws InvalidInput
  void read(std::int64_t first, std::int64_t count, std::vector<int>& out) const;
  /// Values that say "missing" (_FillValue, missing_value) are NaN.
  void read(std::int64_t first, std::int64_t count, std::vector<double>& out) const;

 private:
  void open();
  void describe();
  void require_all_there() const;
  void check(int code) const;
  template <class Number, class Get>
  void read_rows(std::int64_t first, std::int64_t count, std::vector<Number>& out, const Get& get) const;

  std::string path_;
  std::string name_;
  int file_ = -1;
  int id_ = -1;
  int type_ = 0;
  std::vector<std::int64_t> sizes_;
  std::vector<double> missing_;
};

/// Of the bytes of a file; the same on all ranks. @throws IoError
std::uint64_t checksum_of_file(const std::string& path);

}  // namespace garrison::mpi
