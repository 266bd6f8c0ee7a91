// SPDX-License-Identifier: Apache-2.0
// The certificate's part of an agent and of its messages: behind the family's fields, if there is one.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/engine/evidence_shelf.hpp"
#include "garrison/wire/letter.hpp"
#include "garrison/wire/message.hpp"

namespace garrison {

/// An agent's certifier with what it says and hears. Nothing is allocated after construction.
/// Threads: one at a time.
class AgentEvidence {
 public:
  /// `certifier`: null = no certificate was asked for. `neighbours`: ascending; they outlive this.
  AgentEvidence(std::unique_ptr<certificate::Certifier> certifier, std::span<const int> neighbours,
                std::size_t places, int id, int agents)
      : certifier_(std::move(certifier)), neighbours_(neighbours), agents_(agents) {
    if (!certifier_) return;
    shelf_.emplace(*certifier_, neighbours, places);
    certifier_->shape_evidence(id, said_);
  }

  explicit operator bool() const noexcept { return certifier_ != nullptr; }
  certificate::Certifier* operator->() const noexcept { return certifier_.get(); }
  certificate::Certifier* get() const noexcept { return certifier_.get(); }

  /// The most bytes that `sender` puts behind a message of the family.
  std::size_t most_bytes(int sender) const {
    certificate::Evidence said;
    return certifier_ ? wire::most_bytes(shaped(sender, said), agents_) : 0;
  }
  void list_fields(int sender, std::vector<wire::FieldInfo>& all) const {
    certificate::Evidence said;
    if (certifier_) wire::list_fields(FieldList(shaped(sender, said)), agents_, all);
  }

  /// Writes what is to be said in this round; how many bytes. After the last round as in it, but for evidence
  /// that holds nothing: it has a meaning in the first round alone.
  std::size_t encode(int round, int rounds, std::byte* out) noexcept {
    if (!certifier_) return 0;
    if (round < rounds) certifier_->say(round, said_);
    return certifier_->spares(round, said_) ? 0 : wire::encode(said_, agents_, out);
  }
  /// Reads what neighbour k put behind the message in this place. first: of a sample, with an estimate.
  void decode(wire::Decoder& body, std::size_t place, std::size_t neighbour, bool first) noexcept {
    if (!certifier_) return;
    if (body.at_end()) return shelf_->leave(place, neighbour);
    certificate::Evidence& heard = shelf_->open(place, neighbour);
    heard.visit(body);
    if (!heard.silent() || (first && certifier_->derives(neighbours_[neighbour]))) return;
    body.refuse_as(Refusal::size);  // that is said by no bytes
  }
  /// Hears what lies in these places, which are in ascending order of sender; sensed(slot): the estimate that
  /// measurements may follow from, or null.
  template <class Sensed>
  void hear(int round, std::span<const std::uint32_t> slots, std::span<const int> senders,
            const Sensed& sensed) noexcept {
    std::size_t neighbour = 0;
    for (std::size_t k = 0; k < slots.size(); ++k) {
      if (!shelf_->has(slots[k])) {
        const double* const x = round == 0 ? sensed(slots[k]) : nullptr;
        if (x != nullptr) certifier_->hear_estimate(senders[k], x);
        continue;
      }
      while (neighbours_[neighbour] != senders[k]) ++neighbour;
      certifier_->hear(round, senders[k], shelf_->take(slots[k], neighbour));
    }
  }

 private:
  certificate::Evidence& shaped(int sender, certificate::Evidence& said) const {
    certifier_->shape_evidence(sender, said);
    return said;
  }

  std::unique_ptr<certificate::Certifier> certifier_;
  std::span<const int> neighbours_;
  int agents_;
  std::optional<EvidenceShelf> shelf_;  // of the message in each place
  certificate::Evidence said_;
};

}  // namespace garrison
