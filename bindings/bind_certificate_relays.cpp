// SPDX-License-Identifier: Apache-2.0
// Certificates on their way: relayed, carried over steps, after losses.
#include "certificate.hpp"
#include "garrison/certificate/propagate.hpp"
#include "garrison/certificate/recovery.hpp"
#include "garrison/certificate/relay.hpp"
#include "garrison/certificate/two_numbers.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

LossState state_of(const std::pair<int, double>& s, int t) {
  if (s.first < 0 || s.first > t) refuse("lam", std::to_string(s.first), "a time in 0.." + std::to_string(t));
  if (!(s.second >= 0.0)) refuse("x", text(s.second), "a number >= 0");
  return {s.first, s.second};
}
std::pair<int, double> from_state(const LossState& s) { return {static_cast<int>(s.lam), s.x}; }

int agent_of(const Recovery& r, int agent) {
  if (agent < 0 || agent >= r.rb().cols())
    refuse("agent", std::to_string(agent), "0.." + std::to_string(r.rb().cols() - 1));
  return agent;
}

}  // namespace

void bind_certificate_relays(py::module_& m) {
  m.def(
      "averaged",
      [](const VectorRef& weights, const MatrixRef& estimates, const VectorRef& bounds) {
        return averaged(weights, estimates.transpose(), bounds);
      },
      py::arg("weights"), py::arg("estimates"), py::arg("bounds"),
      numpydoc(R"(R: Region around the weighted sum of the estimates that arrived.

weights : (q,) array | Of any sign, with sum 1.
estimates : (q, n) array | One per row, finite.
bounds : (q,) array | On their errors, >= 0; inf or nan = none known.
< Region
! InvalidInput | Sizes that differ, or a number out of range.)")
          .c_str());
  m.def("after_injection", &after_injection, py::arg("norm_A"), py::arg("b"), py::arg("bw"), py::arg("kappa"),
        numpydoc(R"(R: norm_A b + bw + |kappa|, the bound after predicting and injecting a known innovation.

norm_A : float | ||A||, >= 0.
b : float | Bound before, >= 0.
bw : float | Bound on the process noise, >= 0.
kappa : float | What was injected; finite.
< float
! InvalidInput | A number out of range.)")
            .c_str());
  py::class_<Propagation>(m, "Propagation", "Regions of some steps ago as regions of today, prepared once.")
      .def_static(
          "bounded",
          [](const MatrixRef& A, int steps, double bw) { return Propagation::bounded(A, steps, bw); },
          py::arg("A"), py::arg("steps"), py::arg("bw"),
          numpydoc(R"(For ||w|| <= bw.

A : (n, n) array | Of the plant.
steps : int | Ages 0..steps are prepared.
bw : float | >= 0.
< Propagation
! InvalidInput | A number out of range, or powers of A that overflow.)")
              .c_str())
      .def_static(
          "gaussian",
          [](const MatrixRef& A, int steps, const MatrixRef& Q, double delta) {
            return Propagation::gaussian(A, steps, Q, delta);
          },
          py::arg("A"), py::arg("steps"), py::arg("Q"), py::arg("delta"),
          numpydoc(R"(For w ~ N(0, Q), white.

A : (n, n) array | Of the plant.
steps : int | Ages 0..steps are prepared.
Q : (n, n) array | Covariance.
delta : float | Probability to fail per use, above 0 and below 1.
< Propagation
! InvalidInput | A number out of range, no covariance, or powers of A that overflow.)")
              .c_str())
      .def_static(
          "bounded_entries",
          [](const MatrixRef& A, int steps, const MatrixRef& Gam, double bw) {
            return Propagation::bounded_entries(A, steps, Gam, bw);
          },
          py::arg("A"), py::arg("steps"), py::arg("Gam"), py::arg("bw"),
          numpydoc(R"(For w = Gam w~ with |w~_i| <= bw.

A : (n, n) array | Of the plant.
steps : int | Ages 0..steps are prepared.
Gam : (n, q) array | How the noise enters.
bw : float | >= 0.
< Propagation
! InvalidInput | A number out of range, or powers of A that overflow.)")
              .c_str())
      .def_static(
          "gaussian_entries",
          [](const MatrixRef& A, int steps, const MatrixRef& Gam, double zc, double z2) {
            return Propagation::gaussian_entries(A, steps, Gam, zc, z2);
          },
          py::arg("A"), py::arg("steps"), py::arg("Gam"), py::arg("zc"), py::arg("z2"),
          numpydoc(R"(For w = Gam w~, w~ ~ N(0, I).

A : (n, n) array | Of the plant.
steps : int | Ages 0..steps are prepared.
Gam : (n, q) array | How the noise enters.
zc : float | Level of each coordinate, >= 0.
z2 : float | Level of the vector, >= 0.
< Propagation
! InvalidInput | A number out of range, or powers of A that overflow.)")
              .c_str())
      .def(
          "age", [](const Propagation& p, const Region& then, int age) { return p.age(then, age); },
          py::arg("then"), py::arg("age"),
          numpydoc(
              R"(The Region of today for one that held some steps ago; its box is never wider than what the ball, the box and
the ellipsoid give. Known inputs move the centre: add theirs.

then : Region | Of n states.
age : int | 0..steps.
< Region
! InvalidInput | Another size, or an age out of range.)")
              .c_str());
  m.def("ellipsoid", &ellipsoid, py::arg("center"), py::arg("shape"), py::arg("stretch"),
        numpydoc(R"(The Region (x - center)' shape^-1 (x - center) <= stretch^2, with its box and ball.

center : (n,) array | Finite.
shape : (n, n) array | Symmetric, positive semidefinite.
stretch : float | >= 0.
< Region
! InvalidInput | Sizes that differ, or a number out of range.)")
            .c_str());
  py::class_<Recovery>(
      m, "Recovery",
      numpydoc(
          R"(L: excess over the table after lost messages. A state is (lam, x): every agent behind the estimate was
within x of the lossless run at time lam, and nothing was lost after; (0, 0) at the start.

kernels : Kernels | Of kernels().
s : int | Sensors attacked at a time, >= 0.
! InvalidInput | s < 0.)")
          .c_str())
      .def(py::init<const Kernels&, int>(), py::arg("kernels"), py::arg("s"))
      .def_property_readonly(
          "rb", [](const Recovery& r) { return r.rb(); }, "(K+1, N)")
      .def_property_readonly(
          "re", [](const Recovery& r) { return r.re(); }, "(K+1, N)")
      .def(
          "rebase",
          [](const Recovery& r, const std::pair<int, double>& s, int t) {
            return from_state(r.rebase(state_of(s, t), t));
          },
          py::arg("state"), py::arg("t"),
          numpydoc(R"(The state seen at time t: carried over every multiple of K.

state : (lam, x) | lam <= t, x >= 0.
t : int | Present step.
< (lam, x)
! InvalidInput | No such state.)")
              .c_str())
      .def(
          "error_excess",
          [](const Recovery& r, int agent, const std::pair<int, double>& s, int t) {
            return r.error_excess(agent_of(r, agent), state_of(s, t), t);
          },
          py::arg("agent"), py::arg("state"), py::arg("t"),
          numpydoc(R"(||e_i(t)|| is at most d_i(t) of the table and this.

agent : int | 0..N-1.
state : (lam, x) | lam <= t, x >= 0.
t : int | Present step.
< float
! InvalidInput | There is no such agent or state.)")
              .c_str())
      .def(
          "level_excess",
          [](const Recovery& r, int agent, const std::pair<int, double>& s, int t) {
            return r.level_excess(agent_of(r, agent), state_of(s, t), t);
          },
          py::arg("agent"), py::arg("state"), py::arg("t"),
          numpydoc(R"(The level of t + 1 is that of the table and this.

agent : int | 0..N-1.
state : (lam, x) | lam <= t, x >= 0.
t : int | Present step.
< float
! InvalidInput | There is no such agent or state.)")
              .c_str())
      .def(
          "merge",
          [](const Recovery& r, const std::pair<int, double>& p, const std::pair<int, double>& q, int t) {
            return from_state(r.merge(state_of(p, t), state_of(q, t), t));
          },
          py::arg("p"), py::arg("q"), py::arg("t"),
          numpydoc(R"(Of two states seen at one time, the one that dominates both.

p, q : (lam, x) | lam <= t, x >= 0.
t : int | Present step.
< (lam, x)
! InvalidInput | No such state.)")
              .c_str())
      .def_static(
          "lost", [](int t, double b, double d) { return from_state(Recovery::lost(t, b, d)); }, py::arg("t"),
          py::arg("b"), py::arg("d"),
          numpydoc(R"(The state after a loss.

t : int | Step of the loss.
b : float | Bounds ||e_i(t)||.
d : float | d_i(t) of the table.
< (lam, x))")
              .c_str());
  py::class_<TwoNumbers>(
      m, "TwoNumbers",
      numpydoc(R"(M: bound rho + sqrt((N-1)/N) p for unknown averaging with ||J - 11'/N|| <= gamma per step.

A : (n, n) array | Of the plant.
C : (N, n) array | Rows of length 1, or 0.
s : int | Sensors attacked at a time, >= 0.
rho : float | Bound on the mean of the errors at the start, >= 0.
p : float | Bound on their deviations from the mean at the start, >= 0.
bw : float | ||w|| <= bw, >= 0.
bv : (N,) array | |v_j| <= bv[j], >= 0.
! InvalidInput | Shapes do not fit, or a number is out of range.)")
          .c_str())
      .def(py::init<const MatrixRef&, const MatrixRef&, int, double, double, double, const VectorRef&>(),
           py::arg("A"), py::arg("C"), py::arg("s"), py::arg("rho"), py::arg("p"), py::arg("bw"),
           py::arg("bv"))
      .def("step", &TwoNumbers::step, py::arg("gamma"),
           numpydoc(R"(One step.

gamma : float | >= 0, of this step.
< float | Bound on every ||e_i||; inf once it overflowed.
! InvalidInput | gamma < 0.)")
               .c_str())
      .def_property_readonly("levels", &TwoNumbers::levels, "(N,): adaptive levels of the coming step")
      .def_property_readonly("rho", &TwoNumbers::rho, "Bound on the mean of the errors.")
      .def_property_readonly("p", &TwoNumbers::p, "Bound on their deviations from the mean.")
      .def_property_readonly("bound", &TwoNumbers::bound,
                             "On the error of every agent: rho and its share of p; inf = none.")
      .def_property_readonly("constants", [](const TwoNumbers& x) {
        const auto& k = x.constants();
        return py::dict(py::arg("c") = k.c, py::arg("cw") = k.cw, py::arg("tau") = k.tau,
                        py::arg("kA") = k.kA, py::arg("kw") = k.kw, py::arg("m") = k.m, py::arg("v1") = k.v1,
                        py::arg("v2") = k.v2);
      });
}
