// SPDX-License-Identifier: Apache-2.0
// A client of a running node's Unix socket, for programs that need nothing else of garrison: this header
// alone. docs/node.md has what a node answers.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>

namespace garrison::node {

/// Threads: one at a time.
class Client {
 public:
  /// @throws std::system_error when nobody answers at `path` ([socket].path of the node)
  explicit Client(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un to{};
    to.sun_family = AF_UNIX;
    if (path.size() >= sizeof to.sun_path)
      throw std::system_error(ENAMETOOLONG, std::generic_category(), path);
    std::memcpy(to.sun_path, path.data(), path.size());
    if (socket_ >= 0 && ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return;
    const int error = errno;
    if (socket_ >= 0) ::close(socket_);
    throw std::system_error(error, std::generic_category(), path);
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Everything the node says of itself, a line of JSON.
  std::string status() { return ask("status"); }
  /// Hands over a measurement, NaN = missing; for a node with source = "socket". The answer is JSON, too.
  std::string measure(std::span<const double> y) {
    std::string request = "y";
    char number[32];
    for (const double value : y) {
      std::snprintf(number, sizeof number, value == value ? " %.17g" : " nan", value);
      request += number;
    }
    return ask(request);
  }
  /// From here on `next` gives a line of JSON a sample, and nothing else can be asked.
  void watch() { send("watch"); }
  /// The next line. @throws std::runtime_error when the node has ended
  std::string next() {
    std::size_t end = 0;
    while ((end = in_.find('\n')) == std::string::npos) {
      char piece[4096];
      const ssize_t got = ::read(socket_, piece, sizeof piece);
      if (got == 0 || (got < 0 && errno != EINTR))
        throw std::runtime_error("the node has ended the connection");
      if (got > 0) in_.append(piece, static_cast<std::size_t>(got));
    }
    std::string line = in_.substr(0, end);
    in_.erase(0, end + 1);
    return line;
  }

 private:
  std::string ask(const std::string& request) {
    send(request);
    return next();
  }
  void send(std::string line) {
    line += '\n';
    for (std::size_t done = 0; done < line.size();) {
      const ssize_t sent = ::send(socket_, line.data() + done, line.size() - done, MSG_NOSIGNAL);
      if (sent < 0 && errno != EINTR) throw std::runtime_error("the node has ended the connection");
      if (sent > 0) done += static_cast<std::size_t>(sent);
    }
  }

  int socket_;
  std::string in_;
};

}  // namespace garrison::node
