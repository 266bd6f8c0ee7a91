// SPDX-License-Identifier: Apache-2.0
#include "mpi/scenario.hpp"

#include <limits>

#include "garrison/attacks/registry.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/wire/blake2b.hpp"
#include "mpi/network_and_model.hpp"
#include "mpi/values.hpp"
#include "node/daemon/files.hpp"
#include "partition/families.hpp"

namespace garrison::mpi {
namespace {

/// Agent-samples of estimates above which summaries are kept unless estimates are asked for.
constexpr double kManyEstimates = 1e7;

void read_filter(const Section& s, Scenario& out) {
  out.family = s.text("name");
  partition::require_family(out.family, s.where("name"));
  for (const FamilyInfo& info : families())
    if (info.name == out.family) out.params = params_of(s, info.params, {"name", "label"});
  placed(s, "name", [&] { return make_filter(out.family, out.params); });  // checks the values
}

void read_attack(const Section& s, Scenario& out) {
  const std::string kind = s.text("kind");
  for (const AttackInfo& info : attack_infos()) {
    if (info.name != kind) continue;
    const ParamMap params = params_of(s, info.params, {"kind", "agents", "start", "stop", "probability"});
    std::vector<int> agents;
    for (const double id : s.numbers("agents")) agents.push_back(agent_of(s, "agents", id));
    if (agents.empty()) refuse(s.where("agents"), "nobody", "the agents that are attacked");
    const std::int64_t start = s.whole("start", 0, kMost, 1);
    const std::int64_t stop = s.whole("stop", 1, INT64_MAX, Schedule::kForever);
    const double probability = s.number("probability", 0.0, 1.0, 1.0);
    AnyAttack attack = placed(s, "kind", [&] {
      const Schedule schedule(start, agents, stop, probability);
      schedule.require_agents_below(out.agents());
      return make_attack(kind, schedule, params);
    });
    if (attack.measurement) out.run.attacks.push_back(attack.measurement);
    if (attack.message) out.run.message_attacks.push_back(attack.message);
    return;
  }
  std::vector<std::string> known;
  for (const AttackInfo& info : attack_infos()) known.emplace_back(info.name);
  const std::string near = nearest_name(kind, known);
  refuse(s.where("kind"), "\"" + kind + "\"", "an attack of `garrison list attacks`",
         near.empty() ? "" : "did you mean \"" + near + "\"?");
}

void read_run(const Section& s, Scenario& out) {
  s.only({"steps", "seed", "x0", "start", "start_error", "trial"});
  out.plant.steps = whole(s, "steps", 1);
  out.run.seed = static_cast<std::uint64_t>(s.whole("seed", 0, INT64_MAX, 0));
  out.run.first_trial = static_cast<int>(s.whole("trial", 0, kMostTrials - 1, 0));
  out.plant.x0 = vector(s, "x0", out.states());
  out.run.start = vector(s, "start", out.states());
  out.plant.start_error = s.number("start_error", 0.0, std::numeric_limits<double>::max(), 0.0);
}

void read_link(const Section& s, LinkFaults& link) {
  s.only({"drop", "delay", "delay_rounds"});
  link.drop = s.number("drop", 0.0, 1.0, 0.0);
  link.delay = s.number("delay", 0.0, 1.0, 0.0);
  link.delay_rounds = whole(s, "delay_rounds", 1, 1);
  if (s.has("delay_rounds") && !s.has("delay"))
    refuse(s.where("delay_rounds"), "a delay without its probability", "the key delay beside it");
}

void read_output(const Section& s, Scenario& out) {
  s.only({"keep", "every"});
  out.every = whole(s, "every", 1, 1);
  if (out.every > out.plant.steps)
    refuse(s.where("every"), std::to_string(out.every),
           "at most " + std::to_string(out.plant.steps) + ", [run].steps", "no sample would be kept");
  const double kept = static_cast<double>(out.agents()) * (out.plant.steps / out.every);
  const std::string word = s.text("keep", kept <= kManyEstimates ? "estimates" : "summary");
  if (word != "estimates" && word != "summary")
    refuse(s.where("keep"), "\"" + word + "\"", "\"estimates\" or \"summary\"");
  out.kept = word == "estimates" ? Kept::estimates : Kept::summary;
}

}  // namespace

Scenario read_scenario(const std::string& path, const Bytes& bytes) {
  const std::string text = node::read_text(path, "a scenario (TOML)");
  const Section file = node::parse_toml(text, path);
  file.only({"title", "model", "network", "filter", "attack", "link", "noise", "run", "partition", "output"});
  Scenario out;
  out.path = path;
  out.fingerprint = wire::checksum(std::as_bytes(std::span(text)));
  Inputs inputs(path);
  out.ground = read_ground(file.section("network"), inputs, bytes);
  out.sensors = read_sensors(file.section("model"), out.agents(), inputs);
  out.fingerprint += inputs.checksum();
  out.inputs = inputs.paths();
  if (!out.sensors.C.empty() && static_cast<int>(out.sensors.C.size()) != out.agents())
    refuse(file.section("model").where("C"), amount(out.sensors.C.size(), "row"),
           std::to_string(out.agents()) + ", one per agent");
  read_filter(file.section("filter"), out);
  read_run(file.section("run"), out);
  if (file.has("attack"))
    for (const Section& one : file.sections("attack")) read_attack(one, out);
  read_link(file.section("link"), out.run.link);
  file.section("noise").only({"law"});
  out.plant.noise = file.section("noise").text("law", "auto");
  const Section parts = file.section("partition");
  parts.only({"method"});
  out.method = parts.text("method", "auto");
  if (out.method != "auto" && out.method != "metis" && out.method != "coordinates" && out.method != "blocks")
    refuse(parts.where("method"), "\"" + out.method + "\"", "auto, metis, coordinates or blocks");
  read_output(file.section("output"), out);
  return out;
}

}  // namespace garrison::mpi
