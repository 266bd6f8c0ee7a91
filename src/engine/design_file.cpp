// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/design_file.hpp"

#include <algorithm>

#include "garrison/wire/archive.hpp"

namespace garrison {
namespace {

constexpr char kMagic[8] = {'G', 'D', 'E', 'S', 'I', 'G', 'N', '1'};

/// A parameter's value, one member of which is meant.
struct Param {
  std::string name;
  std::uint8_t kind = 0;
  bool flag = false;
  std::int64_t whole = 0;
  double number = 0.0;
  std::string words;
  std::vector<double> list;

  template <class V>
  void visit(V& v) {
    v("name", name);
    v.range("kind", kind, 0, 4);
    switch (kind) {
      case 0:
        return v("value", flag);
      case 1:
        return v("value", whole);
      case 2:
        return v("value", number);
      case 3:
        return v("value", words);
      default:
        return v("value", list);
    }
  }
};

std::vector<Param> from_map(const ParamMap& params) {
  std::vector<Param> all;
  for (const auto& [name, value] : params) {
    Param p;
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
ParamMap to_map(const std::vector<Param>& all) {
  ParamMap params;
  for (const Param& p : all) {
    ParamValue value = p.flag;
    if (p.kind == 1) value = p.whole;
    if (p.kind == 2) value = p.number;
    if (p.kind == 3) value = p.words;
    if (p.kind == 4) value = p.list;
    params.emplace(p.name, std::move(value));
  }
  return params;
}

/// What both kinds of files begin with.
struct Head {
  std::uint32_t version = 1;
  bool part = false;
  std::int32_t agent = -1;
  std::string garrison = GARRISON_VERSION;
  std::string filter;
  std::vector<Param> params;
  std::int32_t agents = 0;
  std::int32_t states = 0;

  template <class V>
  void visit(V& v) {
    v.range("version", version, 1, 1);
    v("part", part);
    v.range("agent", agent, -1, INT32_MAX);
    v("garrison", garrison);
    v("filter", filter);
    v("params", params);
    v.range("agents", agents, 1, INT32_MAX);
    v.range("states", states, 1, INT32_MAX);
  }
};

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
  }
};
ModelData data_of(const Model& model) {
  ModelData data{model.A(), {}, model.noise(), {}, model.labels()};
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

  template <class V>
  void visit(V& v) {
    v("model", model);
    v("network", network);
    v("gains", gains);
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

Head head_of(const AnyFilter& filter, const Model& model) {
  Head head;
  head.filter = filter.name();
  head.params = from_map(filter.params());
  head.agents = model.agents();
  head.states = model.states();
  return head;
}

template <class Content>
std::vector<std::byte> sealed(Head head, Content content) {
  wire::GrowingSink sink;
  std::copy_n(reinterpret_cast<const std::byte*>(kMagic), sizeof kMagic, sink.more(sizeof kMagic));
  wire::Writer<wire::GrowingSink> writer(sink);
  writer("head", head);
  writer("content", content);
  std::vector<std::byte> file = sink.release();
  const wire::Digest digest = wire::blake2b(file);
  file.insert(file.end(), digest.begin(), digest.end());
  return file;
}

[[noreturn]] void refuse_file(const std::string& got, const std::string& hint = "") {
  refuse("design file", got, "a file that `save` of a prepared filter wrote", hint);
}

/// The reader behind the head.
wire::Reader opened(std::span<const std::byte> file, Head& head) {
  if (file.size() < sizeof kMagic + sizeof(wire::Digest) ||
      !std::equal(kMagic, kMagic + 7, reinterpret_cast<const char*>(file.data())))
    refuse_file(std::to_string(file.size()) + " bytes that do not begin like one");
  const auto content = file.first(file.size() - sizeof(wire::Digest));
  const wire::Digest digest = wire::blake2b(content);
  if (!std::equal(digest.begin(), digest.end(), file.end() - sizeof(wire::Digest)))
    refuse_file("a damaged one: its hash does not match", "copy it again");
  wire::Reader reader(content.subspan(sizeof kMagic), INT32_MAX, true);
  reader("head", head);
  if (reader.refusal() != Refusal::none)
    refuse_file("one of another version", "write it again with garrison " GARRISON_VERSION);
  return reader;
}

void require_end(const wire::Reader& reader) {
  if (reader.end() != Refusal::none) refuse_file("one that ends too early or too late");
}

}  // namespace

std::vector<std::byte> write_design(const Prepared& prepared) {
  return sealed(
      head_of(prepared.filter(), prepared.model()),
      Design{data_of(prepared.model()), data_of(prepared.network()), octets(prepared.gains_bytes())});
}

std::shared_ptr<const Prepared> read_design(std::span<const std::byte> file) {
  Head head;
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
                    design.model.labels);
  const Network network(head.agents, edges, design.network.directed, design.network.names);
  return make_filter(head.filter, to_map(head.params))->restore(model, network, bytes_of(design.gains));
}

std::vector<std::byte> write_part(const Prepared& prepared, int id) {
  auto part = octets(prepared.part_bytes(id));
  Head head = head_of(prepared.filter(), prepared.model());
  head.part = true;
  head.agent = id;
  return sealed(std::move(head), std::move(part));
}

std::unique_ptr<Agent> read_part(std::span<const std::byte> file) {
  Head head;
  wire::Reader reader = opened(file, head);
  if (!head.part) refuse_file("a whole design", "read it as one, and ask it for an agent");
  std::vector<std::uint8_t> part;
  reader("content", part);
  require_end(reader);
  return make_filter(head.filter, to_map(head.params))->agent(bytes_of(part));
}

DesignSummary summary_of(std::span<const std::byte> file) {
  Head head;
  opened(file, head);
  DesignSummary s{head.part,   head.agent,  head.garrison, head.filter, to_map(head.params),
                  head.agents, head.states, file.size(),   {}};
  std::copy(file.end() - sizeof(wire::Digest), file.end(), s.digest.begin());
  return s;
}

std::uint64_t fingerprint_of(const AnyFilter& filter, const Model& model, const Network& network,
                             std::span<const std::byte> gains) {
  const auto file = sealed(head_of(filter, model), Design{data_of(model), data_of(network), octets(gains)});
  return wire::load<std::uint64_t>(file.data() + file.size() - sizeof(wire::Digest));
}

}  // namespace garrison
