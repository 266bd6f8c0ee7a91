// SPDX-License-Identifier: Apache-2.0
#include "mesh.hpp"

#include <poll.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <deque>

#include "hostile.hpp"

namespace garrison::node::test {

namespace {

Address local(int port) { return address_from("mesh", "127.0.0.1:" + std::to_string(port)); }

bool is_free(int kind, int port) {
  const Descriptor socket(::socket(AF_INET, kind | SOCK_CLOEXEC, 0));
  const Address address = local(port);
  return ::bind(socket.get(), address.get(), address.size) == 0;
}

/// Ports that nobody listens at just now, below those that the system gives to connections.
std::vector<int> free_ports(int count, Seeded& random) {
  std::vector<int> out;
  for (int port = 20'000 + static_cast<int>(random.below(8'000)); static_cast<int>(out.size()) < count;
       ++port)
    if (is_free(SOCK_DGRAM, port) && is_free(SOCK_STREAM, port)) out.push_back(port);
  return out;
}

void put_round(int round, std::byte* at) { wire::store(at, static_cast<std::uint32_t>(round)); }
int round_in(const std::byte* at) { return static_cast<int>(wire::load<std::uint32_t>(at)); }

/// Datagrams as they are: what the system itself costs.
class Raw : public Mesh {
 public:
  Raw(MeshPlan& plan, int own) : plan_(plan), own_(own), neighbours_(plan.neighbours(own)) {
    for (int j = 0; j < plan.nodes; ++j) to_.push_back(local(plan.ports[static_cast<std::size_t>(2 * j)]));
  }
  bool open() override {
    udp_ = std::make_unique<Udp>("mesh", to_[static_cast<std::size_t>(own_)], 4 << 20);
    return true;
  }
  void send(int round) override {
    for (const int j : neighbours_) udp_->send(to_[static_cast<std::size_t>(j)], packed(j, round));
    udp_->flush();
  }
  int receive() override {
    while (came_.empty()) {
      now_ = garrison::node::now();  // once for all that is there: a node's deadlines want it, sealed or not
      if (udp_->receive([this](Bytes bytes) { unpack(bytes); }) > 0) continue;
      pollfd socket{udp_->descriptor(), POLLIN, 0};
      if (::poll(&socket, 1, kPatienceMs) <= 0) return -1;
    }
    const int round = came_.front();
    came_.pop_front();
    return round;
  }

 protected:
  virtual Bytes packed(int, int round) {
    put_round(round, bytes_.data());
    return {bytes_.data(), kBytes};
  }
  virtual void unpack(Bytes bytes) {
    if (bytes.size() == kBytes) came_.push_back(round_in(bytes.data()));
  }

  MeshPlan& plan_;
  int own_;
  std::deque<int> came_;
  Instant now_{};
  std::array<std::byte, kMostDatagram> bytes_{};

 private:
  std::vector<int> neighbours_;
  std::vector<Address> to_;
  std::unique_ptr<Udp> udp_;
};

/// The same under the seal of a node's links.
class Sealed final : public Raw {
 public:
  using Raw::Raw;

 private:
  Peer& peer(int other) {
    return *plan_.peers[static_cast<std::size_t>(own_)][static_cast<std::size_t>(other)];
  }
  Bytes packed(int to, int round) override {
    std::array<std::byte, kBytes> plain{};
    put_round(round, plain.data() + kInner);
    const std::size_t size = peer(to).seal_frame(plain, now_.steady, bytes_.data());
    return {bytes_.data(), size};
  }
  void unpack(Bytes bytes) override {
    if (bytes.size() < kOuter) return;
    const int from = wire::load<std::uint16_t>(bytes.data() + 2);
    if (from >= plan_.nodes || from == own_) return;
    if (peer(from).receive(bytes, now_, random_, plain_.data(), reply_).fate == Fate::taken)
      came_.push_back(round_in(plain_.data() + kInner));
  }

  Seeded random_{3};
  Datagram reply_;
  std::array<std::byte, kMostDatagram> plain_{};
};

/// A session between both, as two nodes make it.
void link(Peer& from, Peer& to, Seeded& random) {
  const Instant now = garrison::node::now();
  std::array<std::byte, kMostDatagram> plain;
  Datagram out, reply;
  from.tick(now, random, out);
  Peer *receiver = &to, *sender = &from;
  while (out.size != 0) {
    receiver->receive(out.view(), now, random, plain.data(), reply);
    out = reply;
    std::swap(receiver, sender);
  }
  if (!from.up() || !to.up()) std::abort();
}

}  // namespace

std::unique_ptr<MeshPlan> MeshPlan::of(int nodes) {
  auto plan = std::make_unique<MeshPlan>();
  plan->nodes = nodes;
  Seeded random(static_cast<std::uint64_t>(garrison::node::now().wall));
  plan->ports = free_ports(2 * nodes, random);
  std::vector<KeyPair> keys;
  for (int i = 0; i < nodes; ++i) keys.push_back(key_pair(random.key()));
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  plan->peers.resize(at(nodes));
  for (int i = 0; i < nodes; ++i)
    for (int j = 0; j < nodes; ++j)
      plan->peers[at(i)].push_back(
          std::make_unique<Peer>(i, j, keys[at(i)], keys[at(j)].open, Prologue{}, 1));
  for (int i = 0; i < nodes; ++i)
    for (int j = 0; j < i; ++j) link(*plan->peers[at(i)][at(j)], *plan->peers[at(j)][at(i)], random);
  add_curve_keys(*plan);
  return plan;
}

std::vector<int> MeshPlan::neighbours(int own) const {
  std::vector<int> out;
  for (const int step : {1, 2, nodes - 2, nodes - 1}) {
    const int other = (own + step) % nodes;
    if (other != own && std::find(out.begin(), out.end(), other) == out.end()) out.push_back(other);
  }
  return out;
}

const std::vector<Mesh::Kind>& Mesh::kinds() {
  static const std::vector<Kind> with{Kind::raw, Kind::sealed, Kind::curve}, without{Kind::raw, Kind::sealed};
  return curve_is_built() ? with : without;
}

const char* Mesh::word(Kind kind) {
  return kind == Kind::raw ? "raw" : kind == Kind::sealed ? "sealed" : "curve";
}

std::unique_ptr<Mesh> Mesh::of(Kind kind, MeshPlan& plan, int own) {
  if (kind == Kind::raw) return std::make_unique<Raw>(plan, own);
  if (kind == Kind::sealed) return std::make_unique<Sealed>(plan, own);
  return curve_mesh(plan, own);
}

}  // namespace garrison::node::test
