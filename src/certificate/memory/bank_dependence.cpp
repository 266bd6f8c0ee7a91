// SPDX-License-Identifier: Apache-2.0
// What the innovations of a bank say against white noise.
#include <algorithm>
#include <cmath>

#include "garrison/certificate/memory/bank.hpp"

namespace garrison::certificate {
namespace {

/// The largest of the rows that a member reads, each of which has the same share of the probability.
Dependence of_member(const BankMember& member, const std::vector<BankSource>& sources) noexcept {
  Dependence most;
  double rows = 0.0;
  Eigen::Index at = 0;
  auto out = member.left_out.begin();
  for (std::size_t j = 0; j < sources.size(); ++j) {
    const Eigen::Index outputs = sources[j].R.size();
    if (out != member.left_out.end() && *out == static_cast<int>(j)) {
      ++out;
      at += outputs;
      continue;
    }
    rows += static_cast<double>(outputs);
    for (const Eigen::Index end = at + outputs; at < end; ++at) {
      Dependence one = detail::dependence(member.heard, at);
      one.source = static_cast<int>(j);
      if (one.evidence > most.evidence) most = one;
    }
  }
  most.evidence -= std::log(std::max(1.0, rows));
  return most;
}

}  // namespace

Dependence Bank::dependence() const noexcept {
  // One member reads honest rows alone: so all of them must say it. Those that lived of late, where none
  // does.
  const std::size_t count = alive_ > 0 ? alive_ : alive_before_;
  Dependence least;
  for (std::size_t k = 0; k < count; ++k) {
    const Dependence one = of_member(members_[k], sources_);
    if (k == 0 || one.evidence < least.evidence) least = one;
  }
  const auto start = static_cast<double>(past_.starts);
  least.evidence -= std::log((start + 1.0) * (start + 2.0));  // the shares of all starts add up to 1
  return least.evidence > past_.most.evidence ? least : past_.most;
}

}  // namespace garrison::certificate
