// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// For programs: loading a module (module.h) that is not one of this component's own.

#include <string>

namespace exactvo::datasets {

/// The library of exactvo_NAME.so beside the program, loaded now and never unloaded. `purpose` is for the words of an
/// error: throws DataError where there is none, or one of another build.
const void* load_module(const std::string& name, const std::string& purpose);

}  // namespace exactvo::datasets
