/* SPDX-License-Identifier: BSD-3-Clause */
#include "xacro.h"

#include <algorithm>

#include <curve_proximity/core.hpp>

namespace curve_proximity {
namespace {

using tinyxml2::XMLAttribute;
using tinyxml2::XMLElement;

/* The prefixes of xacro's elements in this document. */
Words prefixesOfXacro(const XMLElement &root) {
  const std::string space = "xmlns:", xacro = "xacro";
  Words out = {"xacro:"};
  for (const XMLAttribute *a = root.FirstAttribute(); a; a = a->Next()) {
    const std::string name = a->Name(), uri = a->Value();
    const bool is_xacro =
        uri.size() >= xacro.size() && uri.compare(uri.size() - xacro.size(), xacro.size(), xacro) == 0;
    if (name.rfind(space, 0) == 0 && is_xacro) out.push_back(name.substr(space.size()) + ":");
  }
  return out;
}

[[noreturn]] void failXacro(const XMLElement &element, const std::string &what) {
  throw Error("line " + std::to_string(element.GetLineNum()) + ": " + what +
              ": this is xacro: expand it first (xacro FILE > robot.urdf)");
}

/* in_use: a substitution would stand for something that is read. */
void refuseXacro(const XMLElement &element, const Words &prefixes, bool in_use) {
  const auto begins = [&](const std::string &name) {
    return std::any_of(prefixes.begin(), prefixes.end(),
                       [&](const std::string &prefix) { return name.rfind(prefix, 0) == 0; });
  };
  if (begins(element.Name())) failXacro(element, "<" + std::string(element.Name()) + ">");
  for (const XMLAttribute *a = element.FirstAttribute(); a; a = a->Next()) {
    const std::string name = a->Name(), value = a->Value();
    const bool substitutes = value.find("${") != std::string::npos || value.find("$(") != std::string::npos;
    if (begins(name) || (in_use && substitutes)) failXacro(element, name + "=\"" + value + "\"");
  }
  for (const XMLElement *child = element.FirstChildElement(); child; child = child->NextSiblingElement())
    refuseXacro(*child, prefixes, in_use);
}

} // namespace

bool isAmong(const std::string &name, const Words &names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void refuseXacro(const XMLElement &root, const std::vector<std::string> &in_use) {
  static const Words of_old = {"macro", "include", "property", "if", "unless", "insert_block"}; /* without a prefix */
  const Words prefixes = prefixesOfXacro(root);
  for (const XMLAttribute *a = root.FirstAttribute(); a; a = a->Next())
    if (std::string(a->Value()).find("${") != std::string::npos)
      failXacro(root, std::string(a->Name()) + "=\"" + a->Value() + "\"");
  for (const XMLElement *child = root.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const std::string name = child->Name();
    if (isAmong(name, of_old)) failXacro(*child, "<" + name + ">");
    refuseXacro(*child, prefixes, isAmong(name, in_use));
  }
}

} // namespace curve_proximity
