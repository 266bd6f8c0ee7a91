// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/inputs.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/core/error.hpp"
#include "garrison/core/response.hpp"
#include "node/daemon/files.hpp"
#include "node/daemon/sensor.hpp"

namespace garrison::node {

namespace {

constexpr double kMostBytes = 32 << 20;  // half of what a unit may take

std::vector<double> read_rows(const std::string& path, std::size_t inputs) {
  const std::string text = read_text(path, "a CSV file, a row of known inputs a sample ([input].path)");
  std::vector<double> all;
  std::string_view rest = text;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const auto row = parse_line(rest.substr(0, end), inputs);
    const bool known = row && !row->taken &&
                       std::none_of(row->y.begin(), row->y.end(), [](double u) { return std::isnan(u); });
    if (!known)
      refuse(path + ", line " + std::to_string(line),
             "\"" + std::string(rest.substr(0, std::min<std::size_t>(end, 40))) + "\"",
             amount(inputs, "number") + ", separated by commas: inputs are known at all times",
             "a row a sample, no header; what is not known is process noise");
    rest.remove_prefix(std::min(end + 1, rest.size()));
    all.insert(all.end(), row->y.begin(), row->y.end());
  }
  return all;
}

void require_room(const std::string& path, double rows, double states) {
  const double bytes = 8 * (rows + 1) * states;
  if (bytes > kMostBytes)
    refuse(path,
           text(rows) + " rows for " + text(states) + " states, which take " + text(std::round(bytes / 1e6)) +
               " MB",
           "at most " + text(std::round(kMostBytes / 1e6)) + " MB", "a shorter run, or a longer period");
}

}  // namespace

Inputs::Inputs(const std::string& path, const AgentPart& part) : part_(&part) {
  const Eigen::Index n = part.A.rows();
  const Eigen::Index p = part.B.cols();
  u_ = read_rows(path, static_cast<std::size_t>(p));
  rows_ = static_cast<std::int64_t>(u_.size()) / p;
  if (rows_ == 0) refuse(path, "no row", "known inputs, a row a sample");
  require_room(path, static_cast<double>(rows_), static_cast<double>(n));
  Vector s = Vector::Zero(n);
  s_.assign(static_cast<std::size_t>(n), 0.0);
  for (std::int64_t t = 0; t < rows_; ++t) {
    s = driven(part.A, s, part.B, Eigen::Map<const Vector>(u_.data() + t * p, p));
    if (!(s.cwiseAbs().maxCoeff() < kHuge))
      refuse(path + ", line " + std::to_string(t + 1), "a response beyond 1e150",
             "a plant that stays finite");
    s_.insert(s_.end(), s.begin(), s.end());
  }
}

std::span<const double> Inputs::response(std::int64_t sample) const noexcept {
  if (sample > rows_) return {};
  const auto n = static_cast<std::size_t>(part_->A.rows());
  const auto row = static_cast<std::size_t>(std::max<std::int64_t>(0, sample));  // nothing before the first
  return {s_.data() + row * n, n};
}

/// Summed in the order of a network that is simulated in one process, for the same bits.
void Inputs::without(std::int64_t sample, std::span<double> y) const noexcept {
  if (empty()) return;
  const auto s = response(sample);
  if (s.empty()) return std::fill(y.begin(), y.end(), kNaN);
  for (std::size_t r = 0; r < y.size(); ++r) {
    double sum = 0.0;
    for (std::size_t k = 0; k < s.size(); ++k)
      sum += part_->C_transposed(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(r)) * s[k];
    y[r] -= sum;
  }
}

void Inputs::add(std::int64_t sample, std::span<double> x) const noexcept {
  if (empty()) return;
  const auto s = response(sample);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = s.empty() ? kNaN : x[k] + s[k];
}

std::span<const double> Inputs::before(std::int64_t sample) const noexcept {
  if (empty() || sample < 1 || sample > rows_) return {};
  const auto p = static_cast<std::size_t>(part_->B.cols());
  return {u_.data() + static_cast<std::size_t>(sample - 1) * p, p};
}

}  // namespace garrison::node
