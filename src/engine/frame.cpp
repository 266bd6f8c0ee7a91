// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/engine/runner.hpp"

namespace garrison {

void disclaim(const Frame& f, std::size_t agents, std::size_t states) {
  if (f.bound == nullptr) return;
  std::fill_n(f.bound, agents, kNaN);
  if (f.published != nullptr) std::fill_n(f.published, agents, kNaN);
  if (f.box != nullptr) std::fill_n(f.box, agents * states, kNaN);
  if (f.bound_kind != nullptr)
    std::fill_n(f.bound_kind, agents, static_cast<std::uint8_t>(CertificateKind::varying));
}

void certify(const Frame& f, std::size_t i, const certificate::Certifier* certifier,
             std::span<const double> estimate) {
  const auto kind = static_cast<CertificateKind>(f.bound_kind[i]);
  const Bound bound = certificate::least(f.bound[i], kind, certifier, estimate);
  f.bound[i] = bound.value;
  f.bound_kind[i] = static_cast<std::uint8_t>(bound.kind);
  const std::size_t n = estimate.size();
  if (f.box != nullptr) certificate::least_box(bound.value, certifier, estimate, {f.box + i * n, n});
}

}  // namespace garrison
