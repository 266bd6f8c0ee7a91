// SPDX-License-Identifier: Apache-2.0
// A window split by source, so that a set of sources is solved without going through its rows. Internal.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "window_fit.hpp"

namespace garrison::certificate::detail {

enum class Part : char { absent, left_out, in, proved };

struct WindowSources {
  explicit WindowSources(const Window& w)
      : fit(w.most_unknowns()),
        part(static_cast<std::size_t>(w.sources())),
        G_(w.most_unknowns(), static_cast<Eigen::Index>(w.most_unknowns()) * (w.sources() + 1)),
        g_(w.most_unknowns(), w.sources() + 1),
        own_(w.most_unknowns()) {
    at_hand.reserve(part.size());
  }
  static double numbers(const Window& w) {
    return static_cast<double>(w.most_unknowns()) * w.most_unknowns() * (w.sources() + 1.0);
  }

  /// Sums over the rows of every source, and over those that are always honest.
  void begin(const Window& w, std::span<const int> proved) {
    p_ = w.unknowns();
    honest_ = w.sources();
    std::fill(part.begin(), part.end(), Part::absent);
    for (int r = 0; r < w.rows(); ++r)
      if (w.source(r) >= 0) part[static_cast<std::size_t>(w.source(r))] = Part::in;
    for (const int source : proved) part[static_cast<std::size_t>(source)] = Part::proved;
    at_hand.clear();
    for (int source = 0; source < w.sources(); ++source)
      if (part[static_cast<std::size_t>(source)] == Part::in) at_hand.push_back(source);
    sum(w, -1, honest_);
    for (const int source : at_hand) sum(w, source, source);
  }
  bool uses(const Window& w, int r) const {
    return w.source(r) < 0 || part[static_cast<std::size_t>(w.source(r))] == Part::in;
  }
  /// Least squares over the sources that are in.
  bool solve(const Window&) {
    fit.clear(p_);
    fit.add(G_.block(0, column(honest_), p_, p_), g_.col(honest_).head(p_));
    for (const int source : at_hand)
      if (part[static_cast<std::size_t>(source)] == Part::in)
        fit.add(G_.block(0, column(source), p_, p_), g_.col(source).head(p_));
    return fit.solve();
  }

  WindowFit fit;
  std::vector<Part> part;    // of each source
  std::vector<int> at_hand;  // sources with a row that are not proved

 private:
  Eigen::Index column(int slot) const { return slot * G_.rows(); }
  void sum(const Window& w, int source, int slot) {
    own_.clear(p_);
    for (int r = 0; r < w.rows(); ++r)
      if (w.source(r) == source) own_.add(w, r);
    G_.block(0, column(slot), p_, p_) = own_.G();
    g_.col(slot).head(p_) = own_.g();
  }

  Matrix G_, g_;  // side by side
  WindowFit own_;
  int p_ = 0, honest_ = 0;
};

}  // namespace garrison::certificate::detail
