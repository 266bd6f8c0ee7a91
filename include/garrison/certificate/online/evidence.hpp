// SPDX-License-Identifier: Apache-2.0
// The certificate's part of a message.
#pragma once

#include <vector>

#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// Regions older than this are forgotten.
inline constexpr int kMostAge = 1000;

/// Largest Evidence::firm.
inline constexpr int kFirmest = 2;

/// Fields in the sense of core/fields.hpp; drivers put them behind those of the filter's message.
struct Evidence {
  /// The sender's own measurements (local; in the first round only), or those of the whole network that it
  /// knows (flooded). NaN = absent.
  std::vector<double> measurements;
  /// A region that contains the state unless a named assumption is false: its centre, moved to this sample,
  /// and its radius when it was new; all absent = none.
  std::vector<double> ball;
  int age = 0;  ///< samples since
  /// How far liars could stretch it: 2 = not at will, more than 2 s sources were at hand; 1 = every set of
  /// rows that may be the honest one had a row to spare, but s liars alone may have been such a set; 0 = to
  /// anywhere.
  int firm = 0;

  bool has_ball() const { return ball.back() == ball.back(); }

  template <class V>
  void visit(V& v) {
    v.sparse("certificate.measurements", measurements);
    v.sparse("certificate.ball", ball);
    v.count("certificate.age", age, kMostAge);
    v.count("certificate.firm", firm, kFirmest);
  }
};

}  // namespace garrison::certificate
