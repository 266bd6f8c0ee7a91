// SPDX-License-Identifier: Apache-2.0
// Every pair of options keeps the false-alarm rate that is asked for.
#include <doctest/doctest.h>

#include <map>
#include <set>

#include "garrison/filters/structural/detection.hpp"
#include "garrison/filters/structural/filter.hpp"
#include "garrison/filters/structural/gains.hpp"
#include "runs.hpp"

using namespace garrison;

namespace {

struct Option {
  std::string name;
  std::vector<ParamValue> values;
};

/// Values of every described parameter: all choices, both flags, and `more` for the rest, which must have it.
std::vector<Option> options(const std::map<std::string, std::vector<ParamValue>>& more) {
  std::vector<Option> all;
  std::apply(
      [&](const auto&... field) {
        const auto add = [&](const ParamInfo& info) {
          Option option{info.name, {}};
          if (const auto found = more.find(info.name); found != more.end())
            option.values = found->second;
          else if (!info.choices.empty())
            option.values.assign(info.choices.begin(), info.choices.end());
          else if (std::holds_alternative<bool>(info.initial))
            option.values = {false, true};
          CAPTURE(info.name);
          REQUIRE(option.values.size() > 1);
          all.push_back(option);
        };
        (add(field.info), ...);
      },
      Structural::Params::fields());
  return all;
}

using Row = std::vector<std::size_t>;  // a value of every option

bool refused(const std::vector<Option>& all, std::size_t a, std::size_t va, std::size_t b, std::size_t vb) {
  const auto is = [&](const char* name, const ParamValue& value) {
    return (all[a].name == name && all[a].values[va] == value) ||
           (all[b].name == name && all[b].values[vb] == value);
  };
  if (is("test", std::string("residual")) && is("isolate", true)) return true;
  const auto given = [&](const char* name) {
    return (all[a].name == name && va > 0) || (all[b].name == name && vb > 0);
  };
  return given("self_weight") && given("weights");
}

/// Rows that together hold every pair of values that is not refused (greedy).
std::vector<Row> pairwise(const std::vector<Option>& all, test::Rng& rng) {
  std::set<std::array<std::size_t, 4>> open;
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b)
      for (std::size_t va = 0; va < all[a].values.size(); ++va)
        for (std::size_t vb = 0; vb < all[b].values.size(); ++vb)
          if (!refused(all, a, va, b, vb)) open.insert({a, va, b, vb});
  std::vector<Row> rows;
  while (!open.empty()) {
    Row best;
    std::size_t most = 0;
    for (int k = 0; k < 50; ++k) {
      Row row(all.size());
      for (std::size_t a = 0; a < all.size(); ++a)
        row[a] = static_cast<std::size_t>(test::whole(rng, 0, static_cast<int>(all[a].values.size()) - 1));
      const auto& first = *open.begin();
      row[first[0]] = first[1];
      row[first[2]] = first[3];
      bool fits = true;
      std::size_t covers = 0;
      for (std::size_t a = 0; a < all.size(); ++a)
        for (std::size_t b = a + 1; b < all.size(); ++b) {
          fits = fits && !refused(all, a, row[a], b, row[b]);
          covers += open.count({a, row[a], b, row[b]});
        }
      if (fits && covers > most) {
        most = covers;
        best = row;
      }
    }
    if (best.empty()) continue;
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = a + 1; b < all.size(); ++b) open.erase({a, best[a], b, best[b]});
    rows.push_back(best);
  }
  return rows;
}

std::vector<double> by_row(const Matrix& M) {
  std::vector<double> all;
  for (Eigen::Index i = 0; i < M.rows(); ++i)
    for (Eigen::Index k = 0; k < M.cols(); ++k) all.push_back(M(i, k));
  return all;
}

}  // namespace

TEST_CASE("a window of innovations is weighed with the covariance of innovations") {
  const Model model =
      test::known_model(Matrix::Constant(1, 1, 0.7), Matrix::Ones(1, 1), Matrix::Constant(1, 1, 0.5), 2.0);
  const auto filter = make_filter("structural", {{"test", std::string("innovation")},
                                                 {"window", std::int64_t{4}},
                                                 {"false_alarm", 0.05},
                                                 {"settle", std::int64_t{0}}});
  Matrix y(6, 1);
  y << 2, -1, 0.5, 3, -2, 1;
  const Record r = replay(model, Network(1, std::vector<Edge>{}), *filter, y, Matrix(), {});
  for (std::size_t t = 1; t < 4; ++t) CHECK(std::isnan(r.statistic[t]));
  CHECK(r.statistic[4] == doctest::Approx(5.264471).epsilon(1e-6));
  CHECK(r.statistic[5] == doctest::Approx(6.326285).epsilon(1e-6));
  CHECK(r.statistic[6] == doctest::Approx(6.041807).epsilon(1e-6));
  CHECK(r.threshold[6] == doctest::Approx(9.487729).epsilon(1e-6));
}

TEST_CASE("every pair of options alarms on honest data as often as asked for") {
  test::Rng rng(61);
  for (int system = 0; system < 4; ++system) {
    const int N = system == 0 ? 1 : test::whole(rng, 2, 4);
    const int n = test::whole(rng, 1, 3);
    Matrix A = test::normal_matrix(rng, n, n);
    A *= test::uniform(rng, 0.7, 1.0) / Eigen::JacobiSVD<Matrix>(A).singularValues()(0);
    const Model model =
        test::known_model(A, test::normal_matrix(rng, N, n), 0.1 * Matrix::Identity(n, n), 0.3);
    const Network network = N == 1 ? Network(1, std::vector<Edge>{}) : test::connected_network(rng, N);
    const auto setting = Structural::setting({}, model, network);
    std::vector<double> gain;
    for (const Matrix& K : structural::design_gains(setting, "riccati").K)
      for (const double k : by_row(0.8 * K)) gain.push_back(k);
    const std::vector<double> none;
    const auto all =
        options({{"false_alarm", {0.05, 0.02}},
                 {"window", {std::int64_t{1}, std::int64_t{2}, std::int64_t{5}, std::int64_t{10}}},
                 {"self_weight", {kNaN, 0.3}},
                 {"weights", {none, by_row(setting.W)}},
                 {"sharing", {none, by_row(setting.U)}},
                 {"gain", {none, gain}},
                 {"alarm_after", {std::int64_t{1}, std::int64_t{3}}},
                 {"clear_after", {std::int64_t{5}, std::int64_t{1}}},
                 {"settle", {std::int64_t{-1}, std::int64_t{60}}}});
    for (const Row& row : pairwise(all, rng)) {
      ParamMap params;
      std::string words;
      for (std::size_t a = 0; a < all.size(); ++a) {
        params[all[a].name] = all[a].values[row[a]];
        words += all[a].name + "=" + std::to_string(row[a]) + " ";
      }
      RunOptions o;
      o.trials = 60;
      o.seed = 5;
      const Record r =
          simulate(model, network, *make_filter("structural", params), {400, {}, 0.0, "normal"}, o);
      const double asked = std::get<double>(params["false_alarm"]);
      const test::Rate rate = test::alarm_rate(r, 61);
      CAPTURE(system);
      CAPTURE(N);
      CAPTURE(words);
      CAPTURE(rate.tested);
      CHECK(rate.mean <= asked + 4.5 * rate.error + 1e-3);
      // Isolation tests against bounds.
      if (!std::get<bool>(params["isolate"])) CHECK(rate.mean >= asked - 4.5 * rate.error - 1e-3);
      CHECK(rate.tested > 0.5);
    }
  }
}
