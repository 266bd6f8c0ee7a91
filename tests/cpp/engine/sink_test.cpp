// SPDX-License-Identifier: Apache-2.0
// A run that is handed over block by block has the bits of one in memory.
#include <doctest/doctest.h>

#include <cstring>
#include <map>
#include <stdexcept>

#include "../every_filter.hpp"
#include "../random_system.hpp"
#include "garrison/attacks/measurement.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

constexpr int kTrials = 3;
constexpr int kSteps = 23;
constexpr int kAgents = 7;

/// Puts blocks together again, at the places where a whole record has them.
struct Pieces {
  Record whole;
  std::map<int, int> next;  // per trial: the time that comes
  std::size_t largest = 0;  // bytes of a block

  template <class T>
  void put(Bulk<T>& into, const Bulk<T>& block, int trial, int row, int rows_of_a_trial, int rows) {
    if (block.empty()) return;
    const std::size_t width = block.size() / static_cast<std::size_t>(rows);
    into.resize(static_cast<std::size_t>(kTrials * rows_of_a_trial) * width);
    std::memcpy(into.data() + static_cast<std::size_t>(trial * rows_of_a_trial + row) * width, block.data(),
                block.size() * sizeof(T));
    largest = std::max(largest, block.size() * sizeof(T));
  }

  void take(const Record& b, int trial, int first) {
    REQUIRE(first == next[trial]);
    const int times = b.steps + 1;
    next[trial] += times;
    const int samples = times - (first == 0 ? b.first_sample : 0);
    const auto all = [&](auto& into, const auto& block) {
      put(into, block, trial, first, kSteps + 1, times);
    };
    all(whole.truth, b.truth);
    all(whole.error, b.error);
    all(whole.estimate, b.estimate);
    all(whole.bound, b.bound);
    all(whole.bound_kind, b.bound_kind);
    all(whole.statistic, b.statistic);
    all(whole.threshold, b.threshold);
    all(whole.verdict, b.verdict);
    all(whole.signals, b.signals);
    if (samples > 0)
      put(whole.measurements, b.measurements, trial, std::max(first - b.first_sample, 0),
          kSteps + 1 - b.first_sample, samples);
  }
};

template <class T>
bool same(const Bulk<T>& a, const Bulk<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace

TEST_CASE("blocks of a run make up the run in memory, whatever their size and the threads") {
  test::Rng rng(11);
  const Model model = test::scalar_model(rng, 3, kAgents, 0.98, 0.02, 0.01);
  const Network network = test::connected_network(rng, kAgents);
  RunOptions o;
  o.trials = kTrials;
  o.seed = 5;
  o.start = Vector::Zero(3);
  o.attacks = {scale(Schedule(5, {2}), 3.0), denial(Schedule(12, {6}))};
  o.link.drop = 0.1;
  o.keep.signals = true;
  o.keep.details = true;
  const PlantOptions plant{kSteps, Vector::Constant(3, 0.2), 0.5, "uniform"};
  for (const auto& filter : test::every_filter()) {
    CAPTURE(filter->name());
    o.sink = {};
    const Record memory = simulate(model, network, *filter, plant, o);
    for (const std::size_t bytes : {std::size_t{1}, std::size_t{6000}, std::size_t{1} << 30}) {
      for (const int threads : {1, 3}) {
        Pieces pieces;
        RunOptions streamed = o;
        streamed.threads = threads;
        streamed.block_bytes = bytes;
        streamed.sink = [&](const Record& b, int trial, int first) { pieces.take(b, trial, first); };
        const Record rest = simulate(model, network, *filter, plant, streamed);
        CHECK(pieces.next == std::map<int, int>{{0, kSteps + 1}, {1, kSteps + 1}, {2, kSteps + 1}});
        CHECK(pieces.largest <= std::max<std::size_t>(bytes, 8 * 3 * kAgents * 8));
        CHECK(rest.estimate.empty());
        CHECK(rest.error.empty());
        CHECK(same(pieces.whole.truth, memory.truth));
        CHECK(same(pieces.whole.error, memory.error));
        CHECK(same(pieces.whole.measurements, memory.measurements));
        CHECK(same(pieces.whole.estimate, memory.estimate));
        CHECK(same(pieces.whole.bound, memory.bound));
        CHECK(same(pieces.whole.bound_kind, memory.bound_kind));
        CHECK(same(pieces.whole.statistic, memory.statistic));
        CHECK(same(pieces.whole.threshold, memory.threshold));
        CHECK(same(pieces.whole.verdict, memory.verdict));
        CHECK(same(pieces.whole.signals, memory.signals));
        CHECK(rest.accusations.size() == memory.accusations.size());
        CHECK(rest.details.size() == memory.details.size());
        CHECK(rest.link.lost == memory.link.lost);
        CHECK(rest.missing == memory.missing);
        CHECK(rest.bytes_per_step == memory.bytes_per_step);
      }
    }
  }
}

TEST_CASE("a run keeps nothing but counters where nothing else is asked for") {
  test::Rng rng(12);
  const Model model = test::scalar_model(rng, 2, 5, 0.98, 0.02, 0.01);
  RunOptions o;
  o.trials = 9;  // also side by side
  o.attacks = {denial(Schedule(3, {2}))};
  o.keep = {false, false, false, false, false, false, false, false};
  const auto filter = make_filter("saturation", {{"threshold", 0.5}});
  const Record none = simulate(model, Network::ring(5), *filter, {20, {}, 0.0, "uniform"}, o);
  CHECK(none.error.empty());
  CHECK(none.truth.empty());
  CHECK(none.missing == 9 * 18);
  o.keep.error = true;
  const Record errors = simulate(model, Network::ring(5), *filter, {20, {}, 0.0, "uniform"}, o);
  o.keep = {};
  const Record all = simulate(model, Network::ring(5), *filter, {20, {}, 0.0, "uniform"}, o);
  CHECK(errors.truth.empty());
  CHECK(same(errors.error, all.error));
}

TEST_CASE("what a sink throws, the run throws") {
  test::Rng rng(13);
  const Model model = test::scalar_model(rng, 2, 5, 0.98, 0.02, 0.01);
  RunOptions o;
  o.trials = 4;
  o.block_bytes = 1;
  o.sink = [](const Record&, int trial, int first) {
    if (trial == 2 && first == 7) throw std::runtime_error("full");
  };
  const auto filter = make_filter("scalar_gain", {});
  CHECK_THROWS_WITH(simulate(model, Network::ring(5), *filter, {20, {}, 0.0, "uniform"}, o), "full");
}
