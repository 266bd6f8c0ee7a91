// SPDX-License-Identifier: Apache-2.0
// Files of a node: read whole, written so that a crash leaves the old or the new one.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "garrison/node/bytes.hpp"

namespace garrison::node {

/// A file descriptor that is closed at the end.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();
  int get() const noexcept { return number_; }
  explicit operator bool() const noexcept { return number_ >= 0; }

 private:
  int number_ = -1;
};

/// "FILE: got No such file or directory, expected ..."; takes errno.
[[noreturn]] void refuse_file(const std::string& path, const std::string& expected);

/// At most `most` bytes. `expected`: what it should be, for refusals. @throws IoError
std::vector<std::byte> read_bytes(const std::string& path, std::size_t most = 64U << 20U,
                                  const std::string& expected = "a file that can be read");
std::string read_text(const std::string& path, const std::string& expected = "a file that can be read");
/// Beside the file, onto the disk, and then in its place. @throws IoError
void replace_file(const std::string& path, Bytes content, int mode = 0600);
void make_folder(const std::string& path);
/// `path` as it is meant in a file of `folder`.
std::string beside(const std::string& folder, const std::string& path);
std::string folder_of(const std::string& path);

}  // namespace garrison::node
