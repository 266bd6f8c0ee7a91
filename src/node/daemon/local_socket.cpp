// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/local_socket.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "garrison/core/error.hpp"

namespace garrison::node {

namespace {
sockaddr_un address_of(const std::string& path) {
  sockaddr_un out{};
  out.sun_family = AF_UNIX;
  if (path.size() >= sizeof out.sun_path)
    refuse("[socket].path", path,
           "a path of at most " + std::to_string(sizeof out.sun_path - 1) + " characters");
  std::memcpy(out.sun_path, path.data(), path.size());
  return out;
}
}  // namespace

LocalSocket::LocalSocket(std::string path, std::function<std::string(std::string_view)> answer)
    : path_(std::move(path)),
      answer_(std::move(answer)),
      listening_(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  const sockaddr_un address = address_of(path_);
  make_folder(folder_of(path_));
  struct stat found{};
  if (::lstat(path_.c_str(), &found) == 0 && S_ISSOCK(found.st_mode))
    ::unlink(path_.c_str());  // of an earlier life
  if (::bind(listening_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(path_.c_str(), 0660) != 0 || ::listen(listening_.get(), kMostClients) != 0)
    refuse_file(path_, "a path at which a socket can be made");
}

LocalSocket::~LocalSocket() { ::unlink(path_.c_str()); }

void LocalSocket::wait_for(std::vector<pollfd>& all) const {
  all.push_back({listening_.get(), POLLIN, 0});
  for (const Client& c : clients_)
    all.push_back({c.socket.get(), static_cast<short>(c.out.empty() ? POLLIN : POLLIN | POLLOUT), 0});
}

void LocalSocket::serve() {
  take();
  for (Client& c : clients_) {
    read(c);
    write(c);
  }
  clients_.remove_if([](const Client& c) { return c.gone; });
}

void LocalSocket::tell(const std::string& line) {
  for (Client& c : clients_) {
    if (!c.watches) continue;
    c.out += line + "\n";
    c.gone |= c.out.size() > kMostWaiting;
    write(c);
  }
}

bool LocalSocket::watched() const noexcept {
  return std::any_of(clients_.begin(), clients_.end(), [](const Client& c) { return c.watches; });
}

void LocalSocket::take() {
  while (true) {
    Descriptor next(::accept4(listening_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!next) return;
    if (clients_.size() < kMostClients) clients_.push_back({std::move(next), {}, {}, false, false});
  }
}

void LocalSocket::read(Client& client) {
  char piece[1024];
  ssize_t got = 0;
  while ((got = ::read(client.socket.get(), piece, sizeof piece)) > 0) {
    client.in.append(piece, static_cast<std::size_t>(got));
    std::size_t end = 0;
    while ((end = client.in.find('\n')) != std::string::npos) {
      request(client, std::string_view(client.in).substr(0, end));
      client.in.erase(0, end + 1);
    }
    if (client.in.size() > kLongestRequest || client.out.size() > kMostWaiting) {
      client.gone = true;
      return;
    }
  }
  client.gone |= got == 0 || (errno != EAGAIN && errno != EINTR);
}

void LocalSocket::request(Client& client, std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  if (line == "watch") {
    client.watches = true;
    return;
  }
  const std::string answer = answer_(line);
  if (!answer.empty()) client.out += answer + "\n";
}

void LocalSocket::write(Client& client) {
  while (!client.out.empty()) {
    const ssize_t sent = ::send(client.socket.get(), client.out.data(), client.out.size(), MSG_NOSIGNAL);
    if (sent <= 0) {
      client.gone |= errno != EAGAIN && errno != EINTR;
      return;
    }
    client.out.erase(0, static_cast<std::size_t>(sent));
  }
}

}  // namespace garrison::node
