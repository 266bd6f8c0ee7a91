// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/engine/runner.hpp"

namespace garrison {

void disclaim(const Frame& f, std::size_t agents) {
  if (f.bound == nullptr) return;
  std::fill_n(f.bound, agents, kNaN);
  if (f.published != nullptr) std::fill_n(f.published, agents, kNaN);
  if (f.bound_kind != nullptr)
    std::fill_n(f.bound_kind, agents, static_cast<std::uint8_t>(CertificateKind::varying));
}

void certify(const Frame& f, std::size_t i, const certificate::Certifier* certifier,
             std::span<const double> estimate) {
  const auto kind = static_cast<CertificateKind>(f.bound_kind[i]);
  const Bound bound = certificate::least(f.bound[i], kind, certifier, estimate);
  f.bound[i] = bound.value;
  f.bound_kind[i] = static_cast<std::uint8_t>(bound.kind);
}

void name_sources(const Frame& f, std::size_t agents) {
  for (std::size_t i = 0; i < agents; ++i) certify(f, i, nullptr, {});
}

}  // namespace garrison
