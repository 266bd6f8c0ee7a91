// SPDX-License-Identifier: Apache-2.0
// Random geometric networks by counters: a point depends on its agent alone, so a rank needs no others but
// those near its own.
#include <algorithm>
#include <array>
#include <cmath>

#include "garrison/core/random.hpp"
#include "partition/ground.hpp"

namespace garrison::partition {
namespace {

using Point = std::array<double, 2>;

class Geometric final : public Ground {
 public:
  Geometric(int agents, double radius, std::uint64_t seed)
      : agents_(agents),
        radius_(radius),
        seed_(seed),
        random_(seed, 0, Purpose::position),
        side_(static_cast<int>(std::clamp(1.0 / radius, 1.0, 1.0 + std::sqrt(agents)))) {}
  int agents() const override { return agents_; }
  std::string description() const override {
    return "random_geometric " + std::to_string(agents_) + " " + text(radius_) + " " + std::to_string(seed_);
  }

  Neighbours neighbours(std::span<const int> ids) const override {
    const Near near = near_of(ids);
    Neighbours out;
    for (const int i : ids) {
      const std::size_t first = out.lists.size();
      const Point p = point(i);
      const auto [cx, cy] = cells_of(p);
      for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, side_ - 1); ++x)
        for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, side_ - 1); ++y)
          for (std::int32_t k = near.first[cell(x, y)]; k < near.first[cell(x, y) + 1]; ++k) {
            const auto at = static_cast<std::size_t>(k);
            const double dx = p[0] - near.points[at][0];
            const double dy = p[1] - near.points[at][1];
            if (near.ids[at] != i && dx * dx + dy * dy < radius_ * radius_) out.lists.push_back(near.ids[at]);
          }
      std::sort(out.lists.begin() + static_cast<std::ptrdiff_t>(first), out.lists.end());
      out.offsets.push_back(static_cast<std::int64_t>(out.lists.size()));
    }
    return out;
  }

  /// Strips of equally many agents.
  std::vector<std::int32_t> owners(int ranks) const override {
    std::vector<std::int64_t> in_column(static_cast<std::size_t>(side_), 0);
    std::vector<std::int32_t> column(static_cast<std::size_t>(agents_));
    for (int i = 0; i < agents_; ++i) {
      column[static_cast<std::size_t>(i)] = cells_of(point(i))[0];
      ++in_column[static_cast<std::size_t>(column[static_cast<std::size_t>(i)])];
    }
    std::vector<std::int32_t> of_column;
    std::int64_t before = 0;
    for (const std::int64_t count : in_column) {
      of_column.push_back(static_cast<std::int32_t>((before + count / 2) * ranks / agents_));
      before += count;
    }
    for (std::int32_t& one : column) one = of_column[static_cast<std::size_t>(one)];
    return column;
  }

 private:
  /// The agents in cells that matter, cell by cell.
  struct Near {
    std::vector<std::int32_t> first;
    std::vector<int> ids;
    std::vector<Point> points;
  };
  Near near_of(std::span<const int> ids) const {
    std::vector<char> wanted(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), 0);
    for (const int i : ids) {
      const auto [cx, cy] = cells_of(point(i));
      for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, side_ - 1); ++x)
        for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, side_ - 1); ++y) wanted[cell(x, y)] = 1;
    }
    Near near;
    near.first.assign(wanted.size() + 1, 0);
    const auto each = [&](const auto& action) {
      for (int i = 0; i < agents_; ++i) {
        const Point p = point(i);
        const auto [x, y] = cells_of(p);
        if (wanted[cell(x, y)] != 0) action(i, p, cell(x, y));
      }
    };
    each([&](int, const Point&, std::size_t at) { ++near.first[at + 1]; });
    for (std::size_t k = 1; k < near.first.size(); ++k) near.first[k] += near.first[k - 1];
    near.ids.resize(static_cast<std::size_t>(near.first.back()));
    near.points.resize(near.ids.size());
    std::vector<std::int32_t> next(near.first.begin(), near.first.end() - 1);
    each([&](int i, const Point& p, std::size_t at) {
      const auto k = static_cast<std::size_t>(next[at]++);
      near.ids[k] = i;
      near.points[k] = p;
    });
    return near;
  }

  Point point(int i) const {
    return {random_.uniform(0, static_cast<std::uint32_t>(i), 0),
            random_.uniform(0, static_cast<std::uint32_t>(i), 1)};
  }
  std::array<int, 2> cells_of(const Point& p) const {
    return {std::min(static_cast<int>(p[0] * side_), side_ - 1),
            std::min(static_cast<int>(p[1] * side_), side_ - 1)};
  }
  std::size_t cell(int x, int y) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(y);
  }

  int agents_;
  double radius_;
  std::uint64_t seed_;
  Random random_;
  int side_;
};

}  // namespace

std::unique_ptr<Ground> random_geometric(int agents, double radius, std::uint64_t seed) {
  if (agents < 1) refuse("agents", std::to_string(agents), "at least 1");
  if (!(radius > 0.0) || !std::isfinite(radius)) refuse("radius", text(radius), "a finite number > 0");
  return std::make_unique<Geometric>(agents, radius, seed);
}

}  // namespace garrison::partition
