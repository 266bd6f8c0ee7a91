// SPDX-License-Identifier: Apache-2.0
// garrison_node_hostile [SCALE]: rows 2 to 5 of the acceptance table, full counts at SCALE 1 (the default).
// Prints what was tried, taken and what a refusal costs; ends with 1 when anything was taken, or a refusal
// costs more than a microsecond.
#include "hostile.hpp"

#include <cstdio>
#include <cstdlib>

using namespace garrison::node;
using namespace garrison::node::test;

namespace {
constexpr double kMostCost = 1e-6;  // seconds of CPU for a refusal
bool failed = false;
bool slow = false;

/// keyless: somebody without keys, whom a refusal has to cost more than us.
void show(const char* what, const Outcome& outcome, bool keyless = true) {
  std::printf("%-46s tried %8lld, taken %lld, %.2f us each;", what, static_cast<long long>(outcome.tried),
              static_cast<long long>(outcome.accepted()),
              outcome.seconds / static_cast<double>(outcome.tried) * 1e6);
  for (std::size_t k = 0; k < kFates; ++k)
    if (const auto n = outcome.fates[static_cast<Fate>(k)]; n != 0)
      std::printf(" %s %lld", word(static_cast<Fate>(k)).data(), static_cast<long long>(n));
  std::printf("\n");
  failed |= outcome.accepted() != 0;
  slow |= keyless && outcome.seconds > kMostCost * static_cast<double>(outcome.tried);
}

void replays(Pair& pair, std::int64_t count) {
  std::vector<Octets> genuine;
  for (std::int64_t k = 0; k < count; ++k) {
    genuine.push_back(pair.frame(pair.zero));
    failed |= pair.give(pair.one, genuine.back()) != Fate::taken;
  }
  const auto replay = [&](std::int64_t k) -> const Octets& { return genuine[static_cast<std::size_t>(k)]; };
  show("replayed at once", throw_at(pair, pair.one, count, replay));
  pair.pass(1'000'000);
  show("replayed after a second", throw_at(pair, pair.one, count, replay));
  show("reflected to their sender", throw_at(pair, pair.zero, count, replay));
  Pair other(99);
  other.prologue = pair.prologue;
  Peer third = other.end(1, 0);
  show("given to another node", throw_at(pair, third, count, replay));
  Peer receiver = pair.end(1, 0, 2);
  for (const Octets& bytes : pair.captured) pair.give(receiver, bytes);
  show("after a restart of the receiver", throw_at(pair, receiver, count, replay));
  Peer sender = pair.end(0, 1, 2);
  failed |= !pair.link(sender, pair.one);
  show("after a restart of the sender", throw_at(pair, pair.one, count, replay));
  failed |= pair.give(pair.one, pair.frame(sender)) != Fate::taken;
  pair.zero = sender;
}
}  // namespace

int main(int count, char** arguments) {
  if (!start_crypto()) return 1;
  const double scale = count > 1 ? std::atof(arguments[1]) : 1.0;
  const auto scaled = [scale](double n) { return static_cast<std::int64_t>(n * scale) + 1; };
  Pair pair(3);
  if (!pair.link(pair.zero, pair.one)) return 1;
  replays(pair, scaled(1e5));
  Octets bytes;
  const Octets unused = pair.frame(pair.zero);
  show("forged: right header, random rest",
       throw_at(pair, pair.one, scaled(1e6), [&](std::int64_t) -> const Octets& {
         bytes = unused;
         garrison::wire::store(bytes.data() + 8, std::uint64_t{200000} + pair.random.below(1000000));
         for (std::size_t k = kOuter; k < bytes.size(); ++k)
           bytes[k] = static_cast<std::byte>(pair.random.next());
         return bytes;
       }));
  show("mutated: bits, lengths, counters, fields",
       throw_at(pair, pair.one, scaled(1e6), [&](std::int64_t) -> const Octets& {
         bytes = mutated(unused, pair.random);
         return bytes;
       }));
  Pair stranger(4);
  Peer unknown = stranger.end(0, 1);
  Datagram out;
  show("handshakes of strangers", throw_at(pair, pair.one, scaled(1e6), [&](std::int64_t k) -> const Octets& {
         if (k % 1000 == 0) {
           stranger.pass(Peer::kRetry);
           unknown.tick(stranger.now, stranger.random, out);
           bytes.assign(out.view().begin(), out.view().end());
         }
         garrison::wire::store(bytes.data() + 4, pair.random.next());
         return bytes;
       }));
  Pair foreign(3);
  foreign.prologue[40] ^= std::byte{1};
  Peer other_design = foreign.end(0, 1);
  foreign.pass(3'600'000'000);
  show("right key, another design",
       throw_at(pair, pair.one, scaled(1e4),
                [&](std::int64_t) -> const Octets& {
                  foreign.pass(Peer::kRetry);
                  other_design.tick(foreign.now, foreign.random, out);
                  bytes.assign(out.view().begin(), out.view().end());
                  return bytes;
                }),
       false);
  failed |= pair.give(pair.one, unused) != Fate::taken;
  std::printf("the link still works: %s\n",
              failed ? "NO, or something was taken" : "yes, and nothing was taken");
  if (slow) std::printf("a refusal of somebody without keys costs more than a microsecond\n");
  return failed || slow ? 1 : 0;
}
