// SPDX-License-Identifier: Apache-2.0
// Turns a family F into an AnyFilter. Included only by the one source file that instantiates the family.
#pragma once

#include <utility>

#include "garrison/core/dispatch.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/engine/engine.hpp"

namespace garrison {

template <class F>
class PreparedOf final : public Prepared {
 public:
  PreparedOf(typename F::Gains gains, const Model& model, const Network& network)
      : gains_(std::make_shared<const typename F::Gains>(std::move(gains))),
        model_(model),
        network_(network) {}

  std::unique_ptr<Runner> runner(int threads) const override {
    return dispatched([&]<int n>() -> std::unique_ptr<Runner> {
      return std::make_unique<Engine<F, n>>(gains_, model_, network_, threads);
    });
  }
  void check_start(const Matrix& x0) const override {
    if constexpr (requires { F::check_start(*gains_, x0); }) F::check_start(*gains_, x0);
  }
  std::unique_ptr<AnyAgent> agent(int id) const override {
    if (id < 0 || id >= model_.agents())
      refuse("id", std::to_string(id), "an agent in 0.." + std::to_string(model_.agents() - 1));
    return dispatched([&]<int n>() -> std::unique_ptr<AnyAgent> {
      return std::make_unique<Agent<F, n>>(gains_, model_, network_, id);
    });
  }
  std::unique_ptr<LaneRunner> lanes() const override {
    if constexpr (requires { F::lanes(gains_, model_, network_); })
      return F::lanes(gains_, model_, network_);
    else
      return nullptr;
  }
  std::unique_ptr<World> world(const WorldOptions& options) const override {
    if constexpr (requires { F::world(*gains_, options); })
      return F::world(*gains_, options);
    else
      return nullptr;
  }

 private:
  /// A family that exists for one dimension only (and has refused others in `design`) is compiled for that
  /// one.
  template <class Action>
  auto dispatched(const Action& action) const {
    if constexpr (requires { F::only_states; })
      return action.template operator()<F::only_states>();
    else
      return dispatch(model_.states(), action);
  }

  std::shared_ptr<const typename F::Gains> gains_;
  Model model_;
  Network network_;
};

namespace detail {
template <class F>
struct RunsAs {
  using type = F;
};
template <class F>
  requires requires { typename F::RunsAs; }
struct RunsAs<F> {
  using type = typename F::RunsAs;
};
}  // namespace detail

/// A family may name another one, F::RunsAs, that runs the gains of its design: it then costs no engine of
/// its own.
template <class F>
class FilterOf final : public AnyFilter {
 public:
  explicit FilterOf(typename F::Params params) : params_(std::move(params)) {
    check_params(std::string(F::name), params_);
  }
  std::string name() const override { return std::string(F::name); }
  ParamMap params() const override { return values(params_); }
  std::shared_ptr<const Prepared> prepare(const Model& model, const Network& network) const override {
    require_same_size(model, network);
    using Runs = typename detail::RunsAs<F>::type;
    return std::make_shared<PreparedOf<Runs>>(F::design(params_, model, network), model, network);
  }
  Check check(const Model& model, const Network& network) const override {
    require_same_size(model, network);
    return F::check(params_, model, network);
  }
  std::vector<std::string> signal_names() const override { return F::signal_names(); }
  std::vector<std::string> warnings(const Model& model, const VerdictLog& log) const override {
    if constexpr (requires { F::warnings(model, log); })
      return F::warnings(model, log);
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
  static void require_same_size(const Model& model, const Network& network) {
    if (model.agents() != network.agents())
      refuse("network", std::to_string(network.agents()) + " agents",
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
