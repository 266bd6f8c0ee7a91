// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/authors.hpp"

#include <algorithm>

namespace garrison::node {

Authors::Authors(Setup setup)
    : setup_(std::move(setup)),
      leaves_(setup_.neighbours.size() * 2 * static_cast<std::size_t>(setup_.batch * setup_.rounds)),
      books_(setup_.open.size()) {}

/// Batches of different nodes end in different samples: signatures are made and checked all along, not by
/// everybody at once.
bool Authors::said(std::int64_t sample, int round, Bytes body, Statement& out) noexcept {
  const auto batch_of = [&](std::int64_t t) { return (t + setup_.own) / setup_.batch; };
  const bool closes = open_.count != 0 && batch_of(sample) != batch_of(open_.first);
  if (closes) {
    out = open_;
    out.sender = static_cast<std::uint16_t>(setup_.own);
    out.boot = setup_.boot;
    sign(out, setup_.run, setup_.key);
    open_ = {};
  }
  if (open_.count == 0) open_.first = sample;
  open_.last = sample;
  open_.digest = chained(open_.digest, leaf_of(sample, round, body));
  ++open_.count;
  return closes;
}

void Authors::heard(int neighbour, std::int64_t sample, int round, Bytes body) noexcept {
  const std::size_t k = neighbour_of(neighbour);
  if (k == setup_.neighbours.size() || sample < 0) return;
  leaf(k, sample, round) = {sample, leaf_of(sample, round, body)};
}

Authors::News Authors::take(const Statement& statement, Statement& other) noexcept {
  if (statement.sender >= books_.size() || statement.sender == setup_.own) return News::known;
  const Key& open = setup_.open[statement.sender];
  if (open == Key{}) return News::refused;
  Book& book = books_[statement.sender];
  const auto end = book.kept.begin() + static_cast<std::ptrdiff_t>(std::min(book.count, kKept));
  if (std::find(book.kept.begin(), end, statement) != end) return News::known;
  if (!genuine(statement, setup_.run, open)) return News::refused;
  ++taken_;
  compare(statement);
  const auto found =
      std::find_if(book.kept.begin(), end, [&](const Statement& old) { return contradict(old, statement); });
  News news = News::fresh;
  if (found != end && book.convicted != statement.boot) {
    book.convicted = statement.boot;
    other = *found;
    ++contradictions_;
    news = News::contradiction;
  }
  book.kept[book.count++ % kKept] = statement;
  return news;
}

Authors::Leaf& Authors::leaf(std::size_t neighbour, std::int64_t sample, int round) noexcept {
  const std::int64_t samples = 2 * setup_.batch;
  const auto at = static_cast<std::size_t>((sample % samples) * setup_.rounds + round);
  return leaves_[neighbour * static_cast<std::size_t>(samples * setup_.rounds) + at];
}

std::size_t Authors::neighbour_of(int id) const noexcept {
  const auto at = std::lower_bound(setup_.neighbours.begin(), setup_.neighbours.end(), id);
  const bool found = at != setup_.neighbours.end() && *at == id;
  return found ? static_cast<std::size_t>(at - setup_.neighbours.begin()) : setup_.neighbours.size();
}

/// Only where all that it is about has arrived: what was lost on the way proves nothing.
void Authors::compare(const Statement& statement) noexcept {
  const std::size_t k = neighbour_of(statement.sender);
  if (k == setup_.neighbours.size() || statement.last - statement.first >= 2 * setup_.batch) return;
  Key digest{};
  std::uint32_t count = 0;
  for (std::int64_t t = statement.first; t <= statement.last; ++t)
    for (int round = 0; round < setup_.rounds; ++round) {
      const Leaf& one = leaf(k, t, round);
      if (one.sample != t) continue;
      digest = chained(digest, one.digest);
      ++count;
    }
  if (count == statement.count && digest != statement.digest) ++disowned_;
}

}  // namespace garrison::node
