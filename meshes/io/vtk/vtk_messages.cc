// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtk_messages.h"

#include <vtkLogger.h>
#include <vtkObjectFactory.h>

namespace smoothfem {

namespace {

class Collector : public vtkOutputWindow {
 public:
  static Collector* New();
  vtkTypeMacro(Collector, vtkOutputWindow);

  void DisplayText(const char*) override { any_ = true; }
  void DisplayErrorText(const char*) override { any_ = true; }
  void DisplayWarningText(const char*) override { any_ = true; }
  void DisplayGenericWarningText(const char*) override { any_ = true; }
  void DisplayDebugText(const char*) override {}

  bool any() const { return any_; }

 private:
  bool any_ = false;
};

vtkStandardNewMacro(Collector);

}  // namespace

VtkMessages::VtkMessages()
    : collector_(vtkSmartPointer<Collector>::New()), former_(vtkOutputWindow::GetInstance()) {
  vtkOutputWindow::SetInstance(collector_);
  // Since version 9 VTK also has its own log.
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
}

VtkMessages::~VtkMessages() {
  vtkOutputWindow::SetInstance(former_);
}

bool VtkMessages::any() const {
  return static_cast<const Collector&>(*collector_).any();
}

}  // namespace smoothfem
