// SPDX-License-Identifier: Apache-2.0
#include <garrison/core/error.hpp>
#include <iostream>

int main() { std::cout << "garrison says " << garrison::text(1.5) << '\n'; }
