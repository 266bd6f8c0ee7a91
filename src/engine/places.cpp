// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/places.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/kernel/magnitude.hpp"

namespace garrison {

Places::Places(const Model& model, const Network& network, std::span<const int> order)
    : model_(model), A_(model.A()), position_(order.size()) {
  for (const int i : order) {
    position_[static_cast<std::size_t>(i)] = places_.size();
    places_.push_back({i, model_.outputs(i), network.degree(i), rows_.size()});
    first_output_.push_back(model_.offset(i));
    rows_.resize(rows_.size() + static_cast<std::size_t>(model_.C(i).size()));
  }
  sight(model_.stacked());
}

void Places::sight(const Matrix& C) {
  for (std::size_t k = 0; k < places_.size(); ++k) {
    double* row = rows_.data() + places_[k].first;
    for (int r = 0; r < places_[k].outputs; ++r)
      for (Eigen::Index c = 0; c < C.cols(); ++c) *row++ = C(first_output_[k] + r, c);
  }
}

void Places::vary(const Matrix* A, const Matrix* C) {
  varying_ = true;
  if (A != nullptr) A_ = *A;
  if (C != nullptr) sight(*C);
}

void Places::constant() {
  if (!varying_) return;
  varying_ = false;
  A_ = model_.A();
  sight(model_.stacked());
}

bool Places::measures_below(double limit, const double* y) const noexcept {
  return known_below(y, static_cast<std::size_t>(model_.total_outputs()), limit);
}

bool Places::miss_more_than(int most, const double* y) const noexcept {
  std::ptrdiff_t numbers = 0;
  for (int r = 0; r < model_.total_outputs(); ++r) numbers += y[r] != y[r] ? 1 : 0;
  if (numbers <= most) return false;
  int sensors = 0;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const double* const own = measured(k, y);
    sensors += std::any_of(own, own + places_[k].outputs, [](double v) { return std::isnan(v); }) ? 1 : 0;
  }
  return sensors > most;
}

}  // namespace garrison
