// SPDX-License-Identifier: Apache-2.0
#include "mpi/run.hpp"

#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <optional>

#include "mpi/checkpoint.hpp"
#include "mpi/cut.hpp"
#include "mpi/ending.hpp"
#include "mpi/hash.hpp"
#include "mpi/memory.hpp"
#include "mpi/mpi_exchange.hpp"
#include "mpi/outputs.hpp"
#include "mpi/progress.hpp"
#include "mpi/results.hpp"
#include "mpi/together.hpp"
#include "partition/connected.hpp"
#include "partition/families.hpp"
#include "partition/part_run.hpp"
#include "partition/split.hpp"

namespace garrison::mpi {
namespace {

/// An agent of a rank takes at least so much, whatever the family.
constexpr double kOwnBytes = 300.0;

/// Everything that one rank has.
class Share {
 public:
  explicit Share(const RunCommand& command) : command_(command) {
    const Bytes bytes = shared_bytes(kOwnBytes);
    together([&] {
      scenario_ = read_scenario(command.scenario, bytes);
      const std::vector<int> first{0};
      const Model one = scenario_.sensors.model(first);
      partition::require_simulable(one, first, scenario_.plant, scenario_.run);
      partition::require_params(scenario_.family, scenario_.params, one);
      if (exchange_.rank() != 0) return;
      require_outputs(command, scenario_);
      if (command.resume) static_cast<void>(Checkpoint(command.results, scenario_.fingerprint).sample());
    });
    cut();
    build();
    if (!command_.results.empty()) open_results();
    trial_->start();
    if (command_.resume) resume();
  }

  void samples() {
    const double start = MPI_Wtime();
    waited_before_ = exchange_.waited();
    const std::int64_t from = trial_->sample();
    Progress progress("sample", scenario_.plant.steps);
    while (trial_->sample() < scenario_.plant.steps) {
      trial_->advance();
      progress.at(trial_->sample());
      keep();
      const std::int64_t t = trial_->sample();
      if (command_.checkpoint > 0 && t % command_.checkpoint == 0) save();
    }
    report(from, MPI_Wtime() - start);
  }

 private:
  void cut() {
    int rounds = 1;
    together([&] { rounds = std::max(1, partition::rounds_of(scenario_.family, scenario_.params)); });
    Cut mine = cut_of(scenario_, exchange_, std::min(rounds, static_cast<int>(command_.halo)));
    ids_ = std::move(mine.ids);
    region_ = std::move(mine.region);
    if (partition::needs_connected(scenario_.family)) partition::require_connected(region_, exchange_);
    say_cut(region_, exchange_, mine.made);
    if (exchange_.rank() == 0 && command_.halo > 1)
      std::printf("one exchange for every %d of the rounds of a sample%s\n", region_.depth(),
                  region_.depth() < command_.halo ? ", which has no more" : "");
  }

  void build() {
    std::optional<partition::Whole> whole;
    const int others = ranks_here();
    together([&] {
      model_ = std::make_unique<Model>(scenario_.sensors.model(ids_));
      const std::string why = partition::needs_whole(scenario_.family, scenario_.params, scenario_.agents());
      if (why.empty()) return;
      require_memory(
          "filter (" + why + ")",
          amount(scenario_.agents(), "agent") + " on each of " + amount(others, "rank") + " of a machine",
          kWhole.agent * others * scenario_.agents());
      std::vector<int> all(static_cast<std::size_t>(scenario_.agents()));
      std::iota(all.begin(), all.end(), 0);
      whole.emplace(scenario_.sensors.model(all), partition::network_of(*scenario_.ground));
    });
    runner_ = partition::part_runner(scenario_.family, scenario_.params, whole ? &*whole : nullptr, *model_,
                                     region_, exchange_);
    together([&] {
      trial_ = std::make_unique<partition::PartRun>(*runner_, *model_, ids_, scenario_.agents(),
                                                    scenario_.plant, scenario_.run);
      estimates_.resize(ids_.size() * static_cast<std::size_t>(scenario_.states()));
    });
  }

  void open_results() {
    checkpoint_.emplace(command_.results, scenario_.fingerprint);
    flag_ = command_.results + ".ended";
    together([&] {
      if (exchange_.rank() != 0) return;
      std::error_code none;
      std::filesystem::remove(flag_, none);  // of a machine that went down
      if (!command_.resume) checkpoint_->clear();
      if (command_.checkpoint > 0) checkpoint_->make();
    });
    results_ = std::make_unique<Results>(command_.results, scenario_, command_.resume);
    order_ = std::make_unique<PublicOrder>(ids_, scenario_.agents(), scenario_.states());
    if (!command_.resume)
      say("garrison-mpi: the job was ended; no checkpoint was written yet: start again, with --force\n");
  }

  void resume() {
    std::int64_t t = 0;
    together([&] {
      t = checkpoint_->sample();
      checkpoint_->read(ids_, *runner_);
      trial_->skip_to(t);
    });
    results_->require_until(t);
    if (exchange_.rank() == 0) std::printf("goes on from the checkpoint of sample %" PRId64 "\n", t);
    resumable(t);
  }

  void keep() {
    const std::int64_t t = trial_->sample();
    const bool kept = results_ && t % scenario_.every == 0;
    if (!kept && !command_.hash) return;
    runner_->estimates(estimates_.data());
    const auto n = static_cast<std::size_t>(scenario_.states());
    for (std::size_t k = 0; k < ids_.size() && command_.hash; ++k)
      hash_ += hash_of(std::span(estimates_).subspan(k * n, n), t, ids_[k]);
    if (!kept) return;
    const auto range = order_->move(estimates_.data());
    results_->write(t, trial_->truth(), summary_of(*order_, range, trial_->truth()), *order_, range);
  }

  void save() {
    if (!checkpoint_) return;
    results_->sync();
    checkpoint_->write(trial_->sample(), ids_, *runner_);
    resumable(trial_->sample());
  }
  void resumable(std::int64_t t) {
    say("garrison-mpi: the job was ended; the checkpoint of sample " + std::to_string(t) +
        " is whole. Go on, on any number of ranks:\n  " + resume_command(command_, exchange_.ranks()) + "\n");
  }
  void say(const std::string& line) { say_when_ended(line, flag_); }

  void report(std::int64_t from, double seconds) {
    const LinkCounters& link = trial_->link();
    std::int64_t sums[] = {link.sent,
                           link.lost,
                           link.late,
                           link.forged,
                           link.refused,
                           runner_->resets(),
                           static_cast<std::int64_t>(hash_)};
    double most[] = {megabytes(), exchange_.waited() - waited_before_};
    exchange_.sum(sums);  // the hash is a sum modulo 2^64
    exchange_.largest(most);
    if (exchange_.rank() != 0) return;
    const auto samples = static_cast<double>(trial_->sample() - from);
    std::printf("%.0f samples in %.3f s, %.3f ms each; waited %.1f %%; at most %.0f MB on one rank\n",
                samples, seconds, 1e3 * seconds / std::max(1.0, samples), 100.0 * most[1] / seconds, most[0]);
    if (sums[0] + sums[1] + sums[2] + sums[3] + sums[4] > 0)
      std::printf("messages: %" PRId64 " sent, %" PRId64 " lost, %" PRId64 " late, %" PRId64
                  " forged, %" PRId64 " refused\n",
                  sums[0], sums[1], sums[2], sums[3], sums[4]);
    if (runner_->overflows() > 0)
      std::printf("estimates overflowed in %" PRId64 " samples, %" PRId64
                  " agents rejoined: the filter diverged\n",
                  runner_->overflows(), sums[5]);
    if (!command_.hash) return;
    if (samples == 0.0) {
      std::printf("no hash: every sample was there\n");
      return;
    }
    if (from > 0) std::printf("of the samples after %" PRId64 " alone: ", from);
    std::printf("hash %016" PRIx64 "\n", static_cast<std::uint64_t>(sums[6]));
  }

  const RunCommand& command_;
  MpiExchange exchange_;
  Scenario scenario_;
  std::vector<int> ids_;
  partition::Region region_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<partition::PartRunner> runner_;
  std::unique_ptr<partition::PartRun> trial_;
  std::optional<Checkpoint> checkpoint_;
  std::unique_ptr<Results> results_;
  std::unique_ptr<PublicOrder> order_;
  std::vector<double> estimates_;
  std::string flag_;
  double waited_before_ = 0.0;  // in the design
  std::uint64_t hash_ = 0;
};

}  // namespace

void run(const RunCommand& command) { Share(command).samples(); }

}  // namespace garrison::mpi
