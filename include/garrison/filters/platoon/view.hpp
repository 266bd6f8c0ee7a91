// SPDX-License-Identifier: Apache-2.0
// What one vehicle sees of those in its range: (7)-(11) by running sums over the links, O(L) for all.
#pragma once

#include <array>

#include "garrison/filters/platoon/partition.hpp"
#include "garrison/filters/platoon/vehicle.hpp"

namespace garrison::platoon {

/// One vehicle in range.
struct Seen {
  const VehicleMessage* message;  ///< null = lost, or the vehicle itself
  bool linked;                    ///< all relative measurements between us arrived
  bool measured;                  ///< linked, and its absolute measurement arrived
  double link[2];                 ///< S(i, j): y_{i|j} = y_jj + S(i, j)
  double y[2];                    ///< y_{i|j} of (7)
};

/// The window i-L..i+L; place p stands for vehicle i - L + p, place L for i itself.
/// Threads: one at a time.
class View {
 public:
  View(int id, int vehicles, int range, const VehicleState& s, const Inbox<VehicleMessage>& inbox) noexcept
      : id_(id), vehicles_(vehicles), range_(range) {
    for (int p = 0; p < size(); ++p) at(p) = {nullptr, false, false, {0.0, 0.0}, {0.0, 0.0}};
    for (std::size_t k = 0; k < inbox.size(); ++k) at(inbox.sender(k) - id + range).message = &inbox[k];
    Seen& own = at(range);
    own.linked = true;
    own.measured = s.has_y;
    for (int k = 0; k < 2; ++k) {
      own.link[k] = 0.0;
      own.y[k] = s.y[k];
    }
    for (int p = range - 1; p >= 0; --p)  // towards the leader: add y_{m-1,m} of the vehicle behind
      extend(at(p), at(p + 1), p + 1 == range ? s.has_link : has_link(at(p + 1)),
             p + 1 == range ? s.link : link_of(at(p + 1)), 1.0);
    for (int p = range + 1; p < size(); ++p)  // towards the tail: subtract its own
      extend(at(p), at(p - 1), has_link(at(p)), link_of(at(p)), -1.0);
  }

  int size() const noexcept { return 2 * range_ + 1; }
  int id_of(int place) const noexcept { return id_ - range_ + place; }
  bool exists(int place) const noexcept { return id_of(place) >= 0 && id_of(place) < vehicles_; }
  const Seen& operator[](int place) const noexcept { return seen_[static_cast<std::size_t>(place)]; }

 private:
  Seen& at(int place) noexcept { return seen_[static_cast<std::size_t>(place)]; }
  static bool has_link(const Seen& s) noexcept { return s.message != nullptr && s.message->has_link; }
  static const double* link_of(const Seen& s) noexcept {
    return s.message == nullptr ? nullptr : s.message->link();
  }
  static void extend(Seen& to, const Seen& from, bool measured, const double* link, double sign) noexcept {
    to.linked = from.linked && measured;
    if (!to.linked) return;
    for (int k = 0; k < 2; ++k) to.link[k] = from.link[k] + sign * link[k];
    to.measured = to.message != nullptr && to.message->has_y;
    if (!to.measured) return;
    for (int k = 0; k < 2; ++k) to.y[k] = to.message->y()[k] + to.link[k];
  }

  int id_;
  int vehicles_;
  int range_;
  std::array<Seen, 2 * kMostRange + 1> seen_;
};

/// Algorithm 2: moves s.sets to t.
void detect(const Local& local, const Shared& shared, const View& view, VehicleState& s) noexcept;
/// (12) and the error bounds: moves s.x and s.alpha to t.
void observe(const Local& local, const Shared& shared, const View& view, VehicleState& s) noexcept;
/// Algorithm 3 and the certified gap.
void control(const Local& local, const Shared& shared, const View& view, VehicleState& s) noexcept;

}  // namespace garrison::platoon
