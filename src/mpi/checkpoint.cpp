// SPDX-License-Identifier: Apache-2.0
#include "mpi/checkpoint.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "garrison/core/error.hpp"
#include "garrison/wire/blake2b.hpp"
#include "garrison/wire/bytes.hpp"
#include "mpi/here.hpp"
#include "mpi/together.hpp"
#include "node/daemon/files.hpp"

namespace garrison::mpi {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 40;
constexpr const char* kOtherwise = "start without --resume, with --force or another -o";
constexpr std::size_t kHead = 8;  // of a record: public id, bytes of its state

void append(std::vector<std::byte>& out, std::uint32_t value) {
  out.resize(out.size() + 4);
  wire::store(out.data() + out.size() - 4, value);
}

}  // namespace

std::string checkpoint_folder(const std::string& results) { return results + ".checkpoint"; }

Checkpoint::Checkpoint(const std::string& results, std::uint64_t scenario)
    : folder_(checkpoint_folder(results)), scenario_(scenario) {}

std::string Checkpoint::file_of(std::int64_t t, int rank, int ranks) const {
  return folder_ + "/sample-" + std::to_string(t) + "." + std::to_string(rank) + "-of-" +
         std::to_string(ranks);
}

void Checkpoint::clear() const {
  std::error_code failed;
  std::filesystem::remove(folder_ + "/latest", failed);  // first: without it the others count for nothing
  if (!failed && std::filesystem::is_directory(folder_))
    for (const auto& entry : std::filesystem::directory_iterator(folder_, failed))
      if (entry.path().filename().string().starts_with("sample-"))
        std::filesystem::remove(entry.path(), failed);
  if (failed)
    throw IoError(folder_ + ": got " + failed.message() +
                  ", expected to remove the checkpoint of an earlier run");
}

void Checkpoint::make() const { node::make_folder(folder_); }

void Checkpoint::write(std::int64_t t, const std::vector<int>& ids,
                       const partition::PartRunner& runner) const {
  const int rank = this_rank();
  const int ranks = all_ranks();
  together([&] {
    std::vector<std::byte> out;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      const std::size_t head = out.size();
      append(out, static_cast<std::uint32_t>(ids[k]));
      append(out, 0);
      runner.save(static_cast<int>(k), out);
      wire::store(out.data() + head + 4, static_cast<std::uint32_t>(out.size() - head - kHead));
    }
    const std::uint64_t sum = wire::checksum(out);
    out.resize(out.size() + 8);
    wire::store(out.data() + out.size() - 8, sum);
    node::replace_file(file_of(t, rank, ranks), out, 0644);
  });
  together([&] {
    if (rank != 0) return;
    const std::string line = "garrison-mpi 1 sample " + std::to_string(t) + " ranks " +
                             std::to_string(ranks) + " scenario " + std::to_string(scenario_) + "\n";
    node::replace_file(folder_ + "/latest", std::as_bytes(std::span(line)), 0644);
    const std::string kept = "sample-" + std::to_string(t) + ".";
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("sample-") && !name.starts_with(kept)) std::filesystem::remove(entry.path());
    }
  });
}

Checkpoint::Latest Checkpoint::latest() const {
  const std::string path = folder_ + "/latest";
  std::istringstream words(node::read_text(path, "a checkpoint: run with --checkpoint and --force first"));
  std::string program, version, a, b, c;
  Latest out{};
  std::uint64_t scenario = 0;
  words >> program >> version >> a >> out.sample >> b >> out.ranks >> c >> scenario;
  if (!words || program != "garrison-mpi" || version != "1" || out.sample < 1 || out.ranks < 1)
    refuse(path, "something else", "the line that garrison-mpi writes beside its checkpoints", kOtherwise);
  if (scenario != scenario_)
    refuse(path, "a checkpoint of another scenario",
           "one of the scenario, and of the files that it names, as they are now",
           "put back what was changed, or start with --force, not --resume");
  return out;
}

std::int64_t Checkpoint::sample() const { return latest().sample; }

void Checkpoint::read(const std::vector<int>& ids, partition::PartRunner& runner) const {
  const Latest from = latest();
  std::size_t found = 0;
  for (int rank = 0; rank < from.ranks; ++rank) {
    const std::string path = file_of(from.sample, rank, from.ranks);
    const auto bytes =
        node::read_bytes(path, kMostBytes, std::string("a part of the checkpoint; ") + kOtherwise);
    const std::size_t end = bytes.size() < 8 ? 0 : bytes.size() - 8;
    const std::span<const std::byte> content(bytes.data(), end);
    if (bytes.size() < 8 || wire::load<std::uint64_t>(bytes.data() + end) != wire::checksum(content))
      throw IoError(path + ": got a file that was cut or changed, expected what garrison-mpi wrote; " +
                    kOtherwise);
    for (std::size_t at = 0; at < end;) {
      const auto id = static_cast<int>(wire::load<std::uint32_t>(bytes.data() + at));
      const std::size_t size = wire::load<std::uint32_t>(bytes.data() + at + 4);
      const auto own = std::lower_bound(ids.begin(), ids.end(), id);
      if (own != ids.end() && *own == id) {
        runner.load(static_cast<int>(own - ids.begin()), content.subspan(at + kHead, size));
        ++found;
      }
      at += kHead + size;
    }
  }
  if (found != ids.size())
    refuse(folder_,
           "states of " + std::to_string(found) + " of " + amount(ids.size(), "agent") + " of a rank",
           "the state of every agent once", kOtherwise);
}

}  // namespace garrison::mpi
