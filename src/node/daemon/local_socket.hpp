// SPDX-License-Identifier: Apache-2.0
// The node's Unix socket: a request is a line, an answer is a line of JSON.
//
//   status      everything, once          watch   a line a sample, until the client goes
//   y 1.5 nan   a measurement, for source = "socket"
#pragma once

#include <poll.h>

#include <functional>
#include <list>
#include <string>
#include <vector>

#include "node/daemon/files.hpp"

namespace garrison::node {

class LocalSocket {
 public:
  /// answer(request): the line for it, without its end; empty = none. @throws IoError
  LocalSocket(std::string path, std::function<std::string(std::string_view)> answer);
  ~LocalSocket();
  LocalSocket(const LocalSocket&) = delete;
  LocalSocket& operator=(const LocalSocket&) = delete;

  /// Adds what to wait for; and does what can be done without waiting.
  void wait_for(std::vector<pollfd>& all) const;
  void serve();
  /// To all that watch. Who does not keep up is let go.
  void tell(const std::string& line);
  bool watched() const noexcept;

 private:
  static constexpr std::size_t kMostClients = 16;
  static constexpr std::size_t kLongestRequest = 4096;
  static constexpr std::size_t kMostWaiting = 256 << 10;

  struct Client {
    Descriptor socket;
    std::string in;
    std::string out;
    bool watches = false;
    bool gone = false;
  };
  void take();
  void read(Client& client);
  void request(Client& client, std::string_view line);
  static void write(Client& client);

  std::string path_;
  std::function<std::string(std::string_view)> answer_;
  Descriptor listening_;
  std::list<Client> clients_;
};

}  // namespace garrison::node
