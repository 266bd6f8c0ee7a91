// SPDX-License-Identifier: Apache-2.0
#include "unseen_part.hpp"

#include <algorithm>
#include <limits>

#include "splitting.hpp"

namespace garrison::detail {
namespace {

using Index = Eigen::Index;

Visibility split(Pair pair, const std::vector<Complex>& candidates, double least) {
  const Index n = pair.A.rows();
  if (pair.C.rows() > n)  // as good, and smaller
    pair.C = Eigen::HouseholderQR<Matrix>(pair.C).matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const bool real =
      std::all_of(candidates.begin(), candidates.end(), [](Complex z) { return z.imag() == 0.0; });
  return real ? Splitting<double>(pair, least).run(candidates)
              : Splitting<Complex>(pair, least).run(candidates);
}

/// Rounding is small in all units, so a pair that is far from unseen modes in some is far from them. Units
/// are tried that do not depend on those given: those in which every state drives its outputs as strongly as
/// others do, and, because these grow with the distance from the outputs, those that balance A and keep
/// little of that. The units given answer only where their answer is plain.
Visibility in_good_units(const Matrix& A, const Matrix& C, double least) {
  const double rate = natural_rate(A);
  const Pair own = balanced(A, C, rate);
  const auto candidates = candidate_modes(A, own.A, rate, least);
  const Visibility given = split(rows_scaled(A, C, rate), candidates, least);
  constexpr double kClearly = 1e-4;
  if (given.sight == Sight::seen && given.distance > kClearly) return given;
  const Visibility v = split(own, candidates, least);
  if (C.rows() == 0 || (v.sight == Sight::seen && v.distance > kClearly)) return v;
  constexpr double kLoose = 1e-2;
  const Pair loose = balanced(A, C, rate, kLoose);
  const Visibility w = split(rows_scaled(loose.A, loose.C, rate), candidates, least);
  const Visibility& best = w.distance > v.distance ? w : v;
  if (best.sight != Sight::unclear || best.distance > balanced_level(A.rows())) return best;
  for (const Visibility* other : {&given, &v, &w})
    if (other->sight == Sight::unseen) return *other;
  return best;
}

/// Rows and columns `kept` of A, columns of C.
Pair part(const Matrix& A, const Matrix& C, const std::vector<Index>& kept) {
  return {A(kept, kept), C(Eigen::all, kept)};
}

}  // namespace

template class Splitting<double>;
template class Splitting<Complex>;

Visibility examine(const Matrix& A, const Matrix& C, double least) {
  const auto reached = reach_outputs(A, C);
  std::vector<Index> heard;
  std::vector<Index> silent;
  for (Index j = 0; j < A.rows(); ++j) (reached[static_cast<std::size_t>(j)] ? heard : silent).push_back(j);
  if (silent.empty()) return in_good_units(A, C, least);
  // States that move no output: their modes are seen by nobody, whatever the numbers.
  const Pair dark = part(A, C, silent);
  Visibility v = in_good_units(dark.A, Matrix(0, dark.A.rows()), least);
  if (heard.empty()) return v;
  const Pair lit = part(A, C, heard);
  const Visibility of_lit = in_good_units(lit.A, lit.C, least);
  v.unseen.insert(v.unseen.end(), of_lit.unseen.begin(), of_lit.unseen.end());
  v.unclear.insert(v.unclear.end(), of_lit.unclear.begin(), of_lit.unclear.end());
  if (of_lit.distance < v.distance) {
    v.distance = of_lit.distance;
    v.nearest = of_lit.nearest;
  }
  v.sight = !v.unseen.empty() ? Sight::unseen : !v.unclear.empty() ? Sight::unclear : Sight::seen;
  return v;
}

namespace {

/// Changes entries that are small in all units, up to `part`: change(entry, whole), `whole` being the size of
/// what it is small against. False when there are none.
template <class Change>
bool change_small(Matrix& A, Matrix& C, double part, const Change& change) {
  const Index n = A.rows();
  bool changed = false;
  const auto look_at = [&](double& entry, double whole) {
    if (entry == 0.0 || std::abs(entry) > part * whole) return;
    change(entry, whole);
    changed = true;
  };
  const double rate = natural_rate(A);
  const Matrix before = A;
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i)
      if (i != j && std::abs(before(i, j)) * std::abs(before(j, i)) <= part * rate * rate)
        look_at(A(i, j), rate);
  for (Index k = 0; k < C.rows(); ++k) {
    Index largest = 0;
    const double row = C.row(k).cwiseAbs().maxCoeff(&largest);
    for (Index j = 0; j < n; ++j)
      if (std::abs(C(k, j)) * std::abs(before(j, largest)) <= part * row * rate) look_at(C(k, j), row);
  }
  return changed;
}

}  // namespace

bool drop_rounding(Matrix& A, Matrix& C) {
  constexpr double part = 2.0 * std::numeric_limits<double>::epsilon();
  return change_small(A, C, part, [](double& entry, double) { entry = 0.0; });
}

bool enlarge_small(Matrix& A, Matrix& C) {
  return change_small(A, C, unclear_level(A.rows()),
                      [](double& entry, double whole) { entry = std::copysign(whole, entry); });
}

}  // namespace garrison::detail
