// SPDX-License-Identifier: Apache-2.0
#include "bindings.hpp"
#include "garrison/version.hpp"
#include "guard.hpp"

PYBIND11_MODULE(_core, m) {
  m.doc() = "Compiled core of garrison. Use it through the garrison package.";
  m.attr("__version__") = GARRISON_VERSION;
  // Order: a class must be bound before a function that shows it in its signature.
  bind_core(m);
  bind_filters(m);
  bind_attacks(m);
  bind_messages(m);
  bind_agents(m);
  bind_designs(m);
  bind_drivers(m);
  bind_analysis(m);
  bind_fit(m);
  bind_autoregression(m);
  bind_known(m);
  bind_rdkf(m);
  bind_saturation(m);
  bind_structure(m);
  bind_structural(m);
  bind_partial_sharing(m);
  bind_platoon(m);
  bind_certificate(m);
  guard(m);  // in front of everything above
}
