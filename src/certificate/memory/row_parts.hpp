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

/// In the order of their first columns. Rows of zeros are in none. each_entry(f) calls f(row, column) for all
/// entries that are not 0.
template <class EachEntry>
std::vector<RowPart> row_parts(Eigen::Index rows, Eigen::Index columns, const EachEntry& each_entry) {
  std::vector<Eigen::Index> parent(static_cast<std::size_t>(columns));
  std::iota(parent.begin(), parent.end(), Eigen::Index{0});
  const auto root = [&](Eigen::Index k) {
    while (parent[static_cast<std::size_t>(k)] != k) {
      auto& up = parent[static_cast<std::size_t>(k)];
      up = parent[static_cast<std::size_t>(up)];
      k = up;
    }
    return k;
  };
  // A column with an entry, of each row.
  std::vector<Eigen::Index> first(static_cast<std::size_t>(rows), -1);
  each_entry([&](Eigen::Index r, Eigen::Index k) {
    auto& before = first[static_cast<std::size_t>(r)];
    if (before < 0)
      before = k;
    else
      parent[static_cast<std::size_t>(root(k))] = root(before);
  });
  std::map<Eigen::Index, std::size_t> number;
  std::vector<RowPart> parts;
  for (Eigen::Index k = 0; k < columns; ++k) {
    const auto [place, added] = number.emplace(root(k), parts.size());
    if (added) parts.emplace_back();
    parts[place->second].columns.push_back(k);
  }
  for (Eigen::Index r = 0; r < rows; ++r)
    if (const Eigen::Index k = first[static_cast<std::size_t>(r)]; k >= 0)
      parts[number.at(root(k))].rows.push_back(r);
  return parts;
}

inline std::vector<RowPart> row_parts(const MatrixRef& H) {
  return row_parts(H.rows(), H.cols(), [&](const auto& entry) {
    for (Eigen::Index k = 0; k < H.cols(); ++k)
      for (Eigen::Index r = 0; r < H.rows(); ++r)
        if (H(r, k) != 0.0) entry(r, k);
  });
}

}  // namespace garrison::certificate::detail
