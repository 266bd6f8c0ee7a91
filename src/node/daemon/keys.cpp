// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/keys.hpp"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include "garrison/core/error.hpp"
#include "node/daemon/files.hpp"
#include "node/octets.hpp"

namespace garrison::node {

namespace {
constexpr std::string_view kHead = "garrison-key-1 ";
using Signing = std::array<std::byte, crypto_sign_SECRETKEYBYTES>;
}  // namespace

Identity identity_of(const Key& seed) {
  Identity out{seed, {}, {}};
  Signing secret;
  crypto_sign_seed_keypair(octets(out.open), octets(secret), octets(seed));
  Key exchange{};
  crypto_sign_ed25519_sk_to_curve25519(octets(exchange), octets(secret));
  out.exchange = key_pair(exchange);
  wipe(secret);
  wipe(exchange);
  return out;
}

Key random_seed() {
  Key seed;
  randombytes_buf(seed.data(), seed.size());
  return seed;
}

bool exchange_key(const Key& open, Key& out) noexcept {
  return crypto_sign_ed25519_pk_to_curve25519(octets(out), octets(open)) == 0;
}

std::string base64(Bytes bytes) {
  std::string out(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(out.data(), out.size(), octets(bytes), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  out.pop_back();  // its zero
  return out;
}

Key key_from(const std::string& which, const std::string& base64) {
  Key key{};
  std::size_t size = 0;
  const int bad = sodium_base642bin(octets(key), key.size(), base64.data(), base64.size(), nullptr, &size,
                                    nullptr, sodium_base64_VARIANT_ORIGINAL);
  if (bad != 0 || size != key.size())
    refuse(which, std::to_string(base64.size()) + " characters that are not 32 bytes in base64",
           "44 characters, as garrison-keygen prints them", "copy the line once more");
  return key;
}

Key open_key_from(const std::string& which, const std::string& base64) {
  const Key key = key_from(which, base64);
  Key exchange{};
  if (!exchange_key(key, exchange))
    refuse(which, "32 bytes that are no point of the curve", "the public key that garrison-keygen printed");
  return key;
}

void write_key(const std::string& path, const Identity& identity) {
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!file) refuse_file(path, "a new file in a folder that can be written");
  const std::string line = std::string(kHead) + base64(identity.seed) + "\n";
  if (::write(file.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    refuse_file(path, "room on the disk");
}

Identity read_key(const std::string& path) {
  struct stat found{};
  if (::stat(path.c_str(), &found) != 0) refuse_file(path, "the key that garrison-keygen wrote");
  if (!S_ISREG(found.st_mode)) refuse(path, "no plain file", "the key that garrison-keygen wrote");
  if ((found.st_mode & 077U) != 0)
    refuse(path, "a key that others than its owner may read or write", "mode 0600", "chmod 600 " + path);
  std::string text = read_text(path);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  if (!text.starts_with(kHead)) refuse(path, "no key", "a file that garrison-keygen wrote");
  const Identity out = identity_of(key_from(path, text.substr(kHead.size())));
  wipe(std::as_writable_bytes(std::span(text)));
  return out;
}

}  // namespace garrison::node
