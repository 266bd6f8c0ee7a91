// SPDX-License-Identifier: Apache-2.0
// garrison-mpi: one network on many ranks. docs/how-to/one-huge-network.md.
#include <mpi.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>

#include "garrison/version.hpp"
#include "mpi/here.hpp"
#include "mpi/memory.hpp"
#include "mpi/owners.hpp"
#include "mpi/run.hpp"
#include "mpi/spectrum.hpp"
#include "mpi/whole.hpp"
#include "partition/split.hpp"

using namespace garrison;
using namespace garrison::mpi;

namespace {

constexpr const char* kUsage =
    "usage: mpirun -n R garrison-mpi run SCENARIO [-o FILE.nc] [--halo ROUNDS] [--checkpoint SAMPLES] "
    "[--resume] [--force] [--hash]\n"
    "       garrison-mpi partition SCENARIO --ranks R\n"
    "       mpirun -n R garrison-mpi spectrum SCENARIO [--products K] [--slepc]\n"
    "       garrison-mpi whole SCENARIO [--threads T]\n"
    "\n"
    "  run        runs the scenario on all ranks; the bits do not depend on their number\n"
    "  partition  decides beforehand which rank has which agents, and keeps it beside the scenario\n"
    "  spectrum   lambda_2 and lambda_max of the network, and the step that averages best\n"
    "  whole      runs it with the engine of one process and prints its hash, to compare\n"
    "\n"
    "  -o            results, netCDF\n"
    "  --halo        exchange every so many rounds of a sample; each rank works out what others do in "
    "between\n"
    "  --checkpoint  keep the states of all agents every so many samples\n"
    "  --resume      go on from the last checkpoint, on any number of ranks\n"
    "  --force       replace results that are there\n"
    "  --hash        print a hash of all estimates\n"
    "  --products    products with the Laplacian after which the search for its spectrum ends (5000)\n"
    "  --slepc       SLEPc in place of Lanczos, where it is built in\n"
    "  --version\n"
    "\n"
    "Exit codes: 0 done, 1 a spectrum that did not settle, 2 a file or the command line was refused (the "
    "message comes from rank 0 alone).\n";

struct Words {
  std::string command;
  RunCommand run;
  SpectrumCommand spectrum;
  std::int64_t ranks = 0;
  std::int64_t threads = 0;
};

std::int64_t number(const std::string& option, const char* word) {
  std::int64_t value = 0;
  const char* const end = word + std::strlen(word);
  const auto [stop, code] = std::from_chars(word, end, value);
  if (code != std::errc() || stop != end || value < 1 || value > 1'000'000'000)
    refuse(option, std::string("\"") + word + "\"", "a whole number in 1..1000000000");
  return value;
}

Words read_words(int count, char** words) {
  Words out;
  out.command = count > 1 ? words[1] : "";
  out.run.program = words[0];
  const bool known = out.command == "run" || out.command == "partition" || out.command == "spectrum" ||
                     out.command == "whole";
  if (!known)
    refuse("garrison-mpi", "\"" + out.command + "\"", "run, partition, spectrum or whole", "see --help");
  for (int k = 2; k < count; ++k) {
    const std::string word = words[k];
    const auto value = [&] {
      const char* const next = k + 1 < count ? words[++k] : "";
      if (*next == '\0' || std::string_view(next).starts_with("--"))
        refuse(word, "nothing behind it", "a value", "see --help");
      return next;
    };
    const bool runs = out.command == "run";
    if (runs && word == "-o")
      out.run.results = value();
    else if (runs && word == "--checkpoint")
      out.run.checkpoint = number(word, value());
    else if (runs && word == "--halo")
      out.run.halo = number(word, value());
    else if (runs && word == "--resume")
      out.run.resume = true;
    else if (runs && word == "--force")
      out.run.force = true;
    else if (runs && word == "--hash")
      out.run.hash = true;
    else if (out.command == "partition" && word == "--ranks")
      out.ranks = number(word, value());
    else if (out.command == "spectrum" && word == "--products")
      out.spectrum.products = number(word, value());
    else if (out.command == "spectrum" && word == "--slepc")
      out.spectrum.slepc = true;
    else if (out.command == "whole" && word == "--threads")
      out.threads = number(word, value());
    else if (word.starts_with("-") || !out.run.scenario.empty())
      refuse("garrison-mpi " + out.command, "\"" + word + "\"", "one SCENARIO and the options of --help");
    else
      out.run.scenario = word;
  }
  if (out.run.scenario.empty())
    refuse("garrison-mpi " + out.command, "no SCENARIO", "a TOML file", "see --help");
  out.spectrum.scenario = out.run.scenario;
  if (out.command == "partition" && out.ranks == 0) refuse("--ranks", "nothing", "a number of ranks");
  if (out.run.results.empty() && (out.run.checkpoint > 0 || out.run.resume))
    refuse("-o", "nothing", "the results that a checkpoint belongs to");
  return out;
}

void make_partition(const Words& words) {
  const auto ranks = static_cast<int>(words.ranks);
  if (ranks < 2) refuse("--ranks", "1", "at least 2", "one rank has all agents");
  const Scenario scenario = read_scenario(words.run.scenario, kPartition);
  const Owners owners = owners_of(scenario, ranks);
  if (!owners.not_kept.empty()) throw IoError(owners.not_kept);
  std::printf("%d agents on %d ranks (%s): %s\n", scenario.agents(), ranks, owners.made.c_str(),
              cache_of(scenario, ranks).c_str());
}

int obey(int count, char** words, int rank) {
  try {
    const Words given = read_words(count, words);
    if (given.command == "run") run(given.run);
    if (given.command == "spectrum" && !print_spectrum(given.spectrum)) return 1;
    if (rank == 0 && given.command == "partition") make_partition(given);
    if (rank == 0 && given.command == "whole") run_whole(given.run.scenario, static_cast<int>(given.threads));
    return 0;
  } catch (const Error& error) {  // the same on all ranks
    if (rank == 0) std::fprintf(stderr, "garrison-mpi: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {  // memory, mostly, on this rank alone
    std::fprintf(stderr, "garrison-mpi: rank %d: %s\n", rank, error.what());
    MPI_Abort(MPI_COMM_WORLD, 2);
    return 2;
  }
}

/// `code`, unless what was printed, which may be all that was asked for, did not reach its place: a full
/// disk.
int printed(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  std::fprintf(stderr, "garrison-mpi: standard output: got %s, expected a place to write to\n",
               std::strerror(errno));
  return 2;
}

}  // namespace

int main(int count, char** words) {
  const std::string_view first = count > 1 ? words[1] : "";
  const bool help = std::any_of(words + std::min(count, 1), words + count,
                                [](const std::string_view word) { return word == "--help" || word == "-h"; });
  if (first == "--version") return std::printf("garrison-mpi " GARRISON_VERSION "\n"), printed(0);
  if (help) return std::fputs(kUsage, stdout), printed(0);
  MPI_Init(&count, &words);
  const int code = printed(obey(count, words, this_rank()));
  MPI_Finalize();
  return code;
}
