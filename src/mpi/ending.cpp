// SPDX-License-Identifier: Apache-2.0
#include "mpi/ending.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <ctime>

namespace garrison::mpi {
namespace {

// Signal handlers may read these: they are written while the signal is blocked.
std::array<char, 32768> said{};  // two paths as long as any can be, quoted
std::array<char, 4096> flag_path{};
std::size_t said_size = 0;

/// For how long the others find the flag: mpirun ends them at once, and kills them a second later.
constexpr timespec kOthers{0, 300'000'000};

void ended(int number) {
  const int flag = ::open(flag_path.data(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0644);
  if (flag >= 0) {
    const auto wrote = ::write(STDERR_FILENO, said.data(), said_size);
    static_cast<void>(wrote);
    ::nanosleep(&kOthers, nullptr);
    ::unlink(flag_path.data());
  }
  ::_exit(128 + number);
}

}  // namespace

void say_when_ended(const std::string& line, const std::string& flag) {
  sigset_t term;
  sigset_t before;
  sigemptyset(&term);
  sigaddset(&term, SIGTERM);
  sigprocmask(SIG_BLOCK, &term, &before);
  said_size = std::min(line.size(), said.size());
  std::copy_n(line.begin(), said_size, said.begin());
  const std::size_t length = std::min(flag.size(), flag_path.size() - 1);
  std::copy_n(flag.begin(), length, flag_path.begin());
  flag_path[length] = '\0';
  std::signal(SIGTERM, ended);
  sigprocmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace garrison::mpi
