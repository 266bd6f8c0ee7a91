// SPDX-License-Identifier: Apache-2.0
// Certificates with memory inside runs: bounds at the edge of their promise, restarts, gaps, what is refused.
#include <doctest/doctest.h>

#include <cstring>
#include <iostream>

#include "../agents_by_hand.hpp"
#include "../certificate/memory/aligned_noise.hpp"
#include "../certificate/random_network.hpp"
#include "garrison/certificate/online/plan.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/engine/certified_network.hpp"
#include "garrison/engine/design_file.hpp"

using namespace garrison;
using certificate::Certifier;
using certificate::Spread;
using certificate::Wanted;

namespace {

constexpr std::uint64_t kSeed = 20261201;
constexpr int kSystems = test::tried(250);

Wanted remembering(Spread spread, int attacked, double failure = 1e-6) {
  Wanted wanted{spread, failure, attacked, 1000};
  wanted.memory = true;
  return wanted;
}

/// A random plant whose sources may have several outputs, of one agent or of several.
struct Case {
  Matrix A, root;  // Q = root root'
  Model model;
  Network network;
  std::vector<int> source;  // of each output
  int sources = 0;
  std::vector<int> attacked;

  bool lies(int r) const { return test::contains(attacked, source[static_cast<std::size_t>(r)]); }
  Vector deviations() const {
    Vector all(model.total_outputs());
    for (int i = 0; i < model.agents(); ++i)
      all.segment(model.offset(i), model.outputs(i)) =
          model.noise().measurement_covariance[static_cast<std::size_t>(i)].diagonal().cwiseSqrt();
    return all;
  }
  bool hears(Spread spread, int agent, int r) const {
    int owner = 0;
    while (model.offset(owner) + model.outputs(owner) <= r) ++owner;
    const auto near = network.neighbours(agent);
    return spread == Spread::flooded || owner == agent ||
           std::find(near.begin(), near.end(), owner) != near.end();
  }
};

Case draw(test::Rng& rng, int s) {
  const int n = test::whole(rng, 1, 3);
  Matrix A = Matrix::Identity(n, n) + 0.2 * test::normal_matrix(rng, n, n);
  A *= test::uniform(rng, 0.7, 1.1) / Eigen::JacobiSVD<Matrix>(A).singularValues()(0);
  const Matrix root = 0.2 * test::normal_matrix(rng, n, n);
  const int N = test::whole(rng, 2 * s + 2, 7);
  std::vector<Matrix> C, R;
  std::vector<int> source;
  const bool shared = test::whole(rng, 0, 2) == 0;  // the last two agents have one source
  Labels labels;
  for (int i = 0; i < N; ++i) {
    const int outputs = test::whole(rng, 0, 9) == 0 ? 0 : test::whole(rng, 1, 2);
    C.push_back(test::normal_matrix(rng, outputs, n));
    Vector variance(outputs);
    for (double& r : variance) r = std::pow(10.0, test::uniform(rng, -1.0, 1.0));
    R.emplace_back(variance.asDiagonal());
    for (int k = 0; k < outputs; ++k)
      labels.sources.push_back("chain " + std::to_string(shared && i == N - 1 ? N - 2 : i));
  }
  if (labels.sources.empty()) return draw(rng, s);
  std::map<std::string, int> numbers;
  for (const auto& name : labels.sources)
    source.push_back(numbers.emplace(name, static_cast<int>(numbers.size())).first->second);
  const auto sources = static_cast<int>(numbers.size());
  if (sources < 2 * s + 1) return draw(rng, s);
  Noise noise;
  noise.process_covariance = root * root.transpose();
  noise.measurement_covariance = R;
  return {A,
          root,
          Model(A, C, noise, {}, labels),
          test::connected_network(rng, N, 0.7),
          source,
          sources,
          test::choose(rng, test::whole(rng, 0, s), sources)};
}

/// Deviations of all noises of a run that leave every event of every certificate true.
double edge(const certificate::Plan& plan) {
  return (1.0 - 1e-9) *
         std::min({plan.z1, plan.z2_full, plan.z2_partial, plan.bank.z1.front(), plan.bank.z2, plan.bank.zc});
}

/// What the certificate of an agent says of x, told by its bounds on estimates far to both sides.
struct Told {
  Vector off, half;  // |x_k - c_k| and its bound
  double far;        // how far the estimates are
  bool holds = true;
};
Told told(const Certifier& certifier, const Vector& x, const Vector& direction) {
  const auto n = static_cast<std::size_t>(x.size());
  const double far = 2.0 * certifier.bound({x.data(), n}).value + 1e-3 * x.norm() + 1e-6;
  Vector low(x.size()), high(x.size());
  Vector estimate = x.array() - far;
  certifier.box({estimate.data(), n}, {low.data(), n});
  estimate = x.array() + far;
  certifier.box({estimate.data(), n}, {high.data(), n});
  Told found{(0.5 * (high - low)).cwiseAbs(), (0.5 * (high + low)).array() - far, far};
  found.holds = (low.array().min(high.array()) >= far * (1.0 - 1e-9)).all();
  for (const double sign : {-1.0, 1.0}) {
    estimate = x + sign * far * direction;
    found.holds = found.holds && certifier.bound({estimate.data(), n}).value >= far * (1.0 - 1e-9);
  }
  return found;
}

}  // namespace

TEST_CASE("banks in runs hold at the edge of their promise, whoever lies, whatever is missing") {
  test::Rng rng(kSeed);
  constexpr int kSteps = 14;
  Workers workers(1);
  std::size_t remembered = 0;
  std::size_t absent = 0;
  std::size_t proved = 0;
  int sharp = 0;
  double largest = 0.0;
  for (int k = 0; k < kSystems; ++k) {
    CAPTURE(k);
    const int s = test::whole(rng, 1, 2);
    const Case d = draw(rng, s);
    const Spread spread = k % 3 == 0 ? Spread::local : k % 3 == 1 ? Spread::direct : Spread::flooded;
    const auto plan =
        std::make_shared<const certificate::Plan>(make_plan(remembering(spread, s), d.model, d.network));
    const Matrix C = d.model.stacked();
    const Vector deviation = d.deviations();
    Matrix here(kSteps, C.rows());
    for (double& one : here.reshaped()) one = test::whole(rng, 0, 9) > 1;
    const int chosen = test::whole(rng, 0, d.model.agents() - 1);  // whom the noise is made for
    const Vector direction = test::unit_vector(rng, static_cast<int>(d.A.rows()));
    const auto noise = test::aligned_noise(
        d.A, d.root, C, deviation.cwiseAbs2(), kSteps, direction, edge(*plan),
        [&](int t, int r) { return here(t, r) != 0.0 && !d.lies(r) && d.hears(spread, chosen, r); });
    CertifiedNetwork agents(plan, d.network, 3);
    agents.reset(0);
    Vector x = std::pow(10.0, test::uniform(rng, 0.0, 5.0)) *
               test::normal_matrix(rng, static_cast<int>(d.A.rows()), 1);
    Vector other = x + std::pow(10.0, test::uniform(rng, -0.5, 2.5)) *
                           test::unit_vector(rng, static_cast<int>(d.A.rows()));
    for (int t = 1; t <= kSteps; ++t) {
      CAPTURE(t);
      if (t > 1) {
        const Vector step = d.root * noise.w.row(t - 2).transpose();
        x = d.A * x + step;
        other = d.A * other + step;
      }
      Vector y = C * x + deviation.cwiseProduct(noise.v.row(t - 1).transpose());
      for (int r = 0; r < static_cast<int>(y.size()); ++r) {
        if (d.lies(r)) y(r) = k % 4 == 0 ? y(r) + 30.0 : C.row(r).dot(other);
        if (here(t - 1, r) == 0.0) y(r) = kNaN;
      }
      agents.begin(t, y.data());
      agents.finish(workers);
      for (int i = 0; i < d.model.agents(); ++i) {
        CAPTURE(i);
        const Certifier& one = *agents.of(i);
        const Bound bound = one.bound({x.data(), static_cast<std::size_t>(x.size())});
        CHECK(bound.kind != CertificateKind::refuted);
        CHECK(one.doubts().apart == 0);  // both regions contain x
        for (const int source : one.proved()) {
          CHECK(test::contains(d.attacked, source));
          ++proved;
        }
        if (!std::isfinite(bound.value)) {
          ++absent;
          continue;
        }
        remembered += bound.kind == CertificateKind::memory ? 1 : 0;
        const Told found = told(one, x, direction);
        CHECK(found.holds);
        if (t < kSteps || i != chosen || bound.kind != CertificateKind::memory) continue;
        const double ratio = found.off.cwiseQuotient(found.half).maxCoeff();
        largest = std::max(largest, ratio);
        sharp += ratio > 0.5 ? 1 : 0;
      }
    }
  }
  std::cout << "banks in runs: " << remembered << " bounds, " << absent << " absent, " << proved
            << " proofs, largest error/box " << largest << ", above one half in " << sharp << " systems\n";
  CHECK(remembered > 20U * kSystems);
  CHECK(proved > static_cast<std::size_t>(kSystems));
  CHECK(largest > 0.9);
}

TEST_CASE("banks in runs fail less often than they say, with Gaussian noise") {
  test::Rng rng(kSeed + 1);
  constexpr double kFailure = 0.2;
  std::normal_distribution<double> normal;
  Workers workers(1);
  int bounds = 0;
  int wrong = 0;
  for (int k = 0; k < kSystems; ++k) {
    const Case d = draw(rng, 1);
    const auto plan = std::make_shared<const certificate::Plan>(
        make_plan(remembering(Spread::flooded, 1, kFailure), d.model, d.network));
    const Matrix C = d.model.stacked();
    const Vector deviation = d.deviations();
    CertifiedNetwork agents(plan, d.network, 3);
    agents.reset(0);
    Vector x = 10.0 * test::normal_matrix(rng, static_cast<int>(d.A.rows()), 1);
    for (int t = 1; t <= 40; ++t) {
      x = d.A * x + d.root * test::normal_matrix(rng, static_cast<int>(d.root.cols()), 1);
      Vector y = C * x;
      for (int r = 0; r < static_cast<int>(y.size()); ++r)
        y(r) += deviation(r) * (normal(rng) + (d.lies(r) ? 3.0 : 0.0));
      agents.begin(t, y.data());
      agents.finish(workers);
      const Bound bound = agents.of(0)->bound({x.data(), static_cast<std::size_t>(x.size())});
      if (std::isinf(bound.value)) continue;
      ++bounds;
      wrong += std::isnan(bound.value) ||
                       !told(*agents.of(0), x, test::unit_vector(rng, static_cast<int>(x.size()))).holds
                   ? 1
                   : 0;
    }
  }
  std::cout << "banks in runs, failure " << kFailure << ": " << wrong << " of " << bounds << " wrong\n";
  CHECK(bounds > 30 * kSystems);
  CHECK(wrong < kFailure * bounds);
}

TEST_CASE(
    "banks hold through lost messages and restarts, the same in engine and agents, and after a snapshot") {
  test::Rng rng(kSeed + 2);
  constexpr int kSteps = 25;
  int bounds = 0;
  std::size_t proved = 0;
  for (int k = 0; k < kSystems / 5; ++k) {
    CAPTURE(k);
    const Case d = draw(rng, 1);
    const Spread spread = k % 3 == 0 ? Spread::local : k % 3 == 1 ? Spread::direct : Spread::flooded;
    const auto filter = make_filter("scalar_gain", {{"rounds", std::int64_t{3}}});
    const auto prepared = certified(*filter->prepare(d.model, d.network), remembering(spread, 1));
    const double length = edge(*prepared->certificate());
    const Matrix C = d.model.stacked();
    const Vector deviation = d.deviations();
    const Vector all = test::unit_vector(
        rng, kSteps * static_cast<int>(C.rows() + d.root.cols()));  // deviations of all noises of the run
    Eigen::Index at = 0;
    const auto next = [&](Eigen::Index count) {
      at += count;
      return Vector(length * all.segment(at - count, count));
    };
    const auto n = static_cast<int>(d.A.rows());
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Rows y(kSteps, C.rows());
    Rows truth(kSteps + 1, n);
    Vector x = 10.0 * test::normal_matrix(rng, n, 1);
    truth.row(0) = x.transpose();
    for (int t = 0; t < kSteps; ++t) {
      x = d.A * x + d.root * next(d.root.cols());
      truth.row(t + 1) = x.transpose();
      const Vector v = deviation.cwiseProduct(next(C.rows()));
      for (int r = 0; r < static_cast<int>(C.rows()); ++r)
        y(t, r) = C.row(r).dot(x) + v(r) + (d.lies(r) ? 7.0 : 0.0);
    }
    RunOptions o;
    o.seed = static_cast<std::uint64_t>(k);
    o.link = {0.2, 0.1, 2, {{2, -1, 5, 9}}, {}};
    o.keep.box = true;
    const Record record = replay(*prepared, Log{y.data(), truth.data(), 1, kSteps}, o);
    const Link link(d.network, o.link, {}, o.seed, 0);
    test::AgentsByHand agents(*prepared, d.network, &link);
    for (int t = 1; t <= kSteps; ++t) {
      CAPTURE(t);
      agents.step(t, [&](int i) {
        return Vector(y.row(t - 1).segment(d.model.offset(i), d.model.outputs(i)).transpose());
      });
      if (t == 11)
        for (int i = 0; i < d.model.agents(); ++i) {
          std::vector<std::byte> snapshot(agents[i].snapshot_bytes());
          REQUIRE(agents[i].save(snapshot) == snapshot.size());
          agents.all()[static_cast<std::size_t>(i)] = read_part(write_part(*prepared, i));
          REQUIRE(agents[i].load(snapshot) == Refusal::none);
        }
      for (int i = 0; i < d.model.agents(); ++i) {
        const auto now = static_cast<std::size_t>(t * d.model.agents() + i);
        const Report report = agents[i].report();
        std::vector<double> box(static_cast<std::size_t>(n));
        agents[i].box(box);
        CHECK(std::memcmp(&report.bound, &record.bound[now], sizeof(double)) == 0);
        CHECK(report.kind == static_cast<CertificateKind>(record.bound_kind[now]));
        CHECK(std::memcmp(box.data(), &record.box[now * box.size()], box.size() * sizeof(double)) == 0);
        CHECK(report.kind != CertificateKind::refuted);
        CHECK_FALSE(record.error[now] > report.bound);
        for (std::size_t j = 0; j < box.size(); ++j)
          CHECK_FALSE(std::abs(record.estimate[now * box.size() + j] -
                               truth(t, static_cast<Eigen::Index>(j))) > box[j]);
        bounds += report.kind == CertificateKind::memory ? 1 : 0;
      }
    }
    CHECK(std::none_of(record.doubted.begin(), record.doubted.end(), [](const Record::Doubted& one) {
      return one.doubts.refuted > 0 || one.doubts.apart > 0;
    }));
    for (int i = 0; i < d.model.agents(); ++i) {
      CHECK(record.proved.back().sets[static_cast<std::size_t>(i)] == agents[i].proved());
      for (const int source : agents[i].proved()) CHECK(test::contains(d.attacked, source));
      proved += agents[i].proved().size();
    }
    // One that starts anew in the middle knows nothing, and has a bound again from what comes later.
    agents[0].reset(Vector::Zero(n), kSteps);
    CHECK(agents[0].proved().empty());
    CHECK(agents[0].report().kind == CertificateKind::too_few);
  }
  std::cout << "banks with lost messages: " << bounds << " bounds, " << proved << " proofs at the end\n";
  CHECK(bounds > 10 * kSystems);
  if (kSystems >= 200) CHECK(proved > 10);  // the few of the sanitizers prove nothing
}

TEST_CASE("process noise ten times as large as modelled puts regions with and without memory apart") {
  test::Rng rng(kSeed + 5);
  std::normal_distribution<double> normal;
  Workers workers(1);
  constexpr int kRuns = 40;
  int apart = 0;
  for (int k = 0; k < kRuns; ++k) {
    CAPTURE(k);
    const int n = 1;
    const int N = test::whole(rng, 12, 16);
    const int s = test::whole(rng, 0, 1);
    const double size = test::uniform(rng, 0.1, 0.15);  // deviation of the process noise that is modelled
    Noise noise;
    noise.process_covariance = size * size * Matrix::Identity(n, n);
    noise.measurement_covariance.assign(static_cast<std::size_t>(N), Matrix::Identity(n, n));
    const Model model(0.95 * Matrix::Identity(n, n),
                      std::vector<Matrix>(static_cast<std::size_t>(N), Matrix::Identity(n, n)), noise);
    const Network network = Network::complete(N);
    const auto plan =
        std::make_shared<const certificate::Plan>(make_plan(remembering(Spread::direct, s), model, network));
    for (const double times : {1.0, 10.0}) {
      CertifiedNetwork agents(plan, network, 1);
      agents.reset(0);
      Vector x = Vector::Zero(n);
      for (int t = 1; t <= 100; ++t) {
        x = 0.95 * x + times * size * test::normal_matrix(rng, n, 1);
        Vector y(N * n);
        for (Eigen::Index r = 0; r < y.size(); ++r) y(r) = x(r % n) + normal(rng);
        agents.begin(t, y.data());
        agents.finish(workers);
        const Bound bound = agents.of(0)->bound({x.data(), static_cast<std::size_t>(n)});
        CHECK(std::isfinite(bound.value));  // the sample alone says something, also where memory is refuted
      }
      const certificate::Doubts found = agents.of(0)->doubts();
      if (times == 1.0) {
        CHECK(found.apart + found.refuted == 0);
        continue;
      }
      if (found.apart == 0) continue;
      ++apart;
      CHECK(found.apart_at >= 1);
      CHECK(found.apart_in < n);
      agents.reset(0);
      CHECK_FALSE(agents.of(0)->doubts().any());
    }
  }
  std::cout << "process noise ten times as large: regions apart in " << apart << " of " << kRuns << " runs\n";
  CHECK(apart > kRuns / 2);
}

TEST_CASE("six position sensors of a double integrator, two lying: agents that hear all prove both") {
  test::Rng rng(kSeed + 3);
  std::normal_distribution<double> normal;
  const double dt = 0.1;
  const Matrix A = (Matrix(2, 2) << 1.0, dt, 0.0, 1.0).finished();
  const Vector push = 0.5 * Vector{{0.5 * dt * dt, dt}};  // acceleration of deviation 0.5
  Noise noise;
  noise.process_covariance = push * push.transpose();
  noise.measurement_covariance.assign(6, Matrix::Identity(1, 1));
  const Model model(A, std::vector<Matrix>(6, (Matrix(1, 2) << 1.0, 0.0).finished()), noise);
  const Network network = Network::complete(6);
  Workers workers(1);
  for (const Spread spread : {Spread::direct, Spread::flooded}) {
    const auto plan =
        std::make_shared<const certificate::Plan>(make_plan(remembering(spread, 2), model, network));
    CertifiedNetwork agents(plan, network, 2);
    agents.reset(0);
    Vector x = Vector{{0.0, 1.0}};
    Vector mean = Vector::Zero(2);
    for (int t = 1; t <= 300; ++t) {
      x = A * x + push * normal(rng);
      Vector y(6);
      for (double& value : y) value = x(0) + normal(rng);
      y(1) += 60.0;
      y(4) += 60.0;
      agents.begin(t, y.data());
      agents.finish(workers);
      for (int i = 0; i < 6; ++i) {
        const Certifier& one = *agents.of(i);
        const auto kind = one.bound({x.data(), 2}).kind;
        CHECK(kind == (t < 2 ? CertificateKind::too_few : CertificateKind::memory));
        if (t < 2) continue;
        const Told found = told(one, x, Vector{{1.0, 0.0}});
        CHECK(found.holds);
        if (t > 200) mean += found.half / 600.0;
        if (t > 10)
          CHECK(std::vector<int>(one.proved().begin(), one.proved().end()) == std::vector<int>{1, 4});
      }
    }
    std::cout << "double integrator in a run: box " << mean.transpose() << "\n";
    CHECK(mean(0) == doctest::Approx(1.0).epsilon(0.15));
    CHECK(mean(1) == doctest::Approx(1.05).epsilon(0.2));
  }
}

TEST_CASE("a bank goes on through gaps, and starts anew after long ones and after a refutation") {
  Noise noise;
  noise.process_covariance = Matrix::Constant(1, 1, 0.01);
  noise.measurement_covariance = {Matrix::Identity(4, 4)};
  Labels labels;
  labels.sources = {"a", "b", "c", "d"};
  const Model model(Matrix::Identity(1, 1), {Matrix::Ones(4, 1)}, noise, {}, labels);
  const Network network(1, {});
  const auto plan =
      std::make_shared<const certificate::Plan>(make_plan(remembering(Spread::local, 1), model, network));
  const auto certifier = make_certifier(plan, 0, {}, 0);
  certifier->reset(0);
  const double x = 0.0;
  const std::vector<double> honest{0.0, 0.0, 0.0, 0.0};
  const std::vector<double> silent(4, kNaN);
  const std::vector<double> lying{0.0, 0.0, 90.0, 0.0};
  const auto at = [&](std::int64_t t, const std::vector<double>& y) {
    certifier->begin(t, y.data(), nullptr);
    return certifier->bound({&x, 1});
  };
  for (int t = 1; t <= 50; ++t) at(t, lying);
  CHECK(std::vector<int>(certifier->proved().begin(), certifier->proved().end()) == std::vector<int>{2});
  const Bound sharp = at(51, honest);
  CHECK(sharp.kind == CertificateKind::memory);
  double last = sharp.value;
  for (int t = 52; t <= 60; ++t) {
    const Bound bound = at(t, silent);
    CHECK(bound.value > last);
    CHECK(bound.kind == CertificateKind::memory);
    last = bound.value;
  }
  CHECK(at(900, silent).kind == CertificateKind::memory);
  CHECK(certifier->proved().size() == 1);
  CHECK(at(900 + 1001, silent).value == kInfinity);
  CHECK(certifier->proved().empty());
  CHECK(at(1902, honest).value < kInfinity);
  for (int t = 1903; t <= 1950; ++t) at(t, lying);
  CHECK(certifier->proved().size() == 1);
  // Another one lies from now on: that no source lied before is false now. W holds all the same.
  const std::vector<double> moved{0.0, 0.0, 0.0, 90.0};
  CHECK(at(1951, moved).kind == CertificateKind::witness);
  CHECK(certifier->doubts().refuted == 1);
  CHECK(certifier->doubts().refuted_at == 1951);
  CHECK(certifier->proved().empty());
  for (int t = 1952; t <= 2000; ++t) CHECK(std::isfinite(at(t, moved).value));
  CHECK(std::vector<int>(certifier->proved().begin(), certifier->proved().end()) == std::vector<int>{3});
  // Two in one sample: more than there may be.
  CHECK(at(2001, {90.0, -90.0, 0.0, 0.0}).kind == CertificateKind::refuted);
}

TEST_CASE("what a bank in a run cannot rest on is refused by name") {
  test::Rng rng(kSeed + 4);
  const Model model = test::scalar_model(rng, 2, 30, 0.98, 0.02, 0.01);
  const Network network = Network::complete(30);
  const auto refused = [&](const Model& of, Wanted wanted, const char* why) {
    wanted.memory = true;
    CHECK_THROWS_WITH_AS(make_plan(wanted, of, network), doctest::Contains(why), InvalidInput);
  };
  refused(model, {Spread::local, 0.0, 1, 1000}, "memory: got true with failure = 0");
  refused(model, {Spread::local, 1e-6, 1, 1000, 6.0, 5.5}, "memory: got true with levels");
  refused(model, {Spread::direct, 1e-6, 3, 1000}, "hears 30 sources with 3 attacked: 4060 filters");
  Noise noise = model.noise();
  noise.process_covariance.resize(0, 0);
  std::vector<Matrix> C;
  for (int i = 0; i < 30; ++i) C.push_back(model.C(i));
  refused(Model(model.A(), C, noise), {Spread::local, 1e-6, 1, 1000}, "without process_covariance");
}
