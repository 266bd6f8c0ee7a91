// SPDX-License-Identifier: Apache-2.0
// Signed statements: what they are about, and who is convicted by them.
#include "garrison/node/authors.hpp"

#include <doctest/doctest.h>

#include "mutants.hpp"

using namespace garrison::node;
using namespace garrison::node::test;

namespace {

constexpr int kRounds = 2, kBatch = 5;

Key seed_of(int id) { return Key{std::byte{9}, static_cast<std::byte>(id)}; }

std::vector<Key> roster(int count) {
  std::vector<Key> open(static_cast<std::size_t>(count));
  for (int id = 0; id < count; ++id) signing_key(seed_of(id), open[static_cast<std::size_t>(id)]);
  return open;
}

Authors author(int own, std::vector<int> neighbours, std::uint64_t boot = 1) {
  Key open{};
  return Authors({own, signing_key(seed_of(own), open), boot, Key{std::byte{1}}, roster(3),
                  std::move(neighbours), kRounds, kBatch});
}

std::string body_of(std::int64_t sample, int round, int version = 0) {
  return std::to_string(sample) + "/" + std::to_string(round) + "/" + std::to_string(version);
}

/// What `from` signs of samples first..last, in which it sends `version` in sample 7.
Statement batch(Authors& from, int version, std::int64_t first = 5, std::int64_t last = 9) {
  Statement out, ignored;
  for (std::int64_t t = first; t <= last; ++t)
    for (int r = 0; r < kRounds; ++r)
      CHECK_FALSE(from.said(t, r, text_bytes(body_of(t, r, t == 7 ? version : 0)), ignored));
  REQUIRE(from.said(last + 1, 0, text_bytes("next"), out));
  return out;
}

void hear(Authors& to, int version, int but_sample = -1) {
  for (std::int64_t t = 5; t <= 9; ++t)
    for (int r = 0; r < kRounds; ++r)
      if (t != but_sample) to.heard(0, t, r, text_bytes(body_of(t, r, t == 7 ? version : 0)));
}

}  // namespace

TEST_CASE("a statement is about a batch, and genuine for its sender and run alone") {
  Authors zero = author(0, {1});
  const Statement s = batch(zero, 0);
  CHECK(s.first == 5);
  CHECK(s.last == 9);
  CHECK(s.count == 10);
  CHECK(genuine(s, Key{std::byte{1}}, roster(3)[0]));
  CHECK_FALSE(genuine(s, Key{std::byte{2}}, roster(3)[0]));
  CHECK_FALSE(genuine(s, Key{std::byte{1}}, roster(3)[1]));
}

TEST_CASE("who sent what it signed is left alone, whatever was lost on the way") {
  Authors zero = author(0, {1}), one = author(1, {0});
  const Statement s = batch(zero, 0);
  Statement other;
  hear(one, 0, 6);
  CHECK(one.take(s, other) == Authors::News::fresh);
  CHECK(one.take(s, other) == Authors::News::known);
  CHECK(one.disowned() == 0);
  Authors two = author(2, {0});
  hear(two, 0);
  CHECK(two.take(s, other) == Authors::News::fresh);
  CHECK(two.disowned() == 0);
}

TEST_CASE("another body than the signed one is seen by who got it") {
  Authors zero = author(0, {1}), one = author(1, {0});
  hear(one, 3);
  Statement other;
  CHECK(one.take(batch(zero, 0), other) == Authors::News::fresh);
  CHECK(one.disowned() == 1);
  CHECK(one.contradictions() == 0);
}

TEST_CASE("two statements about the same samples convict, offline, and once") {
  Authors here = author(0, {1}), there = author(0, {1}), one = author(1, {0});
  const Statement a = batch(here, 0), b = batch(there, 1);
  Statement other;
  CHECK(one.take(a, other) == Authors::News::fresh);
  REQUIRE(one.take(b, other) == Authors::News::contradiction);
  CHECK(other == a);
  CHECK(one.contradictions() == 1);
  const Proof proof{Key{std::byte{1}}, other, b};
  std::array<std::byte, Proof::kSize> bytes;
  proof.write(bytes.data());
  const auto read = Proof::read(bytes);
  REQUIRE(read);
  CHECK(read->convicts(roster(3)[0]));
  CHECK_FALSE(read->convicts(roster(3)[1]));
}

TEST_CASE("statements of other samples, other starts or the same content convict nobody") {
  Authors first = author(0, {1}), again = author(0, {1}), next = author(0, {1}), later = author(0, {1}, 2);
  const Statement a = batch(first, 0);
  for (const Statement& b : {batch(again, 0), batch(next, 0, 10, 14), batch(later, 1)}) {
    CHECK_FALSE(contradict(a, b));
    CHECK_FALSE(Proof{Key{std::byte{1}}, a, b}.convicts(roster(3)[0]));
  }
}

TEST_CASE("mutated statements and proofs are refused") {
  Authors here = author(0, {1}), there = author(0, {1});
  const Statement a = batch(here, 0), b = batch(there, 1);
  std::string statement(Statement::kSize, '\0'), proof(Proof::kSize, '\0');
  a.write(reinterpret_cast<std::byte*>(statement.data()));
  Proof{Key{std::byte{1}}, a, b}.write(reinterpret_cast<std::byte*>(proof.data()));
  std::mt19937_64 random(4);
  Authors one = author(1, {0});
  Statement other;
  for (int k = 0; k < 2000; ++k) {
    const std::string other_statement = mutated(statement, random), other_proof = mutated(proof, random);
    const auto s = Statement::read(text_bytes(other_statement));
    if (s && other_statement != statement) CHECK(one.take(*s, other) != Authors::News::fresh);
    const auto p = Proof::read(text_bytes(other_proof));
    if (p && other_proof != proof) CHECK_FALSE(p->convicts(roster(3)[0]));
  }
  CHECK(one.taken() == 0);
}
