// SPDX-License-Identifier: Apache-2.0
// Each attack: a Params struct that describes its numbers, and one line in the table at the end.
#include "garrison/attacks/registry.hpp"

#include <array>
#include <cmath>
#include <cstdlib>

namespace garrison {
namespace {

struct NoParams {
  static auto fields() { return std::tuple<>(); }
};
struct BiasParams {
  double value = kNaN;
  static auto fields() {
    return std::make_tuple(
        field(&BiasParams::value,
              {.name = "value", .unit = "measurement", .doc = "added to the measurement", .required = true}));
  }
};
struct ScaleParams {
  double factor = 3.0;
  static auto fields() {
    return std::make_tuple(
        field(&ScaleParams::factor, {.name = "factor",
                                     .unit = "1",
                                     .doc = "the measurement is multiplied by it (3 = the paper's attack)"}));
  }
};
struct ConstantParams {
  std::string value = "nan";
  static auto fields() {
    return std::make_tuple(
        field(&ConstantParams::value,
              {.name = "value",
               .unit = "measurement",
               .doc = "what the sensor says instead: a number as text, nan or inf included"}));
  }
};
struct RandomParams {
  double size = 1.0;
  std::string law = "normal";
  bool replace = false;
  static auto fields() {
    return std::make_tuple(
        field(
            &RandomParams::size,
            {.name = "size", .unit = "measurement", .doc = "half width, or scale of the law", .least = 0.0}),
        field(&RandomParams::law, {.name = "law",
                                   .unit = "",
                                   .doc = "distribution of the noise",
                                   .choices = {"uniform", "normal", "laplace", "cauchy"}}),
        field(&RandomParams::replace,
              {.name = "replace", .unit = "", .doc = "drop the measurement, send noise only"}));
  }
};
struct ReplayParams {
  int delay = 10;
  static auto fields() {
    return std::make_tuple(field(&ReplayParams::delay, {.name = "delay",
                                                        .unit = "samples",
                                                        .doc = "age of the recorded measurement that is sent",
                                                        .least = 1}));
  }
};
struct RampParams {
  double slope = 0.1;
  static auto fields() {
    return std::make_tuple(
        field(&RampParams::slope,
              {.name = "slope", .unit = "measurement/sample", .doc = "growth of the added drift"}));
  }
};
struct SinusoidParams {
  double amplitude = 1.0;
  double period = 20.0;
  double phase = 0.0;
  static auto fields() {
    return std::make_tuple(
        field(&SinusoidParams::amplitude,
              {.name = "amplitude", .unit = "measurement", .doc = "size of the added wave"}),
        field(&SinusoidParams::period,
              {.name = "period", .unit = "samples", .doc = "length of one wave", .least = 0.0, .open = true}),
        field(&SinusoidParams::phase, {.name = "phase", .unit = "rad", .doc = "phase at the start"}));
  }
};
struct AutoregressiveParams {
  double coefficient = 0.9;
  double size = 1.0;
  static auto fields() {
    return std::make_tuple(
        field(&AutoregressiveParams::coefficient,
              {.name = "coefficient", .unit = "1", .doc = "memory of the added signal"}),
        field(
            &AutoregressiveParams::size,
            {.name = "size", .unit = "measurement", .doc = "standard deviation of its noise", .least = 0.0}));
  }
};
struct StoryParams {
  std::vector<double> offset;
  std::vector<double> push;
  static auto fields() {
    return std::make_tuple(
        field(&StoryParams::offset,
              {.name = "offset",
               .unit = "state",
               .doc = "displacement of the false state at the start, one number per state"}),
        field(&StoryParams::push, {.name = "push",
                                   .unit = "state/sample",
                                   .doc = "added to the displacement at every sample; left out: 0"}));
  }
};
struct StealthyParams {
  double fraction = 0.99;
  static auto fields() {
    return std::make_tuple(
        field(&StealthyParams::fraction,
              {.name = "fraction",
               .unit = "1",
               .doc = "share of the tolerated deviation that is used; its sign is the direction"}));
  }
};
struct ForgeParams {
  double offset = 1.0;
  bool replace = false;
  static auto fields() {
    return std::make_tuple(
        field(&ForgeParams::offset,
              {.name = "offset", .unit = "state", .doc = "added to every number of the message"}),
        field(&ForgeParams::replace, {.name = "replace", .unit = "", .doc = "send the offset alone"}));
  }
};
struct EquivocateParams {
  double size = 1.0;
  static auto fields() {
    return std::make_tuple(field(
        &EquivocateParams::size,
        {.name = "size", .unit = "state", .doc = "length of the lie sent to each neighbour", .least = 0.0}));
  }
};

struct CoordinatedParams {
  std::vector<double> covariance;
  static auto fields() {
    return std::make_tuple(field(&CoordinatedParams::covariance,
                                 {.name = "covariance",
                                  .unit = "state^2",
                                  .doc = "of the perturbations of all attacked agents together, agents in "
                                         "ascending order, one number per "
                                         "state: a square matrix, row by row; may be singular"}));
  }
};
struct PerturbParams {
  int width = 0;
  std::vector<double> deltas;
  static auto fields() {
    return std::make_tuple(
        field(&PerturbParams::width, {.name = "width",
                                      .unit = "numbers",
                                      .doc = "numbers per sample: attacked agents times states",
                                      .required = true,
                                      .least = 1}),
        field(&PerturbParams::deltas, {.name = "deltas",
                                       .unit = "state",
                                       .doc = "what is added, sample by sample from the start on; agents in "
                                              "ascending order, one number per "
                                              "state"}));
  }
};

struct FalsifyParams {
  std::string which;
  double value = 0.0;
  std::vector<double> members;
  static auto fields() {
    return std::make_tuple(
        field(&FalsifyParams::which,
              {.name = "field",
               .unit = "",
               .doc = "name of the field, e.g. \"estimate\", \"intact\", \"proved\", \"bound\" (the page of "
                      "each filter lists them)",
               .required = true}),
        field(&FalsifyParams::value,
              {.name = "value",
               .unit = "of the field",
               .doc = "what numbers, counts and optional numbers become; a flag is set where it "
                      "is not 0"}),
        field(&FalsifyParams::members,
              {.name = "members", .unit = "agents", .doc = "what a set becomes", .least = 0.0}));
  }
};
struct OutdatedParams {
  int age = 1;
  static auto fields() {
    return std::make_tuple(field(
        &OutdatedParams::age,
        {.name = "age", .unit = "samples", .doc = "how old what is sent is", .required = true, .least = 1}));
  }
};

double number_from(const std::string& words) {
  char* end = nullptr;
  const double value = std::strtod(words.c_str(), &end);  // the least numbers too, which stod refuses
  const bool named = words.find_first_of("nN") != std::string::npos;  // nan, inf
  if (!words.empty() && end == words.c_str() + words.size() && (named || std::isfinite(value))) return value;
  refuse("constant.value", "\"" + words + "\"", "a number such as \"1e300\", \"nan\" or \"-inf\"");
}

Vector vector_of(const std::vector<double>& list) {
  return Eigen::Map<const Vector>(list.data(), static_cast<Eigen::Index>(list.size()));
}

Attack build(Schedule s, const NoParams&) { return denial(std::move(s)); }
Attack build(Schedule s, const BiasParams& p) { return bias(std::move(s), p.value); }
Attack build(Schedule s, const ScaleParams& p) { return scale(std::move(s), p.factor); }
Attack build(Schedule s, const ConstantParams& p) { return constant(std::move(s), number_from(p.value)); }
Attack build(Schedule s, const RandomParams& p) {
  return random_noise(std::move(s), p.law, p.size, p.replace);
}
Attack build(Schedule s, const ReplayParams& p) { return replayed(std::move(s), p.delay); }
Attack build(Schedule s, const RampParams& p) { return ramp(std::move(s), p.slope); }
Attack build(Schedule s, const SinusoidParams& p) {
  return sinusoid(std::move(s), p.amplitude, p.period, p.phase);
}
Attack build(Schedule s, const AutoregressiveParams& p) {
  return autoregressive(std::move(s), p.coefficient, p.size);
}
Attack build(Schedule s, const StoryParams& p) {
  return false_trajectory(std::move(s), vector_of(p.offset), vector_of(p.push));
}
Attack build(Schedule s, const StealthyParams& p) { return stealthy(std::move(s), p.fraction); }
std::shared_ptr<const MessageAttack> build(Schedule s, const ForgeParams& p) {
  return forge(std::move(s), p.offset, p.replace);
}
std::shared_ptr<const MessageAttack> build(Schedule s, const EquivocateParams& p) {
  return equivocate(std::move(s), p.size);
}
std::shared_ptr<const MessageAttack> build(Schedule s, const FalsifyParams& p) {
  std::vector<int> members;
  for (const double id : p.members) {
    if (id != std::floor(id) || id > 1e9) refuse("falsify.members", text(id), "whole numbers, ids of agents");
    members.push_back(static_cast<int>(id));
  }
  return falsify(std::move(s), p.which, p.value, std::move(members));
}
std::shared_ptr<const MessageAttack> build(Schedule s, const OutdatedParams& p) {
  return outdated(std::move(s), p.age);
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::shared_ptr<const MessageAttack> build(Schedule s, const CoordinatedParams& p) {
  const auto size =
      static_cast<Eigen::Index>(std::llround(std::sqrt(static_cast<double>(p.covariance.size()))));
  if (size == 0 || static_cast<std::size_t>(size * size) != p.covariance.size())
    refuse("coordinated.covariance", amount(p.covariance.size(), "number"),
           "a square matrix, row by row: (agents x states)^2 numbers");
  return coordinated(std::move(s), Matrix(Eigen::Map<const Rows>(p.covariance.data(), size, size)));
}
std::shared_ptr<const MessageAttack> build(Schedule s, const PerturbParams& p) {
  const auto width = static_cast<std::size_t>(p.width);
  if (width == 0 || p.deltas.size() % width != 0)
    refuse("perturb.deltas", amount(p.deltas.size(), "number"),
           "a multiple of width = " + std::to_string(p.width));
  const auto samples = static_cast<Eigen::Index>(p.deltas.size() / width);
  return perturb(std::move(s), Matrix(Eigen::Map<const Rows>(p.deltas.data(), samples, p.width)));
}

template <class P>
AttackInfo on_measurements(const char* name, const char* doc) {
  return {name, "measurement", doc, describe<P>(), [name](Schedule s, const ParamMap& given) -> AnyAttack {
            const P p = parse_params<P>(name, given);
            return {"", values(p), build(std::move(s), p), nullptr};
          }};
}
template <class P>
AttackInfo on_messages(const char* name, const char* doc) {
  return {name, "message", doc, describe<P>(), [name](Schedule s, const ParamMap& given) -> AnyAttack {
            const P p = parse_params<P>(name, given);
            return {"", values(p), nullptr, build(std::move(s), p)};
          }};
}

}  // namespace

std::span<const AttackInfo> attack_infos() {
  static const std::array all{
      on_measurements<BiasParams>("bias", "a constant is added"),
      on_measurements<ScaleParams>("scale", "the measurement is multiplied"),
      on_measurements<ConstantParams>("constant", "the sensor says one value, which may be nan, inf or huge"),
      on_measurements<RandomParams>("random", "noise is added, or sent instead"),
      on_measurements<NoParams>("denial", "the measurement is lost"),
      on_measurements<ReplayParams>("replay", "an old recorded measurement is sent"),
      on_measurements<RampParams>("ramp", "a growing drift is added"),
      on_measurements<SinusoidParams>("sinusoid", "a wave is added"),
      on_measurements<AutoregressiveParams>("autoregressive", "correlated noise is added"),
      on_measurements<StoryParams>("false_trajectory",
                                   "all attacked sensors report one false state that obeys the plant"),
      on_measurements<StealthyParams>("stealthy",
                                      "stays inside the threshold that the agent applies (closed loop)"),
      on_messages<ForgeParams>("forge", "the agent sends a false estimate to all neighbours"),
      on_messages<EquivocateParams>("equivocate", "the agent tells each neighbour another lie"),
      on_messages<CoordinatedParams>("coordinated", "the agents add Gaussian noise that they draw together"),
      on_messages<PerturbParams>("perturb", "the agents add given numbers"),
      on_messages<FalsifyParams>("falsify",
                                 "the agent lies in one field of its messages, e.g. a set or a flag"),
      on_messages<OutdatedParams>("outdated", "the agent sends what it sent some samples ago, as new"),
      AttackInfo{"silence",
                 "message",
                 "the agent sends nothing",
                 {},
                 [](Schedule s, const ParamMap& given) -> AnyAttack {
                   parse_params<NoParams>("silence", given);
                   return {"", {}, nullptr, silence(std::move(s))};
                 }},
  };
  return all;
}

AnyAttack make_attack(const std::string& name, Schedule schedule, const ParamMap& params) {
  std::vector<std::string> known;
  for (const AttackInfo& info : attack_infos()) {
    if (info.name == name) {
      AnyAttack attack = info.make(std::move(schedule), params);
      attack.name = name;
      return attack;
    }
    known.push_back(info.name);
  }
  refuse_unknown("attack", name, known);
}

}  // namespace garrison
