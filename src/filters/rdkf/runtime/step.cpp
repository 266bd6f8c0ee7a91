// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/step.hpp"

#include "garrison/filters/rdkf/secular.hpp"

namespace garrison::rdkf {

namespace {
struct Solve {
  template <int B>
  static GARRISON_INLINE void run(const StepFactors* f, const Price* price, const double* y, double* x,
                                  double* room, Step* out) {
    *out = detail::solve_at<B>(*f, *price, y, x, room);
  }
};
}  // namespace

Step solve(const StepFactors& f, const Price& price, const double* y, double* x, double* room) noexcept {
  Step step;
  run_widest<Solve>(&f, &price, y, x, room, &step);
  return step;
}

}  // namespace garrison::rdkf
