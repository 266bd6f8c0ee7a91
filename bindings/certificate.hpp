// SPDX-License-Identifier: Apache-2.0
// What the files of the certificates' bindings share.
#pragma once

#include "bindings.hpp"

// All into the module of the certificates.
void bind_certificate_relays(py::module_& c);
void bind_certificate_memory(py::module_& c);
void bind_certificate_bank(py::module_& c);
void bind_certificate_meters(py::module_& c);
