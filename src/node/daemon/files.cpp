// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "garrison/core/error.hpp"

namespace garrison::node {

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

void refuse_file(const std::string& path, const std::string& expected) {
  throw IoError(path + ": got " + std::strerror(errno) + ", expected " + expected);
}

std::vector<std::byte> read_bytes(const std::string& path, std::size_t most, const std::string& expected) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file) refuse_file(path, expected);
  struct stat found{};
  if (::fstat(file.get(), &found) != 0) refuse_file(path, expected);
  // A pipe would be waited for for ever, a device never ends.
  if (!S_ISREG(found.st_mode)) throw IoError(path + ": got no plain file, expected " + expected);
  std::vector<std::byte> all;
  std::array<std::byte, 65536> piece;
  while (true) {
    const ssize_t got = ::read(file.get(), piece.data(), piece.size());
    if (got < 0) refuse_file(path, expected);
    if (got == 0) return all;
    all.insert(all.end(), piece.begin(), piece.begin() + got);
    if (all.size() > most)
      throw IoError(path + ": got more than " + amount(most, "byte") + ", expected a smaller file");
  }
}

std::string read_text(const std::string& path, const std::string& expected) {
  const auto bytes = read_bytes(path, 64U << 20U, expected);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

namespace {

void fill_file(const Descriptor& file, const std::string& path, Bytes content) {
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t wrote = ::write(file.get(), content.data() + done, content.size() - done);
    if (wrote < 0) refuse_file(path, "room on the disk");
    done += static_cast<std::size_t>(wrote);
  }
  if (::fsync(file.get()) != 0) refuse_file(path, "a disk that takes it");
}

}  // namespace

void replace_file(const std::string& path, Bytes content, int mode) {
  const std::string beside_it = path + ".new";
  {
    const Descriptor file(
        ::open(beside_it.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, static_cast<mode_t>(mode)));
    if (!file) refuse_file(beside_it, "a file that can be written");
    try {
      fill_file(file, beside_it, content);
    } catch (const IoError&) {
      ::unlink(beside_it.c_str());  // half of a file helps nobody, and takes room
      throw;
    }
  }
  if (::rename(beside_it.c_str(), path.c_str()) != 0) refuse_file(path, "a file that can be replaced");
  const Descriptor folder(::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder) ::fsync(folder.get());
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw IoError(path + ": got " + error.message() + ", expected a folder that can be made");
}

std::string beside(const std::string& folder, const std::string& path) {
  return (std::filesystem::path(folder) / path).lexically_normal().string();
}
std::string folder_of(const std::string& path) {
  const auto parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

}  // namespace garrison::node
