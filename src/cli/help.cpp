/* SPDX-License-Identifier: BSD-3-Clause */
#include "help.h"

#include <algorithm>
#include <sstream>

#include "options.h"

namespace curve_proximity::cli {
namespace {

constexpr std::size_t WIDTH = 120, COLUMN = 20; /* of the page; where the texts of options begin */

constexpr const char *INPUTS = R"(INPUTS is one of
  --curves CURVES.csv --scene SCENE.yaml [--robot URDF [--srdf SRDF] [--state "joint: value, ..."]]
                    curves against the objects and the robot's links
  --curves A.csv --against B.csv
                    row i of A against row i of B, each anywhere on its curve
  --robot URDF [--srdf SRDF] --trajectory T.yaml [--scene SCENE.yaml] [--self]
                    the robot along a joint trajectory: a row of kind environment, one of kind self
  --scene SCENE.yaml --movers [--self]
                    what moves in the scene: objects with a trajectory, moving_robots
  --path PATH.yaml [--radius R | --body BODY.yaml] --scene SCENE.yaml
                    a point, a ball or a body along a nav_msgs/Path; the body turns as its poses say
)";

constexpr const char *RESULTS =
    "Results are CSV, or with --json a JSON object a row; metres and radians. On a terminal numbers have six digits, "
    "and "
    "bounds\nare rounded outwards; files and pipes have all digits. A row that fails has the status 'invalid', and its "
    "column message\nsays why.\n";

constexpr const char *EXIT_CODES = R"(Exit code of every command
  0                 everything is answered, and nothing of it is violated, undecided or unproven
  1                 a verdict is violated, or 'check' finds a certificate that does not prove its answer
  2                 a row has no answer, there is no row, or the command line or a file cannot be used
  3                 a verdict is undecided, an answer does not cover all that was given, or a second opinion disagrees
  130               interrupted
Of several, 2 comes before 1, and 1 before 3. Only 0 says that all is well, so that a shell can gate on it. Of 'certify' 0
says that its shards are whole, whatever their rows say: 'merge' tells.
)";

/* Words of two bytes and more count as one column. */
std::size_t columnsOf(const std::string &text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/* "  --name VALUE     text …", the text in a column of its own. */
void addEntry(const std::string &name, const std::string &text, std::string &out) {
  std::string line = "  " + name;
  line.append(columnsOf(line) < COLUMN ? COLUMN - columnsOf(line) : 2, ' ');
  std::size_t at = columnsOf(line);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (at + columnsOf(word) > WIDTH) {
      while (line.back() == ' ') line.pop_back();
      line += "\n" + std::string(COLUMN, ' ');
      at = COLUMN;
    }
    line += word + " ";
    at += columnsOf(word) + 1;
  }
  line.pop_back();
  out += line + "\n";
}

void addOption(const Option &option, std::string &out) {
  addEntry(option.name + (*option.value ? std::string(" ") + option.value : ""), option.help, out);
}

template <typename Use>
void eachLine(const char *text, const Use &use) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) use(line);
}

void addForms(const Command &command, std::string &out) {
  eachLine(command.usage,
           [&](const std::string &form) { out += "cprox " + std::string(command.word) + " " + form + "\n"; });
}

std::string pageOf(const Command &command) {
  std::string out;
  addForms(command, out);
  out += std::string("\n") + command.help + "\n\n";
  if (std::string(command.usage).find("INPUTS") != std::string::npos) out += std::string(INPUTS) + "\n";
  out += "Examples\n";
  eachLine(command.examples, [&](const std::string &line) { out += "  cprox " + line + "\n"; });
  if (*command.columns) out += "\nResults\n";
  if (*command.columns) addEntry("", command.columns, out);
  out += "\nOptions\n";
  for (const Option &option : options())
    if (takes(command, option)) addOption(option, out);
  return out + "\ncprox --help has all commands, and the exit codes.\n";
}

} // namespace

std::string helpText(const std::string &command) {
  if (const Command *one = findCommand(command)) return pageOf(*one);
  std::string out =
      "cprox: how close a continuous motion comes to the things around it, as intervals that contain the true value\n"
      "cprox COMMAND --help: one command, with examples\n\n";
  for (const Command &each : commands()) {
    addForms(each, out);
    out += "                    " + std::string(each.help) + "\n";
  }
  out +=
      "cprox completion SHELL\n                    for source <(cprox completion SHELL), bash or zsh: the shell "
      "completes "
      "commands and options\n\n";
  out += std::string(INPUTS) + "\n";
  for (const Option &option : options()) addOption(option, out);
  out += std::string("  --help, --version\n\n") + RESULTS;
  const char *before = "";
  for (const Command &each : commands()) {
    if (each.columns != before && *each.columns) addEntry(each.word, each.columns, out);
    before = each.columns;
  }
  return out + "\n" + EXIT_CODES;
}

namespace {

/* For troff: a hyphen is one, a backslash is none of its own, and no line begins with a request. */
std::string troff(const std::string &text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = i == 0 || text[i - 1] == '\n';
    if (begins && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (text[i] == '-')
      out += "\\-";
    else if (text[i] == '\\')
      out += "\\e";
    else
      out += text[i];
  }
  return out;
}

std::string asItIs(const std::string &text) {
  return ".nf\n" + troff(text) + ".fi\n";
}

} // namespace

std::string manualPage() {
  std::string out =
      ".TH CPROX 1 \"\" \"cprox " CPROX_VERSION
      "\" \"User Commands\"\n.SH NAME\ncprox \\- certified distances of continuous motions\n"
      ".SH SYNOPSIS\n.nf\ncprox COMMAND [OPTION ...]\ncprox [COMMAND] \\-\\-help\ncprox \\-\\-version\n.fi\n"
      ".SH DESCRIPTION\nHow close a continuous motion comes to the things around it, as intervals that contain the "
      "true "
      "value.\nNo ROS master is needed.\n.SH COMMANDS\n";
  for (const Command &command : commands()) {
    out += std::string(".SS ") + troff(command.word) + "\n" + troff(command.help) + ".\n.PP\n";
    std::string forms, examples;
    addForms(command, forms);
    eachLine(command.examples, [&](const std::string &line) { examples += "    cprox " + line + "\n"; });
    out += asItIs(forms) + ".PP\nExamples:\n" + asItIs(examples);
    if (*command.columns) out += ".PP\nColumns: " + troff(command.columns) + ".\n";
  }
  out += ".SH INPUTS\n" + asItIs(INPUTS) + ".SH OPTIONS\n";
  for (const Option &option : options()) {
    std::string words;
    for (const std::string &word : commandsOf(option)) words += (words.empty() ? "" : ", ") + word;
    out += ".TP\n.B " + troff(option.name) + (*option.value ? " " + std::string(option.value) : "") + "\n" +
           troff(option.help) + ".\nFor: " + troff(words) + ".\n";
  }
  return out + ".SH RESULTS\n" + troff(RESULTS) + ".SH EXIT STATUS\n" + asItIs(EXIT_CODES) +
         ".SH SEE ALSO\n.BR cprox_check (1)\n";
}

/* zsh runs the script of bash. */
std::string completion(const std::string &shell) {
  std::string words, cases;
  for (const Command &command : commands()) {
    words += std::string(command.word) + " ";
    cases += "    " + std::string(command.word) + ") words='--help";
    for (const Option &option : options())
      if (takes(command, option)) cases += std::string(" ") + option.name;
    cases += "' ;;\n";
  }
  const std::string before =
      shell == "zsh" ? "autoload -Uz compinit bashcompinit && compinit -i && bashcompinit\n" : "";
  return before +
         "_cprox() {\n"
         "  local words word=${COMP_WORDS[COMP_CWORD]}\n"
         "  case ${COMP_WORDS[1]} in\n" +
         cases + "    *) words='--help --version' ;;\n  esac\n  [ \"$COMP_CWORD\" -gt 1 ] || words='" + words +
         "completion --help --version'\n"
         "  COMPREPLY=()\n"
         "  [[ $COMP_CWORD -gt 1 && $word != -* ]] || COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "}\n"
         "complete -o default -F _cprox cprox\n";
}

} // namespace curve_proximity::cli
