// SPDX-License-Identifier: Apache-2.0
// A program of its own: it counts every call of operator new while a step runs.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "../random_system.hpp"
#include "garrison/filters/lfre.hpp"
#include "garrison/filters/scalar_gain.hpp"
#include "garrison/runtime/family.hpp"

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
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

using namespace garrison;

TEST_CASE("the counter counts") {
  armed = true;
  delete new int(3);
  armed = false;
  CHECK(count == 1);
}

TEST_CASE("no step of any family allocates, at any dimension, on good and on bad links") {
  for (int n = 1; n <= 9; ++n) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    const Model model = test::scalar_model(rng, n, 8, 0.98, 0.02, 0.01);
    const Network network = test::connected_network(rng, 8);
    const ParamMap bounded{{"threshold", 0.2},
                           {"rounds", std::int64_t{12}},
                           {"attacked", std::int64_t{2}},
                           {"initial_error", 2.0},
                           {"detector", true}};
    for (const auto& filter :
         {make_filter("saturation", {{"threshold", 0.5}}),
          make_filter("saturation", {{"threshold", 0.5}, {"chebyshev", true}}),
          make_filter("saturation", bounded), make_filter("scalar_gain", {}), make_filter("lfre", {})}) {
      const auto runner = filter->prepare(model, network)->runner(1);
      for (const bool faults : {false, true}) {
        Link link(network, {0.2, 0.2, 3},
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

namespace {

/// Allocations of 40 samples of two agents that hear each other, driven without any driver.
template <class F, int n>
long allocations_alone(const typename F::Params& params, const Model& model) {
  const auto gains = F::design(params, model, Network::path(2));
  typename F::template State<n> state[2];
  typename F::template Message<n> message[2];
  typename F::template Message<n> next[2];
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows[2];
  Local local[2];
  const Vec<n> x0 = Vector::Zero(model.states());
  for (int i = 0; i < 2; ++i) {
    rows[i] = model.C(i);
    local[i] = {i, 2, model.states(), 1, 1, model.A().data(), rows[i].data()};
    F::template init<n>(local[i], gains, x0, state[i], message[i]);
    next[i] = message[i];
  }
  const std::uint32_t slots[2] = {1, 0};
  double out[32];
  count = 0;
  armed = true;
  for (int t = 1; t <= 40; ++t) {
    for (int i = 0; i < 2; ++i) {
      const double y = t == 7 ? kNaN : t == 9 ? kInfinity : 0.1 * t * (1 - 2 * i);
      F::template sense<n>(local[i], gains, state[i], &y, t, message[i]);
    }
    for (int round = 0; round < F::rounds(gains); ++round) {
      for (int i = 0; i < 2; ++i)
        F::template fuse<n>(local[i], gains, state[i], {message, {slots + i, 1}}, round, next[i]);
      for (int i = 0; i < 2; ++i) message[i] = next[i];
    }
    for (int i = 0; i < 2; ++i) {
      F::template report<n>(local[i], gains, state[i]);
      F::template signals<n>(local[i], gains, state[i], out);
      F::template expected<n>(local[i], gains, state[i], out);
      F::template alarm_level<n>(local[i], gains, state[i]);
    }
  }
  armed = false;
  return count;
}

/// Engines of all dimensions are tested above; here, what no engine calls is.
template <int n>
void check_alone(int states) {
  test::Rng rng(static_cast<std::uint64_t>(states));
  const Model model = test::scalar_model(rng, states, 2, 0.98, 0.02, 0.01);
  Saturation::Params detector;
  detector.threshold = 0.2;
  detector.attacked = 1;
  detector.initial_error = 2.0;
  detector.detector = true;
  Saturation::Params adaptive = detector;
  adaptive.detector = false;
  adaptive.adaptive = true;
  adaptive.threshold = kNaN;
  CAPTURE(states);
  CHECK(allocations_alone<Saturation, n>(detector, model) == 0);
  CHECK(allocations_alone<Saturation, n>(adaptive, model) == 0);
  CHECK(allocations_alone<ScalarGain, n>({}, model) == 0);
  CHECK(allocations_alone<Lfre, n>({}, model) == 0);
}

}  // namespace

TEST_CASE("sense, fuse and report on their own do not allocate") {
  check_alone<1>(1);
  check_alone<8>(8);
  check_alone<Dynamic>(9);
}

TEST_CASE("eight trials side by side do not allocate either") {
  for (const int n : {1, 3, 8}) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    const Model model = test::scalar_model(rng, n, 8, 0.98, 0.02, 0.01);
    const Network network = test::connected_network(rng, 8);
    const auto lanes = make_filter("saturation", {{"threshold", 0.5}})->prepare(model, network)->lanes();
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
