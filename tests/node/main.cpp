// SPDX-License-Identifier: Apache-2.0
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "garrison/node/crypto.hpp"

int main(int argc, char** argv) {
  if (!garrison::node::start_crypto()) return 1;
  return doctest::Context(argc, argv).run();
}
