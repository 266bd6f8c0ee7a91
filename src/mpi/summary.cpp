// SPDX-License-Identifier: Apache-2.0
#include "mpi/summary.hpp"

#include <algorithm>
#include <cmath>

#include "mpi/here.hpp"

namespace garrison::mpi {
namespace {

constexpr double kLeast = 1e-12;
constexpr double kWidth = 0.01;  // of a bin, natural logarithm
constexpr std::size_t kBins = 5528;

std::size_t bin_of(double error) {
  if (!(error > kLeast)) return std::isnan(error) ? kBins - 1 : 0;
  const double at = std::ceil(std::log(error / kLeast) / kWidth);
  return static_cast<std::size_t>(std::min(at, static_cast<double>(kBins - 1)));
}

double quantile(const std::vector<std::int64_t>& counts, double share) {
  const std::int64_t all = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  const auto rank = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(all)));
  std::int64_t below = 0;
  std::size_t bin = 0;
  while (bin + 1 < kBins && below + counts[bin] < rank) below += counts[bin++];
  return kLeast * std::exp(kWidth * static_cast<double>(bin));
}

/// All ranks' sums one behind the other, on rank 0.
std::vector<double> gathered(const std::vector<double>& sums) {
  const int rank = this_rank();
  const int ranks = all_ranks();
  const auto count = static_cast<int>(sums.size());
  std::vector<int> counts(static_cast<std::size_t>(ranks));
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  const std::vector<int> starts = starts_of(counts);
  std::vector<double> all(rank == 0 ? static_cast<std::size_t>(starts.back() + counts.back()) : 0);
  MPI_Gatherv(sums.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, 0,
              MPI_COMM_WORLD);
  return all;
}

}  // namespace

Summary summary_of(const PublicOrder& order, std::span<const double> estimates,
                   std::span<const double> truth) {
  const std::size_t n = truth.size();
  std::vector<double> sums;
  std::vector<std::int64_t> counts(kBins, 0);
  double extremes[] = {0.0, 0.0};  // the largest error, and whether one is no number
  std::int64_t agents = order.last() - order.first();
  for (std::int64_t k = 0; k < agents; ++k) {
    if (k % kBlock == 0) sums.push_back(0.0);  // ranges begin with blocks
    double square = 0.0;
    for (std::size_t c = 0; c < n; ++c) {
      const double e = estimates[static_cast<std::size_t>(k) * n + c] - truth[c];
      square += e * e;
    }
    const double error = std::sqrt(square);
    sums.back() += error;
    ++counts[bin_of(error)];
    if (std::isnan(error)) extremes[1] = 1.0;
    if (error > extremes[0]) extremes[0] = error;
  }
  MPI_Allreduce(MPI_IN_PLACE, extremes, 2, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(kBins), MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, &agents, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  Summary out;
  for (const double sum : gathered(sums)) out.mean += sum;
  out.mean /= static_cast<double>(agents);
  out.largest = extremes[1] > 0.0 ? std::nan("") : extremes[0];
  out.median = quantile(counts, 0.5);
  out.q95 = quantile(counts, 0.95);
  return out;
}

}  // namespace garrison::mpi
