// SPDX-License-Identifier: Apache-2.0
// Dependencies point one way: core <- kernel; core <- analysis <- certificate <- filters <- engine <-
// drivers and node; drivers <- partition <- mpi; core <- attacks <- engine; core <- wire <- certificate.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "garrison/filters/families.hpp"

namespace fs = std::filesystem;
using namespace garrison;

namespace {
/// What each folder may include, besides itself.
const std::map<std::string, std::set<std::string>> allowed{
    {"core", {"core"}},
    {"kernel", {"kernel", "core"}},
    {"wire", {"wire", "core"}},
    {"analysis", {"analysis", "core", "kernel"}},
    {"certificate", {"certificate", "analysis", "wire", "core", "kernel"}},
    {"attacks", {"attacks", "core", "kernel"}},
    {"filters", {"filters", "certificate", "analysis", "core", "kernel"}},
    {"engine", {"engine", "attacks", "certificate", "wire", "core", "kernel"}},
    {"node", {"node", "engine", "wire", "core"}},
    {"drivers", {"drivers", "engine", "attacks", "certificate", "wire", "core", "kernel"}},
    {"partition", {"partition", "drivers", "engine", "filters", "attacks", "wire", "core", "kernel"}},
    {"mpi", {"mpi", "partition", "node", "drivers", "engine", "attacks", "wire", "core"}},
};

/// The folder that a path below include/garrison or src begins with; the version belongs to the core,
/// the header that includes them all to the top.
std::string layer(const fs::path& path) {
  const std::string first = path.begin()->string();
  if (first == "version.hpp") return "core";
  return first == "garrison.hpp" ? "drivers" : first;
}

/// What a line includes, in quotes or in angle brackets; empty: nothing.
std::string included(const std::string& line) {
  static const std::regex pattern("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
  std::smatch match;
  return std::regex_search(line, match, pattern) ? match[1].str() : "";
}

/// The folder of the project in which that is found from a file in `here` below src; empty: none of ours.
std::string layer_of(const std::string& name, const fs::path& here) {
  const fs::path root = fs::path(GARRISON_SOURCE) / "src";
  if (name.starts_with("garrison/")) return layer(fs::path(name).lexically_relative("garrison"));
  if (fs::exists(root / here / name)) return layer((here / name).lexically_normal());
  return fs::exists(root / name) ? layer(name) : "";
}
}  // namespace

TEST_CASE("headers include only what is below them") {
  const fs::path root = fs::path(GARRISON_SOURCE) / "include" / "garrison";
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".hpp" || entry.path().filename() == "garrison.hpp") continue;
    const std::string folder = layer(fs::relative(entry.path(), root));
    REQUIRE(allowed.count(folder) == 1);
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      const std::string name = included(line);
      if (!name.starts_with("garrison/")) continue;
      ++seen;
      CAPTURE(entry.path().string());
      CAPTURE(line);
      CHECK(allowed.at(folder).count(layer_of(name, {})) == 1);
    }
  }
  CHECK(seen > 50);
}

TEST_CASE("what is not about one family names none") {
  const fs::path root(GARRISON_SOURCE);
  std::vector<std::string> names;
  Families::each([&]<class F>() { names.push_back("\"" + std::string(F::name) + "\""); });
  for (const char* folder : {"include/garrison/core", "include/garrison/engine", "include/garrison/drivers",
                             "src/core", "src/engine", "src/drivers"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);)
        for (const std::string& name : names) {
          CAPTURE(entry.path().string());
          CAPTURE(line);
          CHECK(line.find(name) == std::string::npos);
        }
    }
}

TEST_CASE("compiled parts include only what is below them") {
  // Where a family meets its drivers: it is instantiated there, and its trials run side by side.
  const std::set<std::string> bridges{"garrison/engine/filter_of.hpp", "garrison/engine/plan/consensus.hpp"};
  const fs::path root = fs::path(GARRISON_SOURCE) / "src";
  std::map<std::string, int> bridged;  // by family: its folder, or its only file
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const auto extension = entry.path().extension();
    if (extension != ".hpp" && extension != ".cpp") continue;
    const std::string folder = fs::relative(entry.path(), root).begin()->string();
    if (folder == "registry.cpp") continue;  // knows everybody
    REQUIRE(allowed.count(folder) == 1);
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      const std::string name = included(line);
      const std::string target = layer_of(name, fs::relative(entry.path(), root).parent_path());
      if (target.empty()) continue;
      ++seen;
      CAPTURE(entry.path().string());
      CAPTURE(line);
      if (folder == "filters" && bridges.count(name) == 1)
        ++bridged[std::next(fs::relative(entry.path(), root).begin())->string()];
      else
        CHECK(allowed.at(folder).count(target) == 1);
    }
  }
  CHECK(seen > 50);
  for (const auto& [family, bridges_of_it] : bridged) {
    CAPTURE(family);
    CHECK(bridges_of_it <= 2);  // one to be instantiated, one for trials side by side
  }
}

TEST_CASE("no header turns a family into a filter: that is compiled once") {
  const fs::path root = fs::path(GARRISON_SOURCE) / "include";
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      CAPTURE(entry.path().string());
      CHECK(line.find("#include \"garrison/engine/filter_of.hpp\"") == std::string::npos);
      CHECK(line.find("#include \"../") == std::string::npos);
    }
  }
}

TEST_CASE("what nodes run needs no analysis, no decomposition and no exception") {
  const fs::path root = fs::path(GARRISON_SOURCE) / "src" / "filters";
  const std::regex forbidden(
      "garrison/(analysis|certificate)/|solvers\\.hpp|facts\\.hpp|\\b(throw|try|catch|refuse)\\b");
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().parent_path().filename() != "runtime") continue;
    ++seen;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      CAPTURE(entry.path().string());
      CAPTURE(line);
      CHECK(!std::regex_search(line.substr(0, line.find("//")), forbidden));
    }
  }
  CHECK(seen > 5);
}
