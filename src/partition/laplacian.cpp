// SPDX-License-Identifier: Apache-2.0
#include "partition/laplacian.hpp"

#include <algorithm>

namespace garrison::partition {

Laplacian::Laplacian(const Region& region, Exchange& exchange)
    : region_(region),
      exchange_(exchange),
      here_(static_cast<std::size_t>(region.places())),
      ghosts_(region, exchange) {}

/// The numbers of own agents, and those of ghosts from their ranks.
void Laplacian::fetch(std::span<const double> v) {
  std::copy(v.begin(), v.end(), here_.begin());
  ghosts_.fetch(here_);
}

void Laplacian::apply(std::span<const double> v, std::span<double> out) {
  fetch(v);
  for (int place = 0; place < region_.own; ++place) {
    const auto k = static_cast<std::size_t>(place);
    double sum = region_.degree(place) * v[k];
    for (std::size_t e = region_.first[k]; e < region_.first[k + 1]; ++e)
      sum -= here_[static_cast<std::size_t>(region_.heard[e])];
    out[k] = sum;
  }
}

double Laplacian::bound() {
  std::vector<double> degrees;
  for (int place = 0; place < region_.own; ++place) degrees.push_back(region_.degree(place));
  fetch(degrees);
  double most[] = {0.0};
  for (std::size_t k = 0; k < degrees.size(); ++k)
    for (std::size_t e = region_.first[k]; e < region_.first[k + 1]; ++e)
      most[0] = std::max(most[0], degrees[k] + here_[static_cast<std::size_t>(region_.heard[e])]);
  exchange_.largest(most);
  return most[0];
}

}  // namespace garrison::partition
