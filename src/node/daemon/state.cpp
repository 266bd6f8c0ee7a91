// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/state.hpp"

#include <charconv>
#include <filesystem>

#include "garrison/core/error.hpp"
#include "garrison/node/crypto.hpp"
#include "node/daemon/files.hpp"

namespace garrison::node {

namespace {
constexpr std::string_view kMagic = "GSTATE01";
constexpr std::size_t kHead = kMagic.size() + std::tuple_size_v<Prologue> + 8;
constexpr std::size_t kDigest = 16;
}  // namespace

std::uint64_t last_boot(const std::string& folder) {
  const std::string path = beside(folder, "boot");
  if (!std::filesystem::exists(path)) return 0;
  const std::string text = read_text(path);
  std::uint64_t boot = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), boot);
  const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (error != std::errc{} || rest.find_first_not_of(" \r\n") != std::string_view::npos || boot == UINT64_MAX)
    refuse(path, "\"" + text.substr(0, 40) + "\"", "how often this node has started",
           "write a number that is greater than it ever was");
  return boot;
}

std::uint64_t next_boot(const std::string& folder) {
  const std::uint64_t boot = last_boot(folder) + 1;
  const std::string text = std::to_string(boot) + "\n";
  replace_file(beside(folder, "boot"), text_bytes(text));
  return boot;
}

std::vector<std::byte> state_bytes(const Prologue& run, Bytes snapshot) {
  std::vector<std::byte> all(kHead + snapshot.size() + kDigest);
  copy(text_bytes(kMagic), all.data());
  copy(run, all.data() + kMagic.size());
  wire::store(all.data() + kHead - 8, static_cast<std::uint64_t>(snapshot.size()));
  copy(snapshot, all.data() + kHead);
  hash({}, {Bytes(all).first(all.size() - kDigest)}, std::span(all).last(kDigest));
  return all;
}

void write_state(const std::string& folder, const Prologue& run, Bytes snapshot) {
  replace_file(beside(folder, "state"), state_bytes(run, snapshot));
}

std::optional<std::vector<std::byte>> snapshot_in(Bytes file, const Prologue& run) {
  if (file.size() < kHead + kDigest) return {};
  std::array<std::byte, kDigest> digest;
  hash({}, {file.first(file.size() - kDigest)}, digest);
  const std::size_t size = file.size() - kHead - kDigest;
  const bool ours = same(digest, file.last(kDigest)) && same(file.first(kMagic.size()), text_bytes(kMagic)) &&
                    same(file.subspan(kMagic.size(), run.size()), run) &&
                    wire::load<std::uint64_t>(file.data() + kHead - 8) == size;
  if (!ours) return {};
  return std::vector<std::byte>(file.begin() + kHead,
                                file.begin() + static_cast<std::ptrdiff_t>(kHead + size));
}

std::optional<std::vector<std::byte>> read_state(const std::string& folder, const Prologue& run) {
  if (!has_state(folder)) return {};
  return snapshot_in(read_bytes(beside(folder, "state")), run);
}

bool has_state(const std::string& folder) { return std::filesystem::exists(beside(folder, "state")); }

}  // namespace garrison::node
