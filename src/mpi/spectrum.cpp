// SPDX-License-Identifier: Apache-2.0
#include "mpi/spectrum.hpp"

#include <cstdio>

#include "mpi/cut.hpp"
#include "mpi/memory.hpp"
#include "mpi/progress.hpp"
#include "mpi/slepc_spectrum.hpp"
#include "mpi/together.hpp"
#include "partition/connected.hpp"

namespace garrison::mpi {

namespace {

/// An agent of a rank takes at least so much: its neighbours, and three numbers of its own.
constexpr double kOwnBytes = 100.0;

}  // namespace

bool print_spectrum(const SpectrumCommand& command) {
  MpiExchange exchange;
  Scenario scenario;
  const Bytes bytes = shared_bytes(kOwnBytes);
  together([&] {
    if (command.slepc) require_slepc();
    scenario = read_scenario(command.scenario, bytes);
    if (scenario.agents() < 2) refuse("network", "one agent", "at least two");
  });
  const Cut cut = cut_of(scenario, exchange, 1);
  partition::require_connected(cut.region, exchange);
  say_cut(cut.region, exchange, cut.made);
  const auto most = static_cast<int>(command.products);
  Progress progress("product", most);
  const partition::Spectrum s =
      command.slepc ? slepc_spectrum(cut.region, exchange, most)
                    : partition::laplacian_spectrum(cut.region, exchange, most,
                                                    [&](const auto& now) { progress.at(now.products); });
  if (exchange.rank() != 0) return s.settled;
  std::printf("lambda_2   %.10g  an eigenvalue is within %.1e\n", s.lambda2, s.residual2);
  std::printf("lambda_max %.10g  an eigenvalue is within %.1e; none is above %.10g\n", s.lambda_max,
              s.residual_max, s.bound);
  if (s.settled)
    std::printf(
        "the best step of plain averaging: step = %.10g, which leaves %.6g of a disagreement per "
        "round\n",
        2.0 / (s.lambda2 + s.lambda_max), (s.lambda_max - s.lambda2) / (s.lambda_max + s.lambda2));
  else
    std::printf(
        "not settled after %d products: lambda_2 is smaller still. Raise --products%s. Certainly "
        "stable: step = %.10g\n",
        s.products, has_slepc() ? " or take --slepc" : "", 1.0 / s.bound);
  return s.settled;
}

}  // namespace garrison::mpi
