// SPDX-License-Identifier: Apache-2.0
// Records from one thread to another, without a lock, a wait or memory from the heap: what does not fit is
// refused, and its writer goes on.
#pragma once

#include <atomic>
#include <memory>

#include "garrison/node/bytes.hpp"

namespace garrison::node {

class Ring {
 public:
  /// `size`: bytes, a power of two.
  explicit Ring(std::size_t size) : size_(size), bytes_(new std::byte[size]) {}

  /// One record of these pieces; false when there is no room.
  bool put(std::uint8_t kind, std::initializer_list<Bytes> pieces) noexcept {
    std::size_t content = 0;
    for (const Bytes piece : pieces) content += piece.size();
    const std::size_t written = written_.load(std::memory_order_relaxed);
    if (size_ - (written - read_.load(std::memory_order_acquire)) < kHead + content) return false;
    std::array<std::byte, kHead> head;
    wire::store(head.data(), static_cast<std::uint32_t>(content));
    wire::store(head.data() + 4, kind);
    std::size_t at = write(written, head);
    for (const Bytes piece : pieces) at = write(at, piece);
    written_.store(at, std::memory_order_release);
    return true;
  }

  /// Shows the oldest record and drops it: take(kind, content). False when there is none. `room` is where it
  /// is put together; it grows.
  template <class Room, class Take>
  bool take(Room& room, Take shown) {
    const std::size_t read = read_.load(std::memory_order_relaxed);
    if (written_.load(std::memory_order_acquire) == read) return false;
    std::array<std::byte, kHead> head;
    copy_out(read, head);
    room.resize(wire::load<std::uint32_t>(head.data()));
    copy_out(read + kHead, room);
    read_.store(read + kHead + room.size(), std::memory_order_release);
    shown(wire::load<std::uint8_t>(head.data() + 4), Bytes(room));
    return true;
  }

 private:
  static constexpr std::size_t kHead = 5;

  std::size_t write(std::size_t at, Bytes piece) noexcept {
    const std::size_t from = at & (size_ - 1);
    const std::size_t first = std::min(piece.size(), size_ - from);
    copy(piece.first(first), bytes_.get() + from);
    copy(piece.subspan(first), bytes_.get());
    return at + piece.size();
  }
  void copy_out(std::size_t at, std::span<std::byte> to) const noexcept {
    const std::size_t from = at & (size_ - 1);
    const std::size_t first = std::min(to.size(), size_ - from);
    copy({bytes_.get() + from, first}, to.data());
    copy({bytes_.get(), to.size() - first}, to.data() + first);
  }

  std::size_t size_;
  std::unique_ptr<std::byte[]> bytes_;
  alignas(64) std::atomic<std::size_t> written_{0};
  alignas(64) std::atomic<std::size_t> read_{0};
};

}  // namespace garrison::node
