// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/design_file.hpp"

#include <algorithm>
#include <map>

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/engine/agent.hpp"
#include "garrison/wire/design_head.hpp"

namespace garrison {
namespace {

using wire::DesignHead;
using wire::DesignParam;

std::vector<DesignParam> from_map(const ParamMap& params) {
  std::vector<DesignParam> all;
  for (const auto& [name, value] : params) {
    DesignParam p;
    p.name = name;
    p.kind = static_cast<std::uint8_t>(value.index());
    if (const auto* flag = std::get_if<bool>(&value)) p.flag = *flag;
    if (const auto* whole = std::get_if<std::int64_t>(&value)) p.whole = *whole;
    if (const auto* number = std::get_if<double>(&value)) p.number = *number;
    if (const auto* words = std::get_if<std::string>(&value)) p.words = *words;
    if (const auto* list = std::get_if<std::vector<double>>(&value)) p.list = *list;
    all.push_back(std::move(p));
  }
  return all;
}
ParamMap to_map(const std::vector<DesignParam>& all) {
  ParamMap params;
  for (const DesignParam& p : all) {
    ParamValue value = p.flag;
    if (p.kind == 1) value = p.whole;
    if (p.kind == 2) value = p.number;
    if (p.kind == 3) value = p.words;
    if (p.kind == 4) value = p.list;
    params.emplace(p.name, std::move(value));
  }
  return params;
}

struct Unit {
  std::string name, unit;

  template <class V>
  void visit(V& v) {
    v("name", name);
    v("unit", unit);
  }
};

struct ModelData {
  Matrix A;
  std::vector<Matrix> C;
  Noise noise;
  std::vector<int> exposed;
  Labels labels;
  Matrix B;

  template <class V>
  void visit(V& v) {
    v("A", A);
    v("C", C);
    v("process_bound", noise.process_bound);
    v("measurement_bound", noise.measurement_bound);
    v("process_covariance", noise.process_covariance);
    v("measurement_covariance", noise.measurement_covariance);
    v("agent_process_covariance", noise.agent_process_covariance);
    v("exposed", exposed);
    v("states", labels.states);
    v("outputs", labels.outputs);
    v("sources", labels.sources);
    std::vector<Unit> units;
    for (const auto& [name, unit] : labels.units) units.push_back({name, unit});
    v("units", units);
    for (const Unit& one : units) labels.units[one.name] = one.unit;
    v("B", B);
    v("inputs", labels.inputs);
  }
};
ModelData data_of(const Model& model) {
  ModelData data{model.A(), {}, model.noise(), {}, model.labels(), model.B()};
  for (int i = 0; i < model.agents(); ++i) {
    data.C.push_back(model.C(i));
    data.exposed.push_back(model.exposed(i));
  }
  return data;
}

struct NetworkData {
  bool directed = false;
  std::vector<int> senders, receivers;
  std::vector<std::string> names;

  template <class V>
  void visit(V& v) {
    v("directed", directed);
    v("senders", senders);
    v("receivers", receivers);
    v("names", names);
  }
};
NetworkData data_of(const Network& network) {
  NetworkData data{network.directed(), {}, {}, network.names()};
  for (const auto& [a, b] : network.edges()) {
    data.senders.push_back(a);
    data.receivers.push_back(b);
  }
  return data;
}

struct Design {
  ModelData model;
  NetworkData network;
  std::vector<std::uint8_t> gains;
  std::vector<std::uint8_t> certificate;  // certificate::Plan; empty = none

  template <class V>
  void visit(V& v) {
    v("model", model);
    v("network", network);
    v("gains", gains);
    v("certificate", certificate);
  }
};

std::vector<std::uint8_t> octets(std::span<const std::byte> bytes) {
  std::vector<std::uint8_t> all(bytes.size());
  std::transform(bytes.begin(), bytes.end(), all.begin(),
                 [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
  return all;
}
std::span<const std::byte> bytes_of(const std::vector<std::uint8_t>& octets) {
  return std::as_bytes(std::span(octets));
}

DesignHead head_of(const AnyFilter& filter, const Model& model) {
  DesignHead head;
  head.filter = filter.name();
  head.params = from_map(filter.params());
  head.agents = model.agents();
  head.states = model.states();
  return head;
}

template <class Content>
std::vector<std::byte> sealed(DesignHead head, Content content) {
  const std::span<const std::byte> magic = std::as_bytes(std::span(wire::kDesignMagic));
  std::vector<std::byte> file(magic.begin(), magic.end());
  wire::Writer writer(file);
  writer("head", head);
  writer("content", content);
  const wire::Digest digest = wire::blake2b(file);
  file.insert(file.end(), digest.begin(), digest.end());
  return file;
}

[[noreturn]] void refuse_file(const std::string& got, const std::string& hint = "") {
  refuse("design file", got, "a file that `save` of a prepared filter wrote", hint);
}

/// The reader behind the head.
wire::Reader opened(std::span<const std::byte> file, DesignHead& head) {
  wire::Reader reader({}, 0, true);
  switch (wire::open_design(file, head, reader)) {
    case Refusal::none:
      return reader;
    case Refusal::size:
      refuse_file(amount(file.size(), "byte") + " that do not begin like one");
    case Refusal::damaged:
      refuse_file("a damaged one: its hash does not match", "copy it again");
    default:
      refuse_file("one of another version", "write it again with garrison " GARRISON_VERSION);
  }
}

void require_end(const wire::Reader& reader) {
  if (reader.end() != Refusal::none) refuse_file("one that ends too early or too late");
}

certificate::Plan read_plan(std::span<const std::uint8_t> octets, int agents) {
  certificate::Plan plan;
  if (wire::from_bytes(std::as_bytes(octets), agents, plan) != Refusal::none ||
      !certificate::consistent(plan) || plan.agents != agents)
    refuse_file("a certificate that does not fit the network");
  return plan;
}

/// A filter's own bound is one for as many liars as it was told of.
bool covers(const AnyFilter& filter, int attacked) {
  const ParamMap params = filter.params();
  const auto own = params.find("attacked");
  return own == params.end() || !std::holds_alternative<std::int64_t>(own->second) ||
         attacked <= std::get<std::int64_t>(own->second);
}
/// It counts agents, so it says nothing where a source stands behind several of them.
bool sources_within_agents(const certificate::Plan& plan) {
  std::map<int, std::size_t> agent_of;
  for (std::size_t k = 0; k < plan.ids.size(); ++k)
    for (int r = plan.first[k]; r < plan.first[k + 1]; ++r)
      if (agent_of.emplace(plan.source[static_cast<std::size_t>(r)], k).first->second != k) return false;
  return true;
}

}  // namespace

std::vector<std::byte> write_design(const Prepared& prepared) {
  const auto plan = prepared.certificate();
  return sealed(head_of(prepared.filter(), prepared.model()),
                Design{data_of(prepared.model()), data_of(prepared.network()), octets(prepared.gains_bytes()),
                       plan == nullptr ? std::vector<std::uint8_t>{} : octets(wire::to_bytes(*plan))});
}

std::shared_ptr<const Prepared> read_design(std::span<const std::byte> file) {
  DesignHead head;
  wire::Reader reader = opened(file, head);
  if (head.part)
    refuse_file("the part of agent " + std::to_string(head.agent) + " alone", "read it as an agent");
  Design design;
  reader("content", design);
  require_end(reader);
  std::vector<Edge> edges;
  for (std::size_t k = 0; k < std::min(design.network.senders.size(), design.network.receivers.size()); ++k)
    edges.emplace_back(design.network.senders[k], design.network.receivers[k]);
  const Model model(design.model.A, design.model.C, design.model.noise, design.model.exposed,
                    design.model.labels, design.model.B);
  const Network network(head.agents, edges, design.network.directed, design.network.names);
  auto prepared =
      make_filter(head.filter, to_map(head.params))->restore(model, network, bytes_of(design.gains));
  if (design.certificate.empty()) return prepared;
  return prepared->with(
      std::make_shared<const certificate::Plan>(read_plan(design.certificate, model.agents())));
}

std::shared_ptr<const Prepared> certified(const Prepared& prepared, const certificate::Wanted& wanted) {
  if (prepared.filter().own_states())
    refuse("certificate", "one for " + prepared.filter().name(), "none",
           "its agents have a state each, which the others do not measure; it reports bounds of its own");
  certificate::Plan plan = certificate::make_plan(wanted, prepared.model(), prepared.network());
  plan.family = covers(prepared.filter(), wanted.attacked) && sources_within_agents(plan);
  return prepared.with(std::make_shared<const certificate::Plan>(std::move(plan)));
}

std::vector<std::uint8_t> certificate_part(const certificate::Plan* plan, const AgentPart& who) {
  if (plan == nullptr) return {};
  return octets(wire::to_bytes(certificate::part_of(*plan, who.id, who.neighbours)));
}

std::unique_ptr<certificate::Certifier> certifier_of(std::span<const std::uint8_t> bytes,
                                                     const AgentPart& who, int rounds) {
  if (bytes.empty()) return nullptr;
  auto plan = std::make_shared<const certificate::Plan>(read_plan(bytes, who.agents));
  bool whole = plan->place(who.id) >= 0 && plan->states() == who.A.rows() &&
               plan->outputs(who.id) == who.C_transposed.cols();
  for (const int j : who.neighbours) whole = whole && plan->place(j) >= 0;
  if (!whole) refuse_file("a certificate of another agent");
  return certificate::make_certifier(std::move(plan), who.id, who.neighbours, rounds);
}

std::vector<std::byte> write_part(const Prepared& prepared, int id) {
  auto part = octets(prepared.part_bytes(id));
  DesignHead head = head_of(prepared.filter(), prepared.model());
  head.part = true;
  head.agent = id;
  return sealed(std::move(head), std::move(part));
}

std::unique_ptr<Agent> read_part(std::span<const std::byte> file) {
  DesignHead head;
  wire::Reader reader = opened(file, head);
  if (!head.part) refuse_file("a whole design", "read it as one, and ask it for an agent");
  std::vector<std::uint8_t> part;
  reader("content", part);
  require_end(reader);
  return make_filter(head.filter, to_map(head.params))->agent(bytes_of(part));
}

DesignSummary summary_of(std::span<const std::byte> file) {
  DesignHead head;
  opened(file, head);
  DesignSummary s{head.part,   head.agent,  head.garrison, head.filter, to_map(head.params),
                  head.agents, head.states, file.size(),   {}};
  std::copy(file.end() - sizeof(wire::Digest), file.end(), s.digest.begin());
  return s;
}

std::uint64_t fingerprint_of(const Prepared& prepared) {
  const auto file = write_design(prepared);
  return wire::load<std::uint64_t>(file.data() + file.size() - sizeof(wire::Digest));
}

}  // namespace garrison
