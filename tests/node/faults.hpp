// SPDX-License-Identifier: Apache-2.0
// What goes wrong in a simulated run: all of it is drawn from the seed.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "hostile.hpp"

namespace garrison::node::test {

/// What goes wrong in a run.
enum class Weather {
  all,     ///< anything
  cold,    ///< crashes with lost snapshots, a falsified sensor, loss
  clock,   ///< one clock is an hour wrong for a while
  liar,    ///< one node signs two things
  honest,  ///< anything but lies; everybody signs
};
std::optional<Weather> weather_of(std::string_view word);

/// Drawn from the seed.
struct Faults {
  double loss = 0, duplicates = 0, inject = 0, mutate = 0;
  Micros jitter = 0;
  int liar = -1;
  std::optional<int> attacked;
  std::vector<Micros> skew;
  struct Cut {
    Micros from, to;
    int sender, receiver;  ///< receiver -1: nothing reaches or leaves the sender
  };
  std::vector<Cut> cuts;
  struct Crash {
    Micros at, back;
    int node;
    bool lost;  ///< its snapshot
  };
  std::vector<Crash> crashes;
  struct Step {
    Micros at, by;
    int node;
  };
  std::vector<Step> steps;  ///< of a node's clock

  Faults(int agents, Seeded& random, Weather weather);
  bool none() const { return loss == 0 && cuts.empty() && crashes.empty() && steps.empty() && liar < 0; }

 private:
  void draw_anything(int agents, Seeded& random);
  void draw_crashes(int agents, Seeded& random);
  void draw_hour(int agents, Seeded& random);
};

}  // namespace garrison::node::test
