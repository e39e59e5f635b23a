// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk_messages.h"

#include <vtkLogger.h>
#include <vtkObjectFactory.h>

namespace smoothfem {

namespace {

class Collector : public vtkOutputWindow {
 public:
  static Collector* New();
  vtkTypeMacro(Collector, vtkOutputWindow);

  void DisplayText(const char* text) override { append(text); }
  void DisplayErrorText(const char* text) override { append(text); }
  void DisplayWarningText(const char* text) override { append(text); }
  void DisplayGenericWarningText(const char* text) override { append(text); }
  void DisplayDebugText(const char*) override {}

  const std::string& text() const { return text_; }

 private:
  void append(const char* text) {
    if (text_.empty() && text) text_ = text;
  }

  std::string text_;
};

vtkStandardNewMacro(Collector);

}  // namespace

VtkMessages::VtkMessages()
    : collector_(vtkSmartPointer<Collector>::New()), former_(vtkOutputWindow::GetInstance()) {
  vtkOutputWindow::SetInstance(collector_);
  // Since version 9 VTK also logs by itself.
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
}

VtkMessages::~VtkMessages() {
  vtkOutputWindow::SetInstance(former_);
}

std::string VtkMessages::first() const {
  // "ERROR: In vtkReader.cxx, line 12\nvtkReader (0x55d0): what happened\n\n"
  std::string text = static_cast<const Collector&>(*collector_).text();
  const std::size_t frame = text.find("): ");
  if (frame != std::string::npos) text = text.substr(frame + 3);
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

}  // namespace smoothfem
