// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/roster.hpp"

#include <cmath>

#include "garrison/core/error.hpp"
#include "node/daemon/keys.hpp"
#include "node/daemon/toml_file.hpp"

namespace garrison::node {

namespace {

constexpr std::int64_t kMostMs = 7LL * 24 * 3600 * 1000;
constexpr Micros kLeastRound = 1000;
constexpr std::size_t kLongestName =
    200;  // of logs: the start and a number follow, and 255 are a file's most
constexpr Micros kEarliest = 946'684'800'000'000, kLatest = 4'102'444'800'000'000;  // 2000 and 2100

Micros micros(double ms) { return std::llround(1000.0 * ms); }

Member read_member(const Section& section) {
  section.only({"id", "name", "key", "address", "hears"});
  Member m;
  m.id = static_cast<int>(section.whole("id", 0, 65535));
  m.name = section.text("name", std::to_string(m.id));
  if (m.name.empty()) refuse(section.where("name"), "\"\"", "a name, or none: then its id is the name");
  if (m.name.size() > kLongestName)
    refuse(section.where("name"), amount(m.name.size(), "byte"), "at most " + std::to_string(kLongestName),
           "a shorter name: files are named by it");
  m.open = open_key_from(section.where("key"), section.text("key"));
  m.address = address_from(section.where("address"), section.text("address"));
  if (is_any(m.address))
    refuse(section.where("address"), section.text("address"), "the address that others send to");
  m.directed = section.has("hears");
  for (const double id : section.numbers("hears")) {
    if (id != std::floor(id) || id < 0 || id > 65535)
      refuse(section.where("hears"), text(id), "ids of agents: whole numbers in 0..65535");
    m.hears.push_back(static_cast<int>(id));
  }
  return m;
}

void require_different(const Roster& roster) {
  for (std::size_t k = 1; k < roster.members.size(); ++k)
    for (std::size_t j = 0; j < k; ++j) {
      const Member& a = roster.members[j];
      const Member& b = roster.members[k];
      const char* same = a.id == b.id                         ? "id"
                         : a.name == b.name                   ? "name"
                         : a.open == b.open                   ? "key"
                         : same_address(a.address, b.address) ? "address"
                                                              : nullptr;
      if (same != nullptr)
        refuse(roster.path + ", [[agent]] " + b.name, std::string("the ") + same + " of " + a.name,
               std::string("another ") + same + " for every agent");
    }
}

}  // namespace

const Member* Roster::find(int id) const {
  for (const Member& m : members)
    if (m.id == id) return &m;
  return nullptr;
}
const Member* Roster::find(const std::string& name) const {
  for (const Member& m : members)
    if (m.name == name) return &m;
  return nullptr;
}

Roster parse_roster(const std::string& text, const std::string& path) {
  const Section file = parse_toml(text, path);
  file.only({"run", "agent"});
  const Section run = file.section("run");
  run.only({"start", "period_ms", "round_ms", "resend_ms", "initial"});
  Roster out;
  out.path = path;
  out.schedule.start = run.moment("start");
  if (out.schedule.start < kEarliest || out.schedule.start > kLatest)
    refuse(run.where("start"), std::to_string(out.schedule.start), "a time in this century",
           "a date and time, or microseconds since 1970");
  out.schedule.period = micros(run.number("period_ms", 1.0, static_cast<double>(kMostMs)));
  out.schedule.round = micros(run.number("round_ms", 0.0, static_cast<double>(kMostMs), 0.0));
  out.schedule.resend = micros(run.number("resend_ms", 0.0, static_cast<double>(kMostMs), 0.0));
  out.initial = run.numbers("initial");
  for (const Section& agent : file.sections("agent")) out.members.push_back(read_member(agent));
  require_different(out);
  std::sort(out.members.begin(), out.members.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return out;
}

Roster read_roster(const std::string& path) {
  return parse_roster(read_text(path, "the roster, the same file on all nodes ([run] and [[agent]])"), path);
}

Schedule schedule_for(const Roster& roster, int rounds) {
  Schedule s = roster.schedule;
  if (s.round == 0) s.round = 8 * s.period / (10 * rounds);
  if (s.resend == 0) s.resend = std::max<Micros>(2000, s.round / 8);
  if (s.round < kLeastRound || s.round * rounds > s.period)
    refuse(roster.path + ", [run]",
           text(static_cast<double>(s.period) / 1000) + " ms for " + amount(rounds, "round") + " of " +
               text(static_cast<double>(s.round) / 1000) + " ms",
           "rounds of 1 ms or more that fit into the period",
           "a longer period_ms, or fewer rounds in the design");
  return s;
}

namespace {
std::vector<std::byte> bytes_of(std::span<const double> numbers) {
  std::vector<std::byte> out(8 * numbers.size());
  for (std::size_t k = 0; k < numbers.size(); ++k) wire::store_double(out.data() + 8 * k, numbers[k]);
  return out;
}
}  // namespace

Prologue prologue_of(std::uint64_t design, const Schedule& schedule, std::span<const double> initial,
                     std::span<const double> inputs) {
  std::array<std::byte, 40> numbers;
  const std::uint64_t all[] = {design, static_cast<std::uint64_t>(schedule.start),
                               static_cast<std::uint64_t>(schedule.period),
                               static_cast<std::uint64_t>(schedule.round), initial.size()};
  for (std::size_t k = 0; k < 5; ++k) wire::store(numbers.data() + 8 * k, all[k]);
  Prologue out;
  hash({}, {text_bytes("garrison-node 1"), numbers, bytes_of(initial), bytes_of(inputs)}, out);
  return out;
}

}  // namespace garrison::node
