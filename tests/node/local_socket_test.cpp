// SPDX-License-Identifier: Apache-2.0
// The local socket and its client: requests, those who watch, and those who do not keep up.
#include "node/daemon/local_socket.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "folder.hpp"
#include "garrison/node/client.hpp"
#include "mutants.hpp"

using namespace garrison::node;
using namespace garrison::node::test;

namespace {

/// A socket that is served by a thread, and that says what it was asked.
class Served {
 public:
  explicit Served(const std::string& path)
      : socket_(path, [](std::string_view request) { return "[" + std::string(request) + "]"; }),
        thread_([this] {
          while (!ended_) {
            std::vector<pollfd> all;
            socket_.wait_for(all);
            ::poll(all.data(), all.size(), 5);
            socket_.serve();
            if (socket_.watched()) socket_.tell("{\"t\":" + std::to_string(++t_) + "}");
          }
        }) {}
  ~Served() {
    ended_ = true;
    thread_.join();
  }

 private:
  LocalSocket socket_;
  std::atomic<bool> ended_{false};
  std::int64_t t_ = 0;
  std::thread thread_;
};

}  // namespace

TEST_CASE("clients ask, measure and watch") {
  const Folder folder;
  const Served served(folder / "node.sock");
  Client client(folder / "node.sock");
  CHECK(client.status() == "[status]");
  const double y[] = {0.1, std::numeric_limits<double>::quiet_NaN(), -2e300};
  CHECK(client.measure(y) == "[y 0.10000000000000001 nan -2.0000000000000001e+300]");
  Client watching(folder / "node.sock");
  watching.watch();
  CHECK(watching.next().starts_with("{\"t\":"));
  CHECK(watching.next() > "{");
  CHECK(client.status() == "[status]");
}

TEST_CASE("a client that asks nonsense, too much or goes is no harm to others") {
  const Folder folder;
  const Served served(folder / "node.sock");
  std::mt19937_64 random(6);
  Client good(folder / "node.sock");
  for (int k = 0; k < 50; ++k) {
    Client bad(folder / "node.sock");
    const std::vector<double> many(static_cast<std::size_t>(random() % 2000), 1.5);
    try {
      bad.measure(many);
    } catch (const std::runtime_error&) {  // a request of more than 4096 bytes
    }
    CHECK(good.status() == "[status]");
  }
}

TEST_CASE("the socket of an earlier life is replaced, anything else is not") {
  const Folder folder;
  {
    const Served served(folder / "node.sock");
  }
  CHECK_FALSE(std::filesystem::exists(folder / "node.sock"));
  CHECK_THROWS_AS(Client(folder / "node.sock"), std::system_error);
  std::filesystem::create_directory(folder / "taken");
  CHECK_THROWS(Served(folder / "taken"));
  CHECK(std::filesystem::is_directory(folder / "taken"));
}
