// SPDX-License-Identifier: Apache-2.0
// Files of a node: what fits is read, what does not is refused with file, line, and what to do.
#include "node/daemon/files.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>

#include "folder.hpp"
#include "garrison/core/error.hpp"
#include "mutants.hpp"
#include "node/daemon/keys.hpp"
#include "node/daemon/roster.hpp"
#include "node/daemon/settings.hpp"
#include "node/daemon/state.hpp"
#include "node/daemon/toml_file.hpp"
#include "refusals.hpp"

using namespace garrison;
using namespace garrison::node;
using namespace garrison::node::test;

namespace {

const std::string kSettings = R"(name = "DUB"
part = "part.gdesign"
roster = "../roster.toml"
key = "node.key"
[listen]
address = "HERE"
[sensor]
source = "lines"
command = "cat"
scale = [2.0]
offset = [0.5]
least = [-50]
most = [60]
max_age_ms = 250
[clock]
require_synchronised = false
[log]
size_mb = 2
files = 3
[state]
every_s = 10
[socket]
path = "node.sock"
)";

std::string roster_text() {
  std::string text = "[run]\nstart = 2026-11-28T22:00:00.5+01:00\nperiod_ms = 100\ninitial = [1, 2.5]\n";
  for (int id : {1, 0}) {
    const Identity identity = identity_of(Key{static_cast<std::byte>(id)});
    text += "[[agent]]\nid = " + std::to_string(id) + "\nname = \"n" + std::to_string(id) + "\"\nkey = \"" +
            base64(identity.open) + "\"\naddress = \"HERE\"\n";
  }
  return text;
}

/// No name is looked up in a test: the address is put in after everything else was changed.
std::string with_address(std::string text) {
  int port = 7470;
  for (std::size_t at = 0; (at = text.find("\"HERE\"")) != std::string::npos;)
    text.replace(at, 6, "\"127.0.0.1:" + std::to_string(port++) + "\"");
  return text;
}

std::string settings_with(const std::string& old, const std::string& next) {
  std::string text = kSettings;
  REQUIRE(text.find(old) != std::string::npos);
  text.replace(text.find(old), old.size(), next);
  return refused([&] { parse_settings(with_address(text), "/etc/garrison/node.toml"); });
}

}  // namespace

TEST_CASE("settings: paths are relative to the file, times are microseconds") {
  const Settings s = parse_settings(with_address(kSettings), "/etc/garrison/node.toml");
  CHECK(s.roster == "/etc/roster.toml");
  CHECK(s.state_folder == "/etc/garrison/state");
  CHECK(s.sensor.command == "cat");
  CHECK(s.sensor.max_age == 250'000);
  CHECK(s.log_bytes == 2 << 20);
  CHECK(s.state_every == 10'000'000);
  CHECK(!s.require_synchronised);
}

TEST_CASE("settings: refusals say file, line, key, and what to do") {
  CHECK(says(settings_with("scale =", "scael ="),
             {"node.toml, line 10, [sensor].scael", "did you mean \"scale\""}));
  CHECK(says(settings_with("\"lines\"", "\"line\""),
             {"line 8, [sensor].source", "\"line\"", "\"lines\", \"udp\""}));
  CHECK(says(settings_with("size_mb = 2", "size_mb = 0"), {"line 18", "got 0", "1..1048576"}));
  CHECK(says(settings_with("size_mb = 2", "size_mb = 2.5"), {"line 18", "got 2.5", "a whole number"}));
  CHECK(says(settings_with("[listen]", "[listen"), {"line 5", "TOML"}));
  CHECK(says(settings_with("name = \"DUB\"", ""), {"name", "got nothing", "add a line"}));
  CHECK(says(settings_with("name = \"DUB\"", "name = 7"), {"line 1, name", "got 7", "quotes"}));
  CHECK(says(settings_with("\"HERE\"", "\"127.0.0.1\""), {"line 6, [listen].address", "host:port"}));
  CHECK(says(settings_with("\"HERE\"", "\"127.0.0.1:70000\""), {"[listen].address", "host:port"}));
  CHECK(says(settings_with("\"HERE\"", "\"239.1.2.3:7470\""), {"[listen].address", "an address of many"}));
  CHECK(says(settings_with("\"HERE\"", "\"[ff02::1]:7470\""), {"[listen].address", "an address of many"}));
  CHECK(says(settings_with("[clock]", "[input]\nsource = \"udp\"\n[clock]"),
             {"[input].source", "got \"udp\"", "only known once they are applied"}));
  CHECK(
      says(settings_with("[clock]", "[input]\nsource = \"file\"\n[clock]"), {"[input].path", "got nothing"}));
  CHECK(says(settings_with("command = \"cat\"", ""), {"[sensor].path", "named pipe"}));
  CHECK(says(settings_with("scale = [2.0]", "scale = [nan]"), {"[sensor].scale", "finite"}));
  CHECK(says(
      settings_with("source = \"lines\"\ncommand = \"cat\"", "source = \"udp\"\naddress = \"0.0.0.0:7\""),
      {"[sensor].address", "got 0.0.0.0:7", "not authenticated"}));
}

TEST_CASE("roster: members in order, a start with a time zone") {
  const Roster r = parse_roster(with_address(roster_text()), "roster.toml");
  CHECK(r.schedule.start == 1'795'899'600'500'000);
  CHECK(r.schedule.period == 100'000);
  REQUIRE(r.members.size() == 2);
  CHECK(r.members[0].id == 0);
  CHECK(r.find("n1")->id == 1);
  CHECK(r.find("n2") == nullptr);
  CHECK(r.initial == std::vector{1.0, 2.5});
}

TEST_CASE("roster: what cannot be is refused") {
  const auto with = [](const std::string& old, const std::string& next) {
    std::string text = roster_text();
    REQUIRE(text.find(old) != std::string::npos);
    text.replace(text.find(old), old.size(), next);
    return refused([&] { parse_roster(with_address(text), "roster.toml"); });
  };
  CHECK(says(with("id = 1", "id = 0"), {"[[agent]] n", "the id of", "another id for every agent"}));
  CHECK(says(with("n1", "n0"), {"the name of", "another name"}));
  CHECK(says(with("key = \"", "key = \"A"), {"[agent].key", "32 bytes in base64"}));
  CHECK(says(with("period_ms = 100", "period_ms = 0"), {"[run].period_ms", "got 0"}));
  CHECK(says(with("start = 2026-11-28T22:00:00.5+01:00", ""),
             {"[run].start", "got nothing", "2026-01-31T12:00:00Z"}));
  CHECK(says(with("address", "adress"), {"did you mean \"address\""}));
  CHECK(says(with("name = \"n1", "name = \"n" + std::string(300, '1')),
             {"name", "got 301 bytes", "at most 200"}));
  CHECK(says(with("HERE", "0.0.0.0:7470"), {"address", "0.0.0.0:7470", "that others send to"}));
  CHECK(says(with("HERE", "224.0.0.1:7470"), {"address", "an address of many"}));
}

TEST_CASE("an address that no socket can be bound to is said with what the system says") {
  const auto why = [](const char* text) {
    return refused([&] { require_own("[listen].address = " + std::string(text), address_from("", text)); });
  };
  CHECK(why("127.0.0.1:7470").empty());
  CHECK(why("0.0.0.0:7470").empty());
  CHECK(
      says(why("192.0.2.1:7470"), {"[listen].address = 192.0.2.1:7470", "Cannot assign", "of this machine"}));
  CHECK(text_of(address_from("", "127.0.0.1:7470")) == "127.0.0.1:7470");
  CHECK(text_of(address_from("", "[::1]:7470")) == "[::1]:7470");
}

TEST_CASE("schedule: rounds have to fit into the period") {
  Roster r = parse_roster(with_address(roster_text()), "roster.toml");
  CHECK(schedule_for(r, 4).round == 20'000);
  CHECK(schedule_for(r, 4).resend == 2'500);
  CHECK(says(refused([&] { schedule_for(r, 100); }), {"100 rounds", "a longer period_ms"}));
  r.schedule.round = 60'000;
  CHECK(says(refused([&] { schedule_for(r, 2); }), {"2 rounds of 60 ms"}));
}

TEST_CASE("schedule and design make another run") {
  const Schedule s;
  Schedule later = s;
  later.start = 1;
  const std::vector<double> x0{1.0};
  CHECK(prologue_of(1, s, x0) == prologue_of(1, s, x0));
  CHECK(prologue_of(1, s, x0) != prologue_of(2, s, x0));
  CHECK(prologue_of(1, s, x0) != prologue_of(1, later, x0));
  CHECK(prologue_of(1, s, x0) != prologue_of(1, s, {}));
  CHECK(prologue_of(1, s, x0) == prologue_of(1, s, x0, {}));
  CHECK(prologue_of(1, s, x0) != prologue_of(1, s, x0, x0));
}

// toml++ 3.3 held these for unreachable: found by libFuzzer in 440 runs.
TEST_CASE("letters beyond ASCII outside of quotes are refused, and taken inside") {
  for (const char* bad : {"\xef\xbb\x97\n", "n\xc3\xa9 = 1\n", "a = 1 \xe3\x80\x81\n"})
    CHECK(says(refused([&] { parse_toml(bad, "node.toml"); }), {"node.toml, line 1", "a TOML document"}));
  CHECK(parse_toml("name = \"\xc3\xa9\xef\xbb\x97\"  # \xc3\xa9\n", "node.toml").text("name") ==
        "\xc3\xa9\xef\xbb\x97");
}

TEST_CASE("mutated settings and rosters are read or refused, and nothing else happens") {
  std::mt19937_64 random(20);
  int fine = 0, refusals = 0;
  const auto attempt = [&](auto call) {
    const std::string message = refused(call);
    ++(message.empty() ? fine : refusals);
    if (!message.empty()) CHECK(says(message, {"got ", "expected "}));
  };
  for (int k = 0; k < 3000; ++k) {
    const std::string settings = with_address(mutated(kSettings, random));
    attempt([&] { parse_settings(settings, "node.toml"); });
    const std::string roster = with_address(mutated(roster_text(), random));
    attempt([&] { parse_roster(roster, "roster.toml"); });
  }
  CHECK(fine > 100);
  CHECK(refusals > 1000);
}

TEST_CASE("keys: written once, read back, for their owner alone") {
  const Folder folder;
  const std::string path = folder / "node.key";
  const Identity identity = identity_of(random_seed());
  write_key(path, identity);
  CHECK(read_key(path).open == identity.open);
  CHECK(read_key(path).exchange.open == identity.exchange.open);
  Key exchange{};
  REQUIRE(exchange_key(identity.open, exchange));
  CHECK(exchange == identity.exchange.open);  // others make the same of the public half
  CHECK(says(refused([&] { write_key(path, identity); }), {"node.key", "a new file"}));
  ::chmod(path.c_str(), 0640);
  CHECK(says(refused([&] { read_key(path); }), {"others than its owner", "chmod 600"}));
  const std::string other = "garrison-key-2 AAAA\n";
  replace_file(path, text_bytes(other));
  CHECK(says(refused([&] { read_key(path); }), {"got no key", "garrison-keygen"}));
}

TEST_CASE("state: read back for the same run only, mutants never") {
  const Folder folder;
  Prologue run{}, other{};
  other[3] = std::byte{1};
  const std::string snapshot = "what an agent knows";
  write_state(folder.path(), run, text_bytes(snapshot));
  const auto found = read_state(folder.path(), run);
  REQUIRE(found);
  CHECK(same(*found, text_bytes(snapshot)));
  CHECK(!read_state(folder.path(), other));
  const auto whole = read_text(folder / "state");
  std::mt19937_64 random(1);
  for (int k = 0; k < 5000; ++k) {
    const std::string mutant = mutated(whole, random);
    if (mutant != whole) CHECK(!snapshot_in(text_bytes(mutant), run));
  }
}

TEST_CASE("boot counts up, and is not guessed") {
  const Folder folder;
  CHECK(next_boot(folder.path()) == 1);
  CHECK(next_boot(folder.path()) == 2);
  const std::string nonsense = "many";
  replace_file(folder / "boot", text_bytes(nonsense));
  CHECK(says(refused([&] { next_boot(folder.path()); }), {"boot", "\"many\"", "greater than it ever was"}));
}
