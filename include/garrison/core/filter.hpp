// SPDX-License-Identifier: Apache-2.0
// The contract that every filter family fulfils.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "garrison/core/agent_set.hpp"
#include "garrison/core/certificate_kind.hpp"
#include "garrison/core/fields.hpp"
#include "garrison/core/inbox.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// What one agent is told of itself. Plain pointers, so that agents share one plant.
struct Local {
  int id;           ///< public id, 0..agents-1
  int agents;       ///< N
  int states;       ///< n at run time
  int outputs;      ///< rows of C_i; 0 for a relay
  int degree;       ///< most neighbours that this agent hears at a time, for buffers; how many: Inbox::due
  const double* A;  ///< n x n, column by column
  const double* C;  ///< outputs x n, row by row
};

/// What the network says of one agent's sensor.
enum class Verdict : std::uint8_t {
  cleared,     ///< tested, and its measurement was used as it is
  suspected,   ///< its measurement was limited, but nothing is proved
  attacked,    ///< proved to be under attack and isolated
  silent,      ///< no measurement at this step (relay, or lost)
  not_tested,  ///< its measurement was used, and nothing was compared with anything: the family has no test,
               ///< or none that holds at this step
};
inline constexpr int kVerdicts = 5;

/// The verdicts of a whole run, as a family's `warnings` (optional) sees them.
struct VerdictLog {
  std::span<const std::uint8_t> verdict;  ///< [trial][time][agent], values of Verdict; time 0 is the start
  int trials;
  int times;
  int agents;
};

/// Numbers that every family reports of one agent after a step; NaN = does not exist.
struct Report {
  double bound = kNaN;  ///< certified: ||estimate - state|| <= bound, under the family's assumptions
  CertificateKind kind = CertificateKind::none;  ///< of `bound`; drivers fill it in
  double statistic = kNaN;                       ///< what is tested, e.g. |innovation|
  double threshold = kNaN;                       ///< what it is tested against
  Verdict verdict = Verdict::not_tested;
};

/// The compile-time dimension where there is one, else the run-time one.
template <int n>
constexpr int dimension(const Local& local) {
  return n == Dynamic ? local.states : n;
}

/// C x, what agent `local` measures where the plant is at x, noise aside.
template <int n>
inline void measurement(const Local& local, const double* x, double* out) noexcept {
  const int nn = dimension<n>(local);
  for (int r = 0; r < local.outputs; ++r) {
    out[r] = 0.0;
    for (int k = 0; k < nn; ++k) out[r] += local.C[static_cast<std::ptrdiff_t>(r) * nn + k] * x[k];
  }
}
/// C A x, what it measures next: the `expected` of most families.
template <int n>
inline void next_measurement(const Local& local, const double* x, double* out) noexcept {
  const int nn = dimension<n>(local);
  for (int r = 0; r < local.outputs; ++r) {
    out[r] = 0.0;
    for (int i = 0; i < nn; ++i) {
      double predicted = 0.0;
      for (int k = 0; k < nn; ++k) predicted += local.A[static_cast<std::ptrdiff_t>(k) * nn + i] * x[k];
      out[r] += local.C[static_cast<std::ptrdiff_t>(r) * nn + i] * predicted;
    }
  }
}

/// A filter family F for state dimension n (1..8, or Dynamic).
///
/// One sample t of agent i is `sense` with its measurement, then `rounds` times: send the message, receive
/// the neighbours' messages, `fuse`. Then `report`. All of it is a pure state machine: no clock, socket,
/// random number, truth or exception, and no allocation after `init`. The same state and input always
/// give the same output; this is why the engine, the replay and a node agree bit for bit. Who sent a message
/// and when is the driver's (core/envelope.hpp): families keep no sender, sample or round in it, and take t
/// from `sense`, so that a fresh agent may start at any sample.
///
/// - `init(local, gains, x0, state, message)` sizes every buffer of state and message (may allocate).
/// - `y` has local.outputs entries; NaN = missing. Infinite and huge entries are allowed.
/// - `sense` and `fuse` write every field of the message: it holds what it held two rounds ago.
/// - The inbox holds messages of this sample and round only, finite and of the right size; a missing
///   neighbour is simply not in it.
/// - Message, State and Gains list their fields in `visit` (core/fields.hpp, wire/archive.hpp).
/// - `rejoin(local, gains, inbox, t, state)` gives an agent whose estimate is of no use (it has just started
///   in a running network, or overflowed) one from what its neighbours sent in sample t, whatever one liar
///   says where that can be had; where nothing was heard the state stays, or starts anew where it is not
///   finite. Nothing is claimed afterwards that needs the past: `uncover` is part of it.
/// - Optional: `uncover(gains, state)`: a gap lies behind this state, so no bound, no test and no accusation
///   may rest on it;
///   `shape(local, gains, sender, t, message)`: sizes and derived indices of a message that will be read;
///   `most_missing(gains)`: sensors that may lack a measurement at once; where there are more, drivers that
///   see all of them uncover everybody before the sample;
///   `sensed(message)`: the estimate in a message, n numbers, if C times that of the first round is the
///   measurement wherever it was used in full: certificates then need not send it;
///   `part(gains, id, neighbours)`: what one agent needs of the gains, the rest left empty;
///   `sound(state)`: whether a state that was read from a snapshot may be gone on from;
///   `runs(gains)`: whether this build has all that they ask for (a solver, say);
///   `needs_constant(gains)`: why a plant that changes in time cannot be taken, in words; empty = it can;
///   `vary(local, gains, change, first, state)`, for gains that follow the plant: what the state owes to
///   matrices is done anew, once before the sample they are of. A and C are in `local`; of the others a null
///   is the design's, and the agent's own W begins in row `first`. It may allocate before the first sample;
///   `require_series(series, model)`: refuses covariances that gains cannot follow.
/// - What is not inline of all this is in src/filters/<family>/runtime, which nodes link without design,
///   analysis and exceptions.
/// - Optional: `first_sample` = 0 (default 1) for a family that has a sample at the start; `only_states`, the
///   one dimension that it exists for; `control` and `world` for agents with plants of their own
///   (core/world.hpp); `detail_names` and `detail` for lists such as sets; `accused_into` in place of
///   `accused` to build the set when asked; for engines of large networks `Averages`
///   (engine/batch/averaging.hpp) or `SideBySide` (engine/batch/side_by_side.hpp), with the same bits.
/// - `expected` writes the measurement that the agent predicts for the next step (local.outputs entries),
///   `alarm_level` the deviation from it that the agent tolerates there: what an informed attacker knows.
template <class F, int n>
concept Filter =
    requires(const Local& local, const typename F::Gains& gains, typename F::template State<n>& state,
             const typename F::template State<n>& view, typename F::template Message<n>& message,
             const Inbox<typename F::template Message<n>>& inbox, const double* y, double* out,
             const Vec<n>& x0, std::int64_t t, int round, FieldList& fields) {
      { F::name } -> std::convertible_to<std::string_view>;
      { F::rounds(gains) } -> std::same_as<int>;
      F::template init<n>(local, gains, x0, state, message);
      { F::template sense<n>(local, gains, state, y, t, message) } noexcept;
      { F::template fuse<n>(local, gains, state, inbox, round, message) } noexcept;
      { F::template rejoin<n>(local, gains, inbox, t, state) } noexcept;
      { F::template report<n>(local, gains, view) } noexcept -> std::same_as<Report>;
      { F::template estimate<n>(view) } noexcept -> std::convertible_to<const Vec<n>&>;
      { F::template expected<n>(local, gains, view, out) } noexcept;
      { F::template alarm_level<n>(local, gains, view) } noexcept -> std::same_as<double>;
      { F::template signals<n>(local, gains, view, out) } noexcept;
      message.visit(fields);
    } &&
    (
        requires(const typename F::template State<n>& view) {
          { F::template accused<n>(view) } noexcept -> std::same_as<const AgentSet*>;
        } ||
        requires(const typename F::template State<n>& view, AgentSet& set) {
          { F::template accused_into<n>(view, set) } noexcept;
        });

/// A gap lies behind this state; see Filter.
template <class F, int n>
void uncover(const typename F::Gains& gains, typename F::template State<n>& state) noexcept {
  if constexpr (requires { F::template uncover<n>(gains, state); }) F::template uncover<n>(gains, state);
}
/// Sizes and derived indices of a message of sample t; see Filter.
template <class F, int n>
void shape(const Local& local, const typename F::Gains& gains, int sender, std::int64_t t,
           typename F::template Message<n>& message) noexcept {
  if constexpr (requires { F::template shape<n>(local, gains, sender, t, message); })
    F::template shape<n>(local, gains, sender, t, message);
}
/// The estimate in a message from which measurements may follow; null where the family has none. See Filter.
template <class F, int n>
const double* sensed(const typename F::template Message<n>& message) noexcept {
  if constexpr (requires { F::template sensed<n>(message); })
    return F::template sensed<n>(message);
  else
    return nullptr;
}
/// Whether an estimate can be worked with: an agent whose cannot is made to rejoin at the end of the sample.
template <int n>
bool usable(const Vec<n>& x, double limit = kHuge) noexcept {
  bool all = true;
  for (Eigen::Index k = 0; k < x.size(); ++k) all &= std::abs(x[k]) < limit;
  return all;
}
/// Entrywise median of the vectors `of(k)` of `count` messages into x; x stays where there is none, or
/// becomes zero where it is of no use.
template <int n, class Of>
void median_into(std::size_t count, const Of& of, Vec<n>& x) noexcept {
  if (count == 0) {
    if (!usable<n>(x)) x.setZero();
    return;
  }
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x[i] = median_of(count, [&](std::size_t k) { return of(k)[i]; });
}

/// First sample of a family's runs: 1, or 0 where the start has a sample too.
template <class F>
constexpr int first_sample() {
  if constexpr (requires { F::first_sample; })
    return F::first_sample;
  else
    return 1;
}

}  // namespace garrison
