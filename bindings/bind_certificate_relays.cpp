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
      "R: Region around the weighted sum of estimates (q, n) whose errors are at most bounds (q,), inf = not "
      "known;\n"
      "weights (q,) of any sign with sum 1. Raises InvalidInput.");
  m.def("after_injection", &after_injection, py::arg("norm_A"), py::arg("b"), py::arg("bw"), py::arg("kappa"),
        "R: norm_A b + bw + |kappa|, the bound after predicting and injecting a known innovation.");
  py::class_<Propagation>(m, "Propagation", "Regions of some steps ago as regions of today, prepared once.")
      .def_static(
          "bounded",
          [](const MatrixRef& A, int steps, double bw) { return Propagation::bounded(A, steps, bw); },
          py::arg("A"), py::arg("steps"), py::arg("bw"), "||w|| <= bw, ages 0..steps. Raises InvalidInput.")
      .def_static(
          "gaussian",
          [](const MatrixRef& A, int steps, const MatrixRef& Q, double delta) {
            return Propagation::gaussian(A, steps, Q, delta);
          },
          py::arg("A"), py::arg("steps"), py::arg("Q"), py::arg("delta"),
          "w ~ N(0, Q); fails with probability delta per use. Raises InvalidInput.")
      .def_static(
          "bounded_entries",
          [](const MatrixRef& A, int steps, const MatrixRef& Gam, double bw) {
            return Propagation::bounded_entries(A, steps, Gam, bw);
          },
          py::arg("A"), py::arg("steps"), py::arg("Gam"), py::arg("bw"),
          "w = Gam w~ with |w~_i| <= bw; Gam (n, q). Raises InvalidInput.")
      .def_static(
          "gaussian_entries",
          [](const MatrixRef& A, int steps, const MatrixRef& Gam, double zc, double z2) {
            return Propagation::gaussian_entries(A, steps, Gam, zc, z2);
          },
          py::arg("A"), py::arg("steps"), py::arg("Gam"), py::arg("zc"), py::arg("z2"),
          "w = Gam w~, w~ ~ N(0, I): zc for each coordinate, z2 for the vector. Raises InvalidInput.")
      .def(
          "age", [](const Propagation& p, const Region& then, int age) { return p.age(then, age); },
          py::arg("then"), py::arg("age"),
          "The Region of today for one that held `age` steps ago; its box is never wider than what the ball, "
          "the box and "
          "the ellipsoid give.");
  m.def("ellipsoid", &ellipsoid, py::arg("center"), py::arg("shape"), py::arg("stretch"),
        "The Region (x - center)' shape^-1 (x - center) <= stretch^2, with its box and ball. Raises "
        "InvalidInput.");
  py::class_<Recovery>(
      m, "Recovery",
      "L: excess over the table after lost messages. A state is (lam, x): every agent behind the\n"
      "estimate was within x of the lossless run at time lam, and nothing was lost after; (0, 0).")
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
          py::arg("state"), py::arg("t"), "The state seen at time t: carried over every multiple of K.")
      .def(
          "error_excess",
          [](const Recovery& r, int agent, const std::pair<int, double>& s, int t) {
            return r.error_excess(agent_of(r, agent), state_of(s, t), t);
          },
          py::arg("agent"), py::arg("state"), py::arg("t"), "||e_i(t)|| <= d_i(t) + this.")
      .def(
          "level_excess",
          [](const Recovery& r, int agent, const std::pair<int, double>& s, int t) {
            return r.level_excess(agent_of(r, agent), state_of(s, t), t);
          },
          py::arg("agent"), py::arg("state"), py::arg("t"), "level_j(t+1) = nominal + this.")
      .def(
          "merge",
          [](const Recovery& r, const std::pair<int, double>& p, const std::pair<int, double>& q, int t) {
            return from_state(r.merge(state_of(p, t), state_of(q, t), t));
          },
          py::arg("p"), py::arg("q"), py::arg("t"), "Of two states seen at t, the one that dominates both.")
      .def_static(
          "lost", [](int t, double b, double d) { return from_state(Recovery::lost(t, b, d)); }, py::arg("t"),
          py::arg("b"), py::arg("d"),
          "After a loss in step t: b bounds ||e_i(t)||, d is the table's d_i(t).");
  py::class_<TwoNumbers>(
      m, "TwoNumbers",
      "M: bound rho + sqrt((N-1)/N) p for unknown averaging with ||J - 11'/N|| <= gamma per step.")
      .def(py::init<const MatrixRef&, const MatrixRef&, int, double, double, double, const VectorRef&>(),
           py::arg("A"), py::arg("C"), py::arg("s"), py::arg("rho"), py::arg("p"), py::arg("bw"),
           py::arg("bv"))
      .def("step", &TwoNumbers::step, py::arg("gamma"), "One step; returns the bound. Raises InvalidInput.")
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
