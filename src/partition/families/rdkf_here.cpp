// SPDX-License-Identifier: Apache-2.0
#include "partition/families/rdkf_here.hpp"

#include "partition/ghost_numbers.hpp"

namespace garrison::partition {
namespace {

/// Covariances of ghosts travel as estimates do in a run.
class Ghosts final : public rdkf::Borders {
 public:
  Ghosts(const Region& region, Exchange& exchange, int states)
      : exchange_(exchange),
        names_(region.names()),
        numbers_(region, exchange, static_cast<std::size_t>(states * states)) {}
  void refresh(std::vector<Matrix>& P) override {
    numbers_.fetch_by([&](int place) {
      return P[static_cast<std::size_t>(names_[static_cast<std::size_t>(place)])].data();
    });
  }
  double largest(double value) override {
    exchange_.largest(std::span(&value, 1));
    return value;
  }

 private:
  Exchange& exchange_;
  std::vector<int> names_;
  GhostNumbers<double> numbers_;
};

/// Own agents and ghosts by name; ghosts have no rows.
Model model_by_name(const Model& own, const Cast& cast) {
  std::vector<Matrix> C;
  Noise noise;
  noise.process_bound = own.noise().process_bound;
  noise.process_covariance = own.noise().process_covariance;
  const auto& variances = own.noise().measurement_covariance;
  for (std::size_t name = 0, k = 0; name < cast.ids.size(); ++name) {
    const bool here = cast.own[name] != 0;
    C.push_back(here ? own.C(static_cast<int>(k)) : Matrix(0, own.states()));
    if (!variances.empty()) noise.measurement_covariance.push_back(here ? variances[k] : Matrix(0, 0));
    k += here ? 1 : 0;
  }
  return {own.A(), std::move(C), std::move(noise)};
}

Network network_by_name(const Region& region) {
  const auto names = region.names();
  std::vector<Edge> edges;
  for (int place = 0; place < region.own; ++place)
    for (std::size_t e = region.first[static_cast<std::size_t>(place)];
         e < region.first[static_cast<std::size_t>(place) + 1]; ++e)
      if (region.heard[e] >= region.own || region.heard[e] < place)
        edges.emplace_back(names[static_cast<std::size_t>(region.heard[e])],
                           names[static_cast<std::size_t>(place)]);
  return {region.places(), edges};
}

}  // namespace

template <class Params>
Rdkf::Gains rdkf_here(const Params& params, const Model& own, const Region& region, Exchange& exchange) {
  const Cast cast(region);
  Ghosts ghosts(region, exchange, own.states());
  auto gains = rdkf::design_part(params, model_by_name(own, cast), network_by_name(region), ghosts);
  for (std::size_t name = 0; name < cast.ids.size(); ++name) {
    if (cast.own[name] != 0) continue;
    rdkf::AgentGains ghost;
    ghost.J = std::move(gains.agents[name].J);
    gains.agents[name] = std::move(ghost);
  }
  return gains;
}

template Rdkf::Gains rdkf_here(const Rdkf::Params&, const Model&, const Region&, Exchange&);
template Rdkf::Gains rdkf_here(const Dkf::Params&, const Model&, const Region&, Exchange&);

}  // namespace garrison::partition
