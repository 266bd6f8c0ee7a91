// SPDX-License-Identifier: Apache-2.0
// The whole library's side: designs every family, writes each agent's part into a folder, and prints what the
// agents of these parts estimate.
#include <filesystem>
#include <fstream>
#include <garrison/core/model.hpp>
#include <garrison/core/network.hpp>
#include <garrison/engine/design_file.hpp>
#include <garrison/filters/platoon/world.hpp>
#include <iostream>
#include <set>

#include "agents.hpp"

using namespace garrison;

namespace {

struct Case {
  std::string family;
  std::string name;
  ParamMap params;
};

Model plant() {
  Matrix A = 0.9 * Matrix::Identity(4, 4);
  A.diagonal(1).setConstant(0.1);
  std::vector<Matrix> C;
  for (int i = 0; i < 5; ++i) C.push_back(Matrix::Identity(4, 4).row(i % 4));
  Noise noise;
  noise.process_bound = 0.01;
  noise.measurement_bound = Vector::Constant(5, 0.01);
  noise.process_covariance = 1e-4 * Matrix::Identity(4, 4);
  noise.measurement_covariance.assign(5, 1e-4 * Matrix::Identity(1, 1));
  return {A, C, noise};
}

std::vector<Case> cases() {
  const ParamMap string{
      {"reference", std::vector<double>{120.0, 10.0}}, {"spacing", 20.0}, {"gs", 2.0}, {"gv", 4.0}};
  ParamMap vehicles = string;
  vehicles.insert({{"attacked", std::int64_t{1}},
                   {"process_noise", 0.01},
                   {"measurement_noise", 0.01},
                   {"initial_error", 100.0}});
  ParamMap pairs = vehicles;
  pairs.insert({{"pairs", true}, {"median", true}});
  ParamMap pbe = string;
  pbe["kind"] = "pbe";
  return {
      {"saturation", "plain", {{"threshold", 0.5}, {"rounds", std::int64_t{3}}}},
      {"scalar_gain", "plain", {{"rounds", std::int64_t{2}}}},
      {"lfre", "plain", {}},
      {"rdkf", "norm", {{"weight", 0.5}}},
      {"rdkf", "l1", {{"weight", 0.5}, {"penalty", "l1"}}},
      {"rdkf", "group", {{"weight", 0.5}, {"penalty", "group"}}},
      {"dkf", "plain", {}},
      {"partial_sharing", "frozen", {{"gain", 0.1}, {"shared", std::int64_t{2}}}},
      {"partial_sharing", "steady", {{"gain", 0.1}, {"gains", "steady"}}},
      {"structural", "plain", {}},
      {"platoon", "plain", vehicles},
      {"platoon", "pairs", pairs},
      {"platoon_baseline", "pbe", pbe},
  };
}

bool own_states(const std::string& family) { return family.starts_with("platoon"); }

int run(const std::filesystem::path& folder, const Case& one) {
  const bool vehicles = own_states(one.family);
  const Model model = vehicles ? platoon::model(7, 0.05) : plant();
  const Network network = vehicles ? Network::band(7, 2) : Network::ring(5);
  const auto prepared = make_filter(one.family, one.params)->prepare(model, network);
  std::vector<std::unique_ptr<Agent>> agents;
  for (int i = 0; i < model.agents(); ++i) {
    const auto part = write_part(*prepared, i);
    std::ofstream(folder / (std::to_string(i) + ".part"), std::ios::binary)
        .write(reinterpret_cast<const char*>(part.data()), static_cast<std::streamsize>(part.size()));
    agents.push_back(read_part(part));
  }
  return drive(agents) ? 0 : 1;
}

}  // namespace

/// Without arguments: the cases. With FAMILY CASE FOLDER: that one.
int main(int count, char** words) {
  if (count == 4) {
    for (const Case& one : cases())
      if (one.family == words[1] && one.name == words[2]) return run(words[3], one);
    return 2;
  }
  std::set<std::string> covered;
  for (const Case& one : cases()) {
    covered.insert(one.family);
    std::cout << one.family << ' ' << one.name << '\n';
  }
  for (const FamilyInfo& family : families())
    if (covered.count(family.name) == 0) {
      std::cerr << "tests/package/parts.cpp has no case for the family " << family.name << '\n';
      return 1;
    }
}
