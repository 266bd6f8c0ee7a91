// SPDX-License-Identifier: Apache-2.0
// A program of its own: it counts every call of operator new while a step runs.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "../every_filter.hpp"
#include "../random_system.hpp"
#include "garrison/certificate/interval.hpp"
#include "garrison/certificate/memory/anytime_window.hpp"
#include "garrison/certificate/memory/bank.hpp"
#include "garrison/certificate/memory/leverage_window.hpp"
#include "garrison/certificate/memory/subsets_window.hpp"
#include "garrison/certificate/order_rule.hpp"
#include "garrison/certificate/propagate.hpp"
#include "garrison/certificate/relay.hpp"
#include "garrison/certificate/subsets.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/filters/platoon/world.hpp"

namespace {
std::atomic<bool> armed{false};
std::atomic<long> count{0};

void* counted(std::size_t size, std::size_t alignment) {
  if (armed) ++count;
  void* memory = alignment > alignof(std::max_align_t)
                     ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                     : std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
/// Not inlined: gcc would see `free` next to a `new` and warn that they do not belong together.
[[gnu::noinline]] void release(void* memory) noexcept { std::free(memory); }
}  // namespace

void* operator new(std::size_t size) { return counted(size, 0); }
void* operator new[](std::size_t size) { return counted(size, 0); }
void* operator new(std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return counted(size, 0); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return counted(size, 0); }
void operator delete(void* p) noexcept { release(p); }
void operator delete[](void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t) noexcept { release(p); }
void operator delete(void* p, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { release(p); }

using namespace garrison;

TEST_CASE("the counter counts") {
  armed = true;
  int* volatile kept = new int(3);  // volatile: a compiler may leave out a pair of new and delete
  delete kept;
  armed = false;
  CHECK(count == 1);
}

TEST_CASE("no step of any family allocates, at any dimension, on good and on bad links") {
  for (int n = 1; n <= 9; ++n) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    const Model model = test::scalar_model(rng, n, 8, 0.98, 0.02, 0.01);
    const Network network = test::connected_network(rng, 8);
    for (const auto& filter : test::every_filter()) {
      const auto runner = filter->prepare(model, network)->runner(1);
      for (const bool faults : {false, true}) {
        Link link(network, {0.2, 0.2, 3, {}, {}},
                  {forge(Schedule(3, {1}), 2.0, false), equivocate(Schedule(2, {4}), 1.0)}, 1, 0);
        runner->reset(Matrix::Zero(n, 8), faults ? &link : nullptr);
        std::vector<double> y(8);
        for (int t = 1; t <= 40; ++t) {
          for (double& v : y) v = test::uniform(rng, -1, 1);
          if (t == 10) y[2] = 50.0;  // proves an attack: sets differ and are flooded
          if (t == 15) y[3] = kNaN;
          count = 0;
          armed = true;
          runner->step(t, y.data());
          armed = false;
          CAPTURE(n);
          CAPTURE(filter->name());
          CAPTURE(faults);
          CHECK(count == 0);
        }
      }
    }
  }
}

TEST_CASE("no step with a certificate allocates, on good and on bad links") {
  using certificate::Spread;
  for (const int n : {1, 2, 9}) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    const Model model = test::scalar_model(rng, n, 8, 0.98, 0.02, 0.01);
    const Network network = test::connected_network(rng, 8);
    for (const auto& filter : test::every_filter()) {
      const auto plain = filter->prepare(model, network);
      for (const certificate::Wanted& wanted :
           {certificate::Wanted{Spread::local, 1e-6, 1, 1000},
            certificate::Wanted{Spread::flooded, 1e-6, 1, 1000},
            certificate::Wanted{Spread::flooded, 1e-6, 1, 0},
            certificate::Wanted{Spread::local, 0.0, 1, 1000},
            certificate::Wanted{Spread::flooded, 1e-6, 1, 1000, 0.0, 0.0, true},
            certificate::Wanted{Spread::direct, 1e-6, 1, 1000, 0.0, 0.0, true}}) {
        const auto runner = certified(*plain, wanted)->runner(1);
        Link link(network, {0.2, 0.2, 3, {}, {}}, {}, 1, 0);
        for (const bool faults : {false, true}) {
          runner->reset(Matrix::Zero(n, 8), faults ? &link : nullptr);
          std::vector<double> y(8);
          for (int t = 1; t <= 20; ++t) {
            for (double& v : y) v = test::uniform(rng, -0.1, 0.1);
            if (t == 10) y[2] = 50.0;
            if (t == 15) y[3] = kNaN;
            count = 0;
            armed = true;
            runner->step(t, y.data());
            armed = false;
            CAPTURE(n);
            CAPTURE(filter->name());
            CAPTURE(faults);
            CHECK(count == 0);
          }
        }
      }
    }
  }
}

TEST_CASE("no step allocates where some outputs of a sensor are missing") {
  for (const int n : {2, 9}) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    std::vector<Matrix> C;
    Noise noise;
    noise.process_covariance = 0.1 * Matrix::Identity(n, n);
    for (int i = 0; i < 4; ++i) {
      C.push_back(test::normal_matrix(rng, 3, n));
      noise.measurement_covariance.push_back(Matrix::Identity(3, 3) + 0.2 * Matrix::Ones(3, 3));
    }
    const Model model(0.9 * Matrix::Identity(n, n), C, noise);
    const Network network = test::connected_network(rng, 4);
    for (const std::string penalty : {"norm", "huber", "l1", "group"}) {
      const auto filter = make_filter("rdkf", {{"weight", 1.0}, {"penalty", penalty}});
      const auto runner = filter->prepare(model, network)->runner(1);
      runner->reset(Matrix::Zero(n, 4), nullptr);
      std::vector<double> y(12);
      count = 0;
      for (int t = 1; t <= 40; ++t) {
        for (double& v : y) v = test::uniform(rng, 0, 1) < 0.3 ? kNaN : test::uniform(rng, -1, 1);
        armed = true;
        runner->step(t, y.data());
        armed = false;
      }
      CAPTURE(penalty);
      CHECK(count == 0);
    }
  }
}

namespace {

/// Allocations of 40 samples of agents driven by bytes: everything a node does with them.
long allocations_by_hand(const AnyFilter& filter, const Model& model, const Network& network) {
  const auto prepared = filter.prepare(model, network);
  std::vector<std::unique_ptr<Agent>> agents;
  std::vector<std::vector<std::byte>> sent;
  std::vector<std::size_t> bytes(static_cast<std::size_t>(model.agents()));
  for (int i = 0; i < model.agents(); ++i) {
    agents.push_back(prepared->agent(i));
    sent.emplace_back(agents.back()->most_bytes());
  }
  std::vector<std::byte> snapshot(agents[0]->snapshot_bytes());
  std::vector<double> x(static_cast<std::size_t>(model.states()));
  std::vector<double> y(static_cast<std::size_t>(model.outputs(0)));
  count = 0;
  armed = true;
  for (int t = 1; t <= 40; ++t) {
    const int rounds = agents[0]->rounds();
    for (std::size_t i = 0; i < agents.size(); ++i) {
      for (double& v : y) v = t == 7 ? kNaN : t == 9 ? kInfinity : t == 11 && i == 2 ? 50.0 : 0.01 * t;
      bytes[i] = agents[i]->sense(t, y, sent[i]).bytes;
    }
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t i = 0; i < agents.size(); ++i)
        for (const int j : agents[i]->neighbours())
          if ((t + j) % 5 != 0)
            agents[i]->deliver(
                {j, t, round},
                std::span(sent[static_cast<std::size_t>(j)]).first(bytes[static_cast<std::size_t>(j)]));
      for (std::size_t i = 0; i < agents.size(); ++i) bytes[i] = agents[i]->fuse(sent[i]).bytes;
    }
    for (const auto& agent : agents) {
      (void)agent->report();
      agent->estimate(x);
      (void)agent->control();
    }
    if (t % 10 == 0) {
      agents[0]->load(std::span(snapshot).first(agents[0]->save(snapshot)));
      agents[0]->uncover();
    }
    if (t == 20 && agents[1]->listen(t + 1) == Refusal::none) {
      agents[1]->join();
      t += 1;  // the others catch up on what they missed
    }
  }
  armed = false;
  return count;
}

}  // namespace

TEST_CASE("agents driven by bytes do not allocate") {
  for (const int n : {1, 4, 8, 9}) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    const Model model = test::scalar_model(rng, n, 5, 0.98, 0.02, 0.01);
    const Network network = test::connected_network(rng, 5);
    for (const auto& filter : test::every_filter()) {
      CAPTURE(n);
      CAPTURE(filter->name());
      CHECK(allocations_by_hand(*filter, model, network) == 0);
    }
  }
}

TEST_CASE("no step of a string of vehicles allocates, attacked, on good and on bad links") {
  const Model model = platoon::model(9, 0.01);
  const Network network = Network::band(9, 3);
  ParamMap base{{"reference", std::vector<double>{0.0, 10.0}}, {"gs", 50.0}, {"gv", 50.0}};
  base.insert({{"process_noise", 0.1}, {"measurement_noise", 0.1}, {"attacked", std::int64_t{2}}});
  ParamMap plain = base;
  plain.insert({{"threshold", 200.0}, {"initial_error", 300.0}});
  ParamMap strong = plain;
  strong.insert({{"pairs", true}, {"neighbours", true}, {"median", true}});
  strong.insert({{"count", std::string("cover")}, {"bound", std::string("tight")}});
  base["kind"] = std::string("pbe");
  for (const auto& filter : {make_filter("platoon", plain), make_filter("platoon", strong),
                             make_filter("platoon_baseline", base)}) {
    const auto runner = filter->prepare(model, network)->runner(1);
    for (const bool faults : {false, true}) {
      Link link(network, {0.2, 0.2, 3, {}, {}}, {forge(Schedule(3, {1}), 2.0, false)}, 1, 0);
      Matrix start = Matrix::Zero(2, 9);
      for (int i = 0; i < 9; ++i) start(0, i) = -20.0 * i;
      runner->reset(start, faults ? &link : nullptr);
      std::vector<double> y(static_cast<std::size_t>(model.total_outputs()));
      std::vector<double> u(9);
      test::Rng rng(3);
      for (int t = 0; t <= 40; ++t) {
        for (int i = 0; i < 9; ++i) {
          double* own = y.data() + model.offset(i);
          own[0] = -20.0 * i + test::uniform(rng, -0.05, 0.05);
          own[1] = test::uniform(rng, -0.05, 0.05);
          if (i > 0) {
            own[2] = -20.0;
            own[3] = 0.0;
          }
        }
        if (t > 5) y[static_cast<std::size_t>(model.offset(4))] = 1e3 * t;
        if (t > 8) y[static_cast<std::size_t>(model.offset(7))] = t % 2 == 0 ? kNaN : kInfinity;
        count = 0;
        armed = true;
        runner->step(t, y.data());
        runner->control(u.data());
        armed = false;
        CAPTURE(filter->name());
        CAPTURE(faults);
        CAPTURE(t);
        CHECK(count == 0);
      }
    }
  }
}

TEST_CASE("eight trials side by side do not allocate either") {
  for (const int n : {1, 3, 8}) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    const Model model = test::scalar_model(rng, n, 8, 0.98, 0.02, 0.01);
    const Network network = test::connected_network(rng, 8);
    const auto lanes = make_filter("saturation", {{"threshold", 0.5}})->prepare(model, network)->trials();
    REQUIRE(lanes != nullptr);
    const std::vector<Matrix> x0(kLanes, Matrix::Zero(n, 8));
    lanes->reset(x0.data());
    std::vector<double> y(8 * kLanes, 0.3);
    count = 0;
    armed = true;
    for (int t = 0; t < 20; ++t) lanes->step(y.data());
    armed = false;
    CHECK(count == 0);
  }
}

TEST_CASE("the witness and the relays of a sample do not allocate") {
  using namespace garrison::certificate;
  for (const int n : {1, 2, 5, 8, 12}) {
    for (const bool bounded : {false, true}) {
      CAPTURE(n);
      test::Rng rng(static_cast<std::uint64_t>(n));
      const int sources = 3 * n + 4;
      Rows rows(n, sources, 2 * sources);
      LeverageWorkspace room(n, sources, 2 * sources);
      SubsetsWorkspace sets(n, sources, 2 * sources, 100);
      const Matrix A = Matrix::Identity(n, n);
      const Propagation propagation = Propagation::bounded(A, 3, 0.1);
      Region aged{Vector::Zero(n), kInfinity, {}};
      Region prior{Vector::Zero(n), kInfinity, {}};
      const Matrix C = test::normal_matrix(rng, n, 2 * sources);
      std::vector<double> values(static_cast<std::size_t>(sources), 1.0);
      std::vector<double> ends(2 * values.size());
      const std::vector<int> proved{1};
      int answered = 0;
      count = 0;
      armed = true;
      for (int t = 0; t < 20; ++t) {
        rows.clear();
        for (int j = 0; j < 2 * sources; ++j) {
          const double* c = C.col(j).data();
          rows.add(j / 2, {c, static_cast<std::size_t>(n)}, j < 4 ? 1e3 * t : j == 7 ? kNaN : 0.1, 1.0, 0.5);
        }
        const Witness& w = leverage_ball(rows, {2, {5.0, 5.0}, bounded, &prior, proved}, room);
        answered += w.region.answered() ? 1 : 0;
        witness_subsets(rows, {2, {5.0, 5.0}, false, nullptr, proved}, kNaN, sets);
        propagation.age(w.region, 2, aged);
        RelayedBound bound;
        bound.add(0.5, bound_around(w.region, prior.center), 1.0);
        for (double& value : values) value = bound.value() + t;
        order_rule(values, 2);
        interval(values, values, 2, ends);
      }
      armed = false;
      CHECK(count == 0);
      CHECK(answered == 20);
    }
  }
}

TEST_CASE("the certificates with memory of a sample do not allocate, whatever the window holds") {
  using namespace garrison::certificate;
  for (const int n : {1, 2, 4}) {
    CAPTURE(n);
    test::Rng rng(static_cast<std::uint64_t>(n));
    constexpr int kSteps = 6;
    constexpr int kSources = 6;
    const Matrix A = 0.9 * Matrix::Identity(n, n);
    const Matrix Gam = 0.1 * Matrix::Identity(n, n);
    const Vector u = Vector::Zero(n);
    const Matrix C = Matrix::Ones(n, kSources) + test::normal_matrix(rng, n, kSources);
    const Matrix P0 = Matrix::Identity(n, n);
    const Vector c0 = Vector::Zero(n);
    Window window(n, n, kSteps, kSources, kSteps * kSources);
    LeverageWindowWorkspace by_leverage(window);
    SubsetsWindowWorkspace by_subsets(window, 20);
    AnytimeWindowWorkspace by_search(window, 5);
    std::vector<BankSource> sources;
    for (int j = 0; j < kSources; ++j) sources.push_back({C.col(j).transpose(), Vector::Ones(1)});
    Bank bank(A, 0.01 * P0, sources, 1);
    bank.start_gaussian(c0, P0);
    const Vector y = Vector::Zero(kSources);
    const WindowLevels z{6.0, 6.0, 6.0, kNaN};
    int answered = 0;
    count = 0;
    armed = true;
    for (int t = 0; t < 12; ++t) {
      const int steps = std::min(t + 1, kSteps);
      window.begin(steps);
      if (t % 2 == 0)
        window.prior_set(c0, P0, 1.0);
      else
        window.prior_gaussian(c0, P0);
      for (int k = 0; k < steps; ++k) {
        for (int j = 0; j < kSources; ++j) {
          const double* c = C.col(j).data();
          window.add(j, {c, static_cast<std::size_t>(n)},
                     j == 1   ? 1e3 * t
                     : k == j ? kNaN
                              : 0.1,
                     1.0, j == 2 ? 0.1 : 0.0);
        }
        if (k + 1 < steps) window.advance(A, Gam, u);
      }
      for (const bool moving : {false, true})
        answered += leverage_window(window, {1, z, moving, {}, {}}, by_leverage).region.refuted() ? 0 : 1;
      subsets_window(window, {1, z, false, {}, {}}, by_subsets);
      anytime_window(window, {1, z, false, {}, {}}, by_search);
      bank.update(y, z);
    }
    armed = false;
    CHECK(count == 0);
    CHECK(answered == 24);
  }
}
