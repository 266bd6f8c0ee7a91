// SPDX-License-Identifier: Apache-2.0
// Vehicles that are only observed, what is known of their noise and inputs, and what is said when it is
// false.
#include <doctest/doctest.h>

#include "string_by_hand.hpp"

using namespace garrison;

namespace {

ParamMap observer() {
  return {{"attacked", std::int64_t{1}},
          {"process_noise", 0.01},
          {"measurement_noise", 0.1},
          {"initial_error", 10.0}};
}

/// Five cars, 20 m apart, with accelerations u(t, i); position and velocity without noise.
struct Cars {
  Matrix y;  // absolute, relative, and the input where `inputs`
  Matrix truth;
  Matrix start;
};
template <class Input>
Cars cars(int steps, bool inputs, const Input& u) {
  constexpr int N = 5;
  const Model model = platoon::model(N, 0.1, inputs);
  Cars c{Matrix(steps + 1, model.total_outputs()), Matrix(steps + 1, 2 * N), Matrix(2, N)};
  Vector x(2 * N);
  for (int i = 0; i < N; ++i) {
    x(2 * i) = -20.0 * i;
    x(2 * i + 1) = 20.0;
  }
  for (int i = 0; i < N; ++i) c.start.col(i) = x.segment(2 * i, 2);
  for (int t = 0; t <= steps; ++t) {
    c.truth.row(t) = x;
    for (int i = 0; i < N; ++i) {
      const int at = model.offset(i);
      c.y.row(t).segment(at, 2) = x.segment(2 * i, 2);
      if (i > 0) c.y.row(t).segment(at + 2, 2) = x.segment(2 * i, 2) - x.segment(2 * i - 2, 2);
      if (inputs) c.y(t, at + model.outputs(i) - 1) = u(t, i);
    }
    for (int i = 0; i < N; ++i) {
      x(2 * i) += 0.1 * x(2 * i + 1);
      x(2 * i + 1) += 0.1 * u(t, i);
    }
  }
  return c;
}

/// A replay in which no bound may be violated and nobody be accused.
Record observed(const Cars& c, bool inputs, const ParamMap& params) {
  RunOptions o;
  o.start = c.start;
  const Record r = replay(platoon::model(5, 0.1, inputs), Network::band(5, 2),
                          *make_filter("platoon", params), c.y, c.truth, o);
  int violated = 0;
  for (std::size_t k = 0; k < r.error.size(); ++k) violated += r.error[k] > r.bound[k] ? 1 : 0;
  CHECK(violated == 0);
  for (const auto& a : r.accusations)
    for (const auto& set : a.sets) CHECK(set.empty());
  CHECK(r.warnings.empty());
  return r;
}

std::string refusal(const ParamMap& params, const Model& model, const MatrixRef& y) {
  try {
    replay(model, Network::band(5, 2), *make_filter("platoon", params), y, Matrix(), {});
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}
bool has(const std::string& message, const std::string& part) {
  return message.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE(
    "five cars at constant speed without recorded inputs: refused by name, or observed within a stated "
    "bound") {
  const Cars c = cars(60, false, [](int, int) { return 0.0; });
  ParamMap control = observer();
  control["reference"] = std::vector<double>{0.0, 10.0};
  control["gs"] = 0.5;
  control["gv"] = 1.0;
  CHECK(has(refusal(control, platoon::model(5, 0.1), c.y), "without their inputs"));
  CHECK(has(refusal(observer(), platoon::model(5, 0.1), c.y), "input_bound"));
  ParamMap params = observer();
  params["input_bound"] = 1.0;
  const Record r = observed(c, false, params);
  for (std::size_t k = 20 * 5; k < r.error.size(); ++k) {
    CHECK(r.error[k] < 0.1);  // it was 294 m
    CHECK(r.bound[k] < 5.0);
  }
  // With inputs that say what happened the controller's own commands do not matter.
  const Cars told = cars(60, true, [](int, int) { return 0.0; });
  observed(told, true, control);
  observed(told, true, observer());
}

TEST_CASE("inputs that nobody tells: every bound holds while they stay within theirs") {
  test::Rng rng(41);
  for (int run = 0; run < 40; ++run) {
    const double most = test::uniform(rng, 0.0, 4.0);
    const auto law = test::whole(rng, 0, 2);
    const auto u = [&](int t, int i) {
      if (law == 0) return most;
      if (law == 1) return most * (t / 7 % 2 == 0 ? 1.0 : -1.0) * (i % 2 == 0 ? 1.0 : -1.0);
      return most * std::sin(0.3 * t + i);
    };
    ParamMap params = observer();
    params["input_bound"] = most;
    if (run % 2 == 0) params["median"] = true;
    observed(cars(80, false, u), false, params);
    // Some inputs are told, some not; without a bound nothing is claimed where one is missing.
    Cars gaps = cars(80, true, u);
    const Model model = platoon::model(5, 0.1, true);
    for (int t = 0; t <= 80; ++t)
      for (int i = 0; i < 5; ++i)
        if (test::uniform(rng, 0, 1) < 0.3) gaps.y(t, model.offset(i) + model.outputs(i) - 1) = kNaN;
    observed(gaps, true, params);
    observed(gaps, true, observer());
    ParamMap control = observer();
    control["reference"] = std::vector<double>{0.0, 10.0};
    control["gs"] = 0.5;
    control["gv"] = 1.0;
    CHECK(has(refusal(control, model, gaps.y), "missing inputs of vehicle 0"));
  }
}

TEST_CASE("what control lacks is named, and so is what observation has no use for") {
  const Model model = platoon::model(5, 0.1);
  const auto fails = [&](const ParamMap& params) {
    try {
      make_filter("platoon", params)->prepare(model, Network::band(5, 2));
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  ParamMap params = observer();
  params["gs"] = 0.5;
  CHECK(has(fails(params), "platoon.reference: got none"));
  params["reference"] = std::vector<double>{0.0, 10.0};
  CHECK(has(fails(params), "platoon.gv: got none"));
  params["gv"] = 1.0;
  CHECK(fails(params).empty());
  params["input_bound"] = 1.0;
  CHECK(has(fails(params), "platoon.input_bound: got 1"));
  ParamMap silent = observer();
  silent.erase("measurement_noise");
  silent["input_bound"] = 1.0;
  CHECK(has(fails(silent), "platoon.measurement_noise: got none"));
  // Nobody drives vehicles that are only observed.
  params = observer();
  params["input_bound"] = 1.0;
  CHECK(fails(params).empty());
  CHECK_THROWS_WITH_AS(
      simulate(model, Network::band(5, 2), *make_filter("platoon", params), {10, {}, 0.0, "auto", {}}, {}),
      doctest::Contains("simulated vehicles"), InvalidInput);
}

TEST_CASE("a gap costs what the powers of A cost, not the powers of its norm") {
  const double T = 0.1;
  const double eps = 0.06;
  const int N = 7;
  test::Platoon p{{}, {}, platoon::model(N, T), Network::band(N, 2)};
  p.params = {{"attacked", std::int64_t{1}},
              {"process_noise", eps},
              {"measurement_noise", 0.4},
              {"initial_error", 10.0},
              {"gs", 0.5},
              {"gv", 1.0},
              {"reference", std::vector<double>{0.0, 20.0}}};
  test::Start start{Vector(2 * N), Matrix(2, N)};
  for (int i = 0; i < N; ++i) {
    start.x0.segment(2 * i, 2) = Vector{{-20.0 * i, 20.0}};
    start.estimate.col(i) = start.x0.segment(2 * i, 2);
  }
  test::StringByHand string(p, p.params, start, 5, "extreme");
  test::Promises kept;
  const int stop = 100;
  std::vector<double> before;
  double sum = 0.0;
  for (int t = 0; t <= stop + 600; ++t) {
    string.step(t, 0.0, t > stop ? 1.0 : 0.0);
    string.judge({}, kept);
    const int k = t - stop;
    for (int i = 0; i < N && k == 0; ++i) before.push_back(string.bound(i));
    if (k <= 0) continue;
    sum += eps * platoon::norm_A((k - 1) * T);
    for (int i = 0; i < N; ++i) {
      const double right = platoon::norm_A(k * T) * before[static_cast<std::size_t>(i)] + sum;
      CHECK(string.bound(i) <= (k < 200 ? 1.5 : 1.1) * right);  // entry by entry: sqrt 2 at first
      if (k == 200) CHECK(string.bound(i) < 250.0);
      if (k == 600) CHECK(string.bound(i) < 1500.0);
    }
  }
  CHECK(kept.bounds_violated == 0);
  CHECK(kept.gaps_violated == 0);
}

TEST_CASE("separate bounds of the noise hold where every entry is on its bound: 300 strings") {
  test::Rng rng(42);
  double joint_sum = 0.0;
  double separate_sum = 0.0;
  for (int run = 0; run < 300; ++run) {
    auto p = test::random_platoon(rng);
    const int N = p.setting.vehicles;
    const char* const names[] = {"absolute_position_noise", "absolute_velocity_noise",
                                 "relative_position_noise", "relative_velocity_noise"};
    double most[4];
    ParamMap separate = p.params;
    for (int k = 0; k < 4; ++k) separate[names[k]] = most[k] = p.setting.mu * test::uniform(rng, 0.02, 0.7);
    if (run % 2 == 0) separate.erase("measurement_noise");
    if (run % 3 == 0)
      for (const char* name : {"pairs", "neighbours", "median"}) separate[name] = true;
    if (run % 4 == 0) separate["bound"] = std::string("tight");
    const int steps = 35;
    Matrix noise = Matrix::Zero(steps + 1, platoon::kDisturbances * N);
    const auto entry = [&](double bound) {
      const double side = test::uniform(rng, -1, 1);
      return bound * (run % 5 == 0 ? side : std::copysign(1.0, side)) * (1.0 - 1e-12);
    };
    for (int t = 0; t <= steps; ++t)
      for (int i = 0; i < N; ++i) {
        const int at = platoon::kDisturbances * i;
        const double angle = test::uniform(rng, 0, 6.28);
        noise(t, at) = p.setting.eps * (1.0 - 1e-12) * std::cos(angle);
        noise(t, at + 1) = p.setting.eps * (1.0 - 1e-12) * std::sin(angle);
        noise(t, at + 2) = entry(most[0]);
        noise(t, at + 3) = entry(most[1]);
        noise(t, at + 5) = entry(most[2]);
        noise(t, at + 6) = entry(most[3]);
      }
    const auto victims = test::random_victims(rng, p.setting);
    const auto start = test::random_start(rng, p.setting);
    const auto attacks = test::random_attack(rng, p.setting, victims);
    const auto last = [&](const ParamMap& params) {
      test::StringByHand string(p, params, start, static_cast<std::uint64_t>(run), "auto", &noise);
      string.attack(attacks);
      test::Promises kept;
      for (int t = 0; t <= steps; ++t) {
        string.step(t, run % 2 == 0 ? 0.0 : 0.2);
        string.judge(victims, kept);
      }
      CAPTURE(run);
      CHECK(kept.bounds_violated == 0);
      CHECK(kept.gaps_violated == 0);
      CHECK(kept.accused_clean == 0);
      CHECK(kept.cleared_attacked == 0);
      CHECK(kept.doubted == 0);
      double sum = 0.0;
      for (int i = 0; i < N; ++i) sum += std::isnan(string.bound(i)) ? 0.0 : string.bound(i) / p.setting.q;
      return sum;
    };
    joint_sum += last(p.params);
    separate_sum += last(separate);
  }
  CHECK(separate_sum < joint_sum);
}

TEST_CASE("noise bounds understated by a quarter, and more attackers than allowed, are named in a warning") {
  test::Rng rng(43);
  int named = 0;
  int runs = 0;
  while (runs < 60) {
    const auto p = test::random_platoon(rng);
    const int N = p.setting.vehicles;
    if (N < 2 * p.setting.range + 3 || p.setting.attacked > 2)
      continue;  // strings with somebody to contradict
    ++runs;
    const int steps = 200;
    const double mu = p.setting.mu / 0.75;
    Matrix noise = Matrix::Zero(steps + 1, platoon::kDisturbances * N);
    for (int t = 0; t <= steps; ++t)
      for (int i = 0; i < N; ++i)
        for (const int at : {2, 5}) {
          const double angle = test::uniform(rng, 0, 6.283185307179586);
          noise(t, platoon::kDisturbances * i + at) = mu * std::cos(angle);
          noise(t, platoon::kDisturbances * i + at + 1) = mu * std::sin(angle);
        }
    const auto start = test::random_start(rng, p.setting);
    RunOptions o;
    o.start = start.estimate;
    const Record r = simulate(p.model, p.network, *make_filter("platoon", p.params),
                              {steps, start.x0, 0.0, "auto", noise}, o);
    const bool says = !r.warnings.empty() && has(r.warnings[0], "measurement_noise");
    named += says ? 1 : 0;
    if (!says) continue;
    // Doubt reaches everybody in the end; then nobody is called attacked, and nothing cleared.
    const auto last = static_cast<std::size_t>(steps) * static_cast<std::size_t>(N);
    for (std::size_t i = 0; i < static_cast<std::size_t>(N); ++i) {
      if (!std::isnan(r.bound[last + i])) continue;
      CHECK(r.verdict[last + i] != static_cast<std::uint8_t>(Verdict::attacked));
      CHECK(r.verdict[last + i] != static_cast<std::uint8_t>(Verdict::cleared));
      CHECK(r.accusations.back().sets[i].empty());
    }
  }
  CHECK(named >= 57);
}
