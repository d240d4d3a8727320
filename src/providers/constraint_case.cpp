/* SPDX-License-Identifier: BSD-3-Clause */
#include "constraint_case.h"

#include <chrono>
#include <cmath>
#include <curve_proximity/nearest_name.hpp>
#include <curve_proximity/query.hpp>

#include "outline.h"

namespace curve_proximity {
namespace {

/** Writes all that a pair is into one string, so that the same pair is known again. */
class Key {
 public:
  void add(const std::string &text) {
    add(text.size());
    out_ += text;
  }
  void add(double x) {
    raw(&x, sizeof x);
  }
  void add(std::size_t n) {
    raw(&n, sizeof n);
  }
  template <class Matrix>
  void addMatrix(const Matrix &matrix) {
    add(static_cast<std::size_t>(matrix.cols()));
    raw(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof *matrix.data());
  }
  template <class Row>
  void addRows(const std::vector<Row> &rows) {
    add(rows.size());
    raw(rows.data(), rows.size() * sizeof(Row));
  }

  void add(const ObjectDescription &object) {
    add(object.padding);
    add(object.shapes.size());
    for (const ShapeDescription &shape : object.shapes) {
      add(static_cast<std::size_t>(shape.type));
      addRows(shape.dimensions);
      addMatrix(shape.vertices);
      addMatrix(shape.triangles);
      add(shape.hyperquadrics.size());
      for (const HyperquadricTerms &terms : shape.hyperquadrics) addRows(terms);
      addRows(shape.planes);
      addRows(shape.quadrics);
      add(shape.resource);
      add(std::size_t{shape.solid});
      add(shape.octree.id);
      add(shape.octree.resolution);
      add(std::size_t{shape.octree.binary});
      add(shape.octree.data);
      add(std::size_t{shape.unknown_is_occupied});
      addMatrix(shape.pose.matrix());
      addRows(shape.values);
      add(std::size_t{shape.deformed.has_value()});
      if (shape.deformed) {
        addMatrix(shape.deformed->linear);
        addMatrix(shape.deformed->translation);
        addRows(shape.deformed->exponents);
      }
    }
  }

  const std::string &text() const {
    return out_;
  }

 private:
  void raw(const void *bytes, std::size_t n) {
    if (n) out_.append(static_cast<const char *>(bytes), n);
  }

  std::string out_;
};

/* With files by their absolute paths. */
ConstraintBody::Part toPart(const ShapeDescription &given, const ResourceOptions &resources) {
  if (given.type == ShapeType::DISTANCE_GRID || given.type == ShapeType::CURVE)
    throw Error(std::string(shapeTypeName(given.type)) + ": its distance has no gradient here");
  ShapeDescription shape = given;
  if (!shape.resource.empty()) shape.resource = resolveResource(shape.resource, resources, shapeTypeName(shape.type));
  const Geometry geometry = sideGeometry(shape, resources);
  BodyHandle exact; // a mesh that was simplified is not
  if (geometry.margin == 0.0) exact = geometry.body;
  return {shape, geometry.hull, geometry.hull_excess + geometry.margin, exact};
}

ConstraintBody toBody(const ObjectDescription &object, const char *name, const ResourceOptions &resources) {
  ConstraintBody side;
  if (!(object.padding >= 0.0) || !std::isfinite(object.padding))
    throw Error(std::string(name) + ": the padding must be finite and at least 0");
  side.padding = object.padding;
  for (std::size_t i = 0; i < object.shapes.size(); ++i) {
    const ShapeDescription &shape = object.shapes[i];
    try {
      if (!shape.pose.matrix().allFinite()) throw Error("its pose is not finite");
      side.parts.push_back(toPart(shape, resources));
    } catch (const Error &error) {
      throw Error(std::string(name) + ": shape " + std::to_string(i) + ": " + error.what(), error.status());
    }
  }
  return side;
}

/** What the providers are asked, checked once for all of them. */
struct Asked {
  ConstraintPlace place;
  ConstraintCurve curve;
  std::shared_ptr<const RobotMotion> motion;
  std::optional<MovingRobot> robot; /* what moves beside it: this robot among movers */
  std::optional<Movers> movers;
  std::string key;
};

void gatherMovers(const ConstraintCase &all, const MotionCase &described, Asked &asked) {
  const SnapshotPtr &snapshot = described.robot->snapshot();
  asked.robot = MovingRobot{snapshot->robot()->name(), asked.motion, 0.0, 0.0};
  const std::vector<MovingObject> objects = movingObjects(*snapshot, described.origin);
  checkClocks(*asked.robot, described.other_robots, objects);
  std::vector<MovingRobot> robots = described.other_robots;
  robots.insert(robots.begin(), *asked.robot);
  const Stop stop = [&all] { return all.stop && all.stop(all.stop_user); };
  asked.movers.emplace(snapshot, robots, objects, std::vector<std::array<std::string, 2>>(), ResourceOptions(), stop);
}

void makeReady(const ConstraintCase &described, Asked &asked) {
  if (described.motion) {
    if (!described.a.shapes.empty() || !described.b.shapes.empty() || described.curve)
      throw Error("a case is about a trajectory or about two sides: give one of them");
    const MotionCase &motion = *described.motion;
    asked.motion = std::make_shared<const RobotMotion>(*motion.robot, motion.trajectory, motion.rest);
    if (motion.isAmongMovers()) gatherMovers(described, motion, asked);
    return;
  }
  if (!described.a.pose.matrix().allFinite()) throw Error("a: the pose is not finite");
  if (!described.b.pose.matrix().allFinite()) throw Error("b: the pose is not finite");
  asked.place.a = toPose(described.a.pose);
  asked.place.b = toPose(described.b.pose);
  if (described.curve) {
    if (!described.a.pose.matrix().isIdentity(0.0))
      throw Error("a: what rides a curve stands where the curve is: its pose must be the identity");
    const CompiledCurve compiled = compile(*described.curve);
    asked.curve.curve = compiled.curve;
    asked.curve.radius_curve = compiled.radius_curve;
    asked.curve.description = *described.curve;
    asked.place.curve = &asked.curve;
  }
  Key key;
  key.add(described.a);
  key.add(described.b);
  key.add(std::size_t{described.curve.has_value()});
  key.add(std::size_t{described.providers.empty()});
  asked.key = key.text();
}

ConstraintPair toPair(const ConstraintCase &described, const ResourceOptions &resources) {
  return {toBody(described.a, "a", described.resources_a.value_or(resources)),
          toBody(described.b, "b", described.resources_b.value_or(resources)),
          described.curve.has_value(),
          !described.providers.empty(),
          described.stop,
          described.stop_user};
}

using Clock = std::chrono::steady_clock;

double microsecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

/** The row as a whole: the gradient of its nearest row, if there is one, and the value of them all. */
void summarise(ConstraintRow &row) {
  const MotionValue &all = *row.motion;
  ConstraintValue &value = row.value;
  value = ConstraintValue();
  value.valid = true; /* without a row it does not change with the trajectory */
  if (!all.rows.empty()) value = all.rows.front();
  value.status = all.status;
  value.value = all.value;
  value.bounded = all.bounded;
  value.lower = all.lower;
  value.upper = all.upper;
  if (value.reason.empty()) value.reason = all.message;
}

void askAboutMotion(const LoadedProvider &loaded, const ConstraintCase &described, const Asked &asked,
                    Workspace &workspace, ConstraintRow &row) {
  const MotionCase &motion = *described.motion;
  const std::unique_ptr<const MotionConstraint> constraint = loaded.provider->prepareMotion(*motion.robot);
  if (!constraint) throw Error("the provider made nothing of the robot");
  if (asked.movers && !constraint->takesMovers())
    throw Error("the provider answers for scenes in which nothing moves beside the robot");
  row.motion.emplace();
  const Clock::time_point begin = Clock::now();
  constraint->evaluate(
      {motion.trajectory, *asked.motion, described.stop, described.stop_user, asked.movers ? &*asked.movers : nullptr,
       asked.robot ? &*asked.robot : nullptr, !described.providers.empty()},
      workspace, *row.motion);
  row.microseconds = microsecondsSince(begin);
  summarise(row);
}

void askProvider(ProviderSet &providers, const LoadedProvider &loaded, const ConstraintCase &described,
                 const ResourceOptions &resources, const Asked &asked, Workspace &workspace, ConstraintRow &row) {
  if (!loaded.provider) throw Error("provider '" + loaded.spec.name + "' failed to load: " + loaded.failure);
  if (described.motion) {
    askAboutMotion(loaded, described, asked, workspace, row);
    return;
  }
  row.constraint = providers.prepared(loaded, asked.key, [&] { return toPair(described, resources); });
  const Clock::time_point begin = Clock::now();
  row.constraint->evaluate(asked.place, workspace, row.value);
  row.microseconds = microsecondsSince(begin);
}

Coverage coverageOf(const ConstraintCase &described) {
  Coverage out = described.coverage;
  if (!described.motion) return out;
  out.add(described.motion->trajectory.coverage);
  const Snapshot &snapshot = *described.motion->robot->snapshot();
  out.add(snapshot.coverage());
  out.add(snapshot.robot()->coverage());
  return out;
}

/** What is not covered bounds nothing. */
void applyCoverage(const Coverage &coverage, ConstraintRow &row) {
  if (coverage.complete() || row.status < 0) return;
  row.gap = coverage.gap();
  row.message += (row.message.empty() ? "" : "; ") + coverage.message();
  row.value.bounded = false;
  row.value.touching_least = -std::numeric_limits<double>::infinity(); // a penalty's
  row.value.touching_most = std::numeric_limits<double>::infinity();
  if (!row.motion) return;
  row.motion->bounded = false;
  for (MotionRow &one : row.motion->rows) {
    one.bounded = false;
    one.reason += (one.reason.empty() ? "" : "; ") + coverage.message();
  }
}

} // namespace

Geometry sideGeometry(const ShapeDescription &shape, const ResourceOptions &resources) {
  const bool outline = shape.type == ShapeType::POLYGON && turnsBothWays(shape.vertices);
  ResourceOptions as_it_is = resources;
  if (outline) as_it_is.mesh_tolerance = 0.0;
  Geometry geometry = outline ? makeGeometry(filledOutline(shape), as_it_is) : makeGeometry(shape, resources);
  if (!geometry.hull) throw Error("the octree has no occupied cell");
  return geometry;
}

ConstraintSide sideOf(const Snapshot &scene, const std::string &id, const LinkPlaces &places) {
  ConstraintSide out;
  const auto object = scene.objects().find(id);
  if (object != scene.objects().end()) {
    out.object = object->second->description;
    return out;
  }
  out.object.id = id;
  std::string link = id;
  const std::vector<LinkGeometry> *shapes = nullptr;
  const auto attached = scene.attached().find(id);
  if (attached != scene.attached().end()) {
    link = attached->second->link;
    shapes = &attached->second->shapes;
    out.object.padding = scene.attachedPadding(*attached->second);
  } else if (scene.robot() && scene.robot()->links().count(id) > 0) {
    shapes = &scene.linkGeometry(id);
    out.object.padding = scene.linkPadding(id);
    out.resources = scene.robot()->resources();
    if (shapes->empty()) throw Error("link '" + id + "' has no collision geometry");
  } else {
    throw Error("there is no object '" + id + "' in the scene" + didYouMean(id, namesOf(scene.objects())) +
                (scene.robot() ? ", and no link of that name" : ""));
  }
  for (const LinkGeometry &shape : *shapes) {
    out.object.shapes.push_back(shape.description);
    out.object.shapes.back().pose = shape.pose;
  }
  out.object.pose = places(link);
  out.is_on_robot = true;
  return out;
}

ConstraintRow failedRow(const std::string &id, const std::string &why, cprox_status status) {
  ConstraintRow row;
  row.id = id;
  row.status = status;
  row.message = why;
  return row;
}

const char *statusName(const ConstraintRow &row) {
  return row.gap ? gapName(*row.gap) : cprox_status_name(row.status);
}

std::vector<ConstraintRow> answerCase(ProviderSet &providers, const ConstraintCase &described,
                                      const ResourceOptions &resources, Workspace &workspace) {
  std::vector<std::string> names = described.providers;
  const bool all = names.empty();
  if (all)
    for (const LoadedProvider &loaded : providers.all()) names.push_back(loaded.spec.name);
  if (names.empty()) return {failedRow(described.id, "there are no constraint providers")};

  Asked asked;
  cprox_status fault = CPROX_OK;
  const std::string why = messageOf([&] { makeReady(described, asked); }, &fault);
  if (fault < 0) return {failedRow(described.id, why, fault)};

  const Coverage coverage = coverageOf(described);
  std::vector<ConstraintRow> rows;
  for (const std::string &name : names) {
    ConstraintRow row;
    row.id = described.id;
    row.provider = name;
    const LoadedProvider *loaded = providers.find(name);
    bool applies = true;
    row.message = messageOf(
        [&] {
          if (!loaded) throw Error("there is no provider '" + name + "' here");
          try {
            askProvider(providers, *loaded, described, resources, asked, workspace, row);
          } catch (const DoesNotApply &) {
            applies = false;
            throw;
          }
        },
        &row.status);
    if (all && !applies) continue;
    if (row.status >= 0) {
      row.status = row.value.status;
      row.message = row.value.reason;
    }
    applyCoverage(coverage, row);
    rows.push_back(std::move(row));
  }
  if (rows.empty())
    return {failedRow(described.id, "no constraint provider applies to this case: name the one that you mean")};
  return rows;
}

} // namespace curve_proximity
