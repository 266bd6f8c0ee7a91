// SPDX-License-Identifier: Apache-2.0
// How long a search may take. Searches poll it, and end with a certified interval.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// Seconds from its construction, and a question asked while it is polled ("has somebody pressed Ctrl-C?").
/// Copies share the clock. Once over, it stays over.
/// Threads: one at a time.
class GARRISON_EXPORT Budget {
 public:
  Budget() = default;  ///< without end
  /// `seconds` > 0 or inf. @throws InvalidInput
  explicit Budget(double seconds, std::function<bool()> stop = {});
  /// The time is up, or `stop` said so. Cheap enough for every millisecond of work, not for every
  /// microsecond.
  bool over() const;
  /// At most so many more seconds, within this budget.
  Budget within(double seconds) const;

 private:
  struct Clock {
    std::chrono::steady_clock::time_point end;
    bool ends = false;
    std::function<bool()> stop;
    bool stopped = false;
    std::shared_ptr<Clock> outer;
  };
  std::shared_ptr<Clock> clock_;
  static bool over(Clock* clock);
};

/// Everything that this thread computes while the scope lives has this budget.
/// Threads: of the thread that made it; other threads do not see it.
class GARRISON_EXPORT BudgetScope {
 public:
  explicit BudgetScope(Budget budget);
  ~BudgetScope();
  BudgetScope(const BudgetScope&) = delete;
  BudgetScope& operator=(const BudgetScope&) = delete;

 private:
  Budget before_;
};

/// The budget of the innermost scope of this thread; without end where there is none.
GARRISON_EXPORT const Budget& current_budget();

/// For computations that have no result when they are stopped. @throws InvalidInput when the budget is over
GARRISON_EXPORT void require_time(const char* what);

}  // namespace garrison
