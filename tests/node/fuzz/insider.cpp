// SPDX-License-Identifier: Apache-2.0
#include "fuzz/insider.hpp"

#include <cmath>
#include <cstdlib>

#include "plant.hpp"

namespace garrison::node::test {

namespace {
constexpr int kAgents = 8, kNeighbour = 1;
}

Insider::Insider()
    : random_(7),
      own_keys_(key_pair(random_.key())),
      other_keys_(key_pair(random_.key())),
      agent_(shared_design(kAgents)->agent(0)),
      other_(shared_design(kAgents)->agent(kNeighbour)) {
  std::vector<Neighbour> neighbours;
  for (const int j : agent_->neighbours())
    neighbours.push_back({j, j == kNeighbour ? other_keys_.open : key_pair(random_.key()).open});
  World& world = *this;
  node_ = std::make_unique<Node>(*agent_, schedule_, own_keys_, std::move(neighbours), prologue_, 1, world,
                                 random_);
  node_->core().start(Vector{{1.0, 0.0}}, now_);
  peer_ = std::make_unique<Peer>(kNeighbour, 0, other_keys_, own_keys_.open, prologue_, 1);
  Datagram out;
  std::array<std::byte, kMostDatagram> plain;
  peer_->tick(now_, random_, out);
  node_->receive(out.view(), now_);
  while (!arrived_.empty()) {
    const Octets bytes = arrived_.back();
    arrived_.pop_back();
    peer_->receive(bytes, now_, random_, plain.data(), out);
    if (out.size != 0) node_->receive(out.view(), now_);
  }
  if (!peer_->up()) std::abort();
}

void Insider::send(int neighbour, Bytes datagram) noexcept {
  if (neighbour == kNeighbour && peer_ && !peer_->up())
    arrived_.emplace_back(datagram.begin(), datagram.end());
}

/// A frame that was refused still counts as read; time goes on, so that samples begin and end.
bool Insider::says(Bytes plain) {
  std::array<std::byte, 2 * kMostDatagram> sealed;
  const Bytes fitting = plain.first(std::min(plain.size(), kMostDatagram - kOuter - 16));
  const std::size_t size = peer_->seal_frame(fitting, now_.steady, sealed.data());
  return shows({sealed.data(), size}) == Fate::taken;
}

Fate Insider::shows(Bytes datagram) {
  now_.wall += 50;
  now_.steady += 50;
  const Fate fate = node_->receive(datagram, now_);
  node_->tick(now_);
  std::array<double, 2> x{};
  agent_->estimate(x);
  if (!std::isfinite(x[0]) || !std::isfinite(x[1])) std::abort();
  return fate;
}

Octets Insider::message(int round) {
  Octets body(other_->most_bytes());
  const double y = 0.5;
  if (round == 0) other_->sense(other_->sample() + 1, {&y, 1}, body);
  Octets out(kInner + body.size());
  Inner{Kind::message, 0, false, static_cast<std::uint16_t>(round), other_->sample()}.write(out.data());
  std::copy(body.begin(), body.end(), out.begin() + kInner);
  return out;
}

std::vector<std::string> Insider::genuine() {
  std::vector<std::string> out;
  const auto add = [&](const Octets& plain) {
    out.emplace_back(reinterpret_cast<const char*>(plain.data()), plain.size());
  };
  add(message(0));
  for (const Kind kind : {Kind::want, Kind::statement, Kind::alive}) {
    Octets plain(kInner + (kind == Kind::statement ? Statement::kSize : 0));
    Inner{kind, 0, false, 0, 1}.write(plain.data());
    add(plain);
  }
  return out;
}

std::vector<std::string> Insider::sealed() {
  std::vector<std::string> out;
  for (const std::string& plain : genuine()) {
    std::array<std::byte, kMostDatagram> bytes;
    const std::size_t size = peer_->seal_frame(std::as_bytes(std::span(plain)), now_.steady, bytes.data());
    out.emplace_back(reinterpret_cast<const char*>(bytes.data()), size);
  }
  return out;
}

}  // namespace garrison::node::test
