// SPDX-License-Identifier: Apache-2.0
// Memory of one agent of every family, of 30 that watch four states (vehicles: 30 in a string): its state,
// its outgoing message and what both take from the heap; and the whole agent of a node, with its mail and its
// part of the design. Ends with 1 where a state takes more than the figure that docs/install.md gives.
#include <malloc.h>

#include <cstdlib>
#include <garrison/core/model.hpp>
#include <garrison/core/network.hpp>
#include <garrison/engine/any_filter.hpp>
#include <garrison/engine/design_file.hpp>
#include <garrison/engine/part.hpp>
#include <garrison/filters/families.hpp>
#include <garrison/filters/platoon/world.hpp>
#include <iostream>
#include <map>
#include <new>

#include "agents.hpp"

namespace {
long live = 0;

void* taken(std::size_t size, std::size_t alignment) {
  void* memory = alignment > alignof(std::max_align_t)
                     ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                     : std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  live += static_cast<long>(malloc_usable_size(memory));
  return memory;
}
[[gnu::noinline]] void given_back(void* memory) noexcept {
  if (memory != nullptr) live -= static_cast<long>(malloc_usable_size(memory));
  std::free(memory);
}
}  // namespace

void* operator new(std::size_t size) { return taken(size, 0); }
void* operator new(std::size_t size, std::align_val_t a) { return taken(size, static_cast<std::size_t>(a)); }
void operator delete(void* p) noexcept { given_back(p); }
void operator delete(void* p, std::size_t) noexcept { given_back(p); }
void operator delete(void* p, std::align_val_t) noexcept { given_back(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { given_back(p); }

using namespace garrison;

namespace {

constexpr int kAgents = 30;
constexpr int kOne = 15;  // the agent that is looked at: in the middle

struct Setting {
  ParamMap params;
  long most;  // bytes of state and message
};

Model plant() {
  Matrix A = 0.98 * Matrix::Identity(4, 4);
  A(0, 1) = A(2, 3) = 0.1;
  std::vector<Matrix> C;
  for (int i = 0; i < kAgents; ++i) C.push_back(Matrix::Identity(4, 4).row(i % 4));
  Noise noise;
  noise.process_bound = 0.05;
  noise.measurement_bound = Vector::Constant(kAgents, 0.1);
  noise.process_covariance = 1e-3 * Matrix::Identity(4, 4);
  noise.measurement_covariance.assign(kAgents, 0.01 * Matrix::Identity(1, 1));
  return {A, C, noise};
}

const std::map<std::string, Setting, std::less<>> settings{
    {"saturation",
     {{{"threshold", 1.0},
       {"rounds", std::int64_t{6}},
       {"attacked", std::int64_t{1}},
       {"initial_error", 2.0},
       {"detector", true}},
      264}},
    {"rdkf", {{{"weight", 2.0}}, 1400}},
    {"partial_sharing", {{{"gain", 0.03}, {"shared", std::int64_t{2}}}, 2600}},
    {"structural", {{}, 1600}},
    {"platoon",
     {{{"attacked", std::int64_t{1}},
       {"process_noise", 0.05},
       {"measurement_noise", 0.1},
       {"initial_error", 2.0},
       {"gs", 0.5},
       {"gv", 1.0},
       {"reference", std::vector<double>{0.0, 10.0}}},
      1500}},
};

/// State and message of one agent, with their heap, in bytes.
template <class F>
long state_and_message(const Prepared& prepared) {
  constexpr int n = states_of<F>();
  typename F::Gains gains;
  if (wire::from_bytes(prepared.gains_bytes(), INT32_MAX, gains) != Refusal::none) std::abort();
  const Matrix A = prepared.model().A();
  const Matrix rows = prepared.model().C(kOne).transpose();  // row by row
  const auto degree = static_cast<int>(prepared.network().neighbours(kOne).size());
  const Local local{kOne, kAgents, n, static_cast<int>(rows.cols()), degree, A.data(), rows.data()};
  const Vec<n> x = Vec<n>::Zero(n);
  const long before = live;
  typename F::template State<n> state;
  typename F::template Message<n> message;
  F::template init<n>(local, gains, x, state, message);
  return live - before + static_cast<long>(sizeof state + sizeof message);
}

/// The agent of a node, all of it, in bytes.
template <class F>
long whole_agent(const Prepared& prepared) {
  const auto part = write_part(prepared, kOne);
  Refusal why{};
  const long before = live;
  const auto agent = agent_of_part<F, states_of<F>()>(part, why);
  if (agent == nullptr) std::abort();
  return live - before;
}

}  // namespace

int main() {
  bool fits = true;
  Families::each([&]<class F>() {
    const auto found = settings.find(F::name);
    if (found == settings.end()) return;  // baselines
    const bool vehicles = states_of<F>() == 2;
    const Model model = vehicles ? platoon::model(kAgents, 0.1) : plant();
    const Network network = Network::band(kAgents, vehicles ? 3 : 2);
    const auto prepared = make_filter(found->first, found->second.params)->prepare(model, network);
    const long state = state_and_message<F>(*prepared);
    std::cout << "memory: " << F::name << ": state and message " << state << " bytes (at most "
              << found->second.most << "), the whole agent " << whole_agent<F>(*prepared) << '\n';
    fits &= state <= found->second.most;
  });
  return fits ? 0 : 1;
}
