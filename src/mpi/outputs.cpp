// SPDX-License-Identifier: Apache-2.0
#include "mpi/outputs.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "garrison/core/error.hpp"
#include "mpi/checkpoint.hpp"
#include "mpi/plain_file.hpp"
#include "node/daemon/files.hpp"

namespace garrison::mpi {
namespace {

namespace files = std::filesystem;

void require_other_file(const RunCommand& command, const Scenario& scenario) {
  std::vector<std::string> inputs{command.scenario};
  inputs.insert(inputs.end(), scenario.inputs.begin(), scenario.inputs.end());
  for (const std::string& input : inputs) {
    std::error_code none;
    if (files::equivalent(command.results, input, none) && !none)
      refuse("-o", command.results + ", which this run reads", "another file");
  }
}

bool is_netcdf(const files::path& path) {
  constexpr std::string_view kMagic = "CDF";
  std::string begin(kMagic.size(), ' ');
  std::ifstream in(path, std::ios::binary);
  return in.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kMagic;
}

void require_results(const RunCommand& command) {
  std::error_code none;
  const files::path path(command.results);
  const bool exists = files::exists(path, none);
  if (const std::string got = not_a_file(command.results); !got.empty())
    refuse("-o", command.results + ", " + got, "a file");
  if (path.has_parent_path() && !files::is_directory(path.parent_path(), none))
    refuse("-o", command.results, "a file in a folder that is there",
           "make the folder " + path.parent_path().string());
  if (command.resume && !exists)
    refuse("-o", command.results + ", which is not there", "the results that are gone on with",
           "start without --resume");
  if (command.resume && !is_netcdf(path))
    refuse("-o", command.results + ", no netCDF file", "the results that are gone on with",
           "start without --resume");
  if (exists && !command.resume && !command.force)
    refuse("-o", command.results + ", which exists", "a new file",
           "use --force to replace it, or --resume to go on");
  const std::string folder = node::folder_of(command.results);
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse("-o", command.results + ", in a folder that cannot be written into (" + std::strerror(errno) + ")",
           "a file in another folder");
  if (exists && ::access(command.results.c_str(), W_OK) != 0)
    refuse("-o", command.results + ", which cannot be written into (" + std::strerror(errno) + ")",
           "another file");
}

void require_resumable(const RunCommand& command, const Scenario& scenario) {
  if (command.checkpoint == 0 && !command.resume) return;
  for (const auto& lie : scenario.run.message_attacks)
    if (lie->age() > 0)
      refuse(command.resume ? "--resume" : "--checkpoint", "a run with the lie \"outdated\"",
             "lies that need no messages of the past",
             "it cannot be gone on with: leave the option out, and run it in one go");
}

/// As a shell reads it back.
std::string quoted(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-+./:,=@%").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

void require_outputs(const RunCommand& command, const Scenario& scenario) {
  if (command.results.empty()) return;
  if (command.checkpoint > scenario.plant.steps)
    refuse("--checkpoint", std::to_string(command.checkpoint),
           "at most " + std::to_string(scenario.plant.steps) + ", the steps of the scenario");
  require_resumable(command, scenario);
  require_other_file(command, scenario);
  require_results(command);
  const std::string folder = checkpoint_folder(command.results);
  std::error_code none;
  if (files::exists(folder, none) && !files::is_directory(folder, none))
    refuse(folder, "a file", "the folder of checkpoints, or nothing", "move it away, or use another -o");
}

std::string resume_command(const RunCommand& command, int ranks) {
  std::string line = "mpirun -n " + std::to_string(ranks) + " " + quoted(command.program) + " run " +
                     quoted(command.scenario) + " -o " + quoted(command.results);
  if (command.halo > 1) line += " --halo " + std::to_string(command.halo);
  if (command.checkpoint > 0) line += " --checkpoint " + std::to_string(command.checkpoint);
  return line + " --resume";
}

}  // namespace garrison::mpi
