// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.hpp"

#include <algorithm>

#include "folder.hpp"
#include "fuzz/insider.hpp"
#include "garrison/core/error.hpp"
#include "garrison/engine/design_file.hpp"
#include "garrison/engine/snapshot_head.hpp"
#include "garrison/node/log.hpp"
#include "garrison/wire/blake2b.hpp"
#include "node/daemon/keys.hpp"
#include "node/daemon/roster.hpp"
#include "node/daemon/sensor.hpp"
#include "node/daemon/settings.hpp"
#include "node/daemon/state.hpp"
#include "plant.hpp"

namespace garrison::node::test {

namespace {

using Parse = std::function<bool(const std::string&)>;

std::string text_of(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }
void require(bool holds) {
  if (!holds) std::abort();
}
/// With the right digest of so many bytes at its end, as a forger writes it: what is behind the digest is
/// read, too.
std::string sealed(std::string file, std::size_t digest) {
  if (file.size() < digest) return file;
  const auto made = wire::blake2b(text_bytes(file).first(file.size() - digest));
  std::copy_n(reinterpret_cast<const char*>(made.data()), digest,
              file.end() - static_cast<std::ptrdiff_t>(digest));
  return file;
}
/// A refusal is an answer.
Parse refusing(std::function<void(const std::string&)> parse) {
  return [parse = std::move(parse)](const std::string& bytes) {
    try {
      parse(bytes);
      return true;
    } catch (const Error&) {
      return false;
    }
  };
}

Target settings() {
  return {
      refusing([](const std::string& text) { parse_settings(text, "node.toml"); }),
      {"name = \"DUB\"\npart = \"p\"\nroster = \"r\"\n[listen]\naddress = \"127.0.0.1:7470\"\n[sensor]\n"
       "source = \"procfs\"\nread = [\"load\", \"net:lo\"]\nscale = [2.0, 1]\nleast = [-50]\n[clock]\n"
       "require_synchronised = false\n[log]\nsize_mb = 2\n[state]\nevery_s = 10\n[socket]\npath = \"s\"\n"}};
}

Target roster() {
  const std::string key = base64(identity_of(Key{}).open);
  return {
      refusing([](const std::string& text) { schedule_for(parse_roster(text, "roster.toml"), 3); }),
      {"[run]\nstart = 2026-11-28T22:00:00.5+01:00\nperiod_ms = 100\ninitial = [1, 2.5]\n[[agent]]\nid = 1\n"
       "name = \"n\"\naddress = \"127.0.0.1:7470\"\nhears = [0, 2]\nkey = \"" +
       key + "\"\n"}};
}

Target key() {
  return {refusing([](const std::string& text) { open_key_from("key", text); }),
          {base64(identity_of(Key{}).open)}};
}

Target line() {
  return {[](const std::string& text) {
            const auto found = parse_line(text, 3);
            if (found)
              for (const double y : found->y) require(!std::isinf(y));
            return found.has_value();
          },
          {"@1700000000.25 1.5 -2.25e-3 nan", "1,2,3\r\n"}};
}

Target state() {
  const Prologue run{};
  const std::string snapshot = "a snapshot, of which the digest is asked";
  return {[run](const std::string& bytes) { return snapshot_in(text_bytes(bytes), run).has_value(); },
          {text_of(state_bytes(run, text_bytes(snapshot)))}};
}

Target proof() {
  std::array<std::byte, Proof::kSize> bytes;
  Statement a{3, 1, 10, 19, 30, {}, {}}, b = a;
  b.digest[0] = std::byte{1};
  Key open{};
  const SigningKey key = signing_key(Key{}, open);
  sign(a, Key{}, key);
  sign(b, Key{}, key);
  Proof{Key{}, a, b}.write(bytes.data());
  return {[open, a, b](const std::string& found) {
            const auto read = Proof::read(text_bytes(found));
            const bool convicts = read && read->convicts(open);
            require(!convicts || (read->a == a && read->b == b) || (read->a == b && read->b == a));
            return convicts;
          },
          {text_of(bytes)}};
}

const std::vector<std::byte>& part() {
  static const auto made = write_part(*shared_design(8), 0);
  return made;
}

Target design_part() {
  return {
      refusing([](const std::string& bytes) { read_part(text_bytes(sealed(bytes, sizeof(wire::Digest)))); }),
      {text_of(part())}};
}

Target log() {
  const Folder folder;
  {
    LogWriter writer(folder / "x.mcap", "n", part());
    const auto agent = read_part(part());
    std::vector<std::byte> entry(1024), numbers(8), room(agent->most_bytes());
    write_numbers(std::array{0.5}, numbers.data());
    writer.entry({entry.data(), write_entry({Call::sense, 0, 0, 1, numbers}, entry.data())}, 1);
    writer.sample("{}", 1);
  }
  return {refusing([](const std::string& bytes) { replay_log(text_bytes(bytes)); }),
          {read_text(folder / "x.mcap")}};
}

Target snapshot() {
  const std::shared_ptr<Agent> agent = read_part(part());
  std::vector<std::byte> saved(agent->snapshot_bytes());
  saved.resize(agent->save(saved));
  return {[agent](const std::string& bytes) {
            return agent->load(text_bytes(sealed(bytes, SnapshotHead::kChecksum))) == Refusal::none;
          },
          {text_of(saved)}};
}

/// What an insider sends: any plaintext behind a genuine seal.
Target frame() {
  const auto insider = std::make_shared<Insider>();
  return {[insider](const std::string& plain) { return insider->says(text_bytes(plain)); },
          insider->genuine()};
}

/// What anybody sends.
Target datagram() {
  const auto insider = std::make_shared<Insider>();
  return {[insider](const std::string& bytes) { return insider->shows(text_bytes(bytes)) == Fate::taken; },
          insider->sealed()};
}

const std::vector<std::pair<std::string, Target (*)()>> kTargets = {
    {"settings", settings}, {"roster", roster}, {"key", key},          {"line", line},
    {"state", state},       {"proof", proof},   {"part", design_part}, {"log", log},
    {"snapshot", snapshot}, {"frame", frame},   {"datagram", datagram}};

}  // namespace

const std::vector<std::string>& target_names() {
  static const auto names = [] {
    std::vector<std::string> out;
    for (const auto& [name, make] : kTargets) out.push_back(name);
    return out;
  }();
  return names;
}

std::unique_ptr<Target> target_of(const std::string& name) {
  for (const auto& [known, make] : kTargets)
    if (name == known) return std::make_unique<Target>(make());
  return nullptr;
}

}  // namespace garrison::node::test
