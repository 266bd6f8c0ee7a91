// SPDX-License-Identifier: Apache-2.0
// Logs: the same bytes again, from a file that ends anywhere.
#include "garrison/node/log.hpp"

#include <doctest/doctest.h>

#include "folder.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/design_file.hpp"
#include "garrison/node/crypto.hpp"
#include "mutants.hpp"
#include "node/daemon/files.hpp"
#include "node/daemon/log_keeper.hpp"

using namespace garrison;
using namespace garrison::node;
using namespace garrison::node::test;

namespace {

std::vector<std::byte> part() {
  const Matrix A = 0.9 * Matrix::Identity(2, 2);
  std::vector<Matrix> C(3, Matrix::Identity(2, 2));
  return write_part(*make_filter("scalar_gain", {})->prepare(Model(A, C, Noise{}), Network::ring(3)), 1);
}

/// A log of some samples without messages.
std::string written(const std::string& path, int samples) {
  const auto file = part();
  const auto agent = read_part(file);
  LogWriter log(path, "n1", file);
  std::vector<std::byte> room(agent->most_bytes()), entry(1024), numbers(16);
  const auto note = [&](Call call, std::int64_t t, int round, Bytes data) {
    log.entry({entry.data(), write_entry({call, 0, round, t, data}, entry.data())}, t);
  };
  for (std::int64_t t = 1; t <= samples; ++t) {
    const double y[] = {static_cast<double>(t), -1.0};
    write_numbers(y, numbers.data());
    note(Call::sense, t, 0, numbers);
    agent->sense(t, y, room);
    while (agent->round() < agent->rounds()) {
      note(Call::fuse, t, agent->round(), {});
      agent->fuse(room);
    }
    std::array<double, 2> x{};
    agent->estimate(x);
    write_numbers(x, numbers.data());
    note(Call::estimate, t, 0, numbers);
    log.sample("{}", t);
  }
  log.flush();
  return read_text(path);  // still without its end
}

}  // namespace

TEST_CASE("a log gives the same estimates again, whole or cut") {
  const Folder folder;
  const std::string open = written(folder / "a.mcap", 20);
  const std::string whole = read_text(folder / "a.mcap");
  const LogReplay r = replay_log(text_bytes(whole));
  CHECK(r.estimates == 20);
  CHECK(r.wrong == 0);
  CHECK(r.ended);
  CHECK(r.agent == 1);
  CHECK(r.first == 1);
  CHECK(r.last == 20);
  CHECK(!replay_log(text_bytes(open)).ended);
  std::int64_t before = 0;
  for (std::size_t size = part().size() + 400; size < whole.size(); size += 7) {
    const LogReplay cut = replay_log(text_bytes(whole.substr(0, size)));
    CHECK(cut.wrong == 0);
    CHECK(cut.estimates >= before);
    before = cut.estimates;
  }
  CHECK(before == 20);
}

TEST_CASE("another measurement in a log shows") {
  const Folder folder;
  written(folder / "a.mcap", 20);
  std::string whole = read_text(folder / "a.mcap");
  std::array<std::byte, 8> ten;
  wire::store_double(ten.data(), 10.0);
  const std::size_t at = whole.find({reinterpret_cast<const char*>(ten.data()), 8});
  REQUIRE(at != std::string::npos);
  whole[at + 6] = static_cast<char>(whole[at + 6] ^ 4);
  CHECK(replay_log(text_bytes(whole)).wrong > 0);
}

TEST_CASE("mutated logs are replayed or refused") {
  const Folder folder;
  written(folder / "a.mcap", 5);
  const std::string whole = read_text(folder / "a.mcap");
  std::mt19937_64 random(5);
  int refused = 0;
  for (int k = 0; k < 3000; ++k) {
    try {
      const LogReplay r = replay_log(text_bytes(mutated(whole, random)));
      CHECK(r.estimates <= r.calls);
    } catch (const Error&) {
      ++refused;
    }
  }
  CHECK(refused > 100);
}

TEST_CASE("old logs go, and the newest stay") {
  const Folder folder;
  LogKeeper keeper(folder.path(), "n1", 7, part(), 2);
  for (int k = 0; k < 3; ++k) keeper.begin();
  CHECK(!std::filesystem::exists(folder / "n1-000007-0001.mcap"));
  CHECK(std::filesystem::exists(folder / "n1-000007-0002.mcap"));
  CHECK(std::filesystem::exists(folder / "n1-000007-0003.mcap"));
  CHECK_THROWS_AS(replay_log(text_bytes("no log at all")), InvalidInput);
}
