// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/bank.hpp"

#include <algorithm>
#include <cmath>

#include "../require.hpp"
#include "bank_limits.hpp"
#include "bank_sources.hpp"
#include "choices.hpp"
#include "core/solvers.hpp"
#include "core/spectrum.hpp"
#include "ellipsoid_union.hpp"

namespace garrison::certificate {
namespace {

/// Part of its length by which a row has to see a free direction to fix it: its noise grows by the inverse,
/// and that squared has to stay clear of rounding. A row that sees less, but more than rounding, is left out.
constexpr double kSees = 1e-5;
constexpr double kSeesNothing = 1e-12;
/// Standard deviations of an innovation below which what is left of a set prior is not felt in it.
constexpr double kFeltNoMore = 0.01;

/// What the rows of n steps say of each coordinate alone: makes free directions independent of units.
Vector weights(const MatrixRef& A, const std::vector<BankSource>& sources) {
  Vector weight = Vector::Zero(A.rows());
  for (const BankSource& source : sources) {
    Matrix rows = source.R.cwiseSqrt().cwiseInverse().asDiagonal() * source.C;
    for (Eigen::Index k = 0; k < A.rows(); ++k, rows = (rows * A).eval())
      weight += rows.colwise().squaredNorm().transpose();
  }
  for (double& one : weight)
    if (!(one > 1.0 / kHuge && one < kHuge)) one = 1.0;
  return weight;
}

}  // namespace

namespace detail {

void require_sources(const std::vector<BankSource>& sources, Eigen::Index n) {
  if (sources.empty()) refuse("sources", "none", "at least one");
  for (const BankSource& source : sources) {
    require_shape("C", source.C, source.C.rows(), n);
    require_bounds("R", source.R, source.C.rows());
    if (source.R.size() < 1 || !(source.R.minCoeff() > 1.0 / kHuge))
      refuse("R", source.R.size() < 1 ? "no output" : text(source.R.minCoeff()), "variances > 0");
  }
}

void require_bank(const MatrixRef& A, const MatrixRef& Q, const std::vector<BankSource>& sources, int s) {
  const Eigen::Index n = A.rows();
  if (n < 1) refuse("A", shape(A), "at least 1 x 1");
  require_shape("A", A, n, n);
  require_covariance("Q", Q, n);
  require_sources(sources, n);
  const auto m = static_cast<int>(sources.size());
  if (s < 0 || s > m) refuse("s", std::to_string(s), "a number in 0.." + std::to_string(m));
}

}  // namespace detail

Bank::Bank(const MatrixRef& A, const MatrixRef& Q, const std::vector<BankSource>& sources, int s, int limit)
    : A_(A),
      Q_(Q),
      sources_(sources),
      s_(s),
      frame_(std::make_unique<detail::ShapeFrame>(std::max<int>(1, static_cast<int>(A.rows())))) {
  const Eigen::Index n = A.rows();
  detail::require_bank(A, Q, sources, s);
  const int m = static_cast<int>(sources.size());
  detail::require_least("limit", limit, 1);
  const double count = detail::choices(m, s);
  if (!(count <= limit))
    refuse("members", text(count), "at most limit = " + std::to_string(limit), "raise it, or use cells()");
  for (const BankSource& source : sources) outputs_ += static_cast<int>(source.R.size());
  detail::require_room("members", count * (static_cast<double>(n * (2 * n + 1)) + detail::kHeard * outputs_));
  for (Matrix* M : {&room_, &shape_, &sum_}) M->resize(n, n);
  for (Vector* v : {&h_, &Ph_, &k_, &Psih_, &v_, &seen_}) v->resize(n);
  weight_ = weights(A, sources);
  Region& region = witness_.region;
  region.center.resize(n);
  region.box.resize(n);
  region.shape.resize(n, n);
  witness_.proofs.reserve(static_cast<std::size_t>(m));
}

Bank::~Bank() = default;
Bank::Bank(Bank&&) noexcept = default;
Bank& Bank::operator=(Bank&&) noexcept = default;

void Bank::all_members(const VectorRef& c0, const MatrixRef& P, const MatrixRef& Psi) {
  past_ = detail::with_start(past_, dependence());
  members_.clear();
  std::vector<char> out(sources_.size(), 0);
  std::vector<int> ids(sources_.size());
  for (std::size_t k = 0; k < ids.size(); ++k) ids[k] = static_cast<int>(k);
  detail::each_choice(std::span<const int>(ids), s_, std::span(out), char{1}, [&] {
    BankMember member{c0, P, Psi, {}, {}};
    for (const int id : ids)
      if (out[static_cast<std::size_t>(id)] != 0) member.left_out.push_back(id);
    member.accused = member.left_out;
    member.number = static_cast<int>(members_.size());
    member.heard = detail::nothing_heard(outputs_);
    member.free.resize(states());
    members_.push_back(std::move(member));
    return true;
  });
  sets_.clear();
  for (const BankMember& member : members_) sets_.push_back(member.left_out);
  taken_.resize(members_.size());
  started_ = true;
  alive_ = members_.size();
}

void Bank::start_gaussian(const VectorRef& c0, const MatrixRef& P0) {
  detail::require_shape("c0", c0, states(), 1);
  detail::require_covariance("P0", P0, states());
  all_members(c0, P0, Matrix::Zero(states(), states()));
}

void Bank::restart(const Region& region) {
  if (!region.answered()) refuse("region", "no answer", "a region that contains x");
  detail::require_shape("center", region.center, states(), 1);
  const bool ellipsoid = region.shape.size() > 0;
  const double reach = ellipsoid ? region.stretch : region.radius;
  detail::require_least(ellipsoid ? "stretch" : "radius", reach, 0.0);
  if (ellipsoid) detail::require_covariance("shape", region.shape, states());
  const Matrix Psi = ellipsoid ? Matrix(reach * garrison::detail::covariance_root(region.shape))
                               : Matrix(reach * Matrix::Identity(states(), states()));
  const Vector c0 = region.center;
  all_members(c0, Matrix::Zero(states(), states()), Psi);
}

void Bank::start_unknown() {
  all_members(Vector::Zero(states()), Matrix::Zero(states(), states()), Matrix(states(), 0));
  for (BankMember& member : members_) member.free.all(weight_);
}

void Bank::forget(bool everything) noexcept {
  past_ = everything ? PastDependence{} : detail::with_start(past_, dependence());
  alive_ = members_.size();
  for (std::size_t k = 0; k < members_.size(); ++k) {
    BankMember& member = members_[k];
    member.c.setZero();
    member.P.setZero();
    member.free.all(weight_);
    member.number = static_cast<int>(k);
    detail::hear_nothing(member.heard);
    leave_out(member);
  }
}

/// The sources of its number.
void Bank::leave_out(BankMember& member) const noexcept {
  const std::vector<int>& set = sets_[static_cast<std::size_t>(member.number)];
  std::copy(set.begin(), set.end(), member.left_out.begin());
  std::copy(set.begin(), set.end(), member.accused.begin());
}

bool Bank::overflows() const noexcept {
  return std::any_of(members_.begin(), members_.begin() + static_cast<std::ptrdiff_t>(alive_),
                     [](const BankMember& m) {
                       return !(m.c.cwiseAbs().maxCoeff() < kHuge && m.P.cwiseAbs().maxCoeff() < kHuge);
                     });
}

bool Bank::resume() noexcept {
  if (overflows() || past_.most.source >= static_cast<int>(sources_.size())) return false;
  std::fill(taken_.begin(), taken_.end(), char{0});
  for (BankMember& member : members_) {
    const auto at = static_cast<std::size_t>(member.number);
    if (member.number < 0 || at >= sets_.size() || taken_[at] != 0 || !member.free.U.allFinite())
      return false;
    taken_[at] = 1;
    leave_out(member);
  }
  return true;
}

/// One row y = h'x + v, h = h_. False when the innovation is not noise.
bool Bank::take(BankMember& m, Eigen::Index row, double R, double y, double z1) noexcept {
  const Vector& h = h_;
  Ph_ = m.P.lazyProduct(h);
  auto Psih = Psih_.head(m.Psi.cols());
  Psih = m.Psi.transpose().lazyProduct(h);
  const double variance = h.dot(Ph_) + R;
  const double innovation = y - h.dot(m.c);
  if (m.free.count > 0) {
    auto seen = seen_.head(m.free.count);
    seen = m.free.U.leftCols(m.free.count).transpose().lazyProduct(h);
    const double most = std::sqrt((h.array().square() / weight_.array()).sum());
    const double sees = seen.norm();
    if (sees > kSeesNothing * most) detail::hear(m.heard, row, kNaN);
    if (sees > kSees * most) {  // nothing to compare with: the row fixes this direction
      k_ = m.free.U.leftCols(m.free.count).lazyProduct(seen) / (sees * sees);
      m.free.fix(seen);
      move(m, innovation, variance);
      return true;
    }
    if (sees > kSeesNothing * most) return true;
  }
  const double deviation = std::sqrt(std::max(variance, 0.0));
  const double set = Psih.norm();
  const double room = z1 * deviation + set;
  if (!(std::abs(innovation) <= room + 1e-12 * (room + std::abs(y)))) return false;
  detail::hear(m.heard, row, set <= kFeltNoMore * deviation ? innovation / deviation : kNaN);
  // The gain of P + Psi Psi': any gain is valid, P and Psi are carried by the one that is used.
  k_ = (Ph_ + m.Psi.lazyProduct(Psih)) / (variance + Psih.squaredNorm());
  move(m, innovation, variance);
  return true;
}

/// Takes an innovation of this variance in by the gain k_: P becomes (I - k h') P (I - k h')' + k R k'.
void Bank::move(BankMember& m, double innovation, double variance) noexcept {
  m.c += innovation * k_;
  for (Eigen::Index j = 0; j < m.Psi.cols(); ++j) m.Psi.col(j) -= Psih_(j) * k_;
  for (Eigen::Index j = 0; j < m.P.cols(); ++j)
    for (Eigen::Index i = 0; i <= j; ++i)
      m.P(i, j) = m.P(j, i) =
          0.5 * (m.P(i, j) + m.P(j, i)) - k_(i) * Ph_(j) - Ph_(i) * k_(j) + variance * k_(i) * k_(j);
}

bool Bank::advance(BankMember& m, const VectorRef& y, const WindowLevels& z, const BankStep& step) noexcept {
  const std::vector<BankSource>& sources = step.sources != nullptr ? *step.sources : sources_;
  if (step.predict) {
    const Matrix& A = step.A != nullptr ? *step.A : A_;
    v_ = A.lazyProduct(m.c);
    m.c = v_;
    if (step.u != nullptr) m.c += *step.u;
    room_ = A.lazyProduct(m.P);
    m.P = room_.lazyProduct(A.transpose());
    m.P += step.Q != nullptr ? *step.Q : Q_;
    for (Eigen::Index j = 0; j < m.Psi.cols(); ++j) {
      v_ = A.lazyProduct(m.Psi.col(j));
      m.Psi.col(j) = v_;
    }
    m.free.advance(A, weight_, v_);
  }
  detail::forget_unknown(m, weight_, v_, Ph_);
  Eigen::Index at = 0;
  auto out = m.left_out.begin();
  for (std::size_t j = 0; j < sources.size(); ++j) {
    const BankSource& source = sources[j];
    const bool skipped = out != m.left_out.end() && *out == static_cast<int>(j);
    if (skipped) ++out;
    for (Eigen::Index i = 0; i < source.R.size(); ++i, ++at) {
      if (skipped) continue;
      if (!(std::abs(y(at)) <= kHuge)) {
        detail::hear(m.heard, at, kNaN);
        continue;
      }
      h_ = source.C.row(i).transpose();
      if (!take(m, at, source.R(i), y(at), z.z1)) return false;
    }
  }
  return true;
}

const WindowWitness& Bank::update(const VectorRef& y, const WindowLevels& z, const BankStep& step) noexcept {
  witness_.proofs.clear();
  witness_.region.radius = witness_.region.stretch = started_ ? kNaN : kInfinity;
  std::size_t alive = 0;
  alive_before_ = alive_;
  for (std::size_t k = 0; k < alive_; ++k) {
    if (!advance(members_[k], y, z, step)) continue;
    if (alive != k) std::swap(members_[alive], members_[k]);
    ++alive;
  }
  alive_ = alive;  // the dead stay behind: nothing is freed
  witness_.count = static_cast<int>(alive);
  if (alive == 0) return witness_;
  if (std::any_of(members().begin(), members().end(), [](const BankMember& m) { return m.free.count > 0; }))
    witness_.region.radius = witness_.region.stretch = kInfinity;
  else
    enclose(z, step.ellipsoid);
  prove();
  return witness_;
}

const WindowWitness& Bank::checked_update(const VectorRef& y, const WindowLevels& z, const BankStep& step) {
  const Eigen::Index n = states();
  if (y.size() != outputs_) refuse("y", amount(y.size(), "number"), std::to_string(outputs_));
  detail::require_least("z1", z.z1, 0.0);
  detail::require_least("z2", z.z2, 0.0);
  detail::require_least("zc", z.zc, 0.0);
  if (step.A != nullptr) detail::require_shape("A", *step.A, n, n);
  if (step.u != nullptr) detail::require_shape("u", *step.u, n, 1);
  if (step.Q != nullptr) detail::require_covariance("Q", *step.Q, n);
  if (step.sources != nullptr) {
    detail::require_sources(*step.sources, n);
    bool same = step.sources->size() == sources_.size();
    for (std::size_t j = 0; same && j < sources_.size(); ++j)
      same = (*step.sources)[j].R.size() == sources_[j].R.size();
    if (!same)
      refuse("sources", "other numbers of outputs", "those of the design", "mark missing ones by NaN");
  }
  return update(y, z, step);
}

void Bank::prove() noexcept {
  if (static_cast<int>(sources_.size()) < 2 * s_) return;
  const auto living = members();
  for (const int source : living.front().accused)
    if (std::all_of(living.begin(), living.end(), [&](const BankMember& m) {
          return std::binary_search(m.accused.begin(), m.accused.end(), source);
        }))
      witness_.proofs.push_back({source, kAlways});
}

}  // namespace garrison::certificate
