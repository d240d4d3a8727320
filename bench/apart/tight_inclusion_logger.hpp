/* SPDX-License-Identifier: BSD-3-Clause */
/* A logger that writes nothing, where Tight-Inclusion's own would need spdlog. */
#pragma once
namespace ticcd {
struct silent {
  template <typename... arguments>
  void trace(arguments &&...) {}
  template <typename... arguments>
  void debug(arguments &&...) {}
  template <typename... arguments>
  void info(arguments &&...) {}
  template <typename... arguments>
  void warn(arguments &&...) {}
  template <typename... arguments>
  void error(arguments &&...) {}
  template <typename... arguments>
  void critical(arguments &&...) {}
};
inline silent &logger() {
  static silent one;
  return one;
}
} // namespace ticcd
