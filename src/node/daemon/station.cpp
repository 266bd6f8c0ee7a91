// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/station.hpp"

#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "garrison/engine/design_file.hpp"
#include "node/daemon/files.hpp"
#include "node/daemon/sensor.hpp"
#include "node/daemon/state.hpp"

namespace garrison::node {

namespace {

/// The head of a snapshot says which design it is of (docs/node.md).
std::uint64_t design_of(const Agent& agent) {
  std::vector<std::byte> snapshot(agent.snapshot_bytes());
  agent.save(snapshot);
  return wire::load<std::uint64_t>(snapshot.data() + 8);
}

std::unique_ptr<Agent> agent_in(const std::string& path, Bytes part) {
  try {
    return read_part(part);
  } catch (const InvalidInput& error) {
    throw InvalidInput(path + ": " + error.what());
  }
}

const Member& self_in(const Roster& roster, const Settings& settings) {
  const Member* self = roster.find(settings.name);
  if (self != nullptr) return *self;
  std::string names;
  for (const Member& m : roster.members) names += (names.empty() ? "" : ", ") + m.name;
  refuse(settings.file + ", name", "\"" + settings.name + "\"", "an agent of " + roster.path + ": " + names);
}

Vector initial_of(const Roster& roster, int states) {
  if (roster.initial.empty()) return Vector::Zero(states);
  if (roster.initial.size() != static_cast<std::size_t>(states))
    refuse(roster.path + ", [run].initial", amount(roster.initial.size(), "number"),
           std::to_string(states) + ", one per state");
  return Eigen::Map<const Vector>(roster.initial.data(), states);
}

/// A model with inputs says something else without them, and all nodes have to have the same.
Inputs inputs_of(const Settings& settings, const AgentPart& part) {
  const std::string which = settings.file + ", [input]";
  if (part.B.cols() == 0 && !settings.inputs.empty())
    refuse(which, settings.inputs, "none: the model of the design has no B");
  if (part.B.cols() == 0) return {};
  if (settings.inputs.empty())
    refuse(which, "none", "source = \"file\" and a path: the model of the design has known inputs",
           "a CSV file with " + amount(part.B.cols(), "number") + " a row, the same on all nodes");
  return {settings.inputs, part};
}

/// A folder that is there, or can be made, and takes files.
void require_folder(const std::string& which, const std::string& path) {
  std::filesystem::path there(path);
  while (!there.empty() && !std::filesystem::exists(there)) there = there.parent_path();
  if (there.empty()) there = ".";
  if (!std::filesystem::is_directory(there))
    refuse(which, there.string() + ", which is no folder", "a folder");
  if (::access(there.c_str(), W_OK | X_OK) != 0)
    refuse_file(which + ": " + there.string(), "a folder that takes files");
}

/// What a start would fail with.
void require_places(const Settings& s) {
  if (s.socket.size() >= sizeof(sockaddr_un::sun_path))
    refuse(s.file + ", [socket].path", std::to_string(s.socket.size()) + " characters",
           "at most " + std::to_string(sizeof(sockaddr_un::sun_path) - 1), "a shorter path, as in /run");
  require_own(s.file + ", [listen].address = " + text_of(s.listen), s.listen);
  if (s.sensor.source == SensorSettings::Source::udp && same_address(s.sensor.address, s.listen))
    refuse(s.file + ", [sensor].address", "the address of [listen]", "another port");
  require_folder(s.file + ", [state].folder", s.state_folder);
  if (s.log_inputs) require_folder(s.file + ", [log].folder", s.log_folder);
  last_boot(s.state_folder);
}

bool hears(const Member& who, int whom) {
  return std::find(who.hears.begin(), who.hears.end(), whom) != who.hears.end();
}

/// Links both ways, unless the roster says who hears whom.
void add_links(Station& s) {
  const auto heard = s.agent->neighbours();
  for (const Member& m : s.roster.members) {
    if (m.id == s.self.id) continue;
    const bool in = std::binary_search(heard.begin(), heard.end(), m.id);
    const bool out = m.directed ? hears(m, s.self.id) : in;
    if (s.self.directed && hears(s.self, m.id) != in)
      refuse(s.roster.path + ", [[agent]] " + s.self.name + ", hears",
             in ? "a list without " + m.name : m.name, "those whom the design lets it hear",
             "write roster and parts from the same design");
    if (!in && !out) continue;
    if (m.address.storage.ss_family != s.settings.listen.storage.ss_family)
      refuse(s.settings.file + ", [listen].address", "an address of another family than " + m.name + " has",
             "IPv4 or IPv6, as the roster has for the neighbours");
    s.links.push_back(m);
    s.listens.push_back(out);
  }
  for (const int id : heard)
    if (s.roster.find(id) == nullptr)
      refuse(s.roster.path, "no agent " + std::to_string(id), "all neighbours of " + s.self.name,
             "add its [[agent]], or take the roster of this design");
}

}  // namespace

Station read_station(const std::string& path) {
  Station s;
  s.settings = read_settings(path);
  s.roster = read_roster(s.settings.roster);
  s.self = self_in(s.roster, s.settings);
  s.identity = read_key(s.settings.key);
  if (s.identity.open != s.self.open)
    refuse(s.settings.key, "the key " + base64(s.identity.open),
           base64(s.self.open) + ", as " + s.roster.path + " has for " + s.self.name,
           "put the line that garrison-keygen printed into the roster, on all nodes");
  s.part = read_bytes(s.settings.part, 64U << 20U,
                      "the agent's part of a design, which Prepared.save(path, agent=i) writes");
  s.agent = agent_in(s.settings.part, s.part);
  if (s.agent->id() != s.self.id)
    refuse(s.settings.part, "the part of agent " + std::to_string(s.agent->id()),
           "that of agent " + std::to_string(s.self.id) + ", which is " + s.self.name);
  s.schedule = schedule_for(s.roster, s.agent->rounds());
  s.initial = initial_of(s.roster, s.agent->states());
  s.inputs = inputs_of(s.settings, s.agent->part());
  s.run = prologue_of(design_of(*s.agent), s.schedule,
                      {s.initial.data(), static_cast<std::size_t>(s.initial.size())}, s.inputs.numbers());
  add_links(s);
  require_places(s.settings);
  const Sensor tried(s.settings.sensor, static_cast<std::size_t>(s.agent->outputs()), s.settings.file);
  return s;
}

void require_same_run(const Station& now, const Station& next) {
  const Settings &a = now.settings, &b = next.settings;
  const auto same_links = [&] {
    return std::equal(now.links.begin(), now.links.end(), next.links.begin(), next.links.end(),
                      [&](const Member& x, const Member& y) {
                        return x.id == y.id && x.open == y.open && same_address(x.address, y.address);
                      });
  };
  const std::pair<const char*, bool> kept[] = {
      {"name", now.self.id == next.self.id},
      {"key", now.identity.open == next.identity.open},
      {"part", now.part == next.part},
      {"run, inputs or schedule in the roster",
       now.run == next.run && now.schedule.resend == next.schedule.resend},
      {"list of neighbours in the roster", same_links() && now.listens == next.listens},
      {"[listen].address", same_address(a.listen, b.listen)},
      {"[clock].require_synchronised", a.require_synchronised == b.require_synchronised},
      {"[log].level or folder", a.log_inputs == b.log_inputs && a.log_folder == b.log_folder},
      {"[state].folder", a.state_folder == b.state_folder},
      {"[socket].path", a.socket == b.socket},
      {"[limits].receive_buffer_kb", a.receive_buffer == b.receive_buffer}};
  for (const auto& [what, same] : kept)
    if (!same)
      refuse(a.file, std::string("another ") + what,
             "the one that the node runs with: only [sensor], [log] size_mb and files, and [state] every_s "
             "change while it runs",
             "restart the node");
}

}  // namespace garrison::node
