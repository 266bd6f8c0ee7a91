// SPDX-License-Identifier: Apache-2.0
// Design files that somebody has changed and sealed again: refused when they are read, or harmless. Out of
// bounds would show as a crash here, and as an error under valgrind or a sanitizer.
#include <doctest/doctest.h>

#include <new>

#include "../every_filter.hpp"
#include "../filters/platoon/random_platoon.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/engine/design_file.hpp"
#include "garrison/engine/snapshot_head.hpp"
#include "garrison/filters/saturation/data_free.hpp"
#include "garrison/wire/blake2b.hpp"

using namespace garrison;

namespace {

using Bytes = std::vector<std::byte>;
constexpr std::size_t kHead = 60;  // magic, version, name: what says that it is a design file
constexpr int kSamples = 8;

/// Other bytes, whole numbers or numbers at one to four places behind `first`.
void change(test::Rng& rng, Bytes& file, std::size_t first) {
  const auto put = [&](std::size_t at, std::uint64_t value, std::size_t bytes) {
    for (std::size_t k = 0; k < bytes; ++k) file[at + k] = static_cast<std::byte>(value >> (8 * k));
  };
  const int changes = test::whole(rng, 0, 2) == 0 ? test::whole(rng, 2, 4) : 1;
  for (int k = 0; k < changes; ++k) {
    const auto at = static_cast<std::size_t>(
        test::whole(rng, static_cast<int>(first), static_cast<int>(file.size()) - 9));
    constexpr std::int64_t wholes[] = {-1, 0, 1, 2, 3, 7, 1000, 1000000, INT32_MAX, INT32_MIN};
    constexpr double numbers[] = {kNaN, kInfinity, 1e308, -1.0, 0.0};
    const int kind = test::whole(rng, 0, 9);
    if (kind < 3)
      put(at, static_cast<std::uint64_t>(test::whole(rng, 0, 255)), 1);
    else if (kind < 8)
      put(at, static_cast<std::uint64_t>(wholes[test::whole(rng, 0, 9)]), 4);
    else
      put(at, std::bit_cast<std::uint64_t>(numbers[test::whole(rng, 0, 4)]), 8);
  }
}

/// A design file with the hash that belongs to it.
Bytes forged(test::Rng& rng, Bytes file) {
  file.resize(file.size() - sizeof(wire::Digest));
  change(rng, file, kHead);
  const wire::Digest digest = wire::blake2b(file);
  file.insert(file.end(), digest.begin(), digest.end());
  return file;
}

void drive(Agent& agent) {
  Bytes body(agent.most_bytes());
  const Vector y = Vector::Constant(agent.outputs(), 0.5);
  const std::int64_t begin = agent.sample();
  for (std::int64_t t = begin + 1; t <= begin + kSamples; ++t) {
    agent.sense(t, {y.data(), static_cast<std::size_t>(y.size())}, body);
    while (agent.round() < agent.rounds()) agent.fuse(body);
    agent.report();
  }
}

/// Of agent 0, some samples after the start.
Bytes driven_snapshot(const Prepared& prepared) {
  const auto agent = prepared.agent(0);
  drive(*agent);
  Bytes snapshot(agent->snapshot_bytes());
  REQUIRE(agent->save(snapshot) == snapshot.size());
  return snapshot;
}

/// A changed snapshot with the checksum that belongs to it.
template <class Change>
Bytes forged_snapshot(Bytes snapshot, const Change& change_it) {
  snapshot.resize(snapshot.size() - SnapshotHead::kChecksum);
  change_it(snapshot);
  const std::uint64_t sum = wire::checksum(snapshot);
  snapshot.resize(snapshot.size() + SnapshotHead::kChecksum);
  wire::store(snapshot.data() + snapshot.size() - SnapshotHead::kChecksum, sum);
  return snapshot;
}

/// True when the file was taken, and nothing went wrong with what was read.
bool survives(const Bytes& file, bool part) {
  try {
    if (part) {
      drive(*read_part(file));
    } else {
      const auto prepared = read_design(file);
      PlantOptions plant;
      plant.steps = kSamples;
      plant.noise = prepared->filter().own_states() ? "uniform" : "none";
      simulate(*prepared, plant, {});
      for (int i = 0; i < prepared->model().agents(); ++i) drive(*prepared->agent(i));
    }
    return true;
  } catch (const Error&) {
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return false;
}

struct Design {
  std::shared_ptr<const AnyFilter> filter;
  Model model;
  Network network;
};

/// All families, with tables for informed agents, with several outputs of an agent, and vehicles.
std::vector<Design> designs() {
  test::Rng rng(17);
  const Network complete = Network::complete(5);
  const Model single = test::scalar_model(rng, 2, 5, 1.02, 0.02, 0.1);
  const Model several(
      single.A(), {Matrix::Identity(2, 2), single.C(1), Matrix(0, 2), single.C(3), single.C(4)},
      {.process_covariance = 0.04 * Matrix::Identity(2, 2),
       .measurement_covariance = {0.1 * Matrix::Identity(2, 2), Matrix::Constant(1, 1, 0.1), Matrix(0, 0),
                                  Matrix::Constant(1, 1, 0.1), Matrix::Constant(1, 1, 0.1)}});
  std::vector<Design> all;
  for (const auto& filter : test::every_filter()) all.push_back({filter, single, complete});
  all.push_back({make_filter("saturation", {{"threshold", 0.5},
                                            {"rounds", std::int64_t{4}},
                                            {"attacked", std::int64_t{1}},
                                            {"initial_error", 2.0},
                                            {"detector", true},
                                            {"table", true}}),
                 single, complete});
  for (const char* name : {"rdkf", "dkf", "partial_sharing"})
    all.push_back(
        {make_filter(name, name == std::string("partial_sharing") ? ParamMap{{"gain", 0.1}} : ParamMap{}),
         several, complete});
  all.push_back({make_filter("rdkf", {{"penalty", std::string("group")}}), several, complete});
  all.push_back({make_filter("rdkf", {{"penalty", std::string("l1")}}), several, complete});
  test::Platoon platoon = test::random_platoon(rng);
  platoon.params["initial_error"] = 300.0;  // vehicles start at the estimates, not where they should be
  for (const auto& filter : test::every_platoon_filter(platoon.params))
    all.push_back({filter, platoon.model, platoon.network});
  return all;
}

}  // namespace

TEST_CASE("forged design files of every family are refused or harmless") {
  test::Rng rng(18);
  int taken = 0;
  int refused = 0;
  for (const Design& d : designs()) {
    CAPTURE(d.filter->name());
    const auto prepared = d.filter->prepare(d.model, d.network);
    const Bytes whole = write_design(*prepared);
    CHECK(survives(whole, false));
    for (int id = 0; id < d.model.agents(); ++id) CHECK(survives(write_part(*prepared, id), true));
    const Bytes part = write_part(*prepared, 1);
    for (int k = 0; k < 60; ++k) {
      const bool of_part = k % 2 == 1;
      (survives(forged(rng, of_part ? part : whole), of_part) ? taken : refused) += 1;
    }
  }
  CHECK(taken > 100);
  CHECK(refused > 100);
}

TEST_CASE("forged snapshots of every family are refused or harmless") {
  test::Rng rng(19);
  int taken = 0;
  int refused = 0;
  for (const Design& d : designs()) {
    CAPTURE(d.filter->name());
    const auto prepared = d.filter->prepare(d.model, d.network);
    const Bytes snapshot = driven_snapshot(*prepared);
    for (int k = 0; k < 100; ++k) {
      const auto other = prepared->agent(0);
      const Bytes changed =
          forged_snapshot(snapshot, [&](Bytes& all) { change(rng, all, SnapshotHead::kBytes); });
      (other->load(changed) == Refusal::none ? taken : refused) += 1;
      other->report();
      drive(*other);
    }
  }
  CHECK(taken > 100);
  CHECK(refused > 100);
}

TEST_CASE("a huge number in a snapshot is refused, or gone after some samples") {
  for (const Design& d : designs()) {
    CAPTURE(d.filter->name());
    const auto prepared = d.filter->prepare(d.model, d.network);
    const Bytes snapshot = driven_snapshot(*prepared);
    for (std::size_t at = SnapshotHead::kBytes; at + 16 <= snapshot.size(); ++at) {
      const auto other = prepared->agent(0);
      const Bytes changed =
          forged_snapshot(snapshot, [&](Bytes& all) { wire::store_double(all.data() + at, 1e308); });
      if (other->load(changed) != Refusal::none) continue;
      drive(*other);
      std::vector<double> x(static_cast<std::size_t>(other->states()));
      other->estimate(x);
      CAPTURE(at);
      for (const double v : x) CHECK(std::abs(v) < kHuge);
    }
  }
}

TEST_CASE("a snapshot of a sample before the first is refused") {
  const Network complete = Network::complete(5);
  test::Rng rng(20);
  const auto filter = make_filter("saturation", {{"threshold", 0.5},
                                                 {"rounds", std::int64_t{4}},
                                                 {"attacked", std::int64_t{1}},
                                                 {"initial_error", 2.0},
                                                 {"table", true}});
  const auto prepared = filter->prepare(test::scalar_model(rng, 2, 5, 1.02, 0.02, 0.1), complete);
  const Bytes snapshot = driven_snapshot(*prepared);
  int refused = 0;
  // the state's own sample is one of these
  for (std::size_t at = SnapshotHead::kBytes; at + 16 <= snapshot.size(); ++at) {
    const Bytes other = forged_snapshot(snapshot, [&](Bytes& all) {
      wire::store(all.data() + at, static_cast<std::uint64_t>(INT64_MIN / 2));
    });
    const auto reader = prepared->agent(0);
    refused += reader->load(other) == Refusal::none ? 0 : 1;
    reader->report();  // looks into the table
    drive(*reader);
  }
  CHECK(refused > 0);
}

TEST_CASE("the tables of informed agents: every place that leads out of them is refused") {
  saturation::DataFree good;
  good.d = good.H = Matrix::Ones(4, 3);
  good.worst = Vector::Ones(4);
  good.proved.s = 1;
  good.proved.ids = {0, 2};
  good.proved.first = {0, 2, 5};
  good.proved.fade = good.proved.noise = Matrix::Ones(5, 3);
  good.proved.later = Matrix::Ones(3, 2);
  const auto system = certificate::error_system(Matrix::Constant(1, 1, 0.5), Matrix::Ones(3, 1),
                                                Matrix::Constant(3, 3, 1.0 / 3.0));
  good.losses.excess = certificate::Recovery(certificate::kernels(system, 2), 1);
  good.losses.predicted = Vector::Ones(4);
  good.losses.spread = Vector::Ones(6);
  good.losses.reach = good.losses.width = Vector::Ones(3);
  CHECK(good.fits(1, 3, 5));
  CHECK(good.of(1).fits(1, 3, 5));
  CHECK(!good.of(1).fits(2, 3, 5));
  const auto refused = [&](const auto& change) {
    saturation::DataFree bad = good;
    change(bad);
    return !bad.fits(1, 3, 5);
  };
  using Table = saturation::DataFree;
  CHECK(refused([](Table& t) { t.d.resize(4, 2); }));
  CHECK(refused([](Table& t) { t.H.resize(3, 3); }));
  CHECK(refused([](Table& t) { t.worst.resize(3); }));
  CHECK(refused([](Table& t) { t.only = 2; }));
  CHECK(refused([](Table& t) { t.proved.first = {0, 2, 6}; }));
  CHECK(refused([](Table& t) { t.proved.first = {0, 5, 5}; }));
  CHECK(refused([](Table& t) { t.proved.first = {-1, 2, 5}; }));
  CHECK(refused([](Table& t) { t.proved.first = {0, 3, 2, 5}; }));
  CHECK(refused([](Table& t) { t.proved.ids = {0}; }));
  CHECK(refused([](Table& t) { t.proved.ids = {0, 3}; }));
  CHECK(refused([](Table& t) { t.proved.ids = {0, -1}; }));
  CHECK(refused([](Table& t) { t.proved.s = 2; }));
  CHECK(refused([](Table& t) { t.proved.s = 0; }));
  CHECK(refused([](Table& t) { t.proved.fade.resize(5, 1); }));
  CHECK(refused([](Table& t) { t.proved.noise.resize(4, 3); }));
  CHECK(refused([](Table& t) { t.proved.later.resize(3, 1); }));
  CHECK(refused([](Table& t) { t.losses.excess = t.losses.excess.of(0); }));
  CHECK(refused([](Table& t) { t.losses.predicted.resize(3); }));
  CHECK(refused([](Table& t) { t.losses.spread.resize(5); }));
  CHECK(refused([](Table& t) { t.losses.reach.resize(2); }));
  CHECK(refused([](Table& t) { t.losses.width.resize(4); }));
  CHECK(refused([](Table& t) { t.d.resize(0, 0); }));
}
