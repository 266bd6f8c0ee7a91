// SPDX-License-Identifier: Apache-2.0
// Certificates: where the state is, whatever at most s sensors say.
#include "certificate.hpp"
#include "garrison/certificate/calibration.hpp"
#include "garrison/certificate/gaussian_table.hpp"
#include "garrison/certificate/informed.hpp"
#include "garrison/certificate/order_rule.hpp"
#include "garrison/certificate/scan.hpp"
#include "garrison/certificate/subsets.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

using Pair = std::pair<double, double>;
using Ids = std::vector<int>;

Pair from_levels(const Levels& l) { return {l.z1, l.z2}; }
Pair from_interval(const Interval& i) { return {i.lo, i.hi}; }

std::optional<Vector> center_of(const Region& r) {
  return r.answered() ? std::optional(r.center) : std::nullopt;
}
std::optional<Vector> box_of(const Region& r) {
  return r.answered() && r.box.size() > 0 ? std::optional(r.box) : std::nullopt;
}

std::optional<Matrix> shape_of(const Region& r) {
  return r.answered() && r.shape.size() > 0 ? std::optional(r.shape) : std::nullopt;
}

Region given_region(const Vector& center, double radius, const std::optional<Vector>& box) {
  if (center.size() < 1 || !center.allFinite())
    refuse("center", amount(center.size(), "number"), "at least one, all finite");
  if (radius < 0.0) refuse("radius", text(radius), "a number >= 0, infinity or NaN");
  if (box && (box->size() != center.size() || !box->allFinite() || box->minCoeff() < 0.0))
    refuse("box", amount(box->size(), "number"), amount(center.size(), "finite number") + " >= 0");
  return Region{center, radius, box.value_or(Vector())};
}

double checked_bound_around(const Region& r, const VectorRef& estimate) {
  if (r.answered() && (estimate.size() != r.center.size() || !estimate.allFinite()))
    refuse("estimate", amount(estimate.size(), "number"), amount(r.center.size(), "finite number"));
  return bound_around(r, estimate);
}

void bind_quantiles(py::module_& m) {
  m.def(
      "empirical_quantile",
      [](const VectorRef& measured, double delta, double confidence) {
        const Quantile q = empirical_quantile(measured, delta, confidence);
        return std::array<double, 3>{q.value, q.lower, q.upper};
      },
      py::arg("measured"), py::arg("delta"), py::arg("confidence") = 0.95,
      numpydoc(R"(A level that a share of clean numbers exceeds.

measured : (T,) array | Clean numbers; nan = missing.
delta : float | The share, above 0 and below 1.
confidence : float | Of the interval, above 0 and below 1, if the numbers are independent.
< (value, lower, upper) | The level, and where the true one is; nan where T is too small.
! InvalidInput | A number out of range.)")
          .c_str());
  m.def(
      "whiteness",
      [](const MatrixRef& residuals, int lags) {
        const Whiteness w = whiteness(residuals, lags);
        return std::tuple(w.statistic, w.correlation, w.p_value);
      },
      py::arg("residuals"), py::arg("lags") = 10,
      numpydoc(R"(Ljung-Box test of residuals against "each is independent of its past".

residuals : (T, N) array | Of N sensors; nan = missing.
lags : int | 1..T-1.
< (statistic (N,), correlation (N,), p_value) | The correlation is that of lag 1; p_value is that of the
  worst sensor times N: small = a residual depends on its past.
! InvalidInput | No sensor, or lags out of range.)")
          .c_str());
  m.def("two_sided", &two_sided, py::arg("delta"),
        numpydoc(R"(z with P(|N(0,1)| > z) = delta.

delta : float | Above 0 and below 1.
< float
! InvalidInput | delta is out of range.)")
            .c_str());
  m.def("chi", &chi, py::arg("delta"), py::arg("degrees"),
        numpydoc(R"(c with P(chi-square > c^2) = delta: the length that a standard Gaussian vector exceeds.

delta : float | Above 0 and below 1.
degrees : int | Numbers of the vector, >= 1.
< float
! InvalidInput | A number out of range.)")
            .c_str());
  m.def("sub_gaussian_two_sided", &sub_gaussian_two_sided, py::arg("delta"),
        numpydoc(R"(sqrt(2 ln(2/delta)): two_sided for noise with a sub-Gaussian proxy variance.

delta : float | Above 0 and below 1.
< float
! InvalidInput | delta is out of range.)")
            .c_str());
  m.def(
      "sub_gaussian_chi", &sub_gaussian_chi, py::arg("delta"), py::arg("degrees"),
      numpydoc(
          R"(sqrt(n + 2 sqrt(n u) + 2 u), u = ln(1/delta) (Hsu, Kakade, Zhang 2012): chi for noise with a sub-Gaussian
proxy variance.

delta : float | Above 0 and below 1.
degrees : int | n >= 1.
< float
! InvalidInput | A number out of range.)")
          .c_str());
  m.def(
      "gaussian_levels",
      [](double delta, int rows, int states) { return from_levels(gaussian_levels(delta, rows, states)); },
      py::arg("delta"), py::arg("rows"), py::arg("states"),
      numpydoc(R"(Levels of the witnesses that fail together with probability <= delta, half for each.

delta : float | Above 0 and below 1.
rows : int | Measurements of one sample, >= 1.
states : int | n >= 1.
< (z1, z2) | Of every single measurement, and of the least-squares vector.
! InvalidInput | A number out of range.)")
          .c_str());
  m.def(
      "sub_gaussian_levels",
      [](double delta, int rows, int states) {
        return from_levels(sub_gaussian_levels(delta, rows, states));
      },
      py::arg("delta"), py::arg("rows"), py::arg("states"),
      numpydoc(R"(gaussian_levels for sub-Gaussian noise.

delta : float | Above 0 and below 1.
rows : int | Measurements of one sample, >= 1.
states : int | n >= 1.
< (z1, z2) | Of every single measurement, and of the least-squares vector.
! InvalidInput | A number out of range.)")
          .c_str());
  m.def(
      "calibrated_levels",
      [](const MatrixRef& V, const VectorRef& R, int s, double delta) {
        return from_levels(calibrated_levels(V, R, s, delta));
      },
      py::arg("V"), py::arg("R"), py::arg("s"), py::arg("delta"),
      numpydoc(R"(Distribution-free levels for one state and rows C = +-1. Exact for exchangeable samples.

V : (T, N) array | Clean residuals, times C.
R : (N,) array | Variances, > 0.
s : int | Attacked sensors, 0..N-1.
delta : float | At least 2/(T+1), below 1.
< (z1, z2) | As of gaussian_levels.
! InvalidInput | A number out of range, or more than 2e8 sums would be needed.)")
          .c_str());
}

void bind_regions(py::module_& m) {
  py::class_<Region>(
      m, "Region",
      numpydoc(
          R"(||x - center|| <= radius, |x_k - center_k| <= box_k where there is a box, and (x - center)' shape^-1 (x -
center) <= stretch^2 where there is a shape. radius inf: the rows at hand cannot answer; nan: the data
refute the assumption.

center : (n,) array | Finite.
radius : float | >= 0, inf or nan.
box : (n,) array, optional | Half widths, finite and >= 0.
! InvalidInput | A number out of range, or a wrong size.)")
          .c_str())
      .def(py::init(&given_region), py::arg("center"), py::arg("radius"), py::arg("box") = py::none())
      .def_property_readonly("center", &center_of, "(n,), None without an answer")
      .def_readonly("radius", &Region::radius,
                    "||x - center|| is at most this; inf = the rows at hand cannot answer, nan = the data "
                    "refute the assumption.")
      .def_property_readonly("box", &box_of, "(n,), None where there is none")
      .def_property_readonly("shape", &shape_of, "(n, n), None where there is none")
      .def_readonly("stretch", &Region::stretch, "(x - center)' shape^-1 (x - center) <= stretch^2.")
      .def_property_readonly("answered", &Region::answered, "radius is finite")
      .def_property_readonly("refuted", &Region::refuted, "radius is nan: more than s are attacked")
      .def("bound_around", &checked_bound_around, py::arg("estimate"),
           numpydoc(R"(Bound on ||estimate - x|| for any estimate.

estimate : (n,) array | Finite.
< float | inf without an answer, nan when refuted.
! InvalidInput | A wrong size, or a number that is not finite.)")
               .c_str());
  py::class_<Witness>(m, "Witness", "Answer of leverage_ball and witness_subsets.")
      .def_readonly("region", &Witness::region, "Where the state is.")
      .def_property_readonly(
          "center", [](const Witness& w) { return center_of(w.region); }, "region.center")
      .def_property_readonly(
          "radius", [](const Witness& w) { return w.region.radius; }, "region.radius")
      .def_property_readonly(
          "box", [](const Witness& w) { return box_of(w.region); }, "region.box")
      .def_property_readonly(
          "kept", [](const Witness& w) { return std::vector<bool>(w.kept.begin(), w.kept.end()); },
          "per row: neither of a proved source nor refuted; False for rows that are absent")
      .def_readonly("proved", &Witness::proved, "sources shown to be attacked, with those given");
}

/// `kept` by position in what was given.
Witness by_position(Witness w, const GivenRows& given, Eigen::Index rows) {
  std::vector<char> kept(static_cast<std::size_t>(rows), 0);
  for (std::size_t k = 0; k < given.position.size(); ++k)
    kept[static_cast<std::size_t>(given.position[k])] = w.kept[k];
  w.kept = std::move(kept);
  return w;
}

void bind_witness(py::module_& m) {
  m.def(
      "leverage_ball",
      [](const VectorRef& y, const MatrixRef& C, const VectorRef& R, int s, double z1, double z2,
         const std::optional<Vector>& widths, const std::optional<Region>& prior, const Ids& proved,
         const Ids& sources) {
        const GivenRows given = given_rows(y, C, R, widths.value_or(Vector()), sources);
        Assumption a{s, {z1, z2}, widths.has_value(), prior ? &*prior : nullptr, proved};
        return by_position(leverage_ball(given.rows, a), given, y.size());
      },
      py::arg("y"), py::arg("C"), py::arg("R"), py::arg("s"), py::arg("z1") = 0.0, py::arg("z2") = 0.0,
      py::kw_only(), py::arg("widths") = py::none(), py::arg("prior") = py::none(), py::arg("proved") = Ids(),
      py::arg("sources") = Ids(),
      numpydoc(R"(W2: region of the state from the rows of one sample. At most s of all sources lie.

y : (m,) array | Measurements; nan = missing.
C : (m, n) array | Their rows.
R : (m,) array | Variances, > 0.
s : int | >= 0.
z1, z2 : float | gaussian_levels(), >= 0; 0 with bounded noise.
widths : (m,) array, optional | Bounded noise |v| <= width instead, >= 0.
prior : Region, optional | Contains x.
proved : sequence of int | Sources known to be attacked, which then must never change.
sources : sequence of m int | Of each row; empty = its position.
< Witness
! InvalidInput | A number out of range, or sizes that differ.)")
          .c_str());
  m.def(
      "witness_subsets",
      [](const VectorRef& y, const MatrixRef& C, const VectorRef& R, int s, double z1, double z2,
         std::optional<double> z3, const Ids& proved, const Ids& sources, int limit) {
        const GivenRows given = given_rows(y, C, R, Vector(), sources);
        if (z3 && std::isnan(*z3)) refuse("z3", "nan", "a number >= 0, or None");
        const py::gil_scoped_release no_gil;
        const Assumption a{s, {z1, z2}, false, nullptr, proved};
        return by_position(witness_subsets(given.rows, a, z3.value_or(kNaN), limit), given, y.size());
      },
      py::arg("y"), py::arg("C"), py::arg("R"), py::arg("s"), py::arg("z1"), py::arg("z2"), py::kw_only(),
      py::arg("z3") = py::none(), py::arg("proved") = Ids(), py::arg("sources") = Ids(),
      py::arg("limit") = kMostSubsets,
      numpydoc(
          R"(W3: the region of leverage_ball by all sets of sources that may be the honest ones, C(sources, s) of them;
sharper.

y : (m,) array | Measurements; nan = missing.
C : (m, n) array | Their rows.
R : (m,) array | Variances, > 0.
s : int | >= 0.
z1, z2 : float | gaussian_levels(), >= 0.
z3 : float, optional | chi(delta3, m - s - n), only where the law of the noise is known.
proved : sequence of int | Sources known to be attacked, which then must never change.
sources : sequence of m int | Of each row; empty = its position.
limit : int | Most sets, >= 1.
< Witness
! InvalidInput | A number out of range, sizes that differ, or more than `limit` sets.)")
          .c_str());
  m.def(
      "order_rule", [](const VectorRef& values, int f) { return order_rule(values, f); }, py::arg("values"),
      py::arg("f"),
      numpydoc(R"(The (f+1)-th smallest of upper bounds on one number, of which at most f are wrong.

values : (q,) array | Bounds; nan = none.
f : int | >= 0.
< float | inf with f or fewer bounds.
! InvalidInput | f < 0.)")
          .c_str());
  m.def("order_bound", &order_bound, py::arg("r"), py::arg("width"), py::arg("s"),
        numpydoc(R"(W0, one state: bound on |xhat - x| with at most s attacked.

r : (m,) array | C (y - C xhat) of sensors with C = +-1; nan = missing.
width : (m,) array | Bounds of their noise, >= 0.
s : int | >= 0.
< float | inf with s or fewer sensors.
! InvalidInput | Sizes that differ, or a number out of range.)")
            .c_str());
  m.def(
      "interval",
      [](const VectorRef& y, const VectorRef& width, int s) { return from_interval(interval(y, width, s)); },
      py::arg("y"), py::arg("width"), py::arg("s"),
      numpydoc(R"(W0, one state: the points that lie in at least m - s of the intervals y +- width.

y : (m,) array | C y of sensors with C = +-1; nan = missing.
width : (m,) array | Bounds of their noise, >= 0.
s : int | >= 0.
< (lo, hi) | (nan, nan): more than s attacked; (-inf, inf): not enough rows.
! InvalidInput | Sizes that differ, or a number out of range.)")
          .c_str());
  m.def(
      "scan",
      [](const VectorRef& r, const VectorRef& R, int s, double z1, double z2) {
        return from_interval(scan(r, R, s, z1, z2));
      },
      py::arg("r"), py::arg("R"), py::arg("s"), py::arg("z1"), py::arg("z2"),
      numpydoc(R"(W1, one state, Gaussian noise: interval of x - xhat.

r : (m,) array | C (y - C xhat) of sensors with C = +-1; nan = missing.
R : (m,) array | Variances, > 0.
s : int | >= 0.
z1, z2 : float | gaussian_levels(), >= 0.
< (lo, hi) | (nan, nan): more than s attacked; (-inf, inf): not enough rows.
! InvalidInput | Sizes that differ, or a number out of range.)")
          .c_str());
}

py::array_t<double> stacked(const std::vector<Gains>& gains) {
  const auto N = gains.front().rows();
  std::vector<double> all;
  all.reserve(gains.size() * static_cast<std::size_t>(N * N));
  for (const Gains& one : gains) all.insert(all.end(), one.data(), one.data() + one.size());
  return owned(std::move(all), {static_cast<py::ssize_t>(gains.size()), N, N});
}

void bind_system(py::module_& m) {
  py::class_<ErrorSystem>(m, "ErrorSystem", "E(t) = M E(t-1) + B_w w(t-1) + B (v(t) + a(t)), agent by agent.")
      .def_readonly("M", &ErrorSystem::M, "(N n, N n)")
      .def_readonly("B", &ErrorSystem::B, "(N n, N)")
      .def_readonly("B_w", &ErrorSystem::B_w, "(N n, n)");
  m.def(
      "error_system",
      [](const MatrixRef& A, const MatrixRef& C, const MatrixRef& J, const Ids& silent) {
        return error_system(A, C, J, silent);
      },
      py::arg("A"), py::arg("C"), py::arg("J"), py::arg("silent") = Ids(),
      numpydoc(R"(Lemma 1: the errors of all agents as one system.

A : (n, n) array | Of the plant.
C : (N, n) array | Rows of length 1, or 0.
J : (N, N) array | The averaging of one step, row sums 1.
silent : sequence of int | Sensors that inject nothing.
< ErrorSystem
! InvalidInput | Shapes do not fit, or a row is not as said.)")
          .c_str());
  py::class_<Kernels>(m, "Kernels",
                      "What k steps of the error system do: gb, ge (K, N, N), wb, we (K, N),\n"
                      "Rb, Re (K+1, N, N).")
      .def_property_readonly(
          "gb", [](const Kernels& k) { return stacked(k.gb); },
          "(K, N, N): [k, i, l] = |block i of M^k B, column l|.")
      .def_property_readonly(
          "ge", [](const Kernels& k) { return stacked(k.ge); },
          "(K, N, N): [k, j, l] = |C_j A (block j of M^k B, column l)|.")
      .def_readonly("wb", &Kernels::wb, "(K, N): ||block i of M^k B_w||.")
      .def_readonly("we", &Kernels::we, "(K, N): |C_j A (block j of M^k B_w)|.")
      .def_property_readonly(
          "Rb", [](const Kernels& k) { return stacked(k.Rb); }, "(K + 1, N, N): [k, i, l] = ||(M^k)_il||.")
      .def_property_readonly(
          "Re", [](const Kernels& k) { return stacked(k.Re); },
          "(K + 1, N, N): [k, j, l] = |C_j A (M^k)_jl|.")
      .def_property_readonly("window", &Kernels::window, "K, how many powers.");
  m.def("kernels", &kernels, py::arg("system"), py::arg("window"), py::call_guard<py::gil_scoped_release>(),
        numpydoc(R"(What so many steps of an error system do.

system : ErrorSystem | Of error_system().
window : int | K >= 1 steps, best so many that Rb[K].sum(1) < 1e-3.
< Kernels
! InvalidInput | K < 1, too large, or powers that overflow.)")
            .c_str());
}

py::object steady_of(const Table& t) {
  if (!t.steady) return py::none();
  return py::dict(py::arg("d") = t.steady->d, py::arg("eta") = t.steady->eta);
}

void bind_tables(py::module_& m) {
  py::class_<Table>(m, "Table",
                    "Data-free bounds, row t = 0..T, column = agent; infinite where they overflow.")
      .def_readonly("d", &Table::d, "(T+1, N): bounds on ||e_i(t)||")
      .def_readonly("eta", &Table::eta, "(T+1, N): bounds on |C_j A e_j(t)|")
      .def_readonly("H", &Table::H, "(T+1, N): bounds on honest innovations; row 0 is nan")
      .def_readonly("level", &Table::level, "(T+1, N): H or beta; row 0 is nan")
      .def_property_readonly("steady", &steady_of,
                             "{d, eta} (N,) that hold from T on for ever; None: none known");
  m.def(
      "table",
      [](const Kernels& k, int s, double start, int T, double bw, const Vector& bv,
         std::optional<double> beta, bool fixed) {
        const py::gil_scoped_release no_gil;
        return table(k, {s, start, T, beta, fixed}, bw, bv);
      },
      py::arg("kernels"), py::kw_only(), py::arg("s"), py::arg("start"), py::arg("T"), py::arg("bw"),
      py::arg("bv"), py::arg("beta") = py::none(), py::arg("fixed") = false,
      numpydoc(R"(Theorem T, bounded noise: bounds on every agent's error without data.

kernels : Kernels | Of kernels().
s : int | Sensors attacked at a time, >= 0.
start : float | Bound on all ||e_i(0)||, >= 0.
T : int | Last step, >= 1.
bw : float | ||w|| <= bw, >= 0.
bv : (N,) array | |v_j| <= bv[j], >= 0.
beta : float, optional | Fixed level, >= 0; None = adaptive.
fixed : bool | The attacked set never changes.
< Table
! InvalidInput | A number out of range, or more than memory is meant for.)")
          .c_str());
  py::class_<GaussianTable>(m, "GaussianTable",
                            "Table for Gaussian noise; d and eta without the noise itself.")
      .def_readonly("table", &GaussianTable::table,
                    "Bounds of the run, tested with the limit of the covariance.")
      .def_readonly("deviation", &GaussianTable::deviation,
                    "(T+1, N): sqrt of the largest eigenvalue of P_ii")
      .def("bound", &GaussianTable::bound, py::arg("t"), py::arg("delta"),
           numpydoc(R"(Bounds at one step; each fails with probability <= N T P(|N(0,1)| > z) + delta.

t : int | 0..T.
delta : float | Above 0 and below 1.
< (N,) array | On ||e_i(t)||.
! InvalidInput | A number out of range.)")
               .c_str());
  m.def(
      "gaussian_table",
      [](const Kernels& k, int s, double start, int T, const Matrix& Q, const Vector& R, double z,
         std::optional<double> beta, bool fixed) {
        const py::gil_scoped_release no_gil;
        return gaussian_table(k, {s, start, T, beta, fixed}, Q, R, z);
      },
      py::arg("kernels"), py::kw_only(), py::arg("s"), py::arg("start"), py::arg("T"), py::arg("Q"),
      py::arg("R"), py::arg("z"), py::arg("beta") = py::none(), py::arg("fixed") = false,
      numpydoc(R"(Theorem TG: the table for Gaussian noise.

kernels : Kernels | Of kernels().
s : int | Sensors attacked at a time, >= 0.
start : float | Bound on all ||e_i(0)||, >= 0.
T : int | Last step, >= 1.
Q : (n, n) array | w ~ N(0, Q).
R : (N,) array | v_j ~ N(0, R[j]), >= 0.
z : float | Level of the event, in deviations, >= 0.
beta : float, optional | Fixed level, >= 0; None = adaptive.
fixed : bool | The attacked set never changes.
< GaussianTable
! InvalidInput | A number out of range, or no covariance.)")
          .c_str());
  m.def("lists_complete", &lists_complete, py::arg("step"), py::arg("diameter"), py::arg("rounds"),
        numpydoc(R"(t0 of theorem I: the step from which all lists are complete.

step : int | At whose end the first list was complete, >= 0.
diameter : int | Of the network, >= 0.
rounds : int | Hops per step, >= 1.
< int
! InvalidInput | A number out of range.)")
            .c_str());
  m.def(
      "informed",
      [](const ErrorSystem& x, const Vector& start, int steps, double bw, const Vector& bv) {
        const py::gil_scoped_release no_gil;
        return informed(x, start, steps, bw, bv);
      },
      py::arg("system"), py::arg("start"), py::arg("steps"), py::arg("bw"), py::arg("bv"),
      numpydoc(R"(Theorem I, bounded noise: bounds once all agents have proved all attackers.

system : ErrorSystem | With the proved sensors silent.
start : (N,) array | Bounds on all ||e_l(t0)||, >= 0.
steps : int | >= 1.
bw : float | ||w|| <= bw, >= 0.
bv : (N,) array | |v_j| <= bv[j], >= 0.
< (steps, N) array | Row k-1 bounds ||e_i(t0 + k)||.
! InvalidInput | A number out of range, or sizes that differ.)")
          .c_str());
  m.def(
      "informed_gaussian",
      [](const ErrorSystem& x, const Vector& start, int steps, const Matrix& Q, const Vector& R,
         const Matrix& P0, double delta) {
        const py::gil_scoped_release no_gil;
        return informed(x, start, steps, Q, R, P0, delta);
      },
      py::arg("system"), py::arg("start"), py::arg("steps"), py::arg("Q"), py::arg("R"), py::arg("P0"),
      py::arg("delta"),
      numpydoc(R"(Theorem I, Gaussian noise; each bound fails with probability delta.

system : ErrorSystem | With the proved sensors silent.
start : (N,) array | Bounds on all ||e_l(t0)||, >= 0.
steps : int | >= 1.
Q : (n, n) array | w ~ N(0, Q).
R : (N,) array | v_j ~ N(0, R[j]), >= 0.
P0 : (N n, N n) array | Covariance of the noise part at t0: zero unless t0 was fixed in advance.
delta : float | Above 0 and below 1.
< (steps, N) array | Row k-1 bounds ||e_i(t0 + k)||.
! InvalidInput | A number out of range, no covariance, or sizes that differ.)")
          .c_str());
}

}  // namespace

void bind_certificate(py::module_& m) {
  auto c = m.def_submodule(
      "certificate", "Run-time certificates: bounds on an estimate's error whatever at most s sensors say.");
  bind_quantiles(c);
  bind_regions(c);
  bind_witness(c);
  bind_system(c);
  bind_tables(c);
  bind_certificate_relays(c);
  bind_certificate_memory(c);
}
