// SPDX-License-Identifier: Apache-2.0
#include "partition/part_average.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace garrison::partition {

void PartAverage::prepare() {
  const std::size_t numbers = region_.ids.size() * static_cast<std::size_t>(width_);
  if (numbers > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    refuse("partition", std::to_string(region_.ids.size()) + " agents and ghosts on one rank",
           "fewer than 2^31 numbers of their estimates", "use more ranks");
  now_.resize(numbers);
  next_.resize(numbers);
  out_.resize(region_.packed.size() * static_cast<std::size_t>(width_));
  neighbour_.reserve(region_.heard.size());
  for (const std::int32_t place : region_.heard) neighbour_.push_back(place * width_);
  for (int k = 0; k < region_.own; ++k) {
    if (k == region_.interior) interior_ = runs_.size();
    const int degree = region_.degree(k);
    if (k == 0 || k == region_.interior || runs_.back().degree != degree)
      runs_.push_back({k, k, degree, static_cast<std::int32_t>(region_.first[static_cast<std::size_t>(k)])});
    runs_.back().end = k + 1;
  }
  if (region_.interior == region_.own) interior_ = runs_.size();
}

void PartAverage::run(double alpha, std::span<const double> omega, int rounds) {
  const auto bytes = static_cast<std::size_t>(width_) * sizeof(double);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < region_.packed.size(); ++k)
      std::copy_n(row(now_, static_cast<std::size_t>(region_.packed[k])), width_, row(out_, k));
    exchange_.begin(reinterpret_cast<const std::byte*>(out_.data()),
                    reinterpret_cast<std::byte*>(row(now_, static_cast<std::size_t>(region_.own))), bytes);
    const double weight = omega.empty() ? 1.0 : omega[static_cast<std::size_t>(round)];
    const kernel::Round one{neighbour_.data(), now_.data(), next_.data(), alpha, weight};
    kernel::average_runs(one, runs_.data(), runs_.data() + interior_, width_);
    exchange_.finish();
    kernel::average_runs(one, runs_.data() + interior_, runs_.data() + runs_.size(), width_);
    std::swap(now_, next_);
  }
}

}  // namespace garrison::partition
