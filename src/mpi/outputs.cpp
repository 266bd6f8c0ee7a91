// SPDX-License-Identifier: Apache-2.0
#include "mpi/outputs.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "garrison/core/error.hpp"
#include "mpi/checkpoint.hpp"

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

void require_results(const RunCommand& command) {
  std::error_code none;
  const files::path path(command.results);
  const bool exists = files::exists(path, none);
  if (files::is_directory(path, none)) refuse("-o", command.results + ", a folder", "a file");
  if (path.has_parent_path() && !files::is_directory(path.parent_path(), none))
    refuse("-o", command.results, "a file in a folder that is there",
           "make the folder " + path.parent_path().string());
  if (command.resume && !exists)
    refuse("-o", command.results + ", which is not there", "the results that are gone on with",
           "start without --resume");
  if (exists && !command.resume && !command.force)
    refuse("-o", command.results + ", which exists", "a new file",
           "use --force to replace it, or --resume to go on");
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
