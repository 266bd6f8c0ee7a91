// SPDX-License-Identifier: Apache-2.0
// What a pass of W2M works with, in the letters of docs/certificates.md, section 8. Internal.
#pragma once

#include <algorithm>
#include <vector>

#include "../top.hpp"
#include "garrison/certificate/memory/leverage_window.hpp"
#include "shape_frame.hpp"
#include "window_fit.hpp"

namespace garrison::certificate {

struct LeverageWindowWorkspace::Room {
  explicit Room(const Window& w);
  const WindowWitness& answer(const Window& w, const WindowAssumption& a);

  /// Rows that are attacked together: `count` of them from order[first] on; its group has a budget of its
  /// own.
  struct Block {
    int group, first, count;
  };
  enum class Verdict { nothing, dropped, contradiction };

  Eigen::Index n;
  detail::WindowFit fit;
  detail::ShapeFrame frame;
  Matrix V;                     // column r: G^-1/2 N_r'
  Matrix H;                     // G^-1/2 E'
  Matrix EV, FV, row;           // E G^-1/2 V, F V of an ellipsoid, and of one functional
  Vector residual, cross;       // per row
  Matrix gram, columns;         // room for eigenvalues
  Matrix P, Sigma, small;       // n x n
  Vector direction, box;        // room
  std::vector<char> kept, hit;  // per row
  std::vector<char> best_kept = std::vector<char>(kept.size());  // rows behind the reported region
  std::vector<char> is_honest;                                   // per source
  std::vector<int> order, offset;                                // rows sorted by block
  std::vector<Block> blocks;
  std::vector<int> dropped;                      // per group: proved sources
  std::vector<int> first;                        // per group: its first block
  std::vector<double> value, leverage, scratch;  // per block
  int count_blocks = 0, count_groups = 0;
  double lambda = 1.0;     // bound on ||Lam_SS||
  double residual2 = 0.0;  // TOP of ||res_b||^2
  double all_pull = 0.0;   // TOP of ||V_b res_b||
  double bias2 = 0.0;      // sum of the squared biases
  WindowWitness witness;

 private:
  const Block& block(int b) const { return blocks[static_cast<std::size_t>(b)]; }
  Eigen::Index at(const Block& b, int q) const { return order[static_cast<std::size_t>(b.first + q)]; }
  int left(int group, const WindowAssumption& a) const {
    return a.s - dropped[static_cast<std::size_t>(group)];
  }
  /// TOP: per group the sum of its `left` largest, over all groups.
  template <class Of>
  double top(const Of& of, const WindowAssumption& a) {
    double sum = 0.0;
    for (int g = 0; g < count_groups; ++g) {
      const int from = first[static_cast<std::size_t>(g)];
      const int to = first[static_cast<std::size_t>(g) + 1];
      const int take = left(g, a);
      if (take <= 0) continue;
      for (int b = from; b < to; ++b) value[static_cast<std::size_t>(b - from)] = of(b);
      sum += detail::top({value.data(), static_cast<std::size_t>(to - from)}, take);
    }
    return sum;
  }

  void begin(const Window& w, const WindowAssumption& a);
  void sort_blocks(const Window& w, const WindowAssumption& a);
  double norm2(const Matrix& M, Eigen::Index height, const Block& b);
  double pull(const Matrix& M, Eigen::Index height, const Block& b);
  bool fit_rows(const Window& w, const WindowAssumption& a);
  double by_rows(const Window& w, const WindowAssumption& a);
  void reach_of_bias(const Window& w, const WindowAssumption& a);
  double reach(const Window& w, const WindowAssumption& a, const Matrix& M, Eigen::Index height, double F2,
               double zq, bool shaped);
  bool enclose(const Window& w, const WindowAssumption& a);
  Verdict gate(const Window& w, const WindowAssumption& a);
};

}  // namespace garrison::certificate
