// SPDX-License-Identifier: Apache-2.0
// The certificate's part of a message.
#pragma once

#include <cmath>
#include <vector>

#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// Regions older than this are forgotten.
inline constexpr int kMostAge = 1000;

/// With Gaussian noise a region may be so many samples older than the freshest that was to be had.
inline constexpr int kChoice = 3;

/// Flooded, a measurement is passed on in so many rounds after it became known, and a region after the
/// freshest that was to be had changed; both are decided by losses alone. Else a region is passed on until it
/// has had so many rounds more than it needs to reach everybody, less one. One is enough where nothing is
/// lost.
inline constexpr int kRepeats = 3;

/// Fields in the sense of core/fields.hpp; drivers put them behind those of the filter's message. Where
/// nothing is said, no bytes are put there, but for a missing measurement (Certifier::spares).
struct Evidence {
  /// The sender's own measurements (local; in the first round only), or those of the whole network that have
  /// become known to it of late (flooded). NaN = absent.
  std::vector<double> measurements;
  /// A region that contains the state unless a named assumption is false: its centre, moved to this sample,
  /// and its radius when it was new; all absent = none.
  std::vector<double> ball;
  int age = 0;  ///< samples since
  /// Age of the freshest region that the sender could have had; losses alone decide it.
  int fresh = 0;

  bool silent() const {
    for (const double y : measurements)
      if (!std::isnan(y)) return false;
    for (const double v : ball)
      if (!std::isnan(v)) return false;
    return true;
  }

  template <class V>
  void visit(V& v) {
    v.sparse("certificate.measurements", measurements);
    if (ball.empty()) return;
    v.sparse("certificate.ball", ball);
    v.count("certificate.age", age, kMostAge);
    v.count("certificate.fresh", fresh, kMostAge);
  }
};

}  // namespace garrison::certificate
