// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/status.hpp"

#include <cstring>
#include <type_traits>

#include "node/daemon/json.hpp"

namespace garrison::node {

static_assert(std::is_trivially_copyable_v<StatusHead> && std::is_trivially_copyable_v<LinkStatus>);

namespace {

constexpr std::string_view word(Verdict verdict) {
  constexpr std::string_view words[] = {"cleared", "suspected", "attacked", "silent", "not tested"};
  return words[static_cast<std::size_t>(verdict)];
}

/// The counters that are not 0.
void put_fates(Json& json, const Fates& fates) {
  json.open('{');
  for (std::size_t k = 0; k < kFates; ++k) {
    const auto fate = static_cast<Fate>(k);
    if (fates[fate] != 0) json.key(word(fate)).whole(fates[fate]);
  }
  json.close('}');
}

void put_counters(Json& json, const StatusHead& head) {
  const Core::Counters& c = head.counters;
  const std::pair<const char*, std::int64_t> all[] = {{"samples", c.samples},
                                                      {"complete", c.complete},
                                                      {"unmeasured", c.unmeasured},
                                                      {"missing", c.missing},
                                                      {"missed_samples", c.missed_samples},
                                                      {"overruns", c.overruns},
                                                      {"wants", c.wants},
                                                      {"resent", c.resent},
                                                      {"joins", c.joins},
                                                      {"resets", head.resets},
                                                      {"clock_steps", c.clock_steps},
                                                      {"clock_back", c.clock_back},
                                                      {"unsent", head.unsent},
                                                      {"log_gaps", head.log_gaps},
                                                      {"statements", head.statements},
                                                      {"contradictions", head.contradictions},
                                                      {"disowned", head.disowned}};
  json.key("counters").open('{');
  for (const auto& [name, value] : all) json.key(name).whole(value);
  json.close('}');
}

void put_sample(Json& json, const Status& status, const Surroundings& around) {
  const StatusHead& head = status.head;
  const Report& report = head.sample.report;
  json.key("t").whole(head.sample.sample);
  json.key("time").number(static_cast<double>(head.wall) / 1e6);
  json.key("estimate").open('[');
  for (const double x : status.estimate) json.number(x);
  json.close(']');
  if (!around.input.empty()) {
    json.key("input").open('[');
    for (const double u : around.input) json.number(u);
    json.close(']');
  }
  json.key("bound").number(report.bound);
  json.key("bound_kind").word(garrison::word(report.kind));
  json.key("verdict").word(word(report.verdict));
  json.key("statistic").number(report.statistic).key("threshold").number(report.threshold);
  json.key("control").number(head.control);
  json.key("complete").flag(head.sample.complete).key("measured").flag(head.sample.measured);
  json.key("took_ms").number(static_cast<double>(head.sample.took) / 1e3);
  json.key("accused").open('[');
  for (const int id : around.accused) json.whole(id);
  json.close(']');
  json.key("proved").open('[');
  for (const int source : around.proved) json.whole(source);
  json.close(']');
}

void put_link(Json& json, const LinkStatus& link, const std::string& name) {
  const LinkView& v = link.view;
  json.open('{').key("id").whole(v.id).key("name").word(name);
  json.key("state").word(!v.up ? "down" : v.absent ? "absent" : "up");
  json.key("age_s").number(v.age < 0 ? kNaN : static_cast<double>(v.age) / 1e6);
  json.key("skew_us").number(v.timed ? static_cast<double>(v.skew) : kNaN);
  json.key("delay_us").number(v.timed ? static_cast<double>(v.delay) : kNaN);
  json.key("fates");
  put_fates(json, link.fates);
  json.close('}');
}

}  // namespace

bool Status::read(Bytes bytes, std::size_t states, std::size_t count) {
  if (bytes.size() != sizeof head + 8 * states + count * sizeof(LinkStatus)) return false;
  std::memcpy(&head, bytes.data(), sizeof head);
  estimate.resize(states);
  std::memcpy(estimate.data(), bytes.data() + sizeof head, 8 * states);
  links.resize(count);
  if (count != 0)
    std::memcpy(links.data(), bytes.data() + sizeof head + 8 * states, count * sizeof(LinkStatus));
  return true;
}

std::string sample_json(const Status& status, const Surroundings& around) {
  Json json;
  json.open('{');
  put_sample(json, status, around);
  return json.close('}').take();
}

std::string status_json(const Status& status, const Surroundings& around) {
  Json json;
  json.open('{').key("node").word(around.node).key("id").whole(around.id);
  json.key("family").word(around.family).key("boot").whole(static_cast<std::int64_t>(around.boot));
  json.key("state").word(word(status.head.state));
  put_sample(json, status, around);
  put_counters(json, status.head);
  const Sensor::Counters& s = around.sensor;
  json.key("sensor").open('{').key("taken").whole(s.taken).key("malformed").whole(s.malformed);
  json.key("outside").whole(s.outside).key("restarts").whole(s.restarts).close('}');
  json.key("snapshot_age_s")
      .number(around.snapshot_age < 0 ? kNaN : static_cast<double>(around.snapshot_age) / 1e6);
  json.key("log_failed").whole(around.log_failed);
  json.key("states_refused").whole(around.states_refused);
  json.key("outside");
  put_fates(json, status.head.outside);
  json.key("links").open('[');
  for (std::size_t k = 0; k < status.links.size(); ++k) put_link(json, status.links[k], around.names[k]);
  return json.close(']').close('}').take();
}

}  // namespace garrison::node
