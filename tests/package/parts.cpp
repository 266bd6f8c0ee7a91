// SPDX-License-Identifier: Apache-2.0
// The whole library's side: designs every family, writes each agent's part into a folder, and prints what the
// agents of these parts estimate.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <garrison/core/model.hpp>
#include <garrison/core/network.hpp>
#include <garrison/engine/design_file.hpp>
#include <garrison/filters/platoon/world.hpp>
#include <iostream>

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

/// A family that is not named here runs as it comes.
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
  std::vector<Case> all{
      {"saturation", "plain", {{"threshold", 0.5}, {"rounds", std::int64_t{3}}}},
      {"scalar_gain", "plain", {{"rounds", std::int64_t{2}}}},
      {"rdkf", "norm", {{"weight", 0.5}}},
      {"rdkf", "l1", {{"weight", 0.5}, {"penalty", "l1"}}},
      {"rdkf", "group", {{"weight", 0.5}, {"penalty", "group"}}},
      {"partial_sharing", "frozen", {{"gain", 0.1}, {"shared", std::int64_t{2}}}},
      {"partial_sharing", "steady", {{"gain", 0.1}, {"gains", "steady"}}},
      {"platoon", "plain", vehicles},
      {"platoon", "pairs", pairs},
      {"platoon_baseline", "pbe", pbe},
  };
  for (const FamilyInfo& family : families())
    if (std::none_of(all.begin(), all.end(), [&](const Case& one) { return one.family == family.name; }))
      all.push_back({family.name, "plain", {}});
  return all;
}

int run(const std::filesystem::path& folder, const Case& one) {
  const auto filter = make_filter(one.family, one.params);
  const bool vehicles = filter->own_states();
  const Model model = vehicles ? platoon::model(7, 0.05) : plant();
  const Network network = vehicles ? Network::band(7, 2) : Network::ring(5);
  const auto prepared = filter->prepare(model, network);
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
  for (const Case& one : cases()) std::cout << one.family << ' ' << one.name << '\n';
}
