// SPDX-License-Identifier: Apache-2.0
// Where a reported bound comes from, or why there is none.
#pragma once

#include <cstdint>
#include <string_view>

namespace garrison {

/// Proofs of all of them: docs/certificates.md. From `too_few` to `varying`: why a bound is absent.
enum class CertificateKind : std::uint8_t {
  none,       ///< no certificate was asked for, and the filter's family promises nothing here
  published,  ///< the family's own
  witness,    ///< W: the measurements of this sample that reached the agent
  relayed,    ///< R: a region that another agent found, or an earlier sample
  table,      ///< T: data-free
  informed,   ///< I: data-free, all attackers are proved
  recovered,  ///< L: T and what lost messages may have added to it
  too_few,    ///< bound = infinity: too few measurements reached the agent, in this sample and all before
  refuted,    ///< bound = NaN: the data contradict "at most s are attacked" (or the rare event happened)
  liars,      ///< bound = NaN: agents lie in their messages, where every bound rests on what they say
  varying,    ///< bound = NaN: A or C changes in time, and the family's theorem needs a constant plant
  memory,     ///< B: all measurements that reached the agent so far; the attacked are always the same
};
inline constexpr int kCertificateKinds = 12;

constexpr std::string_view word(CertificateKind kind) {
  constexpr std::string_view words[] = {"none",      "published", "witness", "relayed", "table",   "informed",
                                        "recovered", "too few",   "refuted", "liars",   "varying", "memory"};
  return words[static_cast<int>(kind)];
}

/// A bound on ||estimate - state|| with its kind.
struct Bound {
  double value;
  CertificateKind kind;
};

}  // namespace garrison
