// SPDX-License-Identifier: Apache-2.0
// The plant and what each agent sees of it.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "garrison/core/abi.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// What is known of the noise. Everything is optional: a filter that needs an entry says so.
struct GARRISON_EXPORT Noise {
  /// ||w(t)|| <= process_bound for all t; same unit as the state, >= 0; NaN = not known.
  double process_bound = kNaN;
  /// |v_i(t)| <= measurement_bound[i] for every output of agent i; length N; empty = not known.
  Vector measurement_bound = {};
  /// Covariance of w, n x n, symmetric positive semidefinite; empty = not known.
  Matrix process_covariance = {};
  /// Covariance of v_i, m_i x m_i, one per agent; empty = not known.
  std::vector<Matrix> measurement_covariance = {};
  /// What each agent takes for the covariance of w where they differ, n x n, one per agent; empty = all take
  /// process_covariance. Filters weigh with it; the simulated noise does not depend on it.
  std::vector<Matrix> agent_process_covariance = {};
};

/// What people call states and measurements. Every part is optional, and no filter reads any.
struct GARRISON_EXPORT Labels {
  std::vector<std::string> states = {};   ///< n names; empty: x1, x2, ..
  std::vector<std::string> outputs = {};  ///< one name per measurement of the whole network, agent by agent
  /// Who can falsify each measurement: several outputs of one receiver have one source.
  std::vector<std::string> sources = {};
  std::map<std::string, std::string> units = {};  ///< by the name of a state, output or input
  std::vector<std::string> inputs = {};           ///< one name per column of B

  bool operator==(const Labels&) const = default;
};

/// x(t+1) = A x(t) + B u(t) + w(t),  y_i(t) = C_i x(t) + v_i(t) for agents i = 0..N-1; u is known to all.
///
/// Immutable once built. C_i may have any number of rows; an agent without sensors (a relay) has none.
/// Measurements of the whole network are kept flat, agent by agent: agent i owns the entries
/// offset(i) .. offset(i+1)-1.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Model {
 public:
  /// `A`: n x n, finite. `C`: one m_i x n matrix per agent, finite (m_i = 0 allowed), at least one agent.
  /// `exposed`: how many of an agent's first outputs an attacker can reach, one number per agent; empty =
  /// all. `B`: n x p, finite; empty = no known inputs (docs/adr/0016 says how drivers use them).
  /// @throws InvalidInput on a wrong shape, a number that is not finite, an impossible noise, or names that
  /// are empty, occur twice or do not fit in number.
  Model(Matrix A, std::vector<Matrix> C, Noise noise = {}, std::vector<int> exposed = {}, Labels labels = {},
        Matrix B = {});

  int states() const { return static_cast<int>(A_.rows()); }
  int agents() const { return static_cast<int>(C_.size()); }
  const Matrix& A() const { return A_; }
  const Matrix& C(int agent) const { return C_[static_cast<std::size_t>(agent)]; }
  /// n x inputs(); no columns where there are no known inputs.
  const Matrix& B() const { return B_; }
  int inputs() const { return static_cast<int>(B_.cols()); }
  int outputs(int agent) const { return static_cast<int>(C(agent).rows()); }
  /// Outputs 0..exposed-1 of an agent can be attacked, the others are secured.
  int exposed(int agent) const {
    return exposed_.empty() ? outputs(agent) : exposed_[static_cast<std::size_t>(agent)];
  }
  int offset(int agent) const { return offsets_[static_cast<std::size_t>(agent)]; }
  /// Number of scalar measurements of the whole network at one time.
  int total_outputs() const { return offsets_.back(); }
  const Noise& noise() const { return noise_; }
  /// Largest entry of noise().measurement_bound, the common b_v of the papers; NaN when not known.
  double measurement_bound() const;
  /// As given; `state_names` fills in x1, x2, .. where there are none.
  const Labels& labels() const { return labels_; }
  std::vector<std::string> state_names() const;
  /// Same numbers and names; two unknown bounds are equal.
  friend GARRISON_EXPORT bool operator==(const Model& a, const Model& b);

  /// All C_i on top of each other, total_outputs() x n.
  Matrix stacked() const;

 private:
  Matrix A_;
  std::vector<Matrix> C_;
  Noise noise_;
  std::vector<int> offsets_;
  std::vector<int> exposed_;  // empty = all
  Labels labels_;
  Matrix B_;
};

}  // namespace garrison
