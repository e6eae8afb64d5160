// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Problems and certificates of linear programs as Python values.

#include "arguments.h"
#include "exactvo/vo/lp/certificate.h"

namespace exactvo::python {

/// -1 - k in arrays of bindings: nothing, then the parts of the speed bound in the order of lp::BindingKind.
inline constexpr std::int32_t kNoBinding = -1;
std::int32_t as_number(const lp::Binding& binding);
/// The binding; an index of kNoBinding or out of range becomes one that `check` calls malformed.
lp::Binding binding_of(std::int64_t number);

py::tuple as_tuple(const lp::Certificate& certificate);
lp::Certificate certificate_of(py::handle fields);

}  // namespace exactvo::python
