// SPDX-License-Identifier: Apache-2.0
#include "own_filter.hpp"

#include <algorithm>
#include <optional>

#include "convert.hpp"
#include "own_family.hpp"

namespace own {

using namespace garrison;

namespace {

/// Bytes of the longest name of a signal: with the prefix of a saved run it is still the name of a file.
constexpr std::size_t kLongestSignal = 200;

/// Why a saved run (an archive, netCDF, or a folder of zarr) could not hold a signal of this name; empty
/// where it can.
std::string unfit(const std::string& name) {
  if (name.empty()) return "is empty";
  if (name.size() > kLongestSignal) return "has more than " + amount(kLongestSignal, "byte");
  if (name.find_first_of("/\\") != std::string::npos || name == "." || name == "..")
    return "is a path of folders";
  if (name.front() == ' ' || name.back() == ' ') return "begins or ends with a space";
  if (name.find('\'') != std::string::npos) return "has an apostrophe, which netCDF refuses";
  const py::object known = py::module_::import("unicodedata").attr("is_normalized")("NFC", name);
  if (!known.cast<bool>()) return "has letters and accents in two parts, which netCDF refuses";
  if (!py::str(name).attr("isprintable")().cast<bool>()) return "has characters that cannot be printed";
  return {};
}

/// Names of the signals: each is that of an array in a saved run, and of a file in a folder of zarr.
std::vector<std::string> signals_of(const std::string& which, const py::object& given) {
  auto names = convert::names(which, given);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& name = names[k];
    const bool twice = std::count(names.begin(), names.end(), name) > 1;
    if (const auto why = twice ? "is there twice" : unfit(name); !why.empty())
      refuse(which + "[" + std::to_string(k) + "]",
             py::repr(py::str(name).attr("__getitem__")(py::slice(0, 40, 1))).cast<std::string>() +
                 ", which " + why,
             "a name that a saved run can give to an array", "use one word for each, such as \"residual\"");
  }
  return names;
}

/// The C++ part of a Python object never outlives it, so a plain pointer does; who needs the object longer
/// holds it (OwnPrepared).
class OwnFilter final : public AnyFilter {
 public:
  explicit OwnFilter(const FilterHandle* handle) : handle_(handle) {}

  py::object object() const { return py::cast(handle_, py::return_value_policy::reference); }
  std::string name() const override {
    const py::gil_scoped_acquire gil;
    return py::type::of(object()).attr("__name__").cast<std::string>();
  }
  ParamMap params() const override { return {}; }  // Python objects: see attributes_of
  std::shared_ptr<const Prepared> prepare(const Model& model, const Network& network) const override;
  std::shared_ptr<const Prepared> restore(const Model&, const Network&,
                                          std::span<const std::byte>) const override {
    refuse_file();
  }
  std::unique_ptr<garrison::Agent> agent(std::span<const std::byte>) const override { refuse_file(); }
  Check check(const Model& model, const Network& network) const override {
    require_same_size(model, network);
    return {};
  }
  std::vector<std::string> signal_names() const override {
    const py::gil_scoped_acquire gil;
    const py::object self = object();
    if (!py::hasattr(self, "signals")) return {};
    return signals_of(name() + ".signals", self.attr("signals"));
  }
  std::vector<std::string> warnings(const Model&, const VerdictLog&) const override { return {}; }
  std::vector<std::string> refuted(unsigned) const override { return {}; }
  std::vector<std::string> detail_names() const override { return {}; }
  int first_sample() const override { return 1; }
  bool own_states() const override { return false; }

 private:
  [[noreturn]] void refuse_file() const {
    refuse("design", "a filter written in Python (" + name() + ")", "a family of garrison.filters",
           "Python code does not travel in design files");
  }
  const FilterHandle* handle_;
};

Layout layout_of(const py::object& self, const std::string& name, const Model& model) {
  Layout layout;
  py::dict given;
  if (py::hasattr(self, "layout")) {
    const py::object found = noted(name + ".layout", [&] { return self.attr("layout")(model); });
    if (!py::isinstance<py::dict>(found))
      refuse(name + ".layout", convert::shown(found), "a dict: name of a field -> how many numbers it has");
    given = found;
  } else {
    given["estimate"] = model.states();
  }
  for (const auto& [key, value] : given) {
    const auto field = convert::words(name + ".layout", key);
    const int size = convert::small(name + ".layout[\"" + field + "\"]", value);
    if (size < 1) refuse(name + ".layout[\"" + field + "\"]", std::to_string(size), "at least 1");
    layout.names.push_back(field);
    layout.sizes.push_back(static_cast<std::size_t>(size));
    layout.total += static_cast<std::size_t>(size);
  }
  if (layout.names.empty() || layout.names.size() > FieldList::kMost)
    refuse(name + ".layout", std::to_string(layout.names.size()) + " fields",
           "1 to " + std::to_string(FieldList::kMost));
  return layout;
}

int rounds_of(const py::object& self, const std::string& name) {
  const int rounds = py::hasattr(self, "rounds") ? convert::small(name + ".rounds", self.attr("rounds")) : 1;
  if (rounds < 0 || rounds > 1000000) refuse(name + ".rounds", std::to_string(rounds), "0..1000000");
  return rounds;
}

/// Frees what Python keeps for a run, under the lock.
struct EndSession {
  void operator()(Session* session) const {
    const py::gil_scoped_acquire gil;
    delete session;
  }
};
using SessionPtr = std::unique_ptr<Session, EndSession>;

/// The engine, and after every call of it what the user's code raised meanwhile.
class OwnRunner final : public Runner {
 public:
  OwnRunner(SessionPtr session, int rounds, const Model& model, const Network& network,
            std::unique_ptr<CertifiedNetwork> certified)
      : session_(std::move(session)),
        engine_(std::make_shared<const Family::Gains>(Family::Gains{session_.get(), rounds}), model, network,
                1, std::move(certified)),
        // Never cuts anything: with a link that might, the engine looks at every message, and withheld ones
        // (None) do not arrive.
        faultless_(network, {.cuts = {{-1, -1, INT64_MAX - 1, INT64_MAX}}}, {}, 0, 0) {}

  void reset(const Matrix& x0, Link* link) override {
    session_->t = 0;
    engine_.reset(x0, link == nullptr ? &faultless_ : link);
    raise();
  }
  void vary(const Change& change) override {
    engine_.vary(change);
    const py::gil_scoped_acquire gil;
    int first = 0;
    for (auto& agent : session_->agents) {
      auto& info = agent.info.cast<AgentInfo&>();
      const auto rows = info.C.rows();
      if (change.A != nullptr) info.A = *change.A;
      if (change.C != nullptr) info.C = change.C->middleRows(first, rows);
      if (change.Q != nullptr) info.Q = *change.Q;
      if (change.variance != nullptr) info.R = change.variance->segment(first, rows);
      first += static_cast<int>(rows);
    }
  }
  void estimates(Matrix& out) const override { engine_.estimates(out); }
  void place(const Matrix& estimates) override {
    engine_.place(estimates);
    for (Eigen::Index i = 0; i < estimates.cols(); ++i)
      Family::place(*session_, static_cast<int>(i), estimates.col(i));
    raise();
  }
  void step(std::int64_t t, const double* y) override {
    engine_.step(t, y);
    raise();
  }
  void read(const Frame& frame) const override {
    Frame rest = frame;
    rest.signals = nullptr;
    engine_.read(rest);
    raise();
    if (frame.signals == nullptr) return;
    const std::size_t N = session_->agents.size();
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t k = 0; k < session_->signals.size(); ++k)
        frame.signals[k * N + i] = session_->agents[i].signals[k];
  }
  void expected(int agent, double* out) const override {
    engine_.expected(agent, out);
    raise();
  }
  double alarm_level(int agent) const override {
    const double level = engine_.alarm_level(agent);
    raise();
    return level;
  }
  void control(double*) const override {}
  void detail(int, std::size_t, std::vector<double>&) const override {}
  const AgentSet& accused(int agent) const override { return engine_.accused(agent); }
  std::span<const int> proved(int agent) const override { return engine_.proved(agent); }
  certificate::Doubts doubts(int agent) const override { return engine_.doubts(agent); }
  std::int64_t overflows() const override { return engine_.overflows(); }
  std::int64_t resets() const override { return engine_.resets(); }
  unsigned refuted() const override { return 0; }
  std::int64_t bytes_per_step() const override { return engine_.bytes_per_step(); }

 private:
  void raise() const {
    if (session_->failure) std::rethrow_exception(session_->failure);
  }
  SessionPtr session_;
  Engine<Family, Dynamic> engine_;
  Link faultless_;
};

class OwnPrepared final : public Prepared {
 public:
  OwnPrepared(const py::object& self, const OwnFilter& filter, const Model& model, const Network& network,
              std::optional<py::object> gains = std::nullopt)
      : object_(self), filter_(filter), name_(filter.name()), model_(model), network_(network) {
    for (const char* needed : {"sense", "fuse"})
      if (!py::hasattr(self, needed))
        refuse("filter", name_ + " without " + needed, "a class with the methods sense and fuse",
               "see the text of garrison.Filter");
    layout_ = layout_of(self, name_, model);
    rounds_ = rounds_of(self, name_);
    signals_ = filter.signal_names();
    if (gains)
      gains_ = Held(std::move(*gains));
    else if (py::hasattr(self, "design"))
      gains_ = Held(noted(name_ + ".design", [&] { return self.attr("design")(model, network); }));
    else
      gains_ = Held(py::none());
  }

  const Model& model() const override { return model_; }
  const Network& network() const override { return network_; }
  const AnyFilter& filter() const override { return filter_; }
  const py::object& gains() const { return *gains_; }
  std::unique_ptr<Runner> runner(int) const override {
    const py::gil_scoped_acquire gil;
    SessionPtr session(new Session);
    session->filter = *object_;
    session->name = name_;
    session->layout = layout_;
    session->signals = signals_;
    for (int i = 0; i < model_.agents(); ++i) session->agents.push_back({info(i), {}, {}});
    for (auto& agent : session->agents) agent.signals.assign(signals_.size(), kNaN);
    auto certified = certificate_ == nullptr
                         ? nullptr
                         : std::make_unique<CertifiedNetwork>(certificate_, network_, rounds_);
    return std::make_unique<OwnRunner>(std::move(session), rounds_, model_, network_, std::move(certified));
  }
  std::shared_ptr<const certificate::Plan> certificate() const override { return certificate_; }
  std::shared_ptr<const Prepared> with(std::shared_ptr<const certificate::Plan> plan) const override {
    const py::gil_scoped_acquire gil;
    auto certified = std::make_shared<OwnPrepared>(*this);
    certified->certificate_ = std::move(plan);
    return certified;
  }
  void check_start(const Matrix&) const override {}
  void check_log(std::span<const double>) const override {}
  void require_varying(const Series&) const override {}
  void require_functions() const override {}
  std::unique_ptr<garrison::Agent> agent(int) const override { refuse_alone("an agent on its own"); }
  std::unique_ptr<TrialsRunner> trials() const override { return nullptr; }
  std::unique_ptr<World> world(const WorldOptions&) const override { return nullptr; }
  std::vector<std::byte> gains_bytes() const override { refuse_alone("a design file"); }
  std::vector<std::string> gains_outline() const override { return {"gains: of " + name_ + ".design"}; }
  std::vector<std::byte> part_bytes(int) const override { refuse_alone("a part of a design file"); }
  std::uint64_t fingerprint() const override { return 0; }

 private:
  [[noreturn]] void refuse_alone(const char* wanted) const {
    refuse("filter", name_ + ", which is written in Python",
           std::string("a family of garrison.filters for ") + wanted,
           "filters of your own run in simulate and replay");
  }
  py::object info(int i) const {
    const auto heard = network_.neighbours(i);
    const auto at = static_cast<std::size_t>(i);
    const Noise& noise = model_.noise();
    const Matrix& Q = noise.agent_process_covariance.empty() ? noise.process_covariance
                                                             : noise.agent_process_covariance[at];
    const auto& R = noise.measurement_covariance;
    return py::cast(AgentInfo{i,
                              model_.agents(),
                              network_.names().empty() ? "" : network_.names()[at],
                              model_.A(),
                              model_.C(i),
                              {heard.begin(), heard.end()},
                              *gains_,
                              Q,
                              R.empty() ? Vector() : Vector(R[at].diagonal())});
  }

  Held object_;
  OwnFilter filter_;
  std::string name_;
  Model model_;
  Network network_;
  Layout layout_;
  std::vector<std::string> signals_;
  Held gains_;
  int rounds_ = 0;
  std::shared_ptr<const certificate::Plan> certificate_;  // null = none
};

std::shared_ptr<const Prepared> OwnFilter::prepare(const Model& model, const Network& network) const {
  require_same_size(model, network);
  const py::gil_scoped_acquire gil;
  return std::make_shared<OwnPrepared>(object(), *this, model, network);
}

}  // namespace

std::shared_ptr<const AnyFilter> filter_of(const FilterHandle* handle) {
  return std::make_shared<OwnFilter>(handle);
}

bool is_own(const AnyFilter& filter) { return dynamic_cast<const OwnFilter*>(&filter) != nullptr; }

py::object object_of(const AnyFilter& filter) { return dynamic_cast<const OwnFilter&>(filter).object(); }

py::object gains_of(const Prepared& prepared) {
  const auto* const found = dynamic_cast<const OwnPrepared*>(&prepared);
  return found == nullptr ? py::object(py::none()) : found->gains();
}

std::shared_ptr<const Prepared> with_gains(const AnyFilter& filter, const Model& model,
                                           const Network& network, py::object gains) {
  const auto* const found = dynamic_cast<const OwnFilter*>(&filter);
  if (found == nullptr)
    refuse("filter", filter.name(), "a class of your own", "a family comes from its design file");
  require_same_size(model, network);
  return std::make_shared<OwnPrepared>(found->object(), *found, model, network, std::move(gains));
}

py::dict attributes_of(const AnyFilter& filter) {
  const py::object object = object_of(filter);
  // The base class itself has no attributes of its own.
  return py::hasattr(object, "__dict__") ? py::dict(object.attr("__dict__").attr("copy")()) : py::dict();
}

}  // namespace own
