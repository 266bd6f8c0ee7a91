// SPDX-License-Identifier: Apache-2.0
#include "partition/part_run.hpp"

#include <string>

#include "drivers/plant.hpp"

namespace garrison::partition {
namespace {

/// A model of the whole network in which only the agents `ids` have sensors: what attacks, which speak of
/// public ids, need to find the measurements of this rank.
Model seen_from_here(const Model& own, std::span<const int> ids, int agents) {
  std::vector<Matrix> C(static_cast<std::size_t>(agents), Matrix(0, own.states()));
  for (std::size_t k = 0; k < ids.size(); ++k)
    C[static_cast<std::size_t>(ids[k])] = own.C(static_cast<int>(k));
  return {own.A(), std::move(C)};
}

void require_open_loop(const RunOptions& options) {
  for (const Attack& attack : options.attacks)
    if (attack->closed_loop())
      refuse("attack.kind", "one that knows what the agents expect",
             "an attack on measurements that does not depend on the filter",
             "no rank knows what agents of others expect");
}

struct Nobody final : Victims {  // closed-loop attacks never come here
  void expected(int, double*) const override {}
  double alarm_level(int) const override { return kNaN; }
};

}  // namespace

void require_simulable(const Model& some, std::vector<int> ids, const PlantOptions& plant,
                       const RunOptions& options) {
  require_open_loop(options);
  static_cast<void>(detail::NoiseLaw(plant.noise, some, nullptr, std::move(ids)));
}

struct PartRun::Parts {
  Parts(const Model& given, std::vector<int> public_ids, int agents, const PlantOptions& plant,
        const RunOptions& options)
      : model(given),
        ids(std::move(public_ids)),
        law(plant.noise, model, nullptr, ids),
        link(Network(agents, {}), options.link, options.message_attacks, options.seed, trial(options)),
        source(detail::simulated_source(model, law, plant, options, trial(options))),
        y(static_cast<std::size_t>(model.total_outputs())) {
    for (const Attack& attack : options.attacks) attack->schedule().require_agents_below(agents);
    if (options.attacks.empty()) return;
    seen = std::make_unique<Model>(seen_from_here(model, ids, agents));
    std::uint32_t salt = 0;
    for (const Attack& plan : options.attacks)
      attacks.push_back(plan->start(*seen, Random(options.seed, trial(options), Purpose::attack), ++salt));
  }
  static std::uint32_t trial(const RunOptions& options) {
    return static_cast<std::uint32_t>(options.first_trial);
  }

  const Model& model;
  std::vector<int> ids;
  detail::NoiseLaw law;
  Link link;
  std::unique_ptr<detail::Source> source;
  std::unique_ptr<Model> seen;
  std::vector<std::unique_ptr<MeasurementAttack>> attacks;
  std::vector<double> y;
};

PartRun::PartRun(PartRunner& runner, const Model& model, std::vector<int> ids, int agents, PlantOptions plant,
                 RunOptions options)
    : runner_(runner), plant_(std::move(plant)), options_(std::move(options)) {
  require_open_loop(options_);
  for (const auto& attack : options_.message_attacks) {
    if (!attack->fits(model.states()))
      refuse("attack", "numbers for another plant",
             "one per attacked agent and state (" + amount(model.states(), "state") + ")");
    runner.require(*attack, agents);
  }
  if (plant_.x0.size() != 0 && plant_.x0.size() != model.states())
    refuse("x0", amount(plant_.x0.size(), "number"), std::to_string(model.states()) + ", one per state");
  if (options_.start.size() == 0) options_.start = Vector::Zero(model.states());
  if (options_.start.rows() != model.states() || options_.start.cols() != 1)
    refuse("start", amount(options_.start.size(), "number"),
           std::to_string(model.states()) + ", one initial estimate for all agents");
  parts_ = std::make_unique<Parts>(model, std::move(ids), agents, plant_, options_);
}

void PartRun::start() {
  t_ = 0;
  runner_.reset(parts_->source->start(options_.start).col(0),
                parts_->link.perfect() ? nullptr : &parts_->link);
}

PartRun::~PartRun() = default;

void PartRun::measure() {
  ++t_;
  parts_->source->next(t_, parts_->y);
  const Nobody nobody;
  for (auto& attack : parts_->attacks) attack->apply({t_, parts_->y, nobody});
}

void PartRun::advance() {
  measure();
  runner_.step(t_, parts_->y.data());
}

void PartRun::skip_to(std::int64_t t) {
  if (parts_->link.memory() > 0)
    refuse("attack.kind", "\"outdated\" after a restart", "lies that need no messages of the past",
           "run it from the start");
  while (t_ < t) measure();
}

std::span<const double> PartRun::truth() const {
  return {parts_->source->truth(), static_cast<std::size_t>(parts_->model.states())};
}
const LinkCounters& PartRun::link() const { return parts_->link.counters; }

}  // namespace garrison::partition
