// SPDX-License-Identifier: Apache-2.0
// The entry of libFuzzer; $GARRISON_TARGET names the parser. Built by tools/fuzz.sh.
#include <cstdio>
#include <cstdlib>

#include "fuzz/targets.hpp"
#include "garrison/node/crypto.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const auto target = [] {
    const char* name = std::getenv("GARRISON_TARGET");
    auto found = garrison::node::start_crypto() ? garrison::node::test::target_of(name != nullptr ? name : "")
                                                : nullptr;
    if (found == nullptr) std::fputs("GARRISON_TARGET names no target\n", stderr), std::exit(2);
    return found;
  }();
  target->parse({reinterpret_cast<const char*>(data), size});
  return 0;
}
