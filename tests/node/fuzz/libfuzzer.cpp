// SPDX-License-Identifier: Apache-2.0
// The entries of libFuzzer; $GARRISON_TARGET names the parser, $GARRISON_SEEDS a folder that genuine inputs
// are put in. Built by tools/fuzz.sh.
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "fuzz/targets.hpp"
#include "garrison/node/crypto.hpp"

namespace {

using namespace garrison::node;

std::unique_ptr<test::Target> chosen;

void write_seeds(const std::string& folder) {
  for (std::size_t k = 0; k < chosen->seeds.size(); ++k)
    std::ofstream(folder + "/genuine-" + std::to_string(k), std::ios::binary) << chosen->seeds[k];
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* const name = std::getenv("GARRISON_TARGET");
  if (start_crypto()) chosen = test::target_of(name != nullptr ? name : "");
  if (chosen == nullptr) std::fputs("GARRISON_TARGET names no target\n", stderr), std::exit(2);
  if (const char* const folder = std::getenv("GARRISON_SEEDS")) write_seeds(folder);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  chosen->parse({reinterpret_cast<const char*>(data), size});
  return 0;
}
