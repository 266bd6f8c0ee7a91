// SPDX-License-Identifier: Apache-2.0
// The only file that knows of METIS.
#include <numeric>

#include "mpi/owners.hpp"

#ifdef GARRISON_HAS_METIS
#include <metis.h>
#endif

namespace garrison::mpi {

#ifdef GARRISON_HAS_METIS
bool has_metis() { return true; }

std::vector<std::int32_t> metis_owners(const partition::Ground& ground, int ranks) {
  std::vector<int> all(static_cast<std::size_t>(ground.agents()));
  std::iota(all.begin(), all.end(), 0);
  const partition::Neighbours neighbours = ground.neighbours(all);
  std::vector<idx_t> offsets(neighbours.offsets.begin(), neighbours.offsets.end());
  std::vector<idx_t> lists(neighbours.lists.begin(), neighbours.lists.end());
  std::vector<idx_t> part(all.size(), -1);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_OBJTYPE] = METIS_OBJTYPE_VOL;
  options[METIS_OPTION_SEED] = 1;  // the same partition in every run
  idx_t vertices = ground.agents();
  idx_t constraints = 1;
  idx_t parts = ranks;
  idx_t volume = 0;
  const int code =
      METIS_PartGraphKway(&vertices, &constraints, offsets.data(), lists.data(), nullptr, nullptr, nullptr,
                          &parts, nullptr, nullptr, options, &volume, part.data());
  if (code != METIS_OK) return {};
  return {part.begin(), part.end()};
}
#else
bool has_metis() { return false; }
std::vector<std::int32_t> metis_owners(const partition::Ground&, int) { return {}; }
#endif

}  // namespace garrison::mpi
