// SPDX-License-Identifier: Apache-2.0
// What each agent of a whole network is told: its id, its neighbours' number, A and its own rows of C.
#pragma once

#include <span>
#include <vector>

#include "garrison/core/filter.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/kernel/aligned.hpp"

namespace garrison {

/// Agents in the engine's order, and the plant in force: the model's, or what `vary` said.
/// Threads: several may read; whoever changes it is alone.
class GARRISON_EXPORT Places {
 public:
  /// `order`: engine position -> public id.
  Places(const Model& model, const Network& network, std::span<const int> order);

  std::size_t size() const { return places_.size(); }
  int id(std::size_t k) const { return places_[k].id; }
  /// Where agent `id` is.
  std::size_t of(int id) const { return position_[static_cast<std::size_t>(id)]; }
  Local local(std::size_t k) const {
    const Place& p = places_[k];
    return {p.id, model_.agents(), model_.states(), p.outputs, p.degree, A_.data(), rows_.data() + p.first};
  }
  /// Where measurements of agent k begin among those of all agents.
  int first_output(std::size_t k) const { return first_output_[k]; }
  const double* measured(std::size_t k, const double* y) const { return y + first_output_[k]; }
  /// Whether no measurement is as large as `limit`; what is missing is not.
  bool measures_below(double limit, const double* y) const noexcept;
  /// Whether more than `most` sensors miss numbers in y.
  bool miss_more_than(int most, const double* y) const noexcept;

  /// Puts another A or C (stacked; null = as before) in force, in place: batches keep pointers to them.
  void vary(const Matrix* A, const Matrix* C);
  bool varying() const { return varying_; }
  /// Back to the model's.
  void constant();

 private:
  /// Where things of one agent are; a Local per agent would be twice as much to read at every step.
  struct Place {
    int id;
    int outputs;
    int degree;
    std::size_t first;  // in rows_
  };
  /// Writes the rows of all C_i, given on top of each other in the order of public ids.
  void sight(const Matrix& C);

  Model model_;
  Matrix A_;
  bool varying_ = false;
  std::vector<Place> places_;
  Aligned<double> rows_;           // of all C_i
  std::vector<int> first_output_;  // of each agent in y
  std::vector<std::size_t> position_;
};

}  // namespace garrison
