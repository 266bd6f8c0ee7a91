// SPDX-License-Identifier: Apache-2.0
// What an agent's data say against what its certificate with memory assumes.
#pragma once

#include "garrison/certificate/memory/dependence.hpp"

namespace garrison::certificate {

/// Since the agent's start or last reset. At each of these samples the bank started anew.
struct Doubts {
  std::int64_t refuted = 0;     ///< samples at which no member of the bank was left
  std::int64_t refuted_at = 0;  ///< the first of them
  /// Samples at which the bank's box and the witness's of this sample alone had no point in common: one of
  /// them was wrong, and the witness assumes less.
  std::int64_t apart = 0;
  std::int64_t apart_at = 0;  ///< the first of them
  int apart_in = 0;           ///< a coordinate in which they were
  Dependence dependence{};    ///< of the innovations; source: of the whole network (Plan::source)

  bool any() const { return refuted > 0 || apart > 0 || dependence.evidence > 0.0; }
  /// All but the dependence, which the bank keeps.
  template <class V>
  void visit(V& v) {
    v.range("refuted", refuted, 0, INT64_MAX / 4);
    v("refuted_at", refuted_at);
    v.range("apart", apart, 0, INT64_MAX / 4);
    v("apart_at", apart_at);
    v.range("apart_in", apart_in, 0, INT32_MAX);
  }
};

}  // namespace garrison::certificate
