// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/udp.hpp"

#include <netdb.h>

#include <cstring>

#include "garrison/core/error.hpp"

namespace garrison::node {

struct Udp::Batch {
  // One byte more than any datagram of ours: longer ones are seen to be so.
  std::array<std::array<std::byte, kMostDatagram + 1>, kBatch> bytes;
  std::array<iovec, kBatch> pieces;
  std::array<mmsghdr, kBatch> heads{};
  std::array<Address, kBatch> to;

  Batch() {
    for (std::size_t k = 0; k < kBatch; ++k) {
      pieces[k] = {bytes[k].data(), bytes[k].size()};
      heads[k].msg_hdr.msg_iov = &pieces[k];
      heads[k].msg_hdr.msg_iovlen = 1;
    }
  }
  static void end(Batch* batch) { delete batch; }
};

namespace {
/// Multicast, or everybody's.
bool of_many(const Address& address) noexcept {
  if (address.storage.ss_family == AF_INET) {
    const auto ip = ntohl(reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr.s_addr);
    return IN_MULTICAST(ip) || ip == INADDR_BROADCAST;
  }
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address.storage);
  return IN6_IS_ADDR_MULTICAST(&v6.sin6_addr);
}
}  // namespace

Address address_from(const std::string& which, const std::string& text) {
  const char* expected = "\"host:port\", e.g. \"127.0.0.1:7470\" or \"[::1]:7470\"";
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon + 1 == text.size()) refuse(which, "\"" + text + "\"", expected);
  std::string host = text.substr(0, colon);
  const std::string port = text.substr(colon + 1);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  if (host.empty() || port.size() > 5 || port.find_first_not_of("0123456789") != std::string::npos ||
      std::stoi(port) < 1 || std::stoi(port) > 65535)
    refuse(which, "\"" + text + "\"", expected);
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int bad = ::getaddrinfo(host.c_str(), port.c_str(), &wanted, &found); bad != 0)
    refuse(which, "\"" + text + "\" (" + ::gai_strerror(bad) + ")", "a host that is known here");
  Address out;
  std::memcpy(&out.storage, found->ai_addr, found->ai_addrlen);
  out.size = found->ai_addrlen;
  ::freeaddrinfo(found);
  if (of_many(out)) refuse(which, "\"" + text + "\", an address of many", "that of one machine");
  return out;
}

std::string text_of(const Address& address) {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  ::getnameinfo(address.get(), address.size, host.data(), host.size(), port.data(), port.size(),
                NI_NUMERICHOST | NI_NUMERICSERV);
  const bool six = address.storage.ss_family == AF_INET6;
  return (six ? "[" : "") + std::string(host.data()) + (six ? "]:" : ":") + port.data();
}

void require_own(const std::string& which, Address address) {
  if (address.storage.ss_family == AF_INET6)
    reinterpret_cast<sockaddr_in6&>(address.storage).sin6_port = 0;
  else
    reinterpret_cast<sockaddr_in&>(address.storage).sin_port = 0;
  const Descriptor tried(::socket(address.storage.ss_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!tried || ::bind(tried.get(), address.get(), address.size) != 0)
    refuse_file(which, "an address of this machine, or 0.0.0.0 for all that it has");
}

bool same_address(const Address& a, const Address& b) noexcept {
  return a.size == b.size && std::memcmp(&a.storage, &b.storage, a.size) == 0;
}

bool is_loopback(const Address& address) noexcept {
  if (address.storage.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address.storage);
    return ntohl(v4.sin_addr.s_addr) >> 24U == 127;
  }
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address.storage);
  return address.storage.ss_family == AF_INET6 && IN6_IS_ADDR_LOOPBACK(&v6.sin6_addr);
}

bool is_any(const Address& address) noexcept {
  if (address.storage.ss_family == AF_INET)
    return reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr.s_addr == htonl(INADDR_ANY);
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address.storage);
  return IN6_IS_ADDR_UNSPECIFIED(&v6.sin6_addr);
}

Udp::Udp(const std::string& which, const Address& own, int receive_buffer)
    : socket_(::socket(own.storage.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)),
      in_(new Batch, &Batch::end),
      out_(new Batch, &Batch::end) {
  if (!socket_) refuse_file(which, "a UDP socket");
  ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  if (::bind(socket_.get(), own.get(), own.size) != 0)
    refuse_file(which + " = " + text_of(own), "an address of this machine that nobody else listens at");
}

void Udp::send(const Address& to, Bytes datagram) noexcept {
  const auto k = static_cast<std::size_t>(waiting_++);
  copy(datagram, out_->bytes[k].data());
  out_->pieces[k].iov_len = datagram.size();
  out_->to[k] = to;
  out_->heads[k].msg_hdr.msg_name = &out_->to[k].storage;
  out_->heads[k].msg_hdr.msg_namelen = to.size;
  if (waiting_ == kBatch) flush();
}

/// What the system does not take is lost, as on any network.
void Udp::flush() noexcept {
  int done = 0;
  while (done < waiting_) {
    const int sent = ::sendmmsg(socket_.get(), out_->heads.data() + done,
                                static_cast<unsigned>(waiting_ - done), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent <= 0) ++unsent_;
    done += std::max(sent, 1);
  }
  waiting_ = 0;
}

int Udp::receive_batch() noexcept {
  return std::max(0, ::recvmmsg(socket_.get(), in_->heads.data(), kBatch, MSG_DONTWAIT, nullptr));
}
Bytes Udp::received(int k) const noexcept {
  const auto at = static_cast<std::size_t>(k);
  return {in_->bytes[at].data(), in_->heads[at].msg_len};
}

}  // namespace garrison::node
