/* SPDX-License-Identifier: BSD-3-Clause */
/** Standard error: messages, and a progress line beneath them where a person is looking. */
#ifndef CURVE_PROXIMITY_CLI_CONSOLE_H
#define CURVE_PROXIMITY_CLI_CONSOLE_H

#include <mutex>
#include <string>

#include "../scene/yaml/yaml_value.h"
#include "exit_code.h"

namespace curve_proximity::cli {

/** Any number of threads may speak at once: lines stay whole. */
class Console {
 public:
  Console();
  ~Console();
  Console(const Console &) = delete;
  Console &operator=(const Console &) = delete;

  /** A line that stays; nothing where the console is quiet. */
  void say(const std::string &message);

  /** The same, also where the console is quiet. */
  void print(const std::string &message);

  /** From now on only errors are said. */
  void beQuiet() {
    is_quiet_ = true;
  }

  /** "warning: …", a line each. */
  void warn(const Warnings &warnings);

  /** Replaces the progress line; nothing where standard error is no terminal. */
  void progress(const std::string &line);

 private:
  void wipe();

  std::mutex mutex_;
  const bool is_terminal_;
  bool shows_progress_ = false, is_quiet_ = false;
};

} // namespace curve_proximity::cli
#endif
