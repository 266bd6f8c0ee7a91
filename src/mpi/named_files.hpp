// SPDX-License-Identifier: Apache-2.0
// The netCDF files that a scenario names.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "mpi/hash.hpp"
#include "mpi/netcdf_file.hpp"
#include "mpi/netcdf_inputs.hpp"
#include "mpi/values.hpp"
#include "node/daemon/toml_file.hpp"

namespace garrison::mpi {

/// Paths are relative to the scenario. Threads: one at a time.
class Inputs {
 public:
  explicit Inputs(const std::string& scenario) : folder_(std::filesystem::path(scenario).parent_path()) {}

  /// What `key = { file = "..", variable = ".." }` means; the variable is called as the key is.
  NetcdfInput of(const node::Section& s, const char* key) {
    const node::Section named = s.section(key);
    named.only({"file", "variable"});
    const std::string name = named.text("file");
    if (name.empty()) refuse(named.where("file"), "\"\"", "the path of a netCDF file");
    NetcdfInput input{(folder_ / name).string(), named.text("variable", key)};
    if (!checksums_.contains(input.path))
      checksums_[input.path] = placed(named, "file", [&] { return checksum_of_file(input.path); });
    return input;
  }
  std::vector<std::string> paths() const {
    std::vector<std::string> all;
    for (const auto& [path, one] : checksums_) all.push_back(path);
    return all;
  }
  std::uint64_t checksum(const NetcdfInput& input) const { return checksums_.at(input.path); }
  /// Of all of them, whatever they are called.
  std::uint64_t checksum() const {
    std::uint64_t sum = 0;
    for (const auto& [path, one] : checksums_) sum += mixed(one);
    return sum;
  }

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::uint64_t> checksums_;
};

}  // namespace garrison::mpi
