// SPDX-License-Identifier: Apache-2.0
// The exchange of partition/exchange.hpp over MPI.
#pragma once

#include <mpi.h>

#include "partition/exchange.hpp"

namespace garrison::mpi {

/// One neighbourhood collective per round (MPI 3.1). Threads: one at a time.
class MpiExchange final : public partition::Exchange {
 public:
  MpiExchange() = default;
  MpiExchange(const MpiExchange&) = delete;
  MpiExchange& operator=(const MpiExchange&) = delete;
  ~MpiExchange() override;

  int rank() const override;
  int ranks() const override;
  void connect(const partition::Routes& routes) override;
  void begin(const std::byte* out, std::byte* in, std::size_t bytes) override;
  void finish() override;
  void sum(std::span<std::int64_t> values) override;
  void largest(std::span<double> values) override;

  /// Seconds spent in `finish` so far: what the interior did not hide.
  double waited() const { return waited_; }

 private:
  void records_of(std::size_t bytes);

  partition::Routes routes_;
  std::vector<int> send_at_;
  std::vector<int> receive_at_;
  MPI_Comm neighbours_ = MPI_COMM_NULL;
  MPI_Datatype record_ = MPI_DATATYPE_NULL;  // counts are of agents, so they fit into int
  std::size_t record_bytes_ = 0;
  MPI_Request request_ = MPI_REQUEST_NULL;
  double waited_ = 0.0;
};

}  // namespace garrison::mpi
