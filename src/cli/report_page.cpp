/* SPDX-License-Identifier: BSD-3-Clause */
#include "report_page.h"

#include <fstream>
#include <sstream>
#include <utility>

#include <report_parts.h>
#include "exit_code.h"

namespace curve_proximity::cli {
namespace {

/* Debian's and Ubuntu's libjs-three. */
constexpr const char *kThree = "/usr/share/javascript/three/three.min.js";
constexpr const char *kOrbitControls = "/usr/share/javascript/three/examples/js/controls/OrbitControls.js";

std::string readScript(const std::string &path) {
  std::ifstream file(path);
  std::ostringstream text;
  if (!(file && text << file.rdbuf()))
    throw BadUsage("'report' needs three.js for its 3-D view: " + path + " is not there; install libjs-three");
  return text.str();
}

std::string replaced(std::string text, const std::string &from, const std::string &to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/* As text of HTML. */
std::string escapedHtml(const std::string &text) {
  return replaced(replaced(replaced(text, "&", "&amp;"), "<", "&lt;"), ">", "&gt;");
}

/* JSON in which no tag of HTML can begin. */
std::string withoutTags(const std::string &json) {
  return replaced(json, "<", "\\u003c");
}

} // namespace

std::string reportPage(const std::string &title, const std::string &data) {
  const std::pair<std::string, std::string> parts[] = {
      {"{{style}}", kReportStyle},     {"{{three}}", readScript(kThree)}, {"{{controls}}", readScript(kOrbitControls)},
      {"{{data}}", withoutTags(data)}, {"{{script}}", kReportScript},     {"{{title}}", escapedHtml(title)}};

  // Each place of the frame is filled once, and what fills it is not looked at again.
  std::string frame = kReportFrame, out;
  std::size_t begin = 0;
  while (begin < frame.size()) {
    const std::size_t open = frame.find("{{", begin);
    out += frame.substr(begin, open - begin);
    if (open == std::string::npos) break;
    const std::size_t close = frame.find("}}", open) + 2;
    for (const auto &[name, text] : parts) {
      if (frame.compare(open, close - open, name) == 0) out += text;
    }
    begin = close;
  }
  return out;
}

} // namespace curve_proximity::cli
