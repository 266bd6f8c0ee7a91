// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/recovery.hpp"

namespace garrison::certificate {

Recovery::Recovery(const Kernels& kernels, int s) {
  const TableOptions homogeneous{s, 1.0, kernels.window(), {}, false};
  Table t = table(kernels, homogeneous, 0.0, Vector::Zero(kernels.system.agents()));
  rb_ = std::move(t.d);
  re_ = std::move(t.eta);
  rmax_ = rb_.rowwise().maxCoeff();
}

}  // namespace garrison::certificate
