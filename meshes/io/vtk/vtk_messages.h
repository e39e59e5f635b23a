// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace smoothfem {

/// Keeps VTK from printing errors and warnings for the length of a scope. They name VTK's source
/// files and addresses, which do not help users.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  bool any() const;

 private:
  vtkSmartPointer<vtkOutputWindow> collector_, former_;
};

}  // namespace smoothfem
