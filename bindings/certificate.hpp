// SPDX-License-Identifier: Apache-2.0
// What the files of the certificates' bindings share.
#pragma once

#include "bindings.hpp"

/// Certificates with memory, in the module of the certificates.
void bind_certificate_memory(py::module_& c);
