// SPDX-License-Identifier: Apache-2.0
#include "garrison/wire/letter.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/core/params.hpp"
#include "garrison/wire/archive.hpp"
#include "garrison/wire/blake2b.hpp"
#include "garrison/wire/message.hpp"

namespace garrison::wire {
namespace {

constexpr std::uint32_t kMagic = 0x32474d47;  // "GMG2"
constexpr std::size_t kFrame = 4 + 8;         // magic, checksum

/// A message whose fields are known at run time only: the visitors of real messages read and write it.
class AnyFields {
 public:
  explicit AnyFields(const Letter& letter) : letter_(letter) {
    for (const FieldInfo& info : letter.fields) {
      Slot slot;
      if (info.kind == FieldKind::numbers || info.kind == FieldKind::sparse)
        slot.numbers.resize(static_cast<std::size_t>(info.size), kNaN);
      if (info.kind == FieldKind::set) slot.set.resize(info.size);
      if (info.kind == FieldKind::labels) slot.labels = LabelSet(info.size);
      slots_.push_back(std::move(slot));
    }
    const auto of_certificate = [](const FieldInfo& info) { return info.name.starts_with("certificate."); };
    filters_ = static_cast<std::size_t>(
        std::find_if(letter.fields.begin(), letter.fields.end(), of_certificate) - letter.fields.begin());
    shown_ = slots_.size();
  }

  /// The fields of a certificate take no bytes where they say nothing: whether they are to be visited.
  void show_certificate(bool shown) { shown_ = shown ? slots_.size() : filters_; }
  bool shows_certificate() const { return shown_ > filters_; }
  bool has_certificate() const { return filters_ < slots_.size(); }
  bool silent() const {
    for (std::size_t k = filters_; k < slots_.size(); ++k)
      for (const double v : slots_[k].numbers)
        if (!std::isnan(v)) return false;
    return true;
  }

  template <class V>
  void visit(V& v) {
    for (std::size_t k = 0; k < shown_; ++k) {
      Slot& slot = slots_[k];
      const FieldInfo& info = letter_.fields[k];
      switch (info.kind) {
        case FieldKind::numbers:
          v.numbers(info.name, std::span<double>(slot.numbers));
          break;
        case FieldKind::sparse:
          v.sparse(info.name, std::span<double>(slot.numbers));
          break;
        case FieldKind::optional:
          v.optional(info.name, slot.number);
          break;
        case FieldKind::flag:
          v.flag(info.name, slot.flag);
          break;
        case FieldKind::count:
          v.count(info.name, slot.count, info.size);
          break;
        case FieldKind::set:
          v.set(info.name, slot.set);
          break;
        case FieldKind::labels:
          v.labels(info.name, slot.labels);
          break;
      }
    }
  }

  FieldValue value(std::size_t k) const {
    const Slot& slot = slots_[k];
    switch (letter_.fields[k].kind) {
      case FieldKind::numbers:
      case FieldKind::sparse:
        return slot.numbers;
      case FieldKind::optional:
        return slot.number;
      case FieldKind::flag:
        return slot.flag;
      case FieldKind::count:
        return slot.count;
      case FieldKind::set: {
        Labels all;
        for (int id = 0; id < letter_.agents && !slot.set.empty(); ++id)
          if (slot.set.contains(id)) all.ids.push_back(id);
        return all;
      }
      case FieldKind::labels:
        break;
    }
    return Labels{{slot.labels.listed().begin(), slot.labels.listed().end()}, slot.labels.complement()};
  }

  void set_value(std::size_t k, const FieldValue& value) {
    const FieldInfo& info = letter_.fields[k];
    Slot& slot = slots_[k];
    const auto wrong = [&](const std::string& expected) {
      refuse("message field " + info.name, "another value", expected);
    };
    switch (info.kind) {
      case FieldKind::numbers:
      case FieldKind::sparse: {
        const auto* numbers = std::get_if<std::vector<double>>(&value);
        if (numbers == nullptr || numbers->size() != slot.numbers.size())
          wrong(amount(slot.numbers.size(), "number"));
        else
          slot.numbers = *numbers;
        break;
      }
      case FieldKind::optional:
        if (const auto* number = std::get_if<double>(&value))
          slot.number = *number;
        else
          wrong("a number, nan = absent");
        break;
      case FieldKind::flag:
        if (const auto* flag = std::get_if<bool>(&value))
          slot.flag = *flag;
        else
          wrong("True or False");
        break;
      case FieldKind::count: {
        const auto* count = std::get_if<int>(&value);
        if (count == nullptr || *count < 0 || *count > info.size)
          wrong("a whole number in 0.." + std::to_string(info.size));
        else
          slot.count = *count;
        break;
      }
      case FieldKind::set:
      case FieldKind::labels:
        set_labels(info, slot, std::get_if<Labels>(&value));
        break;
    }
  }

 private:
  struct Slot {
    std::vector<double> numbers;
    double number = kNaN;
    bool flag = false;
    int count = 0;
    AgentSet set;
    LabelSet labels;
  };
  void set_labels(const FieldInfo& info, Slot& slot, const Labels* given) const {
    const std::string expected = "ids of agents in 0.." + std::to_string(letter_.agents - 1) +
                                 ", ascending, at most " + std::to_string(info.size);
    if (given == nullptr || static_cast<int>(given->ids.size()) > info.size)
      refuse("message field " + info.name, "another value", expected);
    int last = -1;
    for (const int id : given->ids) {
      if (id <= last || id >= letter_.agents)
        refuse("message field " + info.name, "agent " + std::to_string(id), expected);
      last = id;
    }
    if (info.kind == FieldKind::set) {
      slot.set.clear();
      for (const int id : given->ids) slot.set.insert(id);
      return;
    }
    slot.labels.start(static_cast<int>(given->ids.size()), given->complement);
    for (std::size_t k = 0; k < given->ids.size(); ++k) slot.labels.place(static_cast<int>(k), given->ids[k]);
  }

  const Letter& letter_;
  std::vector<Slot> slots_;
  std::size_t filters_ = 0;  // fields of the filter; those of a certificate follow
  std::size_t shown_ = 0;
};

AnyFields decoded(const Letter& letter) {
  AnyFields fields(letter);
  fields.show_certificate(false);
  if (decode(letter.body, letter.agents, fields) == Refusal::none) return fields;
  fields.show_certificate(true);
  Refusal refusal = decode(letter.body, letter.agents, fields);
  // That is said by no bytes; but in the first round these may mean that the measurement follows. Whether
  // they do in this family, with this certificate, agents know: they refuse what a letter takes here.
  if (refusal == Refusal::none && fields.has_certificate() && fields.silent() && letter.envelope.round > 0)
    refusal = Refusal::size;
  if (refusal != Refusal::none)
    refuse("message", "a body with a wrong " + std::string(word(refusal)), "the fields of " + letter.family);
  return fields;
}

}  // namespace

std::vector<FieldValue> Letter::values() const {
  const AnyFields all = decoded(*this);
  std::vector<FieldValue> found;
  for (std::size_t k = 0; k < fields.size(); ++k) found.push_back(all.value(k));
  return found;
}

Letter Letter::with(const std::string& name, const FieldValue& value) const {
  AnyFields all = decoded(*this);
  std::vector<std::string> known;
  for (const FieldInfo& info : fields) known.push_back(info.name);
  const auto at = std::find(known.begin(), known.end(), name);
  if (at == known.end()) refuse_unknown("message of " + family, name, known);
  const bool means = all.shows_certificate() && all.silent();  // that nothing follows
  all.set_value(static_cast<std::size_t>(at - known.begin()), value);
  all.show_certificate(means || !all.silent());
  Letter changed = *this;
  changed.body.resize(most_bytes(all, agents));
  changed.body.resize(encode(all, agents, changed.body.data()));
  return changed;
}

std::vector<std::byte> Letter::to_bytes() const {
  const std::vector<std::byte> content = wire::to_bytes(*this);
  std::vector<std::byte> all(kFrame);
  store(all.data(), kMagic);
  store(all.data() + 4, checksum(content));
  all.insert(all.end(), content.begin(), content.end());
  return all;
}

Letter Letter::from_bytes(std::span<const std::byte> bytes) {
  const auto refuse_bytes = [](const std::string& got) {
    refuse("message", got, "what to_bytes() of a message returned");
  };
  if (bytes.size() < kFrame || load<std::uint32_t>(bytes.data()) != kMagic)
    refuse_bytes(amount(bytes.size(), "byte") + " that do not begin like a message");
  const auto content = bytes.subspan(kFrame);
  if (load<std::uint64_t>(bytes.data() + 4) != checksum(content)) refuse_bytes("damaged bytes");
  Letter letter;
  if (const Refusal refusal = wire::from_bytes(content, INT32_MAX, letter); refusal != Refusal::none)
    refuse_bytes("bytes with a wrong " + std::string(word(refusal)));
  for (const FieldInfo& info : letter.fields)
    if (info.kind == FieldKind::set && info.size != 0 && info.size != letter.agents)
      refuse_bytes("a set of another number of agents");
  decoded(letter);
  return letter;
}

}  // namespace garrison::wire
