// SPDX-License-Identifier: Apache-2.0
// Known inputs as a table of what they do alone.
#include "node/daemon/inputs.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "folder.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/response.hpp"
#include "refusals.hpp"

using namespace garrison;
using namespace garrison::node;
using namespace garrison::node::test;

namespace {

/// Two states, two outputs, one input.
AgentPart plant() {
  AgentPart part{0, 1, Matrix(2, 2), Matrix(2, 2), {}, 1, Matrix(2, 1)};
  part.A << 1.0, 0.1, 0.0, 0.9;
  part.C_transposed << 1.0, 0.3, 0.0, -0.7;
  part.B << 0.005, 0.1;
  return part;
}

std::string refused_table(const std::string& text, const AgentPart& part = plant()) {
  const Folder folder;
  std::ofstream(folder / "u.csv") << text;
  return refused([&] { const Inputs read(folder / "u.csv", part); });
}

}  // namespace

TEST_CASE("measurements without the response, and estimates with it, have the bits of a run in one process") {
  const AgentPart part = plant();
  const Folder folder;
  std::ofstream(folder / "u.csv") << "0.3\n-1.7\n2.5\n";
  const Inputs inputs(folder / "u.csv", part);
  CHECK(inputs.last() == 3);
  CHECK(inputs.numbers().size() == 3);
  const Matrix C = part.C_transposed.transpose();
  Response response(Model(part.A, {C}, {}, {}, {}, part.B));
  for (std::int64_t t = 0; t <= 3; ++t) {
    std::array y{1.1, -2.2}, x{0.1, 0.2};
    inputs.without(t, y);
    inputs.add(t, x);
    const Vector added = C * response.state();
    for (Eigen::Index k = 0; k < 2; ++k) {
      CHECK(y[static_cast<std::size_t>(k)] == (k == 0 ? 1.1 : -2.2) - added(k));
      CHECK(x[static_cast<std::size_t>(k)] == (k == 0 ? 0.1 : 0.2) + response.state()(k));
    }
    CHECK(inputs.before(t).size() == (t == 0 ? 0 : 1));
    if (t < 3) response.advance(Vector::Constant(1, inputs.before(t + 1)[0]));
  }
}

TEST_CASE("behind the last row nothing is known") {
  const AgentPart part = plant();
  const Folder folder;
  std::ofstream(folder / "u.csv") << "0.3\n";
  const Inputs inputs(folder / "u.csv", part);
  std::array y{1.0, 2.0}, x{1.0, 2.0};
  inputs.without(2, y);
  inputs.add(2, x);
  CHECK((std::isnan(y[0]) && std::isnan(y[1]) && std::isnan(x[0]) && std::isnan(x[1])));
  CHECK(inputs.before(2).empty());
}

TEST_CASE("without inputs nothing is changed, and nothing ends") {
  const Inputs none;
  std::array y{1.0};
  none.without(5, y);
  none.add(5, y);
  CHECK(y[0] == 1.0);
  CHECK(none.last() == INT64_MAX);
  CHECK(none.before(5).empty());
}

TEST_CASE("inputs that cannot be used are refused by line") {
  CHECK(says(refused_table("1\nnan\n"), {"u.csv, line 2", "\"nan\"", "1 number", "known at all times"}));
  CHECK(says(refused_table("1\n1,2\n"), {"u.csv, line 2", "\"1,2\""}));
  CHECK(says(refused_table("@3 1\n"), {"u.csv, line 1", "\"@3 1\""}));
  CHECK(says(refused_table(""), {"u.csv", "no row"}));
  AgentPart wild = plant();
  wild.A(0, 0) = 1e100;
  CHECK(says(refused_table("1\n1\n1\n", wild), {"u.csv, line 3", "a response beyond 1e150"}));
  std::string many;
  for (int k = 0; k < 2'100'000; ++k) many += "1\n";
  CHECK(says(refused_table(many), {"2100000 rows for 2 states, which take 34 MB", "at most 34 MB"}));
}
