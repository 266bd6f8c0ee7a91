// SPDX-License-Identifier: Apache-2.0
#include "mpi/run.hpp"

#include <sys/resource.h>

#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <optional>

#include "garrison/engine/any_filter.hpp"
#include "mpi/checkpoint.hpp"
#include "mpi/cut.hpp"
#include "mpi/ending.hpp"
#include "mpi/hash.hpp"
#include "mpi/mpi_exchange.hpp"
#include "mpi/progress.hpp"
#include "mpi/results.hpp"
#include "mpi/together.hpp"
#include "partition/connected.hpp"
#include "partition/families.hpp"
#include "partition/part_run.hpp"
#include "partition/split.hpp"

namespace garrison::mpi {
namespace {

double megabytes() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_maxrss) / 1024.0;
}

/// Of a whole network that a rank must hold for the design of some families.
constexpr double kBytesPerAgent = 1500.0;

/// Everything that one rank has.
class Share {
 public:
  explicit Share(const RunCommand& command) : command_(command) {
    together([&] { scenario_ = read_scenario(command.scenario); });
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
    together([&] {
      model_ = std::make_unique<Model>(scenario_.sensors.model(ids_));
      const std::string why = partition::needs_whole(scenario_.family, scenario_.params, scenario_.agents());
      if (why.empty()) return;
      require_memory("filter (" + why + ")", std::to_string(scenario_.agents()) + " agents on every rank",
                     kBytesPerAgent * scenario_.agents());
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
      std::filesystem::remove(flag_);
      require_other_file();
      if (!command_.resume && !command_.force && std::filesystem::exists(command_.results))
        refuse("-o", command_.results + ", which exists", "a new file",
               "use --force to replace it, or --resume to go on");
    });
    together([&] {
      if (exchange_.rank() == 0 && !command_.resume) checkpoint_->clear();
    });
    results_ = std::make_unique<Results>(command_.results, scenario_, command_.resume);
    order_ = std::make_unique<PublicOrder>(ids_, scenario_.agents(), scenario_.states());
    if (!command_.resume)
      say("garrison-mpi: the job was ended; no checkpoint was written yet: start again\n");
  }
  /// Results may not take the place of what the run reads.
  void require_other_file() const {
    std::vector<std::string> inputs{command_.scenario};
    inputs.insert(inputs.end(), scenario_.inputs.begin(), scenario_.inputs.end());
    for (const std::string& input : inputs) {
      std::error_code none;
      if (std::filesystem::equivalent(command_.results, input, none) && !none)
        refuse("-o", command_.results + ", which this run reads", "another file");
    }
  }

  void resume() {
    std::int64_t t = 0;
    together([&] {
      if (!checkpoint_) refuse("--resume", "no -o", "the results that are gone on with");
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
        " is whole. Go on, on any number of ranks: mpirun -n R garrison-mpi run " + command_.scenario +
        " -o " + command_.results +
        (command_.checkpoint > 0 ? " --checkpoint " + std::to_string(command_.checkpoint) : "") +
        " --resume\n");
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
    if (command_.hash) std::printf("hash %016" PRIx64 "\n", static_cast<std::uint64_t>(sums[6]));
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

void run_whole(const std::string& path, int threads) {
  const Scenario s = read_scenario(path);
  std::vector<int> all(static_cast<std::size_t>(s.agents()));
  std::iota(all.begin(), all.end(), 0);
  RunOptions options = s.run;
  options.threads = threads;
  options.keep = {.estimate = true,
                  .report = false,
                  .signals = false,
                  .measurements = false,
                  .details = false,
                  .box = false};
  const double start = MPI_Wtime();
  const auto prepared =
      make_filter(s.family, s.params)->prepare(s.sensors.model(all), partition::network_of(*s.ground));
  const double designed = MPI_Wtime();
  const Record record = simulate(*prepared, s.plant, options);
  const double seconds = MPI_Wtime() - designed;
  const auto n = static_cast<std::size_t>(s.states());
  const auto N = all.size();
  std::uint64_t hash = 0;
  for (std::size_t t = 1; t <= static_cast<std::size_t>(s.plant.steps); ++t)
    for (std::size_t i = 0; i < N; ++i)
      hash += hash_of({record.estimate.data() + (t * N + i) * n, n}, static_cast<std::int64_t>(t),
                      static_cast<int>(i));
  std::printf("%zu agents, one engine, design %.3f s; %d samples in %.3f s, %.3f ms each; %.0f MB\n", N,
              designed - start, s.plant.steps, seconds, 1e3 * seconds / s.plant.steps, megabytes());
  std::printf("hash %016" PRIx64 "\n", hash);
}

}  // namespace garrison::mpi
