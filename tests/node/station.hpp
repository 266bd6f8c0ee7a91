// SPDX-License-Identifier: Apache-2.0
// One node of a simulation, its disk and its log.
#pragma once

#include "simulation.hpp"

namespace garrison::node::test {

class Simulation::Station final : public World, private Tamper {
 public:
  Station(Simulation& simulation, int id) : s_(simulation), id_(id) {}

  void boot();
  void crash(bool lost);
  void tick();
  Fate receive(Bytes bytes);
  /// Adds what it has counted to the totals.
  void count();
  Instant clock() const;
  bool up() const { return node_ != nullptr; }
  Node& node() { return *node_; }
  Agent& agent() { return *agent_; }
  const std::vector<Octets>& logs() const { return logs_; }
  bool missed() const { return missed_; }

  std::unordered_set<std::uint64_t> taken;
  Micros step = 0;  ///< of its clock

 private:
  void sign();
  void send(int neighbour, Bytes datagram) noexcept override { s_.send(id_, neighbour, datagram); }
  void measure(std::int64_t sample, std::span<double> y) noexcept override;
  void journal(const Entry& entry) noexcept override;
  void contradiction(const Statement& a, const Statement& b) noexcept override;
  void ended(const Sample& sample) noexcept override;
  void keep_snapshot();
  std::size_t operator()(int neighbour, Room plain, std::size_t size) noexcept override;
  std::size_t sign_another(int neighbour, Room plain, std::size_t size) noexcept;

  Simulation& s_;
  int id_;
  std::uint64_t boots_ = 0;
  std::unique_ptr<Agent> agent_;
  std::unique_ptr<Authors> authors_;
  std::unique_ptr<Node> node_;
  Octets disk_;
  std::vector<Octets> logs_;  ///< one per boot
  bool fresh_ = false;
  bool missed_ = false;
};

}  // namespace garrison::node::test
