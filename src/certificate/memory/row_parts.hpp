// SPDX-License-Identifier: Apache-2.0
// Rows that have no state in common, not even by way of others, say nothing of each other: part by part,
// ranks and projectors of large sparse systems are those of small ones.
#pragma once

#include <map>
#include <numeric>
#include <vector>

#include "garrison/core/types.hpp"

namespace garrison::certificate::detail {

struct RowPart {
  std::vector<Eigen::Index> rows, columns;  ///< ascending; one column alone where no row has an entry there
};

/// In the order of their first columns. Rows of zeros are in none.
inline std::vector<RowPart> row_parts(const MatrixRef& H) {
  std::vector<Eigen::Index> parent(static_cast<std::size_t>(H.cols()));
  std::iota(parent.begin(), parent.end(), Eigen::Index{0});
  const auto root = [&](Eigen::Index k) {
    while (parent[static_cast<std::size_t>(k)] != k) {
      auto& up = parent[static_cast<std::size_t>(k)];
      up = parent[static_cast<std::size_t>(up)];
      k = up;
    }
    return k;
  };
  std::vector<Eigen::Index> first(static_cast<std::size_t>(H.rows()),
                                  -1);  // column with an entry, of each row
  for (Eigen::Index k = 0; k < H.cols(); ++k)
    for (Eigen::Index r = 0; r < H.rows(); ++r) {
      if (H(r, k) == 0.0) continue;
      auto& before = first[static_cast<std::size_t>(r)];
      if (before < 0)
        before = k;
      else
        parent[static_cast<std::size_t>(root(k))] = root(before);
    }
  std::map<Eigen::Index, std::size_t> number;
  std::vector<RowPart> parts;
  for (Eigen::Index k = 0; k < H.cols(); ++k) {
    const auto [place, added] = number.emplace(root(k), parts.size());
    if (added) parts.emplace_back();
    parts[place->second].columns.push_back(k);
  }
  for (Eigen::Index r = 0; r < H.rows(); ++r)
    if (const Eigen::Index k = first[static_cast<std::size_t>(r)]; k >= 0)
      parts[number.at(root(k))].rows.push_back(r);
  return parts;
}

}  // namespace garrison::certificate::detail
