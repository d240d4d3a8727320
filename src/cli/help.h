/* SPDX-License-Identifier: BSD-3-Clause */
/** What --help prints, and what a shell completes. */
#ifndef CURVE_PROXIMITY_CLI_HELP_H
#define CURVE_PROXIMITY_CLI_HELP_H

#include <string>

namespace curve_proximity::cli {

/** Of one command: its forms, examples and options. Of none (""): all commands, options, columns and exit codes. */
std::string helpText(const std::string &command);

/** For `source <(cprox completion SHELL)`, bash or zsh: commands, the options of each, and files. */
std::string completion(const std::string &shell);

/** All of it as a page for man. */
std::string manualPage();

} // namespace curve_proximity::cli
#endif
