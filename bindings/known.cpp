// SPDX-License-Identifier: Apache-2.0
#include "known.hpp"

#include "convert.hpp"
#include "garrison/core/error.hpp"

namespace py = pybind11;
using namespace garrison;

namespace {

std::vector<Matrix> matrices_over_time(const std::string& which, py::handle given) {
  const auto array = convert::array(which, given);
  if (array.ndim() != 3) refuse(which, convert::shown(given), "an array (time, rows, columns)");
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<Matrix> all;
  for (py::ssize_t t = 0; t < array.shape(0); ++t)
    all.emplace_back(Eigen::Map<const Rows>(array.data() + t * array.shape(1) * array.shape(2),
                                            array.shape(1), array.shape(2)));
  return all;
}

}  // namespace

std::shared_ptr<const Series> series_of(const py::dict& given) {
  if (given.empty()) return nullptr;
  auto series = std::make_shared<Series>();
  for (const auto& [key, value] : given) {
    const auto name = convert::words("series", key);
    std::vector<Matrix> all = matrices_over_time(name, value);
    if (name == "A")
      series->A = std::move(all);
    else if (name == "B")
      series->B = std::move(all);
    else if (name == "C")
      series->C = std::move(all);
    else if (name == "process_covariance")
      series->process_covariance = std::move(all);
    else if (name == "measurement_covariance")
      series->measurement_covariance = std::move(all);
    else
      refuse("series", name, "A, B, C, process_covariance or measurement_covariance");
  }
  return series;
}
