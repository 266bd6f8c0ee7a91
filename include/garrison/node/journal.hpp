// SPDX-License-Identifier: Apache-2.0
// Every call that changes an agent, as bytes: what the log of a node holds, and what makes the same agent
// again to the last bit.
#pragma once

#include <functional>
#include <vector>

#include "garrison/engine/agent.hpp"
#include "garrison/node/bytes.hpp"

namespace garrison::node {

enum class Call : std::uint8_t {
  reset = 1,    ///< data: the estimate to start with
  load = 2,     ///< data: a snapshot
  sense = 3,    ///< data: the measurement
  deliver = 4,  ///< sender, round; data: the body
  fuse = 5,
  listen = 6,
  join = 7,  ///< round: 1 = and speaks, although it has heard nobody
  uncover = 8,
  estimate = 9,  ///< no call: the estimate at the end of the sample, to compare with
};

struct Entry {
  Call call = Call::estimate;
  std::int32_t sender = 0;
  std::int32_t round = 0;
  std::int64_t sample = 0;
  Bytes data;
};

inline constexpr std::size_t kEntryHead = 21;

/// Call u8, sender u32, round u32, sample i64, size u32, data. `out` has room for kEntryHead + data.
inline std::size_t write_entry(const Entry& entry, std::byte* out) noexcept {
  wire::store(out, static_cast<std::uint8_t>(entry.call));
  wire::store(out + 1, static_cast<std::uint32_t>(entry.sender));
  wire::store(out + 5, static_cast<std::uint32_t>(entry.round));
  wire::store(out + 9, static_cast<std::uint64_t>(entry.sample));
  wire::store(out + 17, static_cast<std::uint32_t>(entry.data.size()));
  copy(entry.data, out + kEntryHead);
  return kEntryHead + entry.data.size();
}
/// The entry that `bytes` begin with; false when they do not hold a whole one.
inline bool read_entry(Bytes bytes, Entry& entry, std::size_t& size) noexcept {
  if (bytes.size() < kEntryHead) return false;
  const std::byte* at = bytes.data();
  const auto call = wire::load<std::uint8_t>(at);
  const std::size_t data = wire::load<std::uint32_t>(at + 17);
  if (call < 1 || call > 9 || data > bytes.size() - kEntryHead) return false;
  entry.call = static_cast<Call>(call);
  entry.sender = static_cast<std::int32_t>(wire::load<std::uint32_t>(at + 1));
  entry.round = static_cast<std::int32_t>(wire::load<std::uint32_t>(at + 5));
  entry.sample = static_cast<std::int64_t>(wire::load<std::uint64_t>(at + 9));
  entry.data = bytes.subspan(kEntryHead, data);
  size = kEntryHead + data;
  return true;
}

inline void write_numbers(std::span<const double> numbers, std::byte* out) noexcept {
  for (std::size_t k = 0; k < numbers.size(); ++k) wire::store_double(out + 8 * k, numbers[k]);
}
inline void read_numbers(Bytes bytes, std::span<double> numbers) noexcept {
  for (std::size_t k = 0; k < numbers.size() && 8 * k + 8 <= bytes.size(); ++k)
    numbers[k] = wire::load_double(bytes.data() + 8 * k);
}

/// Does again what a journal says. `wrong()` counts the estimates that differ in a bit and the calls that
/// were refused this time.
/// Threads: one at a time.
class GARRISON_EXPORT Replay {
 public:
  /// `sent`, if there is one, is shown every body that comes of it: sample, round, body.
  explicit Replay(Agent& agent, std::function<void(std::int64_t, int, Bytes)> sent = {});
  void operator()(const Entry& entry);
  /// All entries of a journal; false when it is cut.
  bool all(Bytes journal);
  std::int64_t estimates() const noexcept { return estimates_; }
  std::int64_t wrong() const noexcept { return wrong_; }

 private:
  void compare(Bytes expected);
  bool done(const Entry& entry);
  bool show(Agent::Sent sent);

  Agent& agent_;
  std::function<void(std::int64_t, int, Bytes)> sent_;
  std::vector<std::byte> room_;
  std::vector<double> numbers_;
  std::int64_t estimates_ = 0;
  std::int64_t wrong_ = 0;
};

}  // namespace garrison::node
