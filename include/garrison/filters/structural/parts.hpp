// SPDX-License-Identifier: Apache-2.0
// What a structural filter is made of: its gains, and the state and the messages of an agent.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/agent_set.hpp"
#include "garrison/core/filter.hpp"
#include "garrison/core/types.hpp"

namespace garrison::structural {

/// Longest rest that a message can tell of.
inline constexpr int kMostRest = 65535;
/// States up to which P_i is carried without `isolate`: 136 numbers of a message. Beyond, a gap ends the
/// tests until the error is stationary again.
inline constexpr int kCarried = 16;

/// Whether what is tested varies by more than rounding: a residual that a gain makes vanish (a projection)
/// says nothing of its sensor. `std`: its deviation, `noise`: R_ii, `innovation`: the innovation's deviation
/// (NaN: not known).
inline bool varies(double std, double noise, double innovation) noexcept {
  constexpr double kRounding = 1e-12;  // of a variance
  return std > 0.0 && std * std > kRounding * std::max(noise, innovation * innovation);
}

/// What agent i needs of an agent it hears (or of itself).
struct Heard {
  int id;
  double weight;  ///< W_ij
  int first;      ///< of K_i c_j in `columns`; -1: y_j is not used

  template <class V>
  void visit(V& v) {
    v.range("id", id, 0, INT32_MAX);
    v("weight", weight);
    v.range("first", first, -1, INT32_MAX);
  }
};
struct Gains {
  std::vector<int> offsets;     ///< first Heard of each agent, N + 1
  std::vector<Heard> heard;     ///< per agent: itself first, then by id
  std::vector<double> columns;  ///< K_i c_j, n numbers each
  std::vector<double> rows;     ///< c_j, N x n row by row
  std::vector<double> std;      ///< of what is tested; NaN = not known, no test
  std::vector<double> innovation_std;
  std::vector<double> precision;  ///< window * window numbers per agent, when window > 1
  std::vector<double>
      covariance;               ///< n x n per agent: of its stationary error, or a bound; empty = not known
  std::vector<double> process;  ///< E, n x n
  std::vector<double> noise;    ///< R_jj per agent
  std::vector<double> doubt;    ///< by which P grows, per sample, while agent j's measurement is left out
  std::vector<double> haste;    ///< the same once the estimate is lost there: more where j alone sees a mode
  double level = kNaN;          ///< m, or the chi-square level
  double sample_level = kNaN;   ///< m
  double rho = kNaN;            ///< rho(Ahat)
  double surprise = 0.0;        ///< E[q^2 | |q| >= m s] / s^2 - 1 of a Gaussian q
  int window = 1;
  int alarm_after = 1;
  int clear_after = 5;
  int settle = 0;   ///< samples after the start
  int recover = 0;  ///< samples after a gap until rho^k < 0.01
  bool innovation = false;
  bool isolate = false;
  bool accuse_missing = false;
  std::vector<char> has_sensor;
  bool sensing(int id) const { return has_sensor[static_cast<std::size_t>(id)] != 0; }

  template <class V>
  void visit(V& v) {
    v("offsets", offsets);
    v("heard", heard);
    v("columns", columns);
    v("rows", rows);
    v("std", std);
    v("innovation_std", innovation_std);
    v("precision", precision);
    v("covariance", covariance);
    v("process", process);
    v("noise", noise);
    v("doubt", doubt);
    v("haste", haste);
    v("level", level);
    v("sample_level", sample_level);
    v("rho", rho);
    v("surprise", surprise);
    v.range("window", window, 1, 100000);
    v.range("alarm_after", alarm_after, 1, INT32_MAX);
    v.range("clear_after", clear_after, 1, INT32_MAX);
    v.range("settle", settle, 0, kMostRest);
    v.range("recover", recover, 0, kMostRest);
    v("innovation", innovation);
    v("isolate", isolate);
    v("accuse_missing", accuse_missing);
    v("has_sensor", has_sensor);
  }
};
/// What an agent remembers besides its estimate.
struct Memory {
  double y = kNaN;
  double residual = kNaN;
  double innovation = kNaN;
  double statistic = kNaN;
  double threshold = kNaN;
  int start = 0;  // samples before the first test
  int rest = 0;   // samples before the error is stationary
  int above = 0;  // tests in a row
  int below = 0;
  int untold = 0;  // measurements in a row that no test says anything of
  int filled = 0;  // residuals in the window
  int oldest = 0;
  bool coarse = false;  // the threshold is so high that only an alarm tells something
  bool broken = false;  // a gap has emptied the window, which is not full yet
  bool alarm = false;
  std::vector<double> last;    // window of residuals, a ring
  std::vector<char> left_out;  // Structural::Trust after the sample before, per Heard
  std::vector<double> P;       // n x n
  std::vector<double> work;    // room for four n x n
  // What follows from the gains, and is not part of a snapshot: I - sum K_i c_j c_j', column by column, and
  // sum R_jj K_i c_j (K_i c_j)', when no measurement is missing, n x n each; then `usual`.
  std::vector<double> fixed;
  double pace = 0.0;         // samples in which the deviation of an error falls by the factor e
  std::vector<int> senders;  // of this sample: the Heard behind each message of the inbox
  std::vector<int> missing;  // Heard whose measurement is not used, the first `gone`
  int gone = 0;
  double own = 0.0;  // weight of the own estimate in (3) at this sample
  AgentSet accused;

  /// Structural::usual_variance of each state; none where no P is carried.
  std::span<const double> usual() const noexcept { return std::span(fixed).subspan(2 * P.size()); }

  template <class V>
  void visit(V& v) {
    const int window = std::max<int>(1, static_cast<int>(last.size()));
    v("y", y);
    v("residual", residual);
    v("innovation", innovation);
    v("statistic", statistic);
    v("threshold", threshold);
    v.range("start", start, 0, kMostRest);
    v.range("rest", rest, 0, kMostRest);
    v.range("above", above, 0, INT32_MAX);
    v.range("below", below, 0, INT32_MAX);
    v.range("untold", untold, 0, INT32_MAX);
    v.range("filled", filled, 0, window);
    v.range("oldest", oldest, 0, window - 1);
    v("coarse", coarse);
    v("broken", broken);
    v("alarm", alarm);
    v("last", last);
    v("left_out", left_out);
    v("P", P);
    v("accused", accused);
  }
};
template <int n>
struct State : Memory {
  Vec<n> x;
  Vec<n> prior;

  template <class V>
  void visit(V& v) {
    v("estimate", x);
    v("prior", prior);
    Memory::visit(v);
  }
};
template <int n>
struct Message {
  static constexpr int size = n == Dynamic ? Dynamic : n + 1;
  bool measured = false;           ///< the last number is y; otherwise there is none
  bool withheld = false;           ///< there is a y, which the sender does not trust
  int rest = 0;                    ///< samples before the sender's error is stationary
  Vec<size> numbers;               ///< estimate, then y
  std::vector<double> covariance;  ///< lower triangle of P_i, n(n+1)/2 numbers; empty where it is not carried
  bool settled =
      false;  ///< `covariance` is the stationary one; not sent, it saves writing it at every sample

  template <class V>
  void visit(V& v) {
    const auto states = static_cast<std::size_t>(numbers.size()) - 1;
    v.numbers("estimate", std::span<double>(numbers.data(), states));
    v.numbers("measurement", std::span<double>(numbers.data() + states, 1));
    v.numbers("covariance", covariance);
    v.flag("measured", measured);
    v.flag("withheld", withheld);
    v.count("rest", rest, kMostRest);
  }
};

}  // namespace garrison::structural
