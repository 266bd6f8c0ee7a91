// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/budget.hpp"

#include <algorithm>
#include <string>

namespace garrison {
namespace {

Budget& innermost() {
  thread_local Budget budget;
  return budget;
}

}  // namespace

Budget::Budget(double seconds, std::function<bool()> stop) : clock_(std::make_shared<Clock>()) {
  if (!(seconds > 0.0)) refuse("seconds", text(seconds), "a time > 0, inf = without end");
  clock_->stop = std::move(stop);
  constexpr double kYears = 1e9;
  clock_->ends = seconds < kYears;
  if (clock_->ends)
    clock_->end =
        std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                               std::chrono::duration<double>(seconds));
}

bool Budget::over(Clock* clock) {
  if (clock == nullptr) return false;
  if (!clock->stopped)
    clock->stopped = (clock->ends && std::chrono::steady_clock::now() >= clock->end) ||
                     (clock->stop && clock->stop()) || over(clock->outer.get());
  return clock->stopped;
}

bool Budget::over() const { return over(clock_.get()); }

Budget Budget::within(double seconds) const {
  if (!(seconds < kInfinity)) return *this;
  Budget part(std::max(seconds, 1e-9));
  part.clock_->outer = clock_;
  return part;
}

BudgetScope::BudgetScope(Budget budget) : before_(std::move(innermost())) { innermost() = std::move(budget); }
BudgetScope::~BudgetScope() { innermost() = std::move(before_); }

const Budget& current_budget() { return innermost(); }

void require_time(const char* what) {
  if (current_budget().over())
    refuse("seconds", std::string("a budget that was used up in ") + what, "enough time to finish it",
           "raise seconds; there is no partial result");
}

}  // namespace garrison
