/* SPDX-License-Identifier: BSD-3-Clause */
#include "packages.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace curve_proximity::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepestFolder = 6; /* folders below an entry of ROS_PACKAGE_PATH */

std::map<std::string, std::string> named; /* by namePackages() */

/* Is this folder the package of that name? Its package.xml says so in <name>. */
bool isPackage(const fs::path &folder, const std::string &name) {
  std::ifstream stream(folder / "package.xml");
  if (!stream) return false;
  const std::string xml((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::size_t begin = xml.find("<name>"), end = xml.find("</name>");
  if (begin == std::string::npos || end == std::string::npos || end < begin) return false;
  std::string found = xml.substr(begin + 6, end - begin - 6);
  found.erase(0, found.find_first_not_of(" \t\r\n"));
  found.erase(found.find_last_not_of(" \t\r\n") + 1);
  return found == name;
}

std::vector<fs::path> pathList(const char *variable) {
  std::vector<fs::path> out;
  const char *value = std::getenv(variable);
  std::string rest = value ? value : "";
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    if (colon > 0) out.emplace_back(rest.substr(0, colon));
    rest.erase(0, colon + 1);
  }
  return out;
}

/* Looks through a tree of packages as ROS does: not below a package, and not where CATKIN_IGNORE stands. */
std::string crawl(const fs::path &folder, const std::string &name, int depth) {
  std::error_code error;
  if (isPackage(folder, name)) return folder.string();
  if (depth == 0 || fs::exists(folder / "package.xml", error) || fs::exists(folder / "CATKIN_IGNORE", error)) return "";
  for (fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, error), end; it != end;
       it.increment(error)) {
    if (error) break;
    if (!it->is_directory(error) || it->path().filename().string().rfind('.', 0) == 0) continue;
    const std::string found = crawl(it->path(), name, depth - 1);
    if (!found.empty()) return found;
  }
  return "";
}

} // namespace

void namePackages(const std::map<std::string, std::string> &folders) {
  named = folders;
}

std::function<std::string(const std::string &)> packageFinder(const std::string &beside) {
  return [beside](const std::string &name) -> std::string {
    if (const auto found = named.find(name); found != named.end()) return found->second;
    std::error_code error;
    for (fs::path folder = fs::absolute(beside, error); folder.has_relative_path(); folder = folder.parent_path()) {
      if (isPackage(folder, name)) return folder.string();
    }
    for (const fs::path &entry : pathList("ROS_PACKAGE_PATH")) {
      if (isPackage(entry / name, name)) return (entry / name).string();
      const std::string found = crawl(entry, name, kDeepestFolder);
      if (!found.empty()) return found;
    }
    std::vector<fs::path> prefixes = pathList("CMAKE_PREFIX_PATH");
    prefixes.emplace_back("/usr");
    for (const fs::path &prefix : prefixes) {
      if (isPackage(prefix / "share" / name, name)) return (prefix / "share" / name).string();
    }
    return "";
  };
}

} // namespace curve_proximity::cli
