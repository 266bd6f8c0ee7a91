// SPDX-License-Identifier: Apache-2.0
// Turns a family F into an AnyFilter. Included only by the one source file that instantiates the family.
#pragma once

#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "garrison/core/dispatch.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/engine/design_file.hpp"
#include "garrison/engine/engine.hpp"
#include "garrison/engine/follows.hpp"
#include "garrison/engine/part.hpp"
#include "garrison/wire/outline.hpp"

namespace garrison {

/// A family that exists for one dimension only (and has refused others in `design`) is compiled for that one.
template <class F, class Action>
auto dispatched(int states, const Action& action) {
  if constexpr (requires { F::only_states; })
    return action.template operator()<F::only_states>();
  else
    return dispatch(states, action);
}

/// Refuses an agent of more rounds, or in a network of more agents, than agents on their own are made for.
template <class F>
void require_counts(const Part<F>& part) {
  const int rounds = F::rounds(part.gains);
  if (rounds > kMostRounds)
    refuse(std::string(F::name) + ".rounds", std::to_string(rounds),
           "at most " + std::to_string(kMostRounds) + " for agents on their own");
  if (part.who.agents > kMostAgents)
    refuse("design", "an agent of " + std::to_string(part.who.agents),
           "at most " + std::to_string(kMostAgents) + " for agents on their own",
           "a file that claims so many is forged or damaged");
}

/// Refuses an agent whose mailboxes take more memory than makes sense, before they do.
template <class F, int n>
void require_room(const Part<F>& part, const certificate::Certifier* certifier) {
  const double bytes = mail_bytes<F, n>(part.gains, part.who, certifier);
  const auto megabytes = [](double some) { return std::to_string(std::llround(some / 1e6)) + " MB"; };
  if (bytes > kMostMail)
    refuse("design",
           "an agent of " + std::to_string(part.who.agents) + " whose mailboxes, for " +
               amount(part.who.neighbours.size(), "neighbour") + " and " +
               amount(F::rounds(part.gains), "round") + ", would take " + megabytes(bytes),
           "at most " + megabytes(kMostMail),
           "design with fewer rounds or neighbours; a file that nobody designed so is forged or damaged");
}

template <class F>
std::unique_ptr<Agent> agent_of(Part<F> part) {
  require_counts(part);
  auto certifier = certifier_of(part.certificate, part.who, F::rounds(part.gains));
  const auto make = [&]<int n>() -> std::unique_ptr<Agent> {
    require_room<F, n>(part, certifier.get());
    auto gains = std::make_shared<const typename F::Gains>(std::move(part.gains));
    return std::make_unique<AgentOf<F, n>>(std::move(gains), std::move(part.who), std::move(certifier));
  };
  if constexpr (requires { F::only_states; })
    return make.template operator()<F::only_states>();
  else
    return dispatch_few(static_cast<int>(part.who.A.rows()), make);
}

/// Threads: constant once made; any number may share it.
template <class F>
class PreparedOf final : public Prepared {
 public:
  PreparedOf(std::shared_ptr<const AnyFilter> filter, std::shared_ptr<const typename F::Gains> gains,
             const Model& model, const Network& network,
             std::shared_ptr<const certificate::Plan> certificate = nullptr)
      : filter_(std::move(filter)),
        gains_(std::move(gains)),
        model_(model),
        network_(network),
        certificate_(std::move(certificate)) {}

  const Model& model() const override { return model_; }
  const Network& network() const override { return network_; }
  const AnyFilter& filter() const override { return *filter_; }
  std::unique_ptr<Runner> runner(int threads) const override {
    return dispatched<F>(model_.states(), [&]<int n>() -> std::unique_ptr<Runner> {
      auto certified = certificate_ == nullptr
                           ? nullptr
                           : std::make_unique<CertifiedNetwork>(certificate_, network_, F::rounds(*gains_));
      return std::make_unique<Engine<F, n>>(gains_, model_, network_, threads, std::move(certified));
    });
  }
  void check_start(const Matrix& x0) const override {
    if constexpr (requires { F::check_start(*gains_, x0); }) F::check_start(*gains_, x0);
  }
  void check_log(std::span<const double> measurements) const override {
    if constexpr (requires { F::check_log(*gains_, model_, measurements); })
      F::check_log(*gains_, model_, measurements);
  }
  std::unique_ptr<Agent> agent(int id) const override { return agent_of<F>(part(id)); }
  void require_varying(const Series& series) const override {
    const bool moves = !series.A.empty() || !series.C.empty();
    require_no_reason(moves ? "A or C that change in time" : "covariances that change in time",
                      why_constant<F>(*gains_));
    if constexpr (requires { F::require_series(series, model_); }) F::require_series(series, model_);
  }
  void require_functions() const override {
    std::string reason = why_constant<F>(*gains_);
    if constexpr (!requires(typename F::template State<1>& s) { F::template averaged<1>(s); })
      if (reason.empty()) reason = "its covariances move by A, which functions have not";
    require_no_reason("a plant by functions", reason);
  }
  std::unique_ptr<TrialsRunner> trials() const override {
    if (certificate_ != nullptr) return nullptr;
    if constexpr (requires { F::trials(gains_, model_, network_); })
      return F::trials(gains_, model_, network_);
    else
      return nullptr;
  }
  std::unique_ptr<World> world(const WorldOptions& options) const override {
    if constexpr (requires { F::world(*gains_, options); })
      return F::world(*gains_, options);
    else
      return nullptr;
  }

  std::shared_ptr<const certificate::Plan> certificate() const override { return certificate_; }
  std::shared_ptr<const Prepared> with(std::shared_ptr<const certificate::Plan> plan) const override {
    return std::make_shared<PreparedOf>(filter_, gains_, model_, network_, std::move(plan));
  }

  std::vector<std::byte> gains_bytes() const override { return wire::to_bytes(*gains_); }
  std::vector<std::string> gains_outline() const override { return wire::outline(*gains_); }
  std::vector<std::byte> part_bytes(int id) const override { return wire::to_bytes(part(id)); }
  std::uint64_t fingerprint() const override {
    std::call_once(known_, [&] { fingerprint_ = fingerprint_of(*this); });
    return fingerprint_;
  }

 private:
  void require_no_reason(const std::string& what, const std::string& reason) const {
    if (!reason.empty())
      refuse("model", what, "a constant plant for " + filter_->name(),
             reason + "; see docs/how-to/changing-plants.md");
  }
  AgentPart part_of(int id) const {
    if (id < 0 || id >= model_.agents())
      refuse("id", std::to_string(id), "an agent in 0.." + std::to_string(model_.agents() - 1));
    const auto heard = network_.neighbours(id);
    return {id, model_.agents(), model_.A(), model_.C(id).transpose(), {heard.begin(), heard.end()},
            0,  model_.B()};
  }
  Part<F> part(int id) const {
    AgentPart who = part_of(id);
    who.design = fingerprint();
    auto certificate = certificate_part(certificate_.get(), who);
    if constexpr (requires { F::part(*gains_, id, std::span<const int>()); })
      return {who, F::part(*gains_, id, who.neighbours), std::move(certificate)};
    else
      return {who, *gains_, std::move(certificate)};
  }

  std::shared_ptr<const AnyFilter> filter_;
  std::shared_ptr<const typename F::Gains> gains_;
  Model model_;
  Network network_;
  std::shared_ptr<const certificate::Plan> certificate_;  // null = none
  mutable std::once_flag known_;
  mutable std::uint64_t fingerprint_ = 0;
};

/// Threads: constant once made; any number may share it.
template <class F>
class FilterOf final : public AnyFilter {
 public:
  explicit FilterOf(typename F::Params params) : params_(std::move(params)) {
    check_params(std::string(F::name), params_);
    require_no_huge(std::string(F::name), values(params_));
  }
  std::string name() const override { return std::string(F::name); }
  ParamMap params() const override { return values(params_); }
  std::shared_ptr<const Prepared> prepare(const Model& model, const Network& network) const override {
    require_same_size(model, network);
    return prepared(F::design(params_, model, network), model, network);
  }
  std::shared_ptr<const Prepared> restore(const Model& model, const Network& network,
                                          std::span<const std::byte> gains) const override {
    require_same_size(model, network);
    typename Runs::Gains restored;
    require_read(wire::from_bytes(gains, model.agents(), restored));
    require_runs(restored);
    for (int id = 0; id < model.agents(); ++id) {
      const auto heard = network.neighbours(id);
      const Local local{
          id,      model.agents(), model.states(), model.outputs(id), static_cast<int>(heard.size()),
          nullptr, nullptr};
      require_fit(fits<Runs>(restored, local, heard));
    }
    return prepared(std::move(restored), model, network);
  }
  std::unique_ptr<Agent> agent(std::span<const std::byte> bytes) const override {
    Part<Runs> part;
    require_read(wire::from_bytes(bytes, INT32_MAX, part));
    require_runs(part.gains);
    require_fit(whole(part));
    return agent_of<Runs>(std::move(part));
  }
  Check check(const Model& model, const Network& network) const override {
    require_same_size(model, network);
    return F::check(params_, model, network);
  }
  std::vector<std::string> signal_names() const override { return F::signal_names(); }
  std::vector<std::string> warnings(const Model& model, const VerdictLog& log) const override {
    if constexpr (requires { F::warnings(params_, model, log); })
      return F::warnings(params_, model, log);
    else if constexpr (requires { F::warnings(model, log); })
      return F::warnings(model, log);
    else
      return {};
  }
  std::vector<std::string> refuted(unsigned bits) const override {
    if constexpr (requires { F::refuted_words(bits); })
      return bits == 0 ? std::vector<std::string>{} : F::refuted_words(bits);
    else
      return {};
  }
  std::vector<std::string> detail_names() const override {
    if constexpr (requires { F::detail_names(); })
      return F::detail_names();
    else
      return {};
  }
  int first_sample() const override { return garrison::first_sample<F>(); }
  bool own_states() const override {
    return requires(const typename F::Gains& g, const WorldOptions& o) { F::world(g, o); };
  }

 private:
  using Runs = RunsOf<F>;
  std::shared_ptr<const Prepared> prepared(typename F::Gains gains, const Model& model,
                                           const Network& network) const {
    return std::make_shared<PreparedOf<Runs>>(std::make_shared<FilterOf>(params_),
                                              std::make_shared<const typename F::Gains>(std::move(gains)),
                                              model, network);
  }
  static void require_read(Refusal refusal) {
    if (refusal != Refusal::none)
      refuse("design", "gains with a wrong " + std::string(word(refusal)),
             "gains of " + std::string(F::name) + " that this version of garrison wrote");
  }
  static void require_fit(bool fit) {
    if (!fit)
      refuse("design", "gains of " + std::string(F::name) + " for another model or network",
             "those of the model and the network beside them", "the file is forged or damaged");
  }
  static void require_runs(const typename F::Gains& gains) {
    if (!runs<Runs>(gains))
      refuse("design", std::string(F::name) + " with a solver that this build does not have",
             "a build of garrison with all that the design asks for");
  }
  static void require_same_size(const Model& model, const Network& network) {
    if (model.agents() != network.agents())
      refuse("network", amount(network.agents(), "agent"),
             std::to_string(model.agents()) + ", because C has one matrix per agent");
  }
  typename F::Params params_;
};

template <class F>
FamilyInfo family_info() {
  return {
      std::string(F::name), std::string(F::title), std::string(F::source), describe<typename F::Params>(),
      [](const ParamMap& given) -> std::shared_ptr<const AnyFilter> {
        return std::make_shared<FilterOf<F>>(parse_params<typename F::Params>(std::string(F::name), given));
      }};
}

}  // namespace garrison
