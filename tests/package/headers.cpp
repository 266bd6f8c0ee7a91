// SPDX-License-Identifier: Apache-2.0
// garrison::headers alone: nothing to link against.
#include <garrison/core/filter.hpp>

int main() {
  const garrison::Report report;
  return report.verdict == garrison::Verdict::not_tested ? 0 : 1;
}
