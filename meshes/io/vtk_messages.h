// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <string>

namespace smoothfem {

/// Collects VTK's errors and warnings for the length of a scope instead of printing them.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  /// The first message without VTK's frame of source file, line and address; empty if there is
  /// none.
  std::string first() const;

 private:
  vtkSmartPointer<vtkOutputWindow> collector_, former_;
};

}  // namespace smoothfem
