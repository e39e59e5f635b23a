// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/progress.h"

#include <unistd.h>

#include <cstdio>

namespace smoothfem {

namespace {

constexpr double seconds_between_bars = 0.1;
constexpr double seconds_between_lines = 15.0;

}  // namespace

std::string duration_text(double seconds) {
  char text[32];
  if (seconds < 60.0)
    std::snprintf(text, sizeof(text), "%.1f s", seconds);
  else
    std::snprintf(text, sizeof(text), "%d min %02d s", static_cast<int>(seconds) / 60,
                  static_cast<int>(seconds) % 60);
  return text;
}

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  clear_line();
}

double Progress::seconds() const {
  return std::chrono::duration<double>(Clock::now() - started_).count();
}

void Progress::clear_line() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void Progress::begin(const std::string& phase, std::size_t n_steps) {
  phase_ = phase;
  n_steps_ = n_steps;
  started_ = last_shown_ = Clock::now();
  if (!terminal_) say(phase);
}

void Progress::update(std::size_t done, const std::string& what,
                      std::optional<double> seconds_left) {
  if (quiet_ || n_steps_ == 0) return;
  const auto now = Clock::now();
  const double since = std::chrono::duration<double>(now - last_shown_).count();
  if (since < (terminal_ ? seconds_between_bars : seconds_between_lines)) return;
  last_shown_ = now;
  const double fraction = seconds_left ? seconds() / (seconds() + *seconds_left)
                                       : static_cast<double>(done) / static_cast<double>(n_steps_);
  const int percent = static_cast<int>(100.0 * fraction);
  const std::string left = seconds_left ? ", about " + duration_text(*seconds_left) + " left" : "";
  if (!terminal_) {
    std::fprintf(stderr, "  %3d %%%s (%s)\n", percent, left.c_str(), what.c_str());
    return;
  }
  constexpr int width = 30;
  const int filled = static_cast<int>(fraction * width);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(width - filled), '.');
  std::fprintf(stderr, "\r\033[K%s [%s] %3d %%%s  %s", phase_.c_str(), bar.c_str(), percent,
               left.c_str(), what.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::end() {
  say((terminal_ ? phase_ + ": " : std::string("  done in ")) + duration_text(seconds()));
  n_steps_ = 0;
}

void Progress::say(const std::string& text) {
  if (quiet_ || text.empty()) return;
  clear_line();
  std::fprintf(stderr, "%s\n", text.c_str());
}

}  // namespace smoothfem
