// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace smoothfem {

/// Starts the interpreter and loads the Python module, unless that has been done. Throws InputError
/// if there is none.
void require_python();

/// True if this program has started the interpreter, false if Python has loaded this library.
bool started_python();

}  // namespace smoothfem
