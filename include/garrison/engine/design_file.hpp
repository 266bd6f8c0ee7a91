// SPDX-License-Identifier: Apache-2.0
// A design that leaves the process: from workstation to node, with the same bits on every processor.
//
//   8 bytes   "GDESIGN" and the version, 1
//   content   wire/archive.hpp: filter, parameters, model, network, gains, certificate; or one agent's part
//   of it 32 bytes  BLAKE2b-256 of all before: the hash of the design
//
// A design made again on another processor has other gains in the last bits; a file carries them.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/wire/blake2b.hpp"

namespace garrison {

/// The whole design as bytes, and back. Reading designs nothing and needs no analysis. @throws InvalidInput
/// when the bytes are damaged, of another version, or no design at all
GARRISON_EXPORT std::vector<std::byte> write_design(const Prepared& prepared);
GARRISON_EXPORT std::shared_ptr<const Prepared> read_design(std::span<const std::byte> file);
/// Agent `id` alone: what it holds of the gains, its plant, its sensor, its neighbours.
GARRISON_EXPORT std::vector<std::byte> write_part(const Prepared& prepared, int id);
GARRISON_EXPORT std::unique_ptr<Agent> read_part(std::span<const std::byte> file);

/// The certifier of an agent from its part of a design; null = none.
GARRISON_EXPORT std::unique_ptr<certificate::Certifier> certifier_of(std::span<const std::uint8_t> bytes,
                                                                     const AgentPart& who, int rounds);
/// What an agent needs of the certificate, as bytes.
GARRISON_EXPORT std::vector<std::uint8_t> certificate_part(const certificate::Plan* plan,
                                                           const AgentPart& who);

/// What a file says of itself.
struct GARRISON_EXPORT DesignSummary {
  bool part = false;     ///< of one agent
  int agent = -1;        ///< which
  std::string garrison;  ///< version that wrote it
  std::string filter;
  ParamMap params;
  int agents = 0;
  int states = 0;
  std::size_t bytes = 0;
  wire::Digest digest{};
};
/// @throws InvalidInput as above
GARRISON_EXPORT DesignSummary summary_of(std::span<const std::byte> file);

/// First eight bytes of the digest of the whole design.
GARRISON_EXPORT std::uint64_t fingerprint_of(const Prepared& prepared);

}  // namespace garrison
