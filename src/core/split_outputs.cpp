// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/split_outputs.hpp"

#include <algorithm>

namespace garrison {
namespace {

/// The old name, and after a colon the output where an agent has several.
std::vector<std::string> part_names(const Model& model, const Network& network, const std::vector<int>& owner,
                                    const std::vector<int>& first) {
  std::vector<std::string> names;
  if (network.names().empty()) return names;
  const auto& outputs = model.labels().outputs;
  for (std::size_t k = 0; k < owner.size(); ++k) {
    const int i = owner[k];
    const int r = static_cast<int>(k) - first[static_cast<std::size_t>(i)];
    std::string name = network.names()[static_cast<std::size_t>(i)];
    if (model.outputs(i) > 1)
      name += ":" + (outputs.empty() ? std::to_string(r + 1)
                                     : outputs[static_cast<std::size_t>(model.offset(i) + r)]);
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

SplitSystem split_outputs(const Model& model, const Network& network) {
  if (model.agents() != network.agents())
    refuse("network", amount(network.agents(), "agent"), std::to_string(model.agents()));
  std::vector<int> first;  // new id of each old agent's first part
  std::vector<int> owner;
  for (int i = 0; i < model.agents(); ++i) {
    first.push_back(static_cast<int>(owner.size()));
    owner.insert(owner.end(), static_cast<std::size_t>(std::max(1, model.outputs(i))), i);
  }
  first.push_back(static_cast<int>(owner.size()));

  const Noise& old = model.noise();
  Noise noise{old.process_bound, {}, old.process_covariance, {}};
  if (old.measurement_bound.size() != 0)
    noise.measurement_bound.resize(static_cast<Eigen::Index>(owner.size()));
  std::vector<Matrix> C;
  for (std::size_t k = 0; k < owner.size(); ++k) {
    const int i = owner[k];
    if (!old.agent_process_covariance.empty())
      noise.agent_process_covariance.push_back(old.agent_process_covariance[static_cast<std::size_t>(i)]);
    const int r = static_cast<int>(k) - first[static_cast<std::size_t>(i)];
    const bool senses = model.outputs(i) > 0;
    C.push_back(senses ? Matrix(model.C(i).row(r)) : Matrix(0, model.states()));
    if (old.measurement_bound.size() != 0)
      noise.measurement_bound(static_cast<Eigen::Index>(k)) = old.measurement_bound(i);
    if (!old.measurement_covariance.empty()) {
      const Matrix& S = old.measurement_covariance[static_cast<std::size_t>(i)];
      noise.measurement_covariance.push_back(senses ? Matrix::Constant(1, 1, S(r, r)) : Matrix(0, 0));
    }
  }

  std::vector<Edge> edges;
  const auto join = [&](int a, int b) {
    for (int p = first[static_cast<std::size_t>(a)]; p < first[static_cast<std::size_t>(a) + 1]; ++p)
      for (int q = first[static_cast<std::size_t>(b)]; q < first[static_cast<std::size_t>(b) + 1]; ++q)
        if (p != q) edges.emplace_back(p, q);
  };
  for (const auto& [from, to] : network.edges()) join(from, to);
  for (int i = 0; i < model.agents(); ++i) join(i, i);
  const int parts = static_cast<int>(owner.size());
  // Measurements keep their order, and with it their names, sources and units.
  return {Model(model.A(), std::move(C), std::move(noise), {}, model.labels(), model.B()),
          Network(parts, edges, network.directed(), part_names(model, network, owner, first)),
          std::move(owner)};
}

}  // namespace garrison
