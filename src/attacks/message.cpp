// SPDX-License-Identifier: Apache-2.0
#include "garrison/attacks/message.hpp"

#include <cmath>

namespace garrison {
namespace {

class Forge final : public MessageAttack {
 public:
  Forge(Schedule schedule, double offset, bool replace)
      : MessageAttack(std::move(schedule)), offset_(offset), replace_(replace) {}
  bool rewrite(const Hop&, const Random&, std::span<double> values) const override {
    for (double& v : values) v = replace_ ? offset_ : v + offset_;
    return true;
  }

 private:
  double offset_;
  bool replace_;
};

class Equivocate final : public MessageAttack {
 public:
  Equivocate(Schedule schedule, double size) : MessageAttack(std::move(schedule)), size_(size) {}
  bool rewrite(const Hop& hop, const Random& random, std::span<double> values) const override {
    const auto receiver = static_cast<std::uint32_t>(hop.receiver);
    double square = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k)
      square += std::pow(direction(hop, random, receiver, k), 2);
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] += size_ * direction(hop, random, receiver, k) / std::sqrt(square);
    return true;
  }

 private:
  static double direction(const Hop& hop, const Random& random, std::uint32_t receiver, std::size_t k) {
    const auto index = static_cast<std::uint32_t>(k) + 64U * static_cast<std::uint32_t>(hop.round + 1);
    return random.normal(hop.t, static_cast<std::uint32_t>(hop.sender) * 65537U + receiver, index);
  }
  double size_;
};

class Silence final : public MessageAttack {
 public:
  using MessageAttack::MessageAttack;
  bool rewrite(const Hop&, const Random&, std::span<double>) const override { return false; }
};

}  // namespace

std::shared_ptr<MessageAttack> forge(Schedule schedule, double offset, bool replace) {
  return std::make_shared<Forge>(std::move(schedule), offset, replace);
}

std::shared_ptr<MessageAttack> equivocate(Schedule schedule, double size) {
  if (!(size >= 0.0)) refuse("size", text(size), "a number >= 0");
  return std::make_shared<Equivocate>(std::move(schedule), size);
}

std::shared_ptr<MessageAttack> silence(Schedule schedule) {
  return std::make_shared<Silence>(std::move(schedule));
}

}  // namespace garrison
