// SPDX-License-Identifier: Apache-2.0
// Ranks as threads of this process.
#pragma once

#include <algorithm>
#include <barrier>
#include <exception>
#include <functional>
#include <map>
#include <thread>
#include <utility>
#include <vector>

#include "partition/exchange.hpp"

namespace garrison::test {

/// What the ranks share. Everything is written before a barrier and read behind it.
class FakeWorld {
 public:
  explicit FakeWorld(int ranks)
      : ranks_(ranks),
        barrier_(ranks),
        sums_(static_cast<std::size_t>(ranks)),
        maxima_(static_cast<std::size_t>(ranks)),
        mail_(static_cast<std::size_t>(ranks)) {}

  /// Runs `work(exchange)` on every rank at once; an exception of any of them is thrown again, the first
  /// rank's first. (All ranks must throw, or none.)
  void run(const std::function<void(partition::Exchange&)>& work) {
    std::vector<std::thread> threads;
    std::vector<std::exception_ptr> failures(static_cast<std::size_t>(ranks_));
    for (int rank = 0; rank < ranks_; ++rank)
      threads.emplace_back([&, rank] {
        Fake exchange(*this, rank);
        try {
          work(exchange);
        } catch (...) {
          failures[static_cast<std::size_t>(rank)] = std::current_exception();
        }
      });
    for (std::thread& thread : threads) thread.join();
    for (const auto& failure : failures)
      if (failure) std::rethrow_exception(failure);
  }

 private:
  class Fake final : public partition::Exchange {
   public:
    Fake(FakeWorld& world, int rank) : world_(world), rank_(rank) {}
    int rank() const override { return rank_; }
    int ranks() const override { return world_.ranks_; }
    void connect(const partition::Routes& routes) override { routes_ = routes; }
    void begin(const std::byte* out, std::byte* in, std::size_t bytes) override {
      auto& mine = world_.mail_[static_cast<std::size_t>(rank_)];
      mine.clear();
      for (std::size_t p = 0; p < routes_.peers.size(); ++p) {
        const auto size = static_cast<std::size_t>(routes_.sends[p]) * bytes;
        mine[routes_.peers[p]].assign(out, out + size);
        out += size;
      }
      in_ = in;
      // What is not there yet must not be read: it is destroyed until it has come.
      for (std::size_t p = 0; p < routes_.peers.size(); ++p)
        std::fill_n(in, static_cast<std::size_t>(routes_.receives[p]) * bytes, std::byte{0xff}),
            in += static_cast<std::size_t>(routes_.receives[p]) * bytes;
    }
    void finish() override {
      world_.barrier_.arrive_and_wait();
      for (const int peer : routes_.peers) {
        const auto& from = world_.mail_[static_cast<std::size_t>(peer)].at(rank_);
        in_ = std::copy(from.begin(), from.end(), in_);
      }
      world_.barrier_.arrive_and_wait();
    }
    void sum(std::span<std::int64_t> values) override {
      gather(world_.sums_, values, [](std::int64_t a, std::int64_t b) { return a + b; });
    }
    void largest(std::span<double> values) override {
      gather(world_.maxima_, values, [](double a, double b) { return std::max(a, b); });
    }

   private:
    template <class T, class Join>
    void gather(std::vector<std::vector<T>>& all, std::span<T> values, const Join& join) {
      all[static_cast<std::size_t>(rank_)].assign(values.begin(), values.end());
      world_.barrier_.arrive_and_wait();
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = all[0][k];
        for (std::size_t r = 1; r < all.size(); ++r) values[k] = join(values[k], all[r][k]);
      }
      world_.barrier_.arrive_and_wait();
    }
    FakeWorld& world_;
    int rank_;
    partition::Routes routes_;
    std::byte* in_ = nullptr;
  };

  int ranks_;
  std::barrier<> barrier_;
  std::vector<std::vector<std::int64_t>> sums_;
  std::vector<std::vector<double>> maxima_;
  std::vector<std::map<int, std::vector<std::byte>>> mail_;  // by sender, then receiver
};

}  // namespace garrison::test
