// SPDX-License-Identifier: Apache-2.0
// Dependencies point one way: core <- analysis, core <- attacks, core <- filters <- runtime.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace fs = std::filesystem;

TEST_CASE("headers include only what is below them") {
  const std::map<std::string, std::set<std::string>> allowed{
      {"core", {"core"}},
      {"analysis", {"analysis", "core"}},
      {"attacks", {"attacks", "core"}},
      {"filters", {"filters", "analysis", "core"}},
      {"runtime", {"runtime", "filters", "attacks", "core"}},
  };
  const fs::path root = fs::path(GARRISON_SOURCE) / "include" / "garrison";
  const std::regex include("#include \"garrison/([a-z]+)/");
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".hpp") continue;
    const std::string folder = fs::relative(entry.path(), root).begin()->string();
    REQUIRE(allowed.count(folder) == 1);
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, include)) continue;
      ++seen;
      CAPTURE(entry.path().string());
      CAPTURE(line);
      CHECK(allowed.at(folder).count(match[1]) == 1);
    }
  }
  CHECK(seen > 50);
}
