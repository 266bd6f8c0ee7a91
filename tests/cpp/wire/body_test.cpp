// SPDX-License-Identifier: Apache-2.0
// Bodies of messages: what goes out comes in bit for bit, and any other bytes are refused by name.
#include <doctest/doctest.h>

#include <cstdlib>
#include <cstring>

#include "../agents_by_hand.hpp"
#include "../every_filter.hpp"
#include "../filters/platoon/random_platoon.hpp"
#include "garrison/wire/blake2b.hpp"
#include "garrison/wire/letter.hpp"

using namespace garrison;

namespace {

/// Real bodies of a filter: what agent 1 sent in some samples, and what agent 0 hears it with.
struct Speech {
  std::unique_ptr<Agent> listener;
  std::vector<wire::Letter> letters;
};

Speech listen(const AnyFilter& filter, const Model& model, const Network& network, std::uint64_t seed) {
  const auto prepared = filter.prepare(model, network);
  Speech speech{prepared->agent(0), {}};
  const auto speaker = prepared->agent(1);
  test::Rng rng(seed);
  std::vector<std::byte> body(speaker->most_bytes());
  for (std::int64_t t = speaker->start() + 1; t < speaker->start() + 6; ++t) {
    const Vector y = test::normal_matrix(rng, speaker->outputs(), 1);
    const auto sent = speaker->sense(t, {y.data(), static_cast<std::size_t>(y.size())}, body);
    REQUIRE(sent.bytes > 0);
    speech.letters.push_back({filter.name(),
                              speaker->design(),
                              {1, t, 0},
                              model.agents(),
                              speaker->fields(1, t),
                              {body.begin(), body.begin() + static_cast<std::ptrdiff_t>(sent.bytes)}});
    while (speaker->round() < speaker->rounds()) speaker->fuse(body);
  }
  return speech;
}

/// A body with one thing wrong, or another length, or nothing of it left.
std::vector<std::byte> mutated(test::Rng& rng, std::vector<std::byte> body) {
  const auto place = [&] {
    return static_cast<std::size_t>(test::whole(rng, 0, static_cast<int>(body.size()) - 1));
  };
  switch (test::whole(rng, 0, 4)) {
    case 0:
      body[place()] ^= static_cast<std::byte>(1 << test::whole(rng, 0, 7));
      break;
    case 1:
      body.resize(place());
      break;
    case 2:
      body.resize(body.size() + static_cast<std::size_t>(test::whole(rng, 1, 9)));
      break;
    case 3:
      for (std::byte& b : body) b = static_cast<std::byte>(test::whole(rng, 0, 255));
      break;
    default:
      for (int k = 0; k < 3; ++k) body[place()] = static_cast<std::byte>(test::whole(rng, 0, 255));
  }
  return body;
}

/// Everything that the delivered body holds is finite and in range.
bool sound(const wire::Letter& letter) {
  const auto values = letter.values();
  for (std::size_t f = 0; f < values.size(); ++f) {
    const wire::FieldValue& value = values[f];
    const bool absent = letter.fields[f].kind == FieldKind::sparse;  // NaN stands for that
    if (const auto* numbers = std::get_if<std::vector<double>>(&value))
      for (const double v : *numbers)
        if (!(absent && std::isnan(v)) && !(std::abs(v) < kHuge)) return false;
    if (const auto* number = std::get_if<double>(&value))
      if (!std::isnan(*number) && !(std::abs(*number) < kHuge)) return false;
    if (const auto* labels = std::get_if<wire::Labels>(&value))
      for (std::size_t k = 0; k < labels->ids.size(); ++k)
        if (labels->ids[k] < (k == 0 ? 0 : labels->ids[k - 1] + 1) || labels->ids[k] >= letter.agents)
          return false;
  }
  return true;
}

void attack(Speech speech, int mutations, std::uint64_t seed) {
  test::Rng rng(seed);
  int taken = 0;
  for (int k = 0; k < mutations; ++k) {
    wire::Letter letter = speech.letters[static_cast<std::size_t>(k) % speech.letters.size()];
    letter.body = mutated(rng, letter.body);
    speech.listener->reset(Vector::Zero(speech.listener->states()), speech.listener->start());
    REQUIRE(speech.listener->listen(letter.envelope.sample) == Refusal::none);
    const Refusal refusal = speech.listener->deliver(letter.envelope, letter.body);
    if (refusal != Refusal::none) {
      const bool named = refusal == Refusal::size || refusal == Refusal::number || refusal == Refusal::flag ||
                         refusal == Refusal::set;
      if (!named) FAIL("refused as " << word(refusal));
      continue;
    }
    ++taken;
    if (!sound(letter)) FAIL("an unsound body was taken");
    // Canonical: what was taken is written back as the same bytes.
    const std::string name = letter.fields[0].name;
    if (letter.with(name, letter.values()[0]).body != letter.body) FAIL("two bodies for one message");
  }
  CHECK(taken < mutations);
  CHECK(taken > 0);
}

/// Per filter and dimension; a few megabytes of bodies. The sanitizers take ten times as long for the same.
/// GARRISON_MUTATIONS asks for another number.
int mutations() {
  if (const char* given = std::getenv("GARRISON_MUTATIONS")) return std::atoi(given);
#if defined(__SANITIZE_ADDRESS__)
  return 5000;
#else
  return 35000;
#endif
}

}  // namespace

TEST_CASE("a body that is not what an agent could have sent is refused by name, in every family") {
  for (const int n : {2, 4, 9}) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    const Model model = test::scalar_model(rng, n, 11, 0.98, 0.02, 0.01);
    const Network network = Network::complete(11);
    for (const auto& filter : test::every_filter()) {
      CAPTURE(n);
      CAPTURE(filter->name());
      attack(listen(*filter, model, network, 7), mutations(), static_cast<std::uint64_t>(n));
    }
  }
  test::Rng rng(3);
  const auto p = test::random_platoon(rng);
  for (const auto& filter : test::every_platoon_filter(p.params)) {
    CAPTURE(filter->name());
    attack(listen(*filter, p.model, p.network, 8), mutations(), 9);
  }
}

TEST_CASE("letters keep every field, and anything else is refused") {
  test::Rng rng(5);
  const Model model = test::scalar_model(rng, 4, 11, 0.98, 0.02, 0.01);
  for (const auto& filter : test::every_filter()) {
    CAPTURE(filter->name());
    const Speech speech = listen(*filter, model, Network::complete(11), 6);
    for (const wire::Letter& letter : speech.letters) {
      const auto bytes = letter.to_bytes();
      CHECK(wire::Letter::from_bytes(bytes) == letter);
      for (std::size_t k = 0; k < letter.fields.size(); ++k) {
        const auto value = letter.values()[k];
        CHECK(letter.with(letter.fields[k].name, value) == letter);
      }
      auto damaged = bytes;
      damaged[damaged.size() / 2] ^= std::byte{4};
      CHECK_THROWS_WITH_AS(wire::Letter::from_bytes(damaged), doctest::Contains("message: got damaged bytes"),
                           InvalidInput);
    }
    CHECK_THROWS_WITH_AS(speech.letters[0].with("estimat", 1.0), doctest::Contains("estimat"), InvalidInput);
  }
  for (int k = 0; k < 2000; ++k) {
    std::vector<std::byte> noise(static_cast<std::size_t>(test::whole(rng, 0, 200)));
    for (std::byte& b : noise) b = static_cast<std::byte>(test::whole(rng, 0, 255));
    CHECK_THROWS_AS(wire::Letter::from_bytes(noise), InvalidInput);
  }
}

TEST_CASE("the bytes of a body, one by one: little-endian, canonical") {
  const Model model(Matrix::Identity(2, 2), std::vector<Matrix>(10, Matrix{{1.0, 0.0}}),
                    {0.1, Vector::Constant(10, 0.1)});
  const auto filter = make_filter("saturation", {{"threshold", 1.0},
                                                 {"rounds", std::int64_t{9}},
                                                 {"detector", true},
                                                 {"attacked", std::int64_t{2}},
                                                 {"initial_error", 1.0}});
  const auto agent = filter->prepare(model, Network::complete(10))->agent(9);
  agent->reset(Vector{{1.0, -2.0}});
  std::vector<std::byte> body(agent->most_bytes());
  const double y = 1e9;  // proves itself attacked: nothing of it is used
  REQUIRE(agent->sense(1, {&y, 1}, body).bytes == 2 * 8 + 1 + 2);
  const unsigned char expected[] = {0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0xc0, 1, 0, 2};
  CHECK(std::memcmp(body.data(), expected, sizeof expected) == 0);
}

TEST_CASE("BLAKE2b-256 of RFC 7693's example and of long messages") {
  const auto hex = [](std::string_view text) {
    std::string digits;
    for (const std::byte b : wire::blake2b(std::as_bytes(std::span(text.data(), text.size())))) {
      digits += "0123456789abcdef"[std::to_integer<int>(b) / 16];
      digits += "0123456789abcdef"[std::to_integer<int>(b) % 16];
    }
    return digits;
  };
  CHECK(hex("") == "0e5751c026e543b2e8ab2eb06099daa1d1e5df47778f7787faab45cdf12fe3a8");
  CHECK(hex("abc") == "bddd813c634239723171ef3fee98579b94964e3bb1cb3e427262c8c068d52319");
  CHECK(hex(std::string(128, 'x')) == "164ffb7089bae6f5a62fb0795e751dc9e88eac92e1a5b2fafe93a25abf2d9c3b");
  CHECK(hex(std::string(1000, 'z')) == "ede3c7fe61664448156ffacd74769c14d598dd38fc8eb46e06ba84c6e5b2b990");
}
