// SPDX-License-Identifier: Apache-2.0
// What recorded measurements say against the noise bounds of a model: a pass over a record that has ended.
#pragma once

#include <vector>

#include "garrison/core/model.hpp"

namespace garrison {

/// What is false, if anything is, whichever sources lie.
enum class Refuted {
  nothing,            ///< or the search was too long
  measurement_bound,  ///< of one sample alone
  process_bound,      ///< of two samples in a row: of both bounds, one is too small
};

struct ContradictionOptions {
  int attacked = 0;        ///< most sources that lie at a time, >= 0
  bool for_good = false;   ///< the same ones in all samples
  bool constant = true;    ///< A holds from each sample to the next
  std::vector<int> owner;  ///< whose each measurement is, numbers >= 0; empty: its agent's
  Matrix inputs;           ///< row r leads from row r of the measurements to the next one; empty = none
};

struct Contradiction {
  Refuted refuted = Refuted::nothing;
  int row = -1;  ///< of the measurements, the first of the two; the last look where the same sources lie
};

/// Looks in every trial for a sample, and for two in a row, that no state and no noise within the bounds
/// explains, whichever `attacked` sources are left out. Sound up to rounding, which it allows for; not
/// complete: groups of n measurements are compared along the measured directions and along the noise that
/// they suggest, in at most 2000 evenly spread samples of the first trial; the others share 8000, at least 20
/// each. `measurements`: trials times samples x Model::total_outputs(), trial by trial, NaN = missing.
/// Nothing is said without measurement_bound. @return one per trial @throws InvalidInput on sizes that do not
/// fit
GARRISON_EXPORT std::vector<Contradiction> contradictions(const Model& model, const MatrixRef& measurements,
                                                          int trials, const ContradictionOptions& options);

}  // namespace garrison
