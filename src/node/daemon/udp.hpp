// SPDX-License-Identifier: Apache-2.0
// Real datagrams: one socket, many a call, nothing allocated after the start.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <functional>
#include <memory>
#include <string>

#include "garrison/node/frame.hpp"
#include "node/daemon/files.hpp"

namespace garrison::node {

struct Address {
  sockaddr_storage storage{};
  socklen_t size = 0;
  const sockaddr* get() const noexcept { return reinterpret_cast<const sockaddr*>(&storage); }
};

/// "127.0.0.1:7470", "[::1]:7470", "host:7470". @throws InvalidInput
Address address_from(const std::string& which, const std::string& text);
/// "host:port", numbers only.
std::string text_of(const Address& address);
/// Refuses what no socket of this machine can be bound to, whether or not somebody listens there. @throws
/// IoError
void require_own(const std::string& which, Address address);

bool same_address(const Address& a, const Address& b) noexcept;
/// Of this machine alone.
bool is_loopback(const Address& address) noexcept;
/// 0.0.0.0 or [::]: where to listen, not where to send to.
bool is_any(const Address& address) noexcept;

class Udp {
 public:
  /// @throws IoError when the address cannot be had. receive_buffer: bytes.
  Udp(const std::string& which, const Address& own, int receive_buffer);

  int descriptor() const noexcept { return socket_.get(); }
  /// Kept until `flush`, or until there are many.
  void send(const Address& to, Bytes datagram) noexcept;
  void flush() noexcept;
  /// Shows what has arrived, at most kBatch; returns how many.
  template <class Take>
  int receive(Take take) noexcept {
    const int count = receive_batch();
    for (int k = 0; k < count; ++k) take(received(k));
    return count;
  }
  std::int64_t unsent() const noexcept { return unsent_; }

  static constexpr int kBatch = 64;

 private:
  struct Batch;
  int receive_batch() noexcept;
  Bytes received(int k) const noexcept;

  Descriptor socket_;
  std::unique_ptr<Batch, void (*)(Batch*)> in_;
  std::unique_ptr<Batch, void (*)(Batch*)> out_;
  int waiting_ = 0;
  std::int64_t unsent_ = 0;
};

}  // namespace garrison::node
