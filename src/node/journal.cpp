// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/journal.hpp"

namespace garrison::node {

Replay::Replay(Agent& agent, std::function<void(std::int64_t, int, Bytes)> sent)
    : agent_(agent),
      sent_(std::move(sent)),
      room_(agent.most_bytes()),
      numbers_(static_cast<std::size_t>(std::max(agent.states(), agent.outputs()))) {}

void Replay::operator()(const Entry& entry) {
  if (entry.call == Call::estimate)
    compare(entry.data);
  else if (!done(entry))
    ++wrong_;
}

bool Replay::all(Bytes journal) {
  Entry entry;
  std::size_t size = 0;
  while (!journal.empty()) {
    if (!read_entry(journal, entry, size)) return false;
    (*this)(entry);
    journal = journal.subspan(size);
  }
  return true;
}

bool Replay::done(const Entry& entry) {
  const auto numbers = [&](int count) {
    const std::span<double> all(numbers_.data(), static_cast<std::size_t>(count));
    read_numbers(entry.data, all);
    return all;
  };
  switch (entry.call) {
    case Call::reset: {
      const auto x0 = numbers(agent_.states());
      const Vector start = Eigen::Map<const Vector>(x0.data(), agent_.states());
      return agent_.reset(start, entry.sample) == Refusal::none;
    }
    case Call::load:
      return agent_.load(entry.data) == Refusal::none;
    case Call::sense:
      return show(agent_.sense(entry.sample, numbers(agent_.outputs()), room_));
    case Call::deliver:
      return agent_.deliver({entry.sender, entry.sample, entry.round}, entry.data) == Refusal::none;
    case Call::fuse:
      return show(agent_.fuse(room_));
    case Call::listen:
      return agent_.listen(entry.sample) == Refusal::none;
    case Call::join:
      return agent_.join(entry.round != 0) == Refusal::none;
    case Call::uncover:
      agent_.uncover();
      return true;
    case Call::estimate:
      break;
  }
  return true;
}

bool Replay::show(Agent::Sent sent) {
  if (sent_ && sent.bytes != 0 && agent_.round() < agent_.rounds())
    sent_(agent_.sample(), agent_.round(), {room_.data(), sent.bytes});
  return sent.refusal == Refusal::none;
}

void Replay::compare(Bytes expected) {
  ++estimates_;
  const std::span<double> x(numbers_.data(), static_cast<std::size_t>(agent_.states()));
  agent_.estimate(x);
  std::vector<std::byte> bytes(8 * x.size());
  write_numbers(x, bytes.data());
  if (!std::equal(bytes.begin(), bytes.end(), expected.begin(), expected.end())) ++wrong_;
}

}  // namespace garrison::node
