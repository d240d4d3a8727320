/* SPDX-License-Identifier: BSD-3-Clause */
#include "console.h"

#include <unistd.h>

#include <cstdio>

namespace curve_proximity::cli {

Console::Console() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

Console::~Console() {
  wipe();
}

void Console::wipe() {
  if (shows_progress_) std::fputs("\r\033[K", stderr);
  shows_progress_ = false;
}

void Console::say(const std::string &message) {
  if (!is_quiet_) print(message);
}

void Console::print(const std::string &message) {
  /* names out of files may hold anything: it stays one line, and nothing that a terminal would obey */
  std::string line = message;
  for (char &c : line) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) c = ' ';
  }

  const std::lock_guard<std::mutex> lock(mutex_);
  wipe();
  std::fprintf(stderr, "%s\n", line.c_str());
}

void Console::warn(const Warnings &warnings) {
  for (const std::string &message : warnings.messages()) say("warning: " + message);
}

void Console::progress(const std::string &line) {
  if (!is_terminal_ || is_quiet_) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  wipe();
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
  shows_progress_ = true;
}

} // namespace curve_proximity::cli
