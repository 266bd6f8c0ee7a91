// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/agent_step.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/filters/rdkf/ipopt_step.hpp"
#include "garrison/filters/rdkf/secular.hpp"

namespace garrison::rdkf {

// In the whole library only: null on a node.
[[gnu::weak]] bool ipopt_available();
[[gnu::weak]] Step solve_ipopt(const MatrixRef&, const MatrixRef&, const VectorRef&, const Price&,
                               double*) noexcept;

namespace {

constexpr int kMostAscents = 5000;
constexpr double kAscentTolerance = 1e-15;

struct Multiply {
  template <int B>
  static GARRISON_INLINE void run(const Packed* M, const double* x, double* out) {
    product<B>(*M, x, out);
  }
};

/// x0, then the step of `norm` and `huber` in the same kernel.
struct Advance {
  template <int B>
  static GARRISON_INLINE void run(const Gains* g, const AgentGains* a, const StepFactors* step,
                                  Workspace* w) {
    product<B>(a->F, w->sum, w->x);
    if (step != nullptr) w->step = detail::solve_at<B>(*step, g->price, w->y, w->x, w->room);
  }
};

/// `whole`, or where some outputs of sensor j are missing the same without them.
const StepFactors& factors(const Gains& g, const AgentGains& a, const StepFactors& whole, std::size_t j,
                           Workspace& w) noexcept {
  if (w.rows[j] == whole.outputs()) return whole;
  const Penalty penalty = g.penalty == Penalty::huber ? Penalty::huber : Penalty::norm;
  return w.partial[j].step(a.sensors[j], a.L, penalty,
                           w.present.data() + j * static_cast<std::size_t>(g.most_outputs));
}
const BoxFactors& box(const AgentGains& a, Workspace& w) noexcept {
  if (w.rows[0] == a.box.outputs()) return a.box;
  return w.partial[0].box(a.sensors[0], a.L, w.present.data());
}

/// Block ascent on the dual: each block is a step of its own against the pull of all the others.
Step ascend(const Gains& g, const AgentGains& a, Workspace& w) noexcept {
  const int n = a.F.rows;
  const std::size_t blocks = a.blocks.size();
  // Pull of each block on x, behind one another, and room for a step behind them.
  double* const pull = w.room;
  double* const room = w.room + blocks * static_cast<std::size_t>(n);
  std::fill_n(pull, blocks * static_cast<std::size_t>(n), 0.0);
  Step total;
  for (int sweep = 0; sweep < kMostAscents; ++sweep) {
    double moved = 0.0;
    double size = 0.0;
    total.mu = 0.0;
    for (std::size_t j = 0; j < blocks; ++j) {
      if (w.rows[j] == 0) continue;
      const StepFactors& f = factors(g, a, a.blocks[j], j, w);
      double* const own = pull + j * static_cast<std::size_t>(n);
      for (int k = 0; k < n; ++k) w.product[k] = w.x[k] - own[k];
      for (int k = 0; k < n; ++k) w.x[k] = w.product[k];
      const Step one = solve(f, g.price, w.y + j * static_cast<std::size_t>(g.most_outputs), w.x, room);
      total.iterations += one.iterations;
      total.mu = std::max(total.mu, one.mu);
      for (int k = 0; k < n; ++k) {
        const double now = w.x[k] - w.product[k];
        moved = std::max(moved, std::abs(now - own[k]));
        size = std::max(size, std::abs(w.x[k]));
        own[k] = now;
      }
    }
    if (!(moved > kAscentTolerance * size)) break;
  }
  return total;
}

Step by_ipopt(const Gains& g, const AgentGains& a, Workspace& w) noexcept {
  const StepFactors& f = factors(g, a, a.step, 0, w);
  const Eigen::Map<const Vector> y(w.y, f.outputs());
  return solve_ipopt(a.Q, f.K.dense(), f.R.dense() * y, g.price, w.x);
}

}  // namespace

bool runs(const Gains& g) noexcept { return !g.ipopt || (ipopt_available != nullptr && ipopt_available()); }

void Workspace::resize(const Gains& g, const AgentGains& a, int states) {
  const auto n = static_cast<std::size_t>(padded(states));
  std::size_t step_room = std::max(a.step.room(), a.box.room());
  for (const StepFactors& f : a.blocks)
    step_room = std::max(step_room, f.room() + a.blocks.size() * static_cast<std::size_t>(states));
  const auto measurements =
      static_cast<std::size_t>(g.most_outputs) * std::max<std::size_t>(1, a.blocks.size());
  memory.assign(3 * n + step_room + measurements, 0.0);
  sum = memory.data();
  x = sum + n;
  product = x + n;
  room = product + n;
  y = room + step_room;
  const std::size_t sensors = std::max<std::size_t>(1, a.blocks.size());
  present.assign(static_cast<std::size_t>(g.most_outputs) * sensors, 0);
  rows.assign(sensors, 0);
  partial.assign(sensors, {});
  for (std::size_t j = 0; j < a.sensors.size(); ++j)
    partial[j].resize(a.sensors[j], g.penalty == Penalty::l1);
}

void multiply(const Packed& M, const double* x, double* out) noexcept { run_widest<Multiply>(&M, x, out); }

void advance(const Gains& g, const AgentGains& a, bool measured, Workspace& w) noexcept {
  const int n = a.F.rows;
  const bool plain = !g.ipopt && (g.penalty == Penalty::norm || g.penalty == Penalty::huber);
  w.step = {};
  run_widest<Advance>(&g, &a, measured && plain ? &factors(g, a, a.step, 0, w) : nullptr, &w);
  if (measured && !plain)
    w.step = g.penalty == Penalty::group ? ascend(g, a, w)
             : g.penalty == Penalty::l1  ? solve_box(box(a, w), g.price.lambda, w.y, w.x, w.room)
                                         : by_ipopt(g, a, w);
  w.deviation = 0.0;
  if (!measured) return;
  multiply(a.F, w.sum, w.product);  // x0 once more
  double square = 0.0;
  for (int k = 0; k < n; ++k) square += (w.x[k] - w.product[k]) * (w.x[k] - w.product[k]);
  w.deviation = std::sqrt(square);
}

}  // namespace garrison::rdkf
