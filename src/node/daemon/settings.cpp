// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/settings.hpp"

#include <cmath>
#include <cstdlib>

#include "garrison/core/error.hpp"
#include "node/daemon/machine.hpp"
#include "node/daemon/toml_file.hpp"

namespace garrison::node {

namespace {

constexpr double kMostSeconds = 1e7;

SensorSettings::Source source_of(const Section& section) {
  const std::string source = section.text("source");
  const std::pair<const char*, SensorSettings::Source> known[] = {
      {"none", SensorSettings::Source::none},     {"lines", SensorSettings::Source::lines},
      {"udp", SensorSettings::Source::udp},       {"file", SensorSettings::Source::file},
      {"procfs", SensorSettings::Source::procfs}, {"socket", SensorSettings::Source::socket}};
  for (const auto& [word, found] : known)
    if (source == word) return found;
  refuse(section.where("source"), "\"" + source + "\"",
         "\"none\", \"lines\", \"udp\", \"file\", \"procfs\" or \"socket\"");
}

SensorSettings read_sensor(const Section& section, const std::string& folder) {
  section.only(
      {"source", "command", "path", "address", "read", "scale", "offset", "least", "most", "max_age_ms"});
  SensorSettings s;
  s.source = source_of(section);
  s.scale = section.numbers("scale");
  s.offset = section.numbers("offset");
  s.least = section.numbers("least");
  s.most = section.numbers("most");
  s.max_age = std::llround(1000 * section.number("max_age_ms", 0.0, 1000 * kMostSeconds, 500.0));
  s.command = section.text("command", "");
  s.path = section.text("path", "");
  using Source = SensorSettings::Source;
  const bool piped = s.source == Source::lines;
  if (!s.command.empty() && (!piped || !s.path.empty()))
    refuse(section.where("command"), "a command", "one only of source = \"lines\", and no path beside it");
  if (s.path.empty() && (s.source == Source::file || (piped && s.command.empty())))
    refuse(section.where("path"), "nothing", piped ? "a named pipe, \"-\", or a command" : "a CSV file");
  s.read = section.texts("read");
  if (s.source == Source::procfs)
    Machine(section.where("read"), s.read);  // refuses names that it does not know
  else if (!s.read.empty())
    refuse(section.where("read"), "a list", "one only of source = \"procfs\"");
  if (!s.path.empty() && s.path != "-") s.path = beside(folder, s.path);
  if (s.source != Source::udp) return s;
  s.address = address_from(section.where("address"), section.text("address"));
  if (!is_loopback(s.address))
    refuse(section.where("address"), section.text("address"),
           "an address of this machine alone: 127.0.0.1 or [::1]",
           "sensors are not authenticated; let a program on this machine receive from others");
  return s;
}

/// Inputs that come as they are applied are no source: one that got lost would shift all that a node says
/// from then on.
std::string read_inputs(const Section& section, const std::string& folder) {
  section.only({"source", "path"});
  if (const std::string source = section.text("source"); source != "file")
    refuse(section.where("source"), "\"" + source + "\"", "\"file\": the inputs of the whole run in \"path\"",
           "inputs that are only known once they are applied are not taken: a node that missed one would be "
           "wrong "
           "from then on");
  return beside(folder, section.text("path"));
}

/// Where the service manager wants it (systemd.exec(5)), else beside the settings.
std::string given_or(const char* variable, const std::string& otherwise) {
  const char* given = std::getenv(variable);
  return given != nullptr && *given != '\0' ? given : otherwise;
}

}  // namespace

Settings parse_settings(const std::string& text, const std::string& path) {
  const Section file = parse_toml(text, path);
  file.only({"name", "part", "roster", "key", "listen", "sensor", "input", "clock", "log", "state", "socket",
             "limits"});
  const std::string folder = folder_of(path);
  Settings s;
  s.file = path;
  s.name = file.text("name");
  s.part = beside(folder, file.text("part"));
  s.roster = beside(folder, file.text("roster"));
  s.key = file.has("key") ? beside(folder, file.text("key"))
                          : beside(given_or("CREDENTIALS_DIRECTORY", folder), "node.key");

  const Section listen = file.section("listen");
  listen.only({"address"});
  s.listen = address_from(listen.where("address"), listen.text("address"));
  if (file.has("sensor")) s.sensor = read_sensor(file.section("sensor"), folder);
  if (file.has("input")) s.inputs = read_inputs(file.section("input"), folder);

  const Section clock = file.section("clock");
  clock.only({"require_synchronised"});
  s.require_synchronised = clock.flag("require_synchronised", true);

  const Section log = file.section("log");
  log.only({"level", "folder", "size_mb", "files"});
  const std::string level = log.text("level", "inputs");
  if (level != "inputs" && level != "off")
    refuse(log.where("level"), "\"" + level + "\"", "\"inputs\" or \"off\"");
  s.log_inputs = level == "inputs";
  s.log_folder = beside(folder, log.text("folder", given_or("LOGS_DIRECTORY", "log")));
  s.log_bytes = log.whole("size_mb", 1, 1 << 20, 64) << 20U;
  s.log_files = static_cast<int>(log.whole("files", 1, 10'000, 4));

  const Section state = file.section("state");
  state.only({"folder", "every_s"});
  s.state_folder = beside(folder, state.text("folder", given_or("STATE_DIRECTORY", "state")));
  s.state_every = std::llround(1e6 * state.number("every_s", 1.0, kMostSeconds, 60.0));

  const Section socket = file.section("socket");
  socket.only({"path"});
  const std::string run = given_or("RUNTIME_DIRECTORY", "");
  const std::string place = socket.text("path", run.empty() ? "" : beside(run, "node.sock"));
  if (!place.empty()) s.socket = beside(folder, place);

  const Section limits = file.section("limits");
  limits.only({"receive_buffer_kb"});
  s.receive_buffer = static_cast<int>(limits.whole("receive_buffer_kb", 16, 1 << 20, 1024)) << 10U;
  return s;
}

Settings read_settings(const std::string& path) {
  return parse_settings(read_text(path, "a node.toml; docs/how-to/deploy-three-nodes.md has one"), path);
}

}  // namespace garrison::node
