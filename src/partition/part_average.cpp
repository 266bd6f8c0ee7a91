// SPDX-License-Identifier: Apache-2.0
#include "partition/part_average.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "partition/block.hpp"

namespace garrison::partition {

void PartAverage::prepare() {
  const std::size_t numbers = region_.ids.size() * static_cast<std::size_t>(width_);
  if (numbers > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    refuse("partition", amount(region_.ids.size(), "agent") + " and ghosts on one rank",
           "fewer than 2^31 numbers of their estimates", "use more ranks");
  now_.resize(numbers);
  next_.resize(numbers);
  const bool deep = region_.depth() > 1;
  const std::size_t rows = deep ? 2 : 1;  // per agent, where a round needs what was one round ago
  out_.resize(rows * region_.packed.size() * static_cast<std::size_t>(width_));
  if (deep) in_.resize(rows * static_cast<std::size_t>(region_.ghosts()) * static_cast<std::size_t>(width_));
  neighbour_.reserve(region_.heard.size());
  for (const std::int32_t place : region_.heard) neighbour_.push_back(place * width_);
  int begin = 0;
  const auto runs_to = [&](int end) {
    for (int k = begin; k < end; ++k) {
      const int degree = region_.degree(k);
      if (k == begin || runs_.back().degree != degree)
        runs_.push_back(
            {k, k, degree, static_cast<std::int32_t>(region_.first[static_cast<std::size_t>(k)])});
      runs_.back().end = k + 1;
    }
    begin = end;
    return runs_.size();
  };
  interior_ = runs_to(region_.interior);
  for (int hops = 0; hops < region_.depth(); ++hops)
    within_.push_back(runs_to(region_.rings[static_cast<std::size_t>(hops)]));
}

void PartAverage::send(bool both) {
  double* out = out_.data();
  for (const std::int32_t place : region_.packed) {
    out = std::copy_n(row(now_, static_cast<std::size_t>(place)), width_, out);
    if (both) out = std::copy_n(row(next_, static_cast<std::size_t>(place)), width_, out);
  }
  double* const in = in_.empty() ? row(now_, static_cast<std::size_t>(region_.own)) : in_.data();
  exchange_.begin(reinterpret_cast<const std::byte*>(out_.data()), reinterpret_cast<std::byte*>(in),
                  (both ? 2 : 1) * static_cast<std::size_t>(width_) * sizeof(double));
}

void PartAverage::receive(bool both) {
  exchange_.finish();
  if (in_.empty()) return;
  const double* in = in_.data();
  for (const std::int32_t place : region_.arrival) {
    std::copy_n(in, width_, row(now_, static_cast<std::size_t>(place)));
    in += width_;
    if (!both) continue;
    std::copy_n(in, width_, row(next_, static_cast<std::size_t>(place)));
    in += width_;
  }
}

void PartAverage::run(double alpha, std::span<const double> omega, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const Block block(round, rounds, region_.depth());
    // A Chebyshev round of a ghost needs where it was before; the first round of a sample is none.
    const bool both = region_.depth() > 1 && !omega.empty() && round > 0;
    if (block.first) send(both);
    const double weight = omega.empty() ? 1.0 : omega[static_cast<std::size_t>(round)];
    const kernel::Round one{neighbour_.data(), now_.data(), next_.data(), alpha, weight};
    const std::size_t early = block.first ? interior_ : 0;
    kernel::average_runs(one, runs_.data(), runs_.data() + early, width_);
    if (block.first) receive(both);
    kernel::average_runs(one, runs_.data() + early, runs_.data() + within_[block.reach], width_);
    std::swap(now_, next_);
  }
}

}  // namespace garrison::partition
