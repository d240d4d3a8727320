/* SPDX-License-Identifier: BSD-3-Clause */
#include "parameters/parameters.h"

#include <ros/console.h>

#include <cmath>
#include <curve_proximity/query.hpp>
#include <set>
#include <sstream>

#include "../../scene/yaml/bad_input.h"
#include "../../scene/yaml/path_yaml.h"

namespace curve_proximity {
namespace {

/** Below this a process with a few threads does not even start. */
constexpr int LEAST_MEMORY_MB = 256;

[[noreturn]] void wrong(const std::string &name, const std::string &what) {
  throw ParameterError("parameter ~" + name + ": " + what);
}

/* ---- ~constraint_providers ---- */

using Xml = XmlRpc::XmlRpcValue;

bool isNumber(const Xml &value) {
  return value.getType() == Xml::TypeInt || value.getType() == Xml::TypeDouble;
}

double toNumber(Xml &value) {
  return value.getType() == Xml::TypeInt ? static_cast<int>(value) : static_cast<double>(value);
}

/** A parameter of a provider; throws Error for what a ParameterValue cannot hold. */
ParameterValue toParameterValue(Xml &value) {
  switch (value.getType()) {
    case Xml::TypeBoolean: return static_cast<bool>(value);
    case Xml::TypeInt: return static_cast<int>(value);
    case Xml::TypeDouble: return static_cast<double>(value);
    case Xml::TypeString: return static_cast<std::string>(value);
    case Xml::TypeArray: {
      std::vector<double> numbers;
      for (int i = 0; i < value.size(); ++i) {
        if (!isNumber(value[i])) throw Error("a list holds numbers alone");
        numbers.push_back(toNumber(value[i]));
      }
      return numbers;
    }
    default: throw Error("true or false, a number, a string or a list of numbers is expected");
  }
}

std::string toWord(Xml &entry, const char *key) {
  if (!entry.hasMember(key) || entry[key].getType() != Xml::TypeString)
    throw Error(std::string(key) + ": a string is expected");
  return static_cast<std::string>(entry[key]);
}

/** The type alone, or name, type and parameters. Throws Error. */
ProviderSpec toProviderSpec(Xml &entry) {
  if (entry.getType() == Xml::TypeString) {
    const std::string type = static_cast<std::string>(entry);
    return {type, type, {}};
  }
  if (entry.getType() != Xml::TypeStruct) throw Error("the name of a plugin is expected, or {name, type, parameters}");
  ProviderSpec spec;
  spec.type = toWord(entry, "type");
  spec.name = entry.hasMember("name") ? toWord(entry, "name") : spec.type;
  for (auto &member : entry) {
    const std::string &key = member.first;
    if (key == "name" || key == "type") continue;
    if (key != "parameters") throw Error(key + ": this is none of name, type, parameters");
    if (member.second.getType() != Xml::TypeStruct) throw Error("parameters: names and values are expected");
    for (auto &parameter : member.second) {
      try {
        spec.parameters[parameter.first] = toParameterValue(parameter.second);
      } catch (const Error &error) {
        throw Error("parameter " + parameter.first + ": " + error.what());
      }
    }
  }
  return spec;
}

/* ---- ~path_body ---- */

YAML::Node toYaml(Xml &value) {
  YAML::Node out;
  switch (value.getType()) {
    case Xml::TypeBoolean: out = static_cast<bool>(value); break;
    case Xml::TypeInt: out = static_cast<int>(value); break;
    case Xml::TypeDouble: out = static_cast<double>(value); break;
    case Xml::TypeString: out = static_cast<std::string>(value); break;
    case Xml::TypeArray:
      out = YAML::Node(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) out.push_back(toYaml(value[i]));
      break;
    case Xml::TypeStruct:
      out = YAML::Node(YAML::NodeType::Map);
      for (auto &member : value) out[member.first] = toYaml(member.second);
      break;
    default: break;
  }
  return out;
}

/** An object in the words of a scene file. Throws yaml::BadInput. */
ObjectDescription toBody(Xml &given, const std::string &where) {
  const yaml::YamlValue value(toYaml(given), where);
  yaml::Warnings warnings;
  ObjectDescription body = yaml::readRider(value, warnings);
  for (const std::string &warning : warnings.messages()) ROS_WARN("%s", warning.c_str());
  return body;
}

/** Fills one parameter after the other from the parameter server. */
class NodeParameters {
 public:
  explicit NodeParameters(const ros::NodeHandle &handle) : handle_(handle) {}

  void operator()(const char *name, std::string &value) {
    Xml given;
    if (!get(name, given, Xml::TypeString, "a string is expected")) return;
    value = static_cast<std::string>(given);
  }

  void operator()(const char *name, bool &value) {
    Xml given;
    if (!get(name, given, Xml::TypeBoolean, "true or false is expected")) return;
    value = static_cast<bool>(given);
  }

  void operator()(const char *name, int &value, const Range &range) {
    Xml given;
    if (!get(name, given, Xml::TypeInt, "a whole number is expected")) return;
    value = static_cast<int>(given);
    check(name, value, range);
  }

  void operator()(const char *name, double &value, const Range &range) {
    Xml given;
    if (!get(name, given)) return;
    if (!isNumber(given)) wrong(name, "a number is expected");
    value = toNumber(given);
    check(name, value, range);
  }

  void operator()(const char *name, std::vector<ProviderSpec> &value) {
    Xml given;
    if (!get(name, given, Xml::TypeArray, "a list is expected")) return;
    value.clear();
    for (int i = 0; i < given.size(); ++i) {
      try {
        value.push_back(toProviderSpec(given[i]));
      } catch (const Error &error) {
        wrong(name + ("[" + std::to_string(i) + "]"), error.what());
      }
    }
  }

  void operator()(const char *name, std::vector<std::string> &value) {
    Xml given;
    if (!get(name, given, Xml::TypeArray, "a list of names is expected")) return;
    value.clear();
    for (int i = 0; i < given.size(); ++i) {
      if (given[i].getType() != Xml::TypeString) wrong(name, "a list of names is expected");
      value.push_back(static_cast<std::string>(given[i]));
    }
  }

  void operator()(const char *name, std::map<std::string, std::string> &value) {
    Xml given;
    if (!get(name, given, Xml::TypeStruct, "names and the parameters that hold their URDFs are expected")) return;
    value.clear();
    for (auto &member : given) {
      if (member.second.getType() != Xml::TypeString)
        wrong(name, member.first + ": the name of the parameter that holds its URDF is expected");
      value[member.first] = static_cast<std::string>(member.second);
    }
  }

  void operator()(const char *name, ObjectDescription &value) {
    Xml given;
    if (!get(name, given, Xml::TypeStruct, "an object is expected: {id, primitives, ...}")) return;
    if (given.begin() == given.end()) return;
    try {
      value = toBody(given, "parameter ~" + std::string(name));
    } catch (const yaml::BadInput &error) {
      throw ParameterError(error.what());
    } catch (const Error &error) {
      wrong(name, error.what());
    }
  }

  /** A name that is ours, though nobody sets it. */
  void keep(const char *name) {
    known_.insert(name);
  }

  /** A misspelt name would otherwise leave a default in force that nobody asked for. */
  void warnOfOthers() const {
    std::vector<std::string> all;
    if (!handle_.getParamNames(all)) return;
    const std::string prefix = handle_.getNamespace() + "/";
    for (const std::string &name : all) {
      if (name.compare(0, prefix.size(), prefix) != 0) continue;
      const std::string whole = name.substr(prefix.size()), own = whole.substr(0, whole.find('/'));
      if (!known_.count(own)) ROS_WARN("parameter ~%s is none of this server's: it is not read", own.c_str());
    }
  }

 private:
  bool get(const char *name, Xml &given) {
    known_.insert(name);
    return handle_.getParam(name, given);
  }

  bool get(const char *name, Xml &given, Xml::Type type, const char *expected) {
    if (!get(name, given)) return false;
    if (given.getType() != type) wrong(name, expected);
    return true;
  }

  void check(const char *name, double value, const Range &range) const {
    if (range.holds(value)) return;
    std::ostringstream what;
    what << value << " is not " << (range.open ? "above " : "at least ") << range.least;
    if (std::isfinite(range.most)) what << " and at most " << range.most;
    if (!std::isfinite(value)) what << " and finite";
    wrong(name, what.str());
  }

  const ros::NodeHandle &handle_;
  std::set<std::string> known_;
};

} // namespace

Parameters readParameters(const ros::NodeHandle &handle) {
  Parameters parameters;
  NodeParameters reader(handle);
  visitParameters(parameters, reader);
  reader.keep(KEPT_BY_SERVER);
  reader.warnOfOthers();

  // What a type and a range cannot say.
  if (parameters.memory_limit_mb > 0 && parameters.memory_limit_mb < LEAST_MEMORY_MB)
    wrong("memory_limit_mb", "0 or at least " + std::to_string(LEAST_MEMORY_MB) + " is expected");
  if (parameters.query_type != "distance" && parameters.query_type != "tolerance" &&
      parameters.query_type != "collision")
    wrong("query_type", "distance, tolerance or collision is expected, not '" + parameters.query_type + "'");
  if (parameters.fixed_frame.empty()) wrong("fixed_frame", "the name of a frame is expected");
  if (!lodFromName(parameters.max_lod)) wrong("max_lod", "sphere, hull or mesh is expected");
  if (!parameters.second_opinion.empty() && !peerFromName(parameters.second_opinion))
    wrong("second_opinion", "fcl, libccd or nothing is expected, not '" + parameters.second_opinion + "'");
  if (parameters.cloud_id.empty()) wrong("cloud_id", "the name of an object is expected");
  if (parameters.octomap_id.empty() || parameters.octomap_id == parameters.cloud_id)
    wrong("octomap_id", "the name of an object is expected, another than ~cloud_id");
  for (const std::string &id : parameters.expected_sensors)
    if (id != parameters.cloud_id && id != parameters.octomap_id)
      wrong("expected_sensors", "'" + id + "' is neither ~cloud_id nor ~octomap_id");
  if (parameters.robot_description.find('<') != std::string::npos)
    wrong("robot_description", "the name of the parameter that holds the URDF is expected, not the URDF itself");
  return parameters;
}

GateParameters readGateParameters(const ros::NodeHandle &handle) {
  GateParameters parameters;
  NodeParameters reader(handle);
  visitGateParameters(parameters, reader);
  reader.keep(READING_OF_GATE);
  reader.warnOfOthers();
  if (parameters.server.empty()) wrong("server", "the namespace of a server is expected");
  return parameters;
}

} // namespace curve_proximity
