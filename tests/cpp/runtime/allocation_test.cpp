// SPDX-License-Identifier: Apache-2.0
// A program of its own: it counts every call of operator new while a step runs.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "../random_system.hpp"
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
