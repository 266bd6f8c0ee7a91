// SPDX-License-Identifier: Apache-2.0
// Steps of the partial-sharing filter for a whole network, timed without plant and record.
#include "bench.hpp"
#include "garrison/engine/any_filter.hpp"

using namespace garrison;

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<Matrix> rows_of(const Rows& all, Eigen::Index each) {
  std::vector<Matrix> out;
  for (Eigen::Index i = 0; i + each <= all.rows(); i += each) out.push_back(all.middleRows(i, each));
  return out;
}

Noise noise_of(const Matrix& Q, const Matrix& R, std::size_t agents) {
  Noise noise;
  noise.process_covariance = Q;
  noise.measurement_covariance.assign(agents, R);
  return noise;
}

class Sharing {
 public:
  /// H: rows of all agents, as many each as R has; R is the same for all.
  Sharing(const Matrix& A, const Rows& H, const Matrix& R, const Matrix& Q, const std::vector<Edge>& edges,
          const Rows& selection, double gain, const std::string& gains)
      : model_(A, rows_of(H, R.rows()), noise_of(Q, R, static_cast<std::size_t>(H.rows() / R.rows()))) {
    const Network network(model_.agents(), edges);
    const ParamMap params{
        {"gain", gain},
        {"gains", gains},
        {"start_is_prediction", true},
        {"selection", std::vector<double>(selection.data(), selection.data() + selection.size())}};
    runner_ = make_filter("partial_sharing", params)->prepare(model_, network)->runner(1);
  }
  /// Seconds of processor time, and the last estimates, N x m.
  std::pair<double, Rows> run(const Rows& y) {
    runner_->reset(Matrix::Zero(model_.states(), model_.agents()), nullptr);
    const double start = cpu_seconds();
    for (Eigen::Index k = 0; k < y.rows(); ++k) runner_->step(k + 1, y.data() + k * y.cols());
    const double seconds = cpu_seconds() - start;
    Rows estimate(model_.agents(), model_.states());
    runner_->read({.estimate = estimate.data()});
    return {seconds, estimate};
  }

 private:
  Model model_;
  std::unique_ptr<Runner> runner_;
};

}  // namespace

void bind_partial_sharing(py::module_& m) {
  py::class_<Sharing>(m, "Sharing")
      .def(py::init<const Matrix&, const Rows&, const Matrix&, const Matrix&, const std::vector<Edge>&,
                    const Rows&, double, const std::string&>())
      .def("run", &Sharing::run);
}
