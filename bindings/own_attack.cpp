// SPDX-License-Identifier: Apache-2.0
#include "own_attack.hpp"

#include <algorithm>

#include "convert.hpp"
#include "own.hpp"

namespace own {

using namespace garrison;

namespace {

/// A numpy.random.Generator that depends on the seed of the run, trial, attack, time and agent only.
py::object generator(const Random& random, std::int64_t t, int agent, std::uint32_t salt, int more = 0) {
  py::list words;
  for (std::uint32_t k = 0; k < 2; ++k)
    words.append(static_cast<std::uint64_t>(
        0x1p53 * random.uniform(t, static_cast<std::uint32_t>(agent), salt + 0x1000000U * (k + 1))));
  words.append(more);
  return py::module_::import("numpy").attr("random").attr("default_rng")(words);
}

std::string called(const Held& function) {
  return py::hasattr(*function, "__name__") ? function->attr("__name__").cast<std::string>()
                                            : py::repr(*function).cast<std::string>();
}

class OwnPlan final : public AttackPlan {
 public:
  OwnPlan(Schedule schedule, py::object given)
      : AttackPlan(std::move(schedule)), function(std::move(given)) {}
  std::unique_ptr<MeasurementAttack> start(const Model& model, const Random& random,
                                           std::uint32_t salt) const override;
  const Held function;
};

class OwnTrial final : public MeasurementAttack {
 public:
  OwnTrial(const OwnPlan& plan, const Model& model, const Random& random, std::uint32_t salt)
      : plan_(plan), model_(model), random_(random), salt_(salt) {
    const py::gil_scoped_acquire gil;
    // An object that remembers starts every trial afresh; plain functions are copied as they are.
    function_ = Held(py::module_::import("copy").attr("deepcopy")(*plan.function));
  }
  void apply(const Sample& s) override {
    for (const int i : plan_.schedule().agents(s.t)) {
      if (!plan_.schedule().strikes(random_, s.t, i, salt_)) continue;
      if (model_.exposed(i) == 0) continue;
      const py::gil_scoped_acquire gil;
      lie(s, i);
    }
  }

 private:
  void lie(const Sample& s, int i) {
    double* const y = s.y.data() + model_.offset(i);
    const auto size = static_cast<std::size_t>(model_.exposed(i));
    const std::string where =
        called(function_) + ", agent " + std::to_string(i) + ", sample " + std::to_string(s.t);
    const py::object told = noted(
        where, [&] { return (*function_)(s.t, i, array_of(y, size), generator(random_, s.t, i, salt_)); });
    const auto numbers = convert::array("attack (" + where + ")", told);
    if (static_cast<std::size_t>(numbers.size()) != size)
      refuse("attack (" + where + ")", amount(numbers.size(), "number"), std::to_string(size),
             "return one number per output of the agent that can be attacked");
    std::copy_n(numbers.data(), size, y);
  }

  const OwnPlan& plan_;
  const Model& model_;
  Random random_;
  std::uint32_t salt_;
  Held function_;
};

std::unique_ptr<MeasurementAttack> OwnPlan::start(const Model& model, const Random& random,
                                                  std::uint32_t salt) const {
  schedule().require_agents_below(model.agents());
  return std::make_unique<OwnTrial>(*this, model, random, salt);
}

py::object value_of(const FieldRef& field) {
  switch (field.kind) {
    case FieldKind::numbers:
    case FieldKind::sparse:
      return array_of(static_cast<double*>(field.data), static_cast<std::size_t>(field.size));
    case FieldKind::optional:
      return py::float_(*static_cast<double*>(field.data));
    case FieldKind::flag:
      return py::bool_(*static_cast<bool*>(field.data));
    case FieldKind::count:
      return py::int_(*static_cast<int*>(field.data));
    case FieldKind::set: {
      py::list members;
      const auto& set = *static_cast<AgentSet*>(field.data);
      for (int id = 0; id < static_cast<int>(64 * set.words()); ++id)
        if (set.contains(id)) members.append(id);
      return members;
    }
    case FieldKind::labels: {
      const auto& set = *static_cast<LabelSet*>(field.data);
      const auto listed = set.listed();
      return py::make_tuple(std::vector<int>(listed.begin(), listed.end()), set.complement());
    }
  }
  return py::none();
}

/// Lists of agents may name any; what no honest agent could send is refused by the receivers.
void put_set(const std::string& which, AgentSet& set, py::handle value) {
  if (set.empty()) return;
  set.clear();
  for (const py::handle one : value) {
    const int id = convert::small(which, one);
    if (id >= 0 && static_cast<std::size_t>(id) < 64 * set.words()) set.insert(id);
  }
}

void put(const std::string& which, const FieldRef& field, py::handle value) {
  switch (field.kind) {
    case FieldKind::numbers:
    case FieldKind::sparse: {
      const auto numbers = convert::array(which, value);
      if (numbers.size() != field.size)
        refuse(which, amount(numbers.size(), "number"), std::to_string(field.size));
      std::copy_n(numbers.data(), field.size, static_cast<double*>(field.data));
      return;
    }
    case FieldKind::optional:
      *static_cast<double*>(field.data) = convert::number(which, value);
      return;
    case FieldKind::flag:
      *static_cast<bool*>(field.data) = convert::flag(which, value);
      return;
    case FieldKind::count:
      *static_cast<int*>(field.data) = convert::small(which, value);
      return;
    case FieldKind::set:
      return put_set(which, *static_cast<AgentSet*>(field.data), value);
    case FieldKind::labels: {
      auto& set = *static_cast<LabelSet*>(field.data);
      if (!py::isinstance<py::tuple>(value) || py::len(value) != 2)
        refuse(which, convert::shown(value), "(ids, complement)");
      const auto pair = py::reinterpret_borrow<py::tuple>(value);
      auto ids = pair[0].cast<std::vector<int>>();
      std::sort(ids.begin(), ids.end());
      if (static_cast<int>(ids.size()) > set.capacity())
        refuse(which, std::to_string(ids.size()) + " ids", "at most " + std::to_string(set.capacity()));
      set.start(static_cast<int>(ids.size()), convert::flag(which, pair[1]));
      for (std::size_t k = 0; k < ids.size(); ++k) set.place(static_cast<int>(k), ids[k]);
      return;
    }
  }
}

class OwnMessageAttack final : public MessageAttack {
 public:
  OwnMessageAttack(Schedule schedule, py::object given)
      : MessageAttack(std::move(schedule)), function(std::move(given)) {}
  bool rewrite(const Hop& hop, const Random& random, const FieldList& message) const override {
    const py::gil_scoped_acquire gil;
    const std::string where = called(function) + ", from agent " + std::to_string(hop.sender) + " to " +
                              std::to_string(hop.receiver) + ", sample " + std::to_string(hop.t) +
                              ", round " + std::to_string(hop.round);
    py::dict honest;
    for (const FieldRef& field : message.all()) honest[py::str(std::string(field.name))] = value_of(field);
    const py::object told = noted(where, [&] {
      return (*function)(hop.t, hop.round, hop.sender, hop.receiver, honest,
                         generator(random, hop.t, hop.sender,
                                   hop.salt + 256U * static_cast<std::uint32_t>(hop.round), hop.receiver));
    });
    if (told.is_none()) return false;
    if (!py::isinstance<py::dict>(told))
      refuse("attack (" + where + ")", convert::shown(told),
             "a message (a dict of fields), or None to send nothing");
    for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(told)) {
      const auto name = py::str(key).cast<std::string>();
      const FieldRef* field = message.find(name);
      if (field == nullptr) refuse_unknown("attack (" + where + ")", name, names(message));
      put("attack (" + where + "): " + name, *field, value);
    }
    return true;
  }
  const Held function;

 private:
  static std::vector<std::string> names(const FieldList& message) {
    std::vector<std::string> all;
    for (const FieldRef& field : message.all()) all.emplace_back(field.name);
    return all;
  }
};

const Held* held(const AnyAttack& attack) {
  if (const auto* plan = dynamic_cast<const OwnPlan*>(attack.measurement.get())) return &plan->function;
  if (const auto* lies = dynamic_cast<const OwnMessageAttack*>(attack.message.get())) return &lies->function;
  return nullptr;
}

}  // namespace

AnyAttack attack(const std::string& name, Schedule schedule, py::object function) {
  if (name == "custom")
    return {name, {}, std::make_shared<OwnPlan>(std::move(schedule), std::move(function)), nullptr};
  return {name, {}, nullptr, std::make_shared<OwnMessageAttack>(std::move(schedule), std::move(function))};
}

bool is_own(const AnyAttack& attack) { return held(attack) != nullptr; }

py::object function_of(const AnyAttack& attack) { return **held(attack); }

}  // namespace own
