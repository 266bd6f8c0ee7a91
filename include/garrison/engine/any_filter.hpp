// SPDX-License-Identifier: Apache-2.0
// A filter family behind one interface: what the CLI, the bindings and the drivers know of it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "garrison/certificate/online/plan.hpp"
#include "garrison/core/abi.hpp"
#include "garrison/core/conditions.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/params.hpp"
#include "garrison/core/series.hpp"
#include "garrison/core/trials.hpp"
#include "garrison/core/world.hpp"
#include "garrison/engine/agent.hpp"
#include "garrison/engine/runner.hpp"

namespace garrison {

class AnyFilter;

/// A filter designed for one model and network; makes any number of runners and agents from it.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Prepared {
 public:
  virtual ~Prepared() = default;
  virtual const Model& model() const = 0;
  virtual const Network& network() const = 0;
  virtual const AnyFilter& filter() const = 0;
  virtual std::unique_ptr<Runner> runner(int threads) const = 0;
  /// Refuses initial estimates (n x N) that the family's promises do not cover.
  virtual void check_start(const Matrix& x0) const = 0;
  /// Refuses recorded measurements (rows of Model::total_outputs() numbers) from which the family cannot tell
  /// what it promises. @throws InvalidInput
  virtual void check_log(std::span<const double> measurements) const = 0;
  /// @throws InvalidInput when there is no such agent
  virtual std::unique_ptr<Agent> agent(int id) const = 0;
  /// Refuses a plant that changes in time where the family is designed for a constant one, and covariances
  /// that its gains cannot follow. @throws InvalidInput
  virtual void require_varying(const Series& series) const = 0;
  /// Several trials side by side, with the same bits as `runner`; null where the family has no such path.
  virtual std::unique_ptr<TrialsRunner> trials() const = 0;
  /// The plants that the agents drive, for one trial; null for families that watch one common plant.
  virtual std::unique_ptr<World> world(const WorldOptions& options) const = 0;

  /// What its runs and agents certify of every estimate; null = nothing but the family's own bound.
  virtual std::shared_ptr<const certificate::Plan> certificate() const = 0;
  /// The same design with another certificate, or with none (null).
  virtual std::shared_ptr<const Prepared> with(std::shared_ptr<const certificate::Plan> plan) const = 0;

  /// The gains alone (wire/archive.hpp), and as lines "name: size or number" for people.
  virtual std::vector<std::byte> gains_bytes() const = 0;
  virtual std::vector<std::string> gains_outline() const = 0;
  /// What agent `id` needs of them: a `Part` of the design file.
  virtual std::vector<std::byte> part_bytes(int id) const = 0;
  /// First eight bytes of the digest of the whole design (engine/design_file.hpp).
  virtual std::uint64_t fingerprint() const = 0;

  /// Refuses a nonlinear plant where the family cannot take predictions from outside. @throws InvalidInput
  virtual void require_functions() const = 0;
};

/// The same design with a certificate. @throws InvalidInput when the model does not say what it needs, or the
/// agents have states of their own
GARRISON_EXPORT std::shared_ptr<const Prepared> certified(const Prepared& prepared,
                                                          const certificate::Wanted& wanted);

/// A filter with its parameters.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT AnyFilter {
 public:
  virtual ~AnyFilter() = default;
  virtual std::string name() const = 0;
  virtual ParamMap params() const = 0;
  /// Designs gains. @throws InvalidInput when parameters, model and network do not fit together.
  virtual std::shared_ptr<const Prepared> prepare(const Model& model, const Network& network) const = 0;
  /// The same from gains that were designed before. @throws InvalidInput when the bytes are not gains of it
  virtual std::shared_ptr<const Prepared> restore(const Model& model, const Network& network,
                                                  std::span<const std::byte> gains) const = 0;
  /// An agent from its part of a design. @throws InvalidInput when the bytes are not one
  virtual std::unique_ptr<Agent> agent(std::span<const std::byte> part) const = 0;
  /// Conditions and bounds of the family's theorems.
  virtual Check check(const Model& model, const Network& network) const = 0;
  virtual std::vector<std::string> signal_names() const = 0;
  /// What a user should know of a run that ended without an error; empty where the family has nothing to say.
  virtual std::vector<std::string> warnings(const Model& model, const VerdictLog& log) const = 0;
  /// Which assumptions can be false when `bits` were refuted (Runner::refuted), in words; empty for 0.
  virtual std::vector<std::string> refuted(unsigned bits) const = 0;
  virtual std::vector<std::string> detail_names() const = 0;
  /// 1, or 0 for families that have a sample at the start too.
  virtual int first_sample() const = 0;
  /// Every agent has a state of its own (and the family a world).
  virtual bool own_states() const = 0;
};

/// One line of `garrison list filters`.
struct GARRISON_EXPORT FamilyInfo {
  std::string name;
  std::string title;
  std::string source;
  std::vector<ParamInfo> params;
  std::shared_ptr<const AnyFilter> (*make)(const ParamMap&);
};

/// The description of family F; instantiated by the source file that compiles it.
template <class F>
FamilyInfo family_info();

/// All families, in the order of filters/families.hpp.
GARRISON_EXPORT std::span<const FamilyInfo> families();
/// The filter `name` with the given parameters; refuses unknown names with the nearest one.
GARRISON_EXPORT std::shared_ptr<const AnyFilter> make_filter(const std::string& name, const ParamMap& params);

}  // namespace garrison
