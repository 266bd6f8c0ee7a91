// SPDX-License-Identifier: Apache-2.0
// A step of the certificates with memory: a bank, and windows that are filled and asked.
#include <optional>
#include <random>
#include <stdexcept>

#include "bench.hpp"
#include "garrison/certificate/memory/anytime_window.hpp"
#include "garrison/certificate/memory/bank.hpp"
#include "garrison/certificate/memory/leverage_window.hpp"
#include "garrison/certificate/memory/subsets_window.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

/// A chain of n integrators with noise at its end, m sources with one row each, s of which are `lie`
/// deviations off.
class Remembered {
 public:
  Remembered(int states, int sources, int attacked, double lie)
      : n_(states), m_(sources), s_(attacked), lie_(lie), A_(Matrix::Identity(states, states)) {
    for (int i = 0; i + 1 < n_; ++i) A_(i, i + 1) = 0.1;
    std::normal_distribution<double> normal;
    C_ = Matrix::NullaryExpr(n_, m_, [&] { return normal(rng_); });
    Gam_ = 0.1 * Matrix::Identity(n_, n_).rightCols(1);
  }

  /// Seconds of a step.
  double bank(int samples, bool ellipsoid) {
    std::vector<BankSource> sources;
    for (int j = 0; j < m_; ++j) sources.push_back({C_.col(j).transpose(), Vector::Ones(1)});
    Bank bank(A_, Gam_ * Gam_.transpose(), sources, s_);
    bank.start_gaussian(Vector::Zero(n_), Matrix::Identity(n_, n_));
    const WindowLevels z{9.0, 9.0, 9.0, kNaN};
    BankStep step;
    step.ellipsoid = ellipsoid;
    double seconds = 0.0;
    for (int t = 0; t < samples; ++t) {
      measure();
      const double start = cpu_seconds();
      kept_ += bank.update(y_, z, step).region.radius;
      seconds += cpu_seconds() - start;
    }
    if (lie_ == 0.0 && bank.members().size() < 2 && s_ > 0) throw std::runtime_error("members died");
    return seconds / samples;
  }

  /// Seconds to fill a window of `steps` samples and ask it. leaves: of A; 0 = W2M, -1 = W3M.
  double window(int samples, int steps, bool moving, int leaves) {
    Window w(n_, 1, steps, m_, steps * m_);
    const WindowAssumption a{s_, window_levels(1e-6, steps * m_, n_), moving, {}, {}};
    LeverageWindowWorkspace leverage(w);
    std::optional<SubsetsWindowWorkspace> subsets;
    std::optional<AnytimeWindowWorkspace> search;
    if (leaves < 0) subsets.emplace(w, 5000);
    if (leaves > 0) search.emplace(w, leaves);
    const Vector none = Vector::Zero(n_);
    double seconds = 0.0;
    for (int t = 0; t < samples; ++t) {
      std::vector<Vector> all;
      for (int k = 0; k < steps; ++k) {
        measure();
        all.push_back(y_);
      }
      const double start = cpu_seconds();
      w.begin(steps);
      for (int k = 0; k < steps; ++k) {
        for (int j = 0; j < m_; ++j)
          w.add(j, {C_.col(j).data(), static_cast<std::size_t>(n_)}, all[static_cast<std::size_t>(k)](j),
                1.0);
        if (k + 1 < steps) w.advance(A_, Gam_, none);
      }
      const WindowWitness& found = leaves < 0   ? subsets_window(w, a, *subsets)
                                   : leaves > 0 ? anytime_window(w, a, *search)
                                                : leverage_window(w, a, leverage);
      kept_ += found.region.radius;
      seconds += cpu_seconds() - start;
    }
    return seconds / samples;
  }

 private:
  /// The state rests at the origin.
  void measure() {
    std::normal_distribution<double> normal;
    y_ = Vector::NullaryExpr(m_, [&] { return normal(rng_); });
    y_.head(s_).array() += lie_;
  }

  int n_, m_, s_;
  double lie_;
  Matrix A_, C_, Gam_;
  Vector y_;
  std::mt19937_64 rng_{1};
  double kept_ = 0.0;
};

}  // namespace

void bind_memory(py::module_& m) {
  py::class_<Remembered>(m, "Remembered")
      .def(py::init<int, int, int, double>(), py::arg("states"), py::arg("sources"), py::arg("attacked"),
           py::arg("lie"))
      .def("bank", &Remembered::bank, py::arg("samples"), py::arg("ellipsoid"))
      .def("window", &Remembered::window, py::arg("samples"), py::arg("steps"), py::arg("moving"),
           py::arg("leaves"));
}
