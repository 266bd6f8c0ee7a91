// SPDX-License-Identifier: Apache-2.0
// Certificates with memory: windows, and what answers from them.
#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "certificate.hpp"
#include "garrison/certificate/memory/anytime_window.hpp"
#include "garrison/certificate/memory/hull_window.hpp"
#include "garrison/certificate/memory/leverage_window.hpp"
#include "garrison/certificate/memory/subsets_window.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

using Ids = std::vector<int>;

/// Sources of an answer that hold for the whole window; by step with a moving set.
Ids always(const WindowWitness& w) {
  Ids ids;
  for (const Proof& proof : w.proofs)
    if (proof.step == kAlways) ids.push_back(proof.source);
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::map<int, Ids> by_step(const WindowWitness& w) {
  std::map<int, Ids> steps;
  for (const Proof& proof : w.proofs)
    if (proof.step != kAlways) steps[proof.step].push_back(proof.source);
  for (auto& [step, ids] : steps) std::sort(ids.begin(), ids.end());
  return steps;
}

template <class T>
std::optional<T> of_region(const WindowWitness& w, const T Region::* field) {
  return w.region.answered() ? std::optional(w.region.*field) : std::nullopt;
}

void bind_window(py::module_& m) {
  py::class_<Window>(
      m, "Window",
      numpydoc(
          R"(The measurements of several steps as one regression z = N theta + o, for x(k+1) = A x(k) + u + Gam w~(k).
Call begin, a prior, then for each step add its rows and advance.

states : int | n >= 1.
noise : int | Columns of Gam, >= 0.
steps : int | Most steps, >= 1.
sources : int | Sources are 0..sources-1, >= 1.
capacity : int | Most measurements, >= 1.
! InvalidInput | A number out of range, or more than memory is meant for.)")
          .c_str())
      .def(py::init<int, int, int, int, int>(), py::arg("states"), py::arg("noise"), py::arg("steps"),
           py::arg("sources"), py::arg("capacity"))
      .def("begin", &Window::begin, py::arg("steps"), py::arg("process_bound") = kNaN,
           numpydoc(R"(Empties the window.

steps : int | Of this window, 1..the most.
process_bound : float | |w~_i| <= process_bound, > 0; nan: w~ ~ N(0, I).
! InvalidInput | A number out of range.)")
               .c_str())
      .def("prior_gaussian", &Window::prior_gaussian, py::arg("c0"), py::arg("P0"),
           numpydoc(R"(x(0) - c0 ~ N(0, P0), right after begin.

c0 : (n,) array | Finite.
P0 : (n, n) array | Positive definite.
! InvalidInput | A wrong size, no such covariance, or not right after begin.)")
               .c_str())
      .def("prior_set", &Window::prior_set, py::arg("c0"), py::arg("P0"), py::arg("r0"),
           py::arg("weight") = 4.0,
           numpydoc(R"((x(0) - c0)' P0^-1 (x(0) - c0) <= r0^2 for certain, right after begin.

c0 : (n,) array | Finite.
P0 : (n, n) array | Positive definite.
r0 : float | >= 0.
weight : float | As how many deviations r0 counts, > 0.
! InvalidInput | A wrong size, a number out of range, or not right after begin.)")
               .c_str())
      .def(
          "add",
          [](Window& w, int source, const VectorRef& c, double y, double variance, double bias,
             bool bounded) {
            return w.add(source, {c.data(), static_cast<std::size_t>(c.size())}, y, variance, bias, bounded);
          },
          py::arg("source"), py::arg("c"), py::arg("y"), py::arg("variance"), py::arg("bias") = 0.0,
          py::arg("bounded") = false,
          numpydoc(R"(A measurement y = c x + v of the present step.

source : int | Whose it is, 0..sources-1.
c : (n,) array | Its row.
y : float | nan = missing.
variance : float | v ~ N(0, variance), > 0.
bias : float | At most so much on top, >= 0.
bounded : bool | |v| <= bias alone.
< bool | False: it says nothing (nan, c = 0, no such source, full, ..) and is left out.)")
              .c_str())
      .def("advance", &Window::advance, py::arg("A"), py::arg("Gam"), py::arg("u"),
           numpydoc(R"(To the next step.

A : (n, n) array | Of the plant.
Gam : (n, noise) array | How the noise enters.
u : (n,) array | Known input.
! InvalidInput | Shapes do not fit, or beyond the last step.)")
               .c_str())
      .def_property_readonly("rows", &Window::rows, "how many, process noise and prior included")
      .def_property_readonly(
          "N",
          [](const Window& w) {
            Matrix N(w.rows(), w.unknowns());
            for (int r = 0; r < w.rows(); ++r) N.row(r) = w.N(r).transpose();
            return N;
          },
          "(rows, unknowns)")
      .def_property_readonly(
          "z",
          [](const Window& w) {
            return Vector(
                Vector::NullaryExpr(w.rows(), [&](Eigen::Index r) { return w.z(static_cast<int>(r)); }));
          },
          "(rows,)")
      .def_property_readonly(
          "bias",
          [](const Window& w) {
            return Vector(
                Vector::NullaryExpr(w.rows(), [&](Eigen::Index r) { return w.bias(static_cast<int>(r)); }));
          },
          "(rows,): bounds on top of the noise, in deviations")
      .def_property_readonly(
          "source",
          [](const Window& w) {
            Ids of;
            for (int r = 0; r < w.rows(); ++r) of.push_back(w.source(r));
            return of;
          },
          "per row; -1: honest (process noise, prior)")
      .def_property_readonly(
          "step_of",
          [](const Window& w) {
            Ids of;
            for (int r = 0; r < w.rows(); ++r) of.push_back(w.step_of(r));
            return of;
          },
          "per row; -1: process noise")
      .def_property_readonly(
          "gaussian",
          [](const Window& w) {
            std::vector<bool> is;
            for (int r = 0; r < w.rows(); ++r) is.push_back(w.noise(r) == RowNoise::gaussian);
            return is;
          },
          "per row: N(0, 1) noise")
      .def_property_readonly("prior_length", &Window::prior_length,
                             "bound on the errors of a set prior together")
      .def_property_readonly(
          "E", [](const Window& w) { return Matrix(w.E()); }, "(n, unknowns): x = E theta + o")
      .def_property_readonly("o", &Window::o, "(n,)");
}

void bind_answer(py::module_& m) {
  py::class_<WindowWitness>(m, "WindowWitness", "Answer of a certificate with memory.")
      .def_readonly("region", &WindowWitness::region, "Where the state is.")
      .def_property_readonly(
          "center", [](const WindowWitness& w) { return of_region(w, &Region::center); },
          "(n,), None without an answer")
      .def_property_readonly(
          "shape", [](const WindowWitness& w) { return of_region(w, &Region::shape); },
          "(n, n): (x - center)' shape^-1 (x - center) <= stretch^2; None without an answer")
      .def_property_readonly(
          "stretch", [](const WindowWitness& w) { return w.region.stretch; },
          "(x - center)' shape^-1 (x - center) <= stretch^2.")
      .def_property_readonly(
          "box", [](const WindowWitness& w) { return of_region(w, &Region::box); },
          "(n,): |x_i - center_i| <= box_i; None without an answer")
      .def_property_readonly(
          "radius", [](const WindowWitness& w) { return w.region.radius; },
          "of the ball; inf: the rows cannot answer; nan: more than s are attacked")
      .def_readonly(
          "mu", &WindowWitness::mu,
          "1 - lambda of W2M: what the attackers leave of the information; nan where it does not apply")
      .def_property_readonly(
          "proved", [](const WindowWitness& w) { return w.region.refuted() ? Ids() : always(w); },
          "sources shown to be attacked, with those given; none where the region is refuted")
      .def_property_readonly(
          "proved_at",
          [](const WindowWitness& w) { return w.region.refuted() ? std::map<int, Ids>() : by_step(w); },
          "{step: sources}, with a moving set; none where the region is refuted")
      .def_property_readonly(
          "dropped", &always,
          "sources whose rows were not used: the proved, or, where the region is refuted, more than "
          "s that contradict, of which no single one is proved")
      .def_property_readonly("dropped_at", &by_step, "{step: sources}: the same with a moving set")
      .def_readonly("count", &WindowWitness::count, "consistent subsets, leaves or living members behind it");
}

WindowAssumption assume(int s, double z1, double z2, double zc, double z3, bool moving, const Ids& proved,
                        const Ids& honest) {
  return {s, {z1, z2, zc, z3}, moving, proved, honest};
}

void bind_window_witnesses(py::module_& m) {
  m.def("noise_root", &noise_root, py::arg("Q"),
        numpydoc(R"(Gam of Window.advance for process noise of a covariance: Gam Gam' = Q.

Q : (n, n) array | Symmetric, positive semidefinite.
< (n, k) array | Without directions in which there is no noise.
! InvalidInput | No covariance.)")
            .c_str());
  m.def(
      "window_levels",
      [](double delta, int rows, int states) {
        const WindowLevels z = window_levels(delta, rows, states);
        return std::tuple(z.z1, z.z2, z.zc);
      },
      py::arg("delta"), py::arg("rows"), py::arg("states"),
      numpydoc(R"(Levels of the window certificates that fail together with probability <= delta.

delta : float | Above 0 and below 1.
rows : int | Measurements of the window, >= 1.
states : int | n >= 1.
< (z1, z2, zc) | Of every single measurement, of the vector, and of each coordinate.
! InvalidInput | A number out of range.)")
          .c_str());
  m.def(
      "leverage_window",
      [](const Window& w, int s, double z1, double z2, double zc, bool moving, const Ids& proved,
         const Ids& honest) {
        const py::gil_scoped_release no_gil;
        return leverage_window(w, assume(s, z1, z2, zc, kNaN, moving, proved, honest));
      },
      py::arg("window"), py::arg("s"), py::arg("z1"), py::arg("z2"), py::arg("zc"), py::kw_only(),
      py::arg("moving") = false, py::arg("proved") = Ids(), py::arg("honest") = Ids(),
      numpydoc(R"(W2M: region of the state of the window's last step, at most s sources lie.

window : Window | Filled up to its last step.
s : int | >= 0.
z1, z2, zc : float | window_levels(), >= 0; 0 with bounded noise.
moving : bool | s sources in each step, else one set for the whole window.
proved, honest : sequence of int | Sources known to be so.
< WindowWitness
! InvalidInput | A number out of range, `proved` with a moving set, or a window that is not filled.)")
          .c_str());
  m.def(
      "subsets_window",
      [](const Window& w, int s, double z1, double z2, double zc, std::optional<double> z3, const Ids& proved,
         int limit) {
        if (z3 && std::isnan(*z3)) refuse("z3", "nan", "a number >= 0, or None");
        const py::gil_scoped_release no_gil;
        return subsets_window(w, assume(s, z1, z2, zc, z3.value_or(kNaN), false, proved, {}), limit);
      },
      py::arg("window"), py::arg("s"), py::arg("z1"), py::arg("z2"), py::arg("zc"), py::kw_only(),
      py::arg("z3") = py::none(), py::arg("proved") = Ids(), py::arg("limit") = kMostWindowSubsets,
      numpydoc(
          R"(W3M: the region of leverage_window by all sets of s sources left out, the attacked set fixed in the window;
sharper.

window : Window | Filled up to its last step.
s : int | >= 0.
z1, z2, zc : float | window_levels(), >= 0.
z3 : float, optional | chi of all residuals of such a set.
proved : sequence of int | Sources known to be attacked.
limit : int | Most sets, >= 1.
< WindowWitness
! InvalidInput | A number out of range, a window that is not filled, or more than `limit` sets.)")
          .c_str());
  m.def(
      "subsets_window_width",
      [](const Window& w, int s, double z1, double zc, std::optional<double> z3, int limit) {
        const py::gil_scoped_release no_gil;
        return subsets_window_width(w, assume(s, z1, 0.0, zc, z3.value_or(kNaN), false, {}, {}), limit);
      },
      py::arg("window"), py::arg("s"), py::arg("z1"), py::arg("zc"), py::kw_only(),
      py::arg("z3") = py::none(), py::arg("limit") = 20 * kMostWindowSubsets,
      numpydoc(R"(W3D, design time: half widths that subsets_window never exceeds whatever s attackers do.

window : Window | Filled up to its last step; its data are not read.
s : int | >= 0.
z1, zc : float | As of subsets_window, at delta / C(sources, s).
z3 : float, optional | As of subsets_window.
limit : int | Most pairs of sets, >= 1.
< (n,) array | inf: not observable without some 2s sources.
! InvalidInput | A number out of range, a window that is not filled, or more than `limit` pairs.)")
          .c_str());
  m.def(
      "anytime_window",
      [](const Window& w, int s, double z1, double z2, double zc, int leaves, const Ids& proved,
         const Ids& honest) {
        const py::gil_scoped_release no_gil;
        return anytime_window(w, assume(s, z1, z2, zc, kNaN, false, proved, honest), leaves);
      },
      py::arg("window"), py::arg("s"), py::arg("z1"), py::arg("z2"), py::arg("zc"), py::kw_only(),
      py::arg("leaves"), py::arg("proved") = Ids(), py::arg("honest") = Ids(),
      numpydoc(R"(A: from leverage_window (1 leaf) to subsets_window (all), within a budget.

window : Window | Filled up to its last step.
s : int | >= 0.
z1, z2, zc : float | window_levels(), >= 0; 0 with bounded noise.
leaves : int | Budget, >= 1: the cost is that of so many leverage_window.
proved, honest : sequence of int | Sources known to be so.
< WindowWitness
! InvalidInput | A number out of range, or a window that is not filled.)")
          .c_str());
}

void bind_hull(py::module_& m) {
  m.def(
      "hull_window",
      [](const Window& w, int s, int limit) {
        const py::gil_scoped_release no_gil;
        const Box box = hull_window(w, s, limit);
        return std::pair(box.lo, box.hi);
      },
      py::arg("window"), py::arg("s"), py::arg("limit") = 2000,
      numpydoc(
          R"(Bounded noise, exactly: hull of the states that explain the rows, by linear programs over all sets of s
sources left out.

window : Window | Of bounded rows only, without a prior, filled up to its last step.
s : int | >= 0.
limit : int | Most sets, >= 1.
< (lo, hi), (n,) arrays | nan: more than s are attacked; inf: the rows cannot answer.
! InvalidInput | Another window, a number out of range, or more than `limit` sets.)")
          .c_str());
}

}  // namespace

void bind_certificate_memory(py::module_& c) {
  bind_window(c);
  bind_answer(c);
  bind_window_witnesses(c);
  bind_hull(c);
  bind_certificate_bank(c);
  bind_certificate_meters(c);
}
