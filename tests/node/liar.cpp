// SPDX-License-Identifier: Apache-2.0
// garrison_node_liar FILE: garrison-node, but it tells every second neighbour something else than the others,
// and signs both. A program of tests: garrison-net up --liar.
#include <algorithm>
#include <cstdio>

#include "equivocation.hpp"
#include "node/daemon/running.hpp"

using namespace garrison::node;

namespace {

/// A message's first number with the other sign, and statements about something else.
class Liar final : public Tamper {
 public:
  explicit Liar(const Station& station) : station_(station), id_(station.self.id) {
    hash({}, {station.run}, run_);
    Key open{};
    key_ = signing_key(station.identity.seed, open);
  }
  std::size_t operator()(int neighbour, Room plain, std::size_t size) noexcept override {
    if (!lied_to(neighbour) || test::state_otherwise(plain, size, id_, run_, key_)) return size;
    if (Inner::read(plain.data()).kind == Kind::message && size >= kInner + 8)
      plain[kInner + 7] ^= std::byte{0x80};
    return size;
  }

 private:
  bool lied_to(int neighbour) const noexcept {
    const auto& all = station_.links;
    const auto at = std::find_if(all.begin(), all.end(), [&](const Member& m) { return m.id == neighbour; });
    return (at - all.begin()) % 2 == 1;
  }

  const Station& station_;
  int id_;
  Key run_{};
  SigningKey key_{};
};

}  // namespace

int main(int count, char** words) {
  if (count < 2 || !start_crypto())
    return std::fputs("usage: garrison_node_liar [--print] FILE\n", stderr), 2;
  block_signals();
  try {
    Station station = read_station(words[count - 1]);
    Liar liar(station);
    run_node(station, count > 2, &liar);
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "garrison_node_liar: %s\n", error.what()), 2;
  }
}
