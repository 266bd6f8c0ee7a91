// SPDX-License-Identifier: Apache-2.0
#include "plant.hpp"

#include <algorithm>
#include <optional>

#include "core/solvers.hpp"
#include "functions.hpp"
#include "garrison/core/params.hpp"
#include "garrison/core/response.hpp"

namespace garrison::detail {
namespace {

/// Symmetric square root. Eigenvalues of singular covariances are zero up to rounding, of either sign.
Matrix root(const Matrix& covariance) {
  if (covariance.rows() == 0) return covariance;
  const Eigen::SelfAdjointEigenSolver<Matrix> of(covariance);
  return of.eigenvectors() * of.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         of.eigenvectors().transpose();
}

class Simulated final : public Source {
 public:
  Simulated(const Model& model, const NoiseLaw& law, const PlantOptions& plant, const RunOptions& options,
            std::uint32_t trial)
      : model_(model),
        law_(law),
        options_(options),
        start_(options.seed, trial, Purpose::start),
        process_(options.seed, trial, Purpose::process),
        measurement_(options.seed, trial, Purpose::measurement),
        start_error_(plant.start_error),
        C_(model.stacked()),
        x_(plant.x0.size() == 0 ? Vector::Zero(model.states()) : plant.x0),
        w_(Vector::Zero(model.states())),
        next_(model.states()) {
    if (options.nonlinear != nullptr) functions_.emplace(*options.nonlinear, model, "the true state");
  }

  Matrix start(const Matrix& given) const override {
    Vector shift(model_.states());
    ball(start_, 0, 0, start_error_, false, shift);
    return given.colwise() + shift;
  }
  const double* truth() const override { return x_.data(); }
  void next(std::int64_t t, std::span<double> y) override {
    law_.process(process_, t - 1, w_);
    if (functions_) return by_functions(static_cast<int>(t), y);
    if (options_.series == nullptr && model_.inputs() == 0)
      next_.noalias() = model_.A() * x_;
    else
      next_ = moved(static_cast<int>(t));
    x_ = next_ + w_;
    Eigen::Map<Vector>(y.data(), static_cast<Eigen::Index>(y.size())).noalias() =
        rows(static_cast<int>(t)) * x_;
    law_.measurement(measurement_, t, y);
  }

 private:
  void by_functions(int t, std::span<double> y) {
    x_ = functions_->moved(x_, options_.inputs, t - 1) + w_;
    const Vector seen = functions_->measured(x_.replicate(1, model_.agents()), t);
    std::copy_n(seen.data(), y.size(), y.begin());
    law_.measurement(measurement_, t, y);
  }
  Vector moved(int t) const {
    static const Series constant;
    const Series& series = options_.series == nullptr ? constant : *options_.series;
    if (model_.inputs() == 0) return series.A_at(model_, t) * x_;
    return driven(series.A_at(model_, t), x_, series.B_at(model_, t), options_.inputs.row(t - 1).transpose());
  }
  const Matrix& rows(int t) const {
    const Series* series = options_.series.get();
    return series == nullptr || series->C.empty() ? C_ : series->C[static_cast<std::size_t>(t - 1)];
  }

  const Model& model_;
  const NoiseLaw& law_;
  const RunOptions& options_;
  Random start_;
  Random process_;
  Random measurement_;
  double start_error_;
  Matrix C_;
  Vector x_;
  Vector w_;
  Vector next_;
  std::optional<Functions> functions_;
};

class Recorded final : public Source {
 public:
  Recorded(const Model& model, const Log& log, std::size_t run, int width, int first_sample)
      : width_(width),
        y_(log.measurements + run * static_cast<std::size_t>(log.steps + 1 - first_sample) *
                                  static_cast<std::size_t>(model.total_outputs())),
        x_(log.truth == nullptr ? nullptr
                                : log.truth + run * static_cast<std::size_t>(log.steps + 1) *
                                                  static_cast<std::size_t>(width)) {}
  Matrix start(const Matrix& given) const override { return given; }
  const double* truth() const override { return x_; }
  void next(std::int64_t t, std::span<double> y) override {
    std::copy_n(y_, y.size(), y.begin());
    y_ += y.size();
    if (x_ != nullptr && t > 0) x_ += width_;
  }

 private:
  int width_;
  const double* y_;
  const double* x_;
};

class Driven final : public Source {
 public:
  Driven(std::unique_ptr<World> world, int agents)
      : world_(std::move(world)), control_(static_cast<std::size_t>(agents)) {}
  Matrix start(const Matrix&) const override { return world_->start(); }
  void meet(const Runner& runner) override { runner_ = &runner; }
  const double* truth() const override { return world_->truth().data(); }
  void next(std::int64_t t, std::span<double> y) override {
    if (t > 0) runner_->control(control_.data());
    world_->next(t, control_, y);
  }

 private:
  std::unique_ptr<World> world_;
  std::vector<double> control_;
  const Runner* runner_ = nullptr;
};

}  // namespace

void ball(const Random& random, std::int64_t t, std::uint32_t agent, double radius, bool on_sphere,
          Vector& out) {
  for (Eigen::Index k = 0; k < out.size(); ++k)
    out(k) = random.normal(t, agent, static_cast<std::uint32_t>(k));
  const double length = out.norm();
  const double u = random.uniform(t, agent, static_cast<std::uint32_t>(out.size()));
  const double share = on_sphere ? 1.0 : std::pow(u, 1.0 / static_cast<double>(out.size()));
  // A hair below the bound, so that rounding cannot break the assumption that the bound states.
  out *= length > 0.0 ? radius * share * (1.0 - 1e-12) / length : 0.0;
}

NoiseLaw::NoiseLaw(const std::string& law, const Model& model, const Series* series, std::vector<int> ids)
    : model_(model), ids_(std::move(ids)) {
  const Noise& noise = model.noise();
  const bool bounds_w = !std::isnan(noise.process_bound);
  const bool bounds_v = noise.measurement_bound.size() != 0;
  const bool changes = series != nullptr && !series->process_covariance.empty();
  const bool covariance_w = noise.process_covariance.size() != 0 || changes;
  const bool changes_v = series != nullptr && !series->measurement_covariance.empty();
  const bool covariance_v = !noise.measurement_covariance.empty() || changes_v;
  if (law == "auto") {
    process_ = bounds_w ? Kind::uniform : covariance_w ? Kind::normal : Kind::none;
    measurement_ = bounds_v ? Kind::uniform : covariance_v ? Kind::normal : Kind::none;
  } else if (law == "uniform" || law == "extreme") {
    if (!bounds_w || !bounds_v)
      refuse("noise", "\"" + law + "\"", "a model with process_bound and measurement_bound",
             "give both bounds");
    process_ = measurement_ = law == "uniform" ? Kind::uniform : Kind::extreme;
  } else if (law == "normal") {
    if (!covariance_w || !covariance_v)
      refuse("noise", "\"normal\"", "a model with both covariances",
             "give process and measurement covariance");
    process_ = measurement_ = Kind::normal;
  } else if (law != "none") {
    refuse_unknown("noise", law, std::vector<std::string>{"auto", "uniform", "extreme", "normal", "none"});
  }
  if (process_ == Kind::normal && changes)
    for (const Matrix& covariance : series->process_covariance) process_roots_.push_back(root(covariance));
  else if (process_ == Kind::normal)
    process_root_ = root(noise.process_covariance);
  if (measurement_ != Kind::normal) return;
  static const Series constant;
  samples_ = changes_v ? series->measurement_covariance.size() : 1;
  for (std::size_t t = 1; t <= samples_; ++t)
    for (int i = 0; i < model.agents(); ++i)
      measurement_roots_.push_back(
          root(measurement_covariance_at(changes_v ? *series : constant, model, i, static_cast<int>(t))));
}

void NoiseLaw::process(const Random& random, std::int64_t t, Vector& w) const {
  if (process_ == Kind::none) return w.setZero(), void();
  if (process_ != Kind::normal)
    return ball(random, t, 0, model_.noise().process_bound, process_ == Kind::extreme, w);
  Vector z(w.size());
  for (Eigen::Index k = 0; k < z.size(); ++k) z(k) = random.normal(t, 0, static_cast<std::uint32_t>(k));
  w.noalias() = (process_roots_.empty() ? process_root_ : process_roots_[static_cast<std::size_t>(t)]) * z;
}

void NoiseLaw::measurement(const Random& random, std::int64_t t, std::span<double> y) const {
  if (measurement_ == Kind::none) return;
  for (int i = 0; i < model_.agents(); ++i) {
    const auto agent = static_cast<std::uint32_t>(ids_.empty() ? i : ids_[static_cast<std::size_t>(i)]);
    const int rows = model_.outputs(i);
    double* own = y.data() + model_.offset(i);
    if (measurement_ == Kind::normal) {
      const std::size_t sample = samples_ > 1 ? static_cast<std::size_t>(t - 1) : 0;
      const Matrix& S = measurement_roots_[sample * static_cast<std::size_t>(model_.agents()) +
                                           static_cast<std::size_t>(i)];
      for (int c = 0; c < rows; ++c) {
        const double z = random.normal(t, agent, static_cast<std::uint32_t>(c));
        for (int r = 0; r < rows; ++r) own[r] += S(r, c) * z;
      }
      continue;
    }
    const double b = model_.noise().measurement_bound(i) * (1.0 - 1e-12);
    for (int r = 0; r < rows; ++r) {
      const double u = 2.0 * random.uniform(t, agent, static_cast<std::uint32_t>(r)) - 1.0;
      own[r] += measurement_ == Kind::extreme ? std::copysign(b, u) : b * u;
    }
  }
}

std::unique_ptr<Source> simulated_source(const Model& model, const NoiseLaw& law, const PlantOptions& plant,
                                         const RunOptions& options, std::uint32_t trial) {
  return std::make_unique<Simulated>(model, law, plant, options, trial);
}

std::unique_ptr<Source> recorded_source(const Model& model, const Log& log, std::uint32_t run, int width,
                                        int first_sample) {
  return std::make_unique<Recorded>(model, log, run, width, first_sample);
}

std::unique_ptr<Source> world_source(std::unique_ptr<World> world, int agents) {
  return std::make_unique<Driven>(std::move(world), agents);
}

}  // namespace garrison::detail
