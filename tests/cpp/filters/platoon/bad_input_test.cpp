// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "random_platoon.hpp"

using namespace garrison;

namespace {

ParamMap good() {
  return {{"threshold", 200.0},
          {"attacked", std::int64_t{2}},
          {"process_noise", 0.1},
          {"measurement_noise", 0.1},
          {"initial_error", 300.0},
          {"reference", std::vector<double>{200.0, 10.0}},
          {"gs", 50.0},
          {"gv", 50.0}};
}

std::string refusal(const ParamMap& params, const Model& model, const Network& network) {
  try {
    make_filter("platoon", params)->prepare(model, network);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

std::string refusal(const std::string& name, const ParamValue& value) {
  ParamMap params = good();
  params[name] = value;
  return refusal(params, platoon::model(5, 0.01), Network::band(5, 2));
}

bool has(const std::string& message, const std::string& part) {
  return message.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("settings that Assumptions 1, 2, 4 or (13) exclude are refused with the number") {
  CHECK(refusal("attacked", std::int64_t{2}).empty());
  CHECK(has(refusal("attacked", std::int64_t{3}), "b = 3"));
  CHECK(has(refusal("attacked", std::int64_t{0}), "at least 1"));
  CHECK(has(refusal("process_noise", -0.1), "-0.1"));
  CHECK(has(refusal("measurement_noise", -0.1), "-0.1"));
  CHECK(has(refusal("measurement_noise", kNaN), "measurement_noise"));
  CHECK(has(refusal("initial_error", 0.0), "initial_error"));
  CHECK(has(refusal("threshold", -3.0), "-3"));
  CHECK(has(refusal("varpi", 300.0), "(1, 200.5"));
  CHECK(has(refusal("varpi", 1.0), "varpi"));
  CHECK(has(refusal("gv", 60.0), "Assumption 4"));
  CHECK(has(refusal("gs", -1.0), "gs"));
  CHECK(has(refusal("reference", std::vector<double>{1.0}), "reference"));
  CHECK(has(refusal("reference", std::vector<double>{1.0, kNaN}), "reference"));
  CHECK(has(refusal("prior_free", std::vector<double>{0.0, 5.0}), "0..4"));
  CHECK(has(refusal("prior_free", std::vector<double>{0.0}), "pairs"));
  ParamMap both = good();
  both["prior_free"] = std::vector<double>{0.0, 1.0};
  both["prior_attacked"] = std::vector<double>{3.0, 1.0};
  CHECK(has(refusal(both, platoon::model(5, 0.01), Network::band(5, 2)), "intersect"));
  ParamMap many = good();
  many["prior_attacked"] = std::vector<double>{0.0, 1.0, 1.0, 2.0, 2.0, 3.0};
  CHECK(has(refusal(many, platoon::model(5, 0.01), Network::band(5, 2)), "3 sensors"));
}

TEST_CASE("models and networks of another kind are refused") {
  CHECK(has(refusal(good(), platoon::model(5, 0.01), Network::band(5, 3)), "V_1 is empty"));
  CHECK(has(refusal(good(), platoon::model(5, 0.01), Network::ring(5)), "vehicle"));
  CHECK(has(refusal(good(), Model(Matrix::Identity(2, 2), std::vector<Matrix>(5, Matrix::Identity(2, 2))),
                    Network::band(5, 2)),
            "(1 T; 0 1)"));
  CHECK(has(refusal(good(), Model(Matrix::Identity(3, 3), std::vector<Matrix>(5, Matrix::Identity(2, 3))),
                    Network::band(5, 2)),
            "states"));
  CHECK_THROWS_AS(platoon::model(2, 0.01), InvalidInput);
  CHECK_THROWS_AS(platoon::model(5, 0.0), InvalidInput);
}

TEST_CASE("a start further from the truth than promised is refused; so are bad disturbances") {
  const Model model = platoon::model(5, 0.01);
  const Network network = Network::band(5, 2);
  const auto filter = make_filter("platoon", good());
  RunOptions o;
  o.start = Matrix::Constant(2, 1, 1000.0);
  CHECK_THROWS_WITH_AS(simulate(model, network, *filter, {3, {}, 0.0, "uniform", {}}, o),
                       doctest::Contains("initial_error"), InvalidInput);
  o.start = {};
  CHECK_THROWS_AS(simulate(model, network, *filter, {3, {}, 0.0, "normal", {}}, o), InvalidInput);
  CHECK_THROWS_AS(simulate(model, network, *filter, {3, {}, 0.0, "auto", Matrix::Zero(4, 3)}, o),
                  InvalidInput);
  CHECK_THROWS_AS(simulate(model, network, *filter, {3, {}, 0.0, "auto", Matrix::Zero(3, 35)}, o),
                  InvalidInput);
  CHECK(simulate(model, network, *filter, {3, {}, 0.0, "auto", Matrix::Zero(4, 35)}, o).steps == 3);
}
