/* SPDX-License-Identifier: BSD-3-Clause */
/* A scene of one box, asked without a node; then the services' types. Prints the distance. */
#include <curve_proximity/Distance.h>
#include <cstdio>
#include <curve_proximity/query.hpp>
#include <curve_proximity/scene.hpp>

int main() {
  namespace cp = curve_proximity;

  // A cube of edge 1 at the origin, in a scene without a robot.
  cp::Operation add{cp::Operation::Kind::ADD, {}};
  add.object.id = "cube";
  add.object.shapes.emplace_back();
  add.object.shapes[0].dimensions = {1.0, 1.0, 1.0};
  cp::SceneChange change;
  change.operations.push_back(add);
  cp::Scene scene;
  for (const std::string &error_message : scene.apply(change)) std::fprintf(stderr, "%s\n", error_message.c_str());

  // A straight line that passes it at a distance of 0.25.
  cp::CurveDescription line;
  line.points.resize(3, 2);
  line.points << -1.0, 1.0, 0.0, 0.0, 0.75, 0.75;
  cp::Workspace workspace;
  const auto answers = cp::ask(scene.snapshot(), {}, line, {}, workspace);

  // The service's types are there as well.
  curve_proximity::Distance service;
  service.request.query.curves.resize(1);
  std::printf("%s %.6f\n", answers.at(0).b.c_str(), answers.at(0).result.upper);
  return 0;
}
