/* SPDX-License-Identifier: BSD-3-Clause */
#include "check.h"

#include <tinyxml2.h>

#include "text.h"

namespace curve_proximity::mesh_reader {
namespace {

using tinyxml2::XMLElement;

/* Arrays of numbers whose length is not what they say. */
std::string noteOnArrays(const XMLElement &element) {
  for (const XMLElement *e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string inside = noteOnArrays(*e);
    if (!inside.empty()) return inside;
    if (std::string_view(e->Name()) != "float_array" || !e->Attribute("count")) continue;
    Words words(e->GetText() ? e->GetText() : "");
    std::uint64_t there = 0;
    while (!words.next().empty()) ++there;
    const std::optional<std::int64_t> promised = parseInteger(e->Attribute("count"));
    if (promised && *promised == static_cast<std::int64_t>(there)) continue;
    return "line " + std::to_string(e->GetLineNum()) + ": a float_array promises " + in_quotes(e->Attribute("count")) +
           " numbers and has " + std::to_string(there);
  }
  return "";
}

} // namespace

std::string extensionOf(const std::string &file) {
  const std::size_t point = file.find_last_of('.');
  if (point == std::string::npos) return "";
  std::string out = file.substr(point + 1);
  for (char &c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out.find("stl") != std::string::npos ? "stl" : out;
}

Triangles checkFile(const std::string &extension, std::string_view bytes) {
  if (extension == "stl") return checkStl(bytes);
  if (extension == "ply") return checkPly(bytes);
  if (extension == "obj") return checkObj(bytes);
  return std::nullopt;
}

std::string noteOn(const std::string &extension, std::string_view bytes) {
  constexpr std::size_t LARGEST = std::size_t{64} << 20;
  if (extension != "dae" || bytes.size() > LARGEST) return "";
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS) {
    return "its XML is wrong in line " + std::to_string(document.ErrorLineNum());
  }
  const XMLElement *root = document.RootElement();
  return root ? noteOnArrays(*root) : "its XML has no element";
}

} // namespace curve_proximity::mesh_reader
