// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/memory.hpp"

#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace garrison::node {

namespace {

/// Code and constants are never written to (what the linker fills in lies in writable segments), so that
/// dropping a page of them loses nothing.
int drop_code_of(dl_phdr_info* object, std::size_t, void*) {
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  for (int k = 0; k < object->dlpi_phnum; ++k) {
    const auto& segment = object->dlpi_phdr[k];
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
    const std::uintptr_t from = (object->dlpi_addr + segment.p_vaddr) & ~(page - 1);
    const std::uintptr_t to = object->dlpi_addr + segment.p_vaddr + segment.p_memsz;
    ::madvise(reinterpret_cast<void*>(from), to - from, MADV_DONTNEED);
  }
  return 0;
}

}  // namespace

void settle_memory() noexcept {
  ::dl_iterate_phdr(drop_code_of, nullptr);
  ::mlockall(MCL_CURRENT | MCL_ONFAULT);
}

}  // namespace garrison::node
