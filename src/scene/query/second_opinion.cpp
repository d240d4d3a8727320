/* SPDX-License-Identifier: BSD-3-Clause */
#include "second_opinion.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

#include "answering.h"
#include "peers.h"

namespace curve_proximity {

struct SecondOpinions::Data {
  Peer peer = Peer::FCL;
  ResourceOptions objects;
  mutable std::mutex mutex;
  mutable std::map<MeshRequest, std::shared_ptr<const PeerMesh>> meshes; /* of files, by what was asked for */
};

namespace {

/* [m] for each metre of size, and for sizes below a metre: what both libraries keep to on pairs of all kinds
 * (doc/second-opinion.md). */
constexpr double ACCURACY = 1e-5;

/* So many pairs of pieces are looked at, and so many are measured: a second or two of either library. */
constexpr std::size_t MOST_PAIRS = 10000000, MOST_MEASURED = 20000;

/* So many meshes of files are kept. */
constexpr std::size_t MOST_MESHES = 256;

/* One side of a pair at one time. */
struct Side {
  std::vector<Piece> pieces;
  double margin = 0.0;                  /* [m] around all of them */
  bool is_solid = false;                /* a mesh whose inside counts, which no peer knows */
  std::optional<Eigen::Vector4d> plane; /* a halfspace: unit normal and offset, instead of pieces */
};

/* ---- shapes ---- */

MeshData meshOf(const ShapeDescription &shape, const ResourceOptions &resources) {
  MeshData mesh = shape.resource.empty() ? MeshData{shape.vertices, shape.triangles}
                                         : readMesh(resolveResource(shape.resource, resources));
  mesh.vertices = meshScale(shape).asDiagonal() * mesh.vertices;
  return mesh;
}

std::shared_ptr<const PeerMesh> keptMesh(const ShapeDescription &shape, const ResourceOptions &resources,
                                         const SecondOpinions::Data &data) {
  const auto make = [&] {
    auto mesh = std::make_shared<PeerMesh>();
    mesh->data = meshOf(shape, resources);
    return mesh;
  };
  if (shape.resource.empty()) return make();
  const MeshRequest key{shape.resource, resolveResource(shape.resource, resources), meshScale(shape), false};
  const std::lock_guard<std::mutex> lock(data.mutex);
  const auto found = data.meshes.find(key);
  if (found != data.meshes.end()) return found->second;
  if (data.meshes.size() >= MOST_MESHES) data.meshes.clear();
  return data.meshes.emplace(key, make()).first->second;
}

/* Only the vertices that triangles use: others do not belong to the mesh. */
Eigen::Matrix3Xd usedVertices(const MeshData &mesh) {
  std::vector<bool> used(static_cast<std::size_t>(mesh.vertices.cols()), false);
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i) used[static_cast<std::size_t>(mesh.triangles(i))] = true;
  Eigen::Matrix3Xd out(3, std::count(used.begin(), used.end(), true));
  for (Eigen::Index i = 0, next = 0; i < mesh.vertices.cols(); ++i)
    if (used[static_cast<std::size_t>(i)]) out.col(next++) = mesh.vertices.col(i);
  return out;
}

Piece pieceOf(ShapeType type, const Eigen::Vector3d &size, const Eigen::Isometry3d &pose) {
  Piece piece;
  piece.type = type;
  piece.size = size;
  piece.pose = pose;
  bound(piece);
  return piece;
}

Piece polytopeOf(Eigen::Matrix3Xd vertices, const Eigen::Isometry3d &pose) {
  Piece piece;
  piece.type = ShapeType::POLYTOPE;
  piece.vertices = std::move(vertices);
  piece.pose = pose;
  bound(piece);
  return piece;
}

/* libccd takes convex pieces: the triangles. */
void addMesh(std::shared_ptr<const PeerMesh> mesh, const Eigen::Isometry3d &pose, Peer peer, Side &side) {
  if (peer == Peer::FCL) {
    Piece piece;
    piece.type = ShapeType::MESH;
    piece.mesh = std::move(mesh);
    piece.pose = pose;
    bound(piece);
    side.pieces.push_back(std::move(piece));
    return;
  }
  const MeshData &data = mesh->data;
  for (Eigen::Index i = 0; i < data.triangles.cols(); ++i) {
    Eigen::Matrix3Xd corners(3, 3);
    for (Eigen::Index k = 0; k < 3; ++k) corners.col(k) = data.vertices.col(data.triangles(k, i));
    side.pieces.push_back(polytopeOf(std::move(corners), pose));
  }
}

Eigen::Isometry3d moved(const Eigen::Isometry3d &pose, const Eigen::Vector3d &by) {
  return pose * Eigen::Translation3d(by);
}

/* The shape at a pose; by_hull: its convex hull has answered. Throws Error for what the peers do not know. */
Side sideOf(const ShapeDescription &shape, const Eigen::Isometry3d &pose, double margin, bool by_hull,
            const ResourceOptions &resources, const SecondOpinions::Data &data) {
  Side side;
  side.margin = margin;
  const std::vector<double> &d = shape.dimensions;
  const std::string who = std::string(peerName(data.peer)) + " is not asked about ";
  if (by_hull && (shape.type == ShapeType::POINTS || shape.type == ShapeType::OCTREE))
    throw Error(who + "the hulls of points and cells");
  switch (shape.type) {
    case ShapeType::POINT:
      side.pieces.push_back(pieceOf(
          ShapeType::POINT, Eigen::Vector3d::Zero(),
          moved(pose, shape.vertices.cols() ? Eigen::Vector3d(shape.vertices.col(0)) : Eigen::Vector3d::Zero())));
      break;
    case ShapeType::SPHERE: side.pieces.push_back(pieceOf(shape.type, {d[0], 0.0, 0.0}, pose)); break;
    case ShapeType::BOX:
    case ShapeType::ELLIPSOID: side.pieces.push_back(pieceOf(shape.type, {d[0], d[1], d[2]}, pose)); break;
    case ShapeType::CAPSULE:
    case ShapeType::CYLINDER:
    case ShapeType::CONE: side.pieces.push_back(pieceOf(shape.type, {d[0], d[1], 0.0}, pose)); break;
    case ShapeType::POLYTOPE:
    case ShapeType::POLYGON: side.pieces.push_back(polytopeOf(shape.vertices, pose)); break;
    case ShapeType::HALFSPACE: {
      const Eigen::Vector3d given(d[0], d[1], d[2]), normal = pose.linear() * given.normalized();
      side.plane =
          Eigen::Vector4d(normal.x(), normal.y(), normal.z(), d[3] / given.norm() - normal.dot(pose.translation()));
      break;
    }
    case ShapeType::POINTS:
      for (Eigen::Index i = 0; i < shape.vertices.cols(); ++i)
        side.pieces.push_back(pieceOf(d.empty() || d[0] == 0.0 ? ShapeType::POINT : ShapeType::SPHERE,
                                      {d.empty() ? 0.0 : d[0], 0.0, 0.0}, moved(pose, shape.vertices.col(i))));
      break;
    case ShapeType::OCTREE: {
      const Boxes boxes = octreeBoxes(shape, resources);
      for (Eigen::Index i = 0; i < boxes.low.cols(); ++i)
        side.pieces.push_back(pieceOf(ShapeType::BOX, boxes.high.col(i) - boxes.low.col(i),
                                      moved(pose, 0.5 * (boxes.low.col(i) + boxes.high.col(i)))));
      break;
    }
    case ShapeType::MESH:
      if (by_hull) {
        side.pieces.push_back(polytopeOf(usedVertices(keptMesh(shape, resources, data)->data), pose));
      } else {
        side.is_solid = shape.solid;
        addMesh(keptMesh(shape, resources, data), pose, data.peer, side);
      }
      break;
    default: throw Error(who + shapeTypeName(shape.type) + "s");
  }
  return side;
}

/* ---- the measurement ---- */

/* A ball that holds a side. */
Piece ballOf(const Side &side) {
  Eigen::AlignedBox3d box;
  for (const Piece &piece : side.pieces) {
    box.extend(piece.centre - Eigen::Vector3d::Constant(piece.radius));
    box.extend(piece.centre + Eigen::Vector3d::Constant(piece.radius));
  }
  return pieceOf(ShapeType::SPHERE, {0.5 * box.diagonal().norm(), 0.0, 0.0},
                 Eigen::Isometry3d(Eigen::Translation3d(box.center())));
}

/* A box of the halfspace that holds all of its points that can be nearest to the other side. */
Piece boxOf(const Eigen::Vector4d &plane, const Piece &other) {
  const Eigen::Vector3d normal = plane.head<3>();
  const double height = normal.dot(other.centre) + plane.w(), half = 2.0 * (other.radius + std::abs(height)) + 1.0;
  Eigen::Isometry3d pose(Eigen::Translation3d(other.centre - (height + half) * normal));
  pose.linear() = rotationBetween(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
  return pieceOf(ShapeType::BOX, Eigen::Vector3d::Constant(2.0 * half), pose);
}

double gapOf(const Piece &a, const Piece &b) {
  return (a.centre - b.centre).norm() - a.radius - b.radius;
}

/* The least distance of a piece of one side and a piece of the other, margins included. */
double distanceOf(Side a, Side b, Peer peer, const Stop &stop) {
  if (a.plane && b.plane) throw Error("two halfspaces have no distance");
  if (a.plane) a.pieces = {boxOf(*a.plane, ballOf(b))};
  if (b.plane) b.pieces = {boxOf(*b.plane, ballOf(a))};
  if (a.pieces.empty() || b.pieces.empty()) throw Error("there is nothing to measure");
  if (a.pieces.size() > MOST_PAIRS / b.pieces.size())
    throw Error(std::to_string(a.pieces.size()) + " and " + std::to_string(b.pieces.size()) +
                " triangles, points or cells are too many for " + peerName(peer) + ", which has no tree over them");

  /* the pair whose balls are nearest first, then all that may be nearer */
  double nearest = INFINITE;
  std::size_t measured = 0;
  const auto look = [&](const Piece &one, const Piece &other) {
    if (stop && stop()) throw Error("the query was ended");
    if (++measured > MOST_MEASURED)
      throw Error("more than " + std::to_string(MOST_MEASURED) +
                  " pairs of triangles, points or cells may be the nearest");
    const double found =
        peer == Peer::FCL ? fclDistance(one, other) : ccdDistance(one, other, std::min(nearest, 1e300));
    nearest = std::min(nearest, found);
  };
  double least = INFINITE;
  const Piece *first = nullptr, *second = nullptr;
  for (const Piece &one : a.pieces) {
    for (const Piece &other : b.pieces) {
      const double gap = gapOf(one, other);
      if (gap >= least) continue;
      least = gap;
      first = &one, second = &other;
    }
  }
  if (!first) throw Error("the shapes are not finite");
  look(*first, *second);
  for (const Piece &one : a.pieces) {
    for (const Piece &other : b.pieces) {
      if (nearest > 0.0 && gapOf(one, other) < nearest && !(&one == first && &other == second)) look(one, other);
    }
  }
  return std::max(0.0, nearest - a.margin - b.margin);
}

double sizeOf(const Side &side) {
  double most = 1.0;
  for (const Piece &piece : side.pieces) most = std::max(most, piece.centre.norm() + piece.radius);
  return most;
}

std::string numberOf(double x) {
  std::ostringstream text;
  text.precision(9);
  text << x;
  return text.str();
}

/* How far meshes that were simplified may be from those that a peer measures. */
double simplifiedBy(const ResourceOptions &objects, const Robot *robot) {
  return 2.0 *
         (objects.mesh_tolerance + std::max(objects.mesh_tolerance, robot ? robot->resources().mesh_tolerance : 0.0));
}

/* Both sides at the times that are looked at: the witness time first. */
using SidesAt = std::function<std::pair<Side, Side>(double t)>;

SecondOpinion opinionOf(Peer peer, const std::vector<double> &times, const SidesAt &sidesAt, double lower, double upper,
                        double simplified, const Stop &stop = nullptr) {
  SecondOpinion out;
  const double least = std::max(0.0, lower), most = std::max(0.0, upper);
  try {
    for (const double t : times) {
      const std::pair<Side, Side> sides = sidesAt(t);
      const bool at_witness = t == times.front();
      const double found = distanceOf(sides.first, sides.second, peer, stop);
      const double accuracy = ACCURACY * std::max(sizeOf(sides.first), sizeOf(sides.second)) + simplified;
      if (at_witness && found > accuracy && most == 0.0 && (sides.first.is_solid || sides.second.is_solid))
        throw Error(std::string(peerName(peer)) + " knows meshes as surfaces: it measures " + numberOf(found) +
                    " m, and cannot tell that something is inside");
      if (at_witness) out.distance = found;
      if (found >= least - accuracy && (!at_witness || found <= most + accuracy)) continue;
      out.verdict = SecondOpinion::DISAGREES;
      out.message = std::string(peerName(peer)) + " disagrees: it measures " + numberOf(found) + " m";
      if (times.size() > 1) out.message += " at t = " + numberOf(t);
      out.message += (found < least ? ", and lower is " + numberOf(least) : ", and upper is " + numberOf(most)) +
                     " m; its accuracy is " + numberOf(accuracy) + " m";
      return out;
    }
    out.verdict = SecondOpinion::AGREES;
  } catch (const Error &error) {
    out.verdict = SecondOpinion::UNKNOWN;
    out.message = std::string("no second opinion: ") + error.what();
  }
  return out;
}

/* ---- answers ---- */

bool isWanted(const Query &query, const Answer &answer) {
  return query.second_opinion && answer.result.status >= 0;
}

void tell(SecondOpinion opinion, Answer &answer) {
  if (!opinion.message.empty()) answer.message += (answer.message.empty() ? "" : "; ") + opinion.message;
  answer.second_opinion = std::move(opinion);
}

/* What ends the query ends the opinion. */
Stop stopOf(const Query &query) {
  return [options = query.options] { return options.stop != nullptr && options.stop(options.stop_user); };
}

/* Whether there is a pair to measure; a closest pair that nobody measured is unknown. */
bool hasPair(const Query &query, Answer &answer) {
  if (answer.result.obstacle_index >= 0 && (answer.by_hull || std::isfinite(answer.result.upper))) return true;
  refuseSecondOpinion(query, "no pair was measured", answer);
  return false;
}

bool hullsAnswer(const Query &query) {
  return query.options.max_lod == CPROX_LOD_HULL;
}

/* Bounding spheres have answered, not the shapes. */
bool byBalls(const Query &query, Answer &answer) {
  if (query.options.max_lod != CPROX_LOD_SPHERE) return false;
  refuseSecondOpinion(query, "bounding spheres have answered", answer);
  return true;
}

std::vector<double> timesOf(const Answer &answer, double t0, double t1) {
  std::vector<double> times{answer.result.t};
  for (const double end : {t0, t1})
    if (end != answer.result.t) times.push_back(end);
  return times;
}

/* A shape of the robot: of a link, or of what a link carries. */
struct RobotShape {
  const LinkGeometry *geometry;
  const std::string *link;
  double padding;
  bool of_link;
};

/* within: a pair of the robot with itself, in which the padding of links does not count. */
RobotShape shapeOf(const Snapshot &snapshot, const std::string &owner, bool is_link, std::size_t part, bool within) {
  if (is_link) {
    const std::string &link = snapshot.robot()->links().find(owner)->first;
    return {&snapshot.linkGeometry(owner).at(part), &link, within ? 0.0 : snapshot.linkPadding(owner), true};
  }
  const AttachedObject &object = *snapshot.attached().at(owner);
  const double padding = within ? object.description.padding : snapshot.attachedPadding(object);
  return {&object.shapes.at(part), &object.link, padding, false};
}

} // namespace

void bound(Piece &piece) {
  const Eigen::Matrix3Xd &vertices = piece.mesh ? piece.mesh->data.vertices : piece.vertices;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  const Eigen::Vector3d &size = piece.size;
  switch (piece.type) {
    case ShapeType::SPHERE: piece.radius = size.x(); break;
    case ShapeType::BOX: piece.radius = 0.5 * size.norm(); break;
    case ShapeType::CAPSULE: piece.radius = 0.5 * size.x() + size.y(); break;
    case ShapeType::CYLINDER:
    case ShapeType::CONE: piece.radius = std::hypot(0.5 * size.x(), size.y()); break;
    case ShapeType::ELLIPSOID: piece.radius = size.maxCoeff(); break;
    case ShapeType::POLYTOPE:
    case ShapeType::MESH:
      centre = vertices.rowwise().mean();
      piece.radius = (vertices.colwise() - centre).colwise().norm().maxCoeff();
      break;
    default: piece.radius = 0.0; break;
  }
  piece.centre = piece.pose * centre;
}

const char *peerName(Peer peer) {
  return peer == Peer::FCL ? "fcl" : "libccd";
}

std::optional<Peer> peerFromName(const std::string &name) {
  for (const Peer peer : {Peer::FCL, Peer::LIBCCD})
    if (name == peerName(peer)) return peer;
  return std::nullopt;
}

const char *secondOpinionName(SecondOpinion::Verdict verdict) {
  switch (verdict) {
    case SecondOpinion::AGREES: return "agrees";
    case SecondOpinion::DISAGREES: return "disagrees";
    case SecondOpinion::UNKNOWN: return "unknown";
    case SecondOpinion::NONE: break;
  }
  return "";
}

SecondOpinions::SecondOpinions(Peer peer, ResourceOptions objects) {
  auto data = std::make_unique<Data>();
  data->peer = peer;
  data->objects = std::move(objects);
  data_ = std::move(data);
}

SecondOpinions::~SecondOpinions() = default;

Peer SecondOpinions::peer() const {
  return data_->peer;
}

SecondOpinion SecondOpinions::ofPair(const ShapeDescription &a, const Eigen::Isometry3d &pose_a,
                                     const ShapeDescription &b, const Eigen::Isometry3d &pose_b, double lower,
                                     double upper) const {
  const auto sidesAt = [&](double) {
    return std::make_pair(sideOf(a, pose_a, 0.0, false, data_->objects, *data_),
                          sideOf(b, pose_b, 0.0, false, data_->objects, *data_));
  };
  return opinionOf(data_->peer, {0.0}, sidesAt, lower, upper, simplifiedBy(data_->objects, nullptr));
}

void refuseSecondOpinion(const Query &query, const std::string &why, Answer &answer) {
  if (!isWanted(query, answer)) return;
  SecondOpinion opinion;
  opinion.verdict = SecondOpinion::UNKNOWN;
  opinion.message = "no second opinion: " + why;
  tell(std::move(opinion), answer);
}

void addSecondOpinion(const SceneObstacles::Data &obstacles, const CompiledCurve &curve, const Query &query,
                      Answer &answer) {
  if (!isWanted(query, answer) || byBalls(query, answer) || !hasPair(query, answer)) return;
  const SecondOpinions::Data &data = query.second_opinion->data();
  const Snapshot &snapshot = *obstacles.snapshot;
  const auto part = static_cast<std::size_t>(answer.result.obstacle_index);

  /* whose shape it is */
  const auto item = std::find_if(obstacles.items.begin(), obstacles.items.end(), [&](const Item &i) {
    return i.is_link == answer.b_is_link && i.part == answer.result.obstacle_index && *i.owner == answer.b;
  });
  if (item == obstacles.items.end()) return refuseSecondOpinion(query, "the pair is not known", answer);
  const auto object = snapshot.objects().find(answer.b);
  const bool stands = !answer.b_is_link && object != snapshot.objects().end();
  const ShapeDescription &shape =
      stands ? object->second->description.shapes.at(part)
             : shapeOf(snapshot, answer.b, answer.b_is_link, part, false).geometry->description;
  const ResourceOptions &resources = answer.b_is_link ? snapshot.robot()->resources() : data.objects;

  const cprox_obstacle &placed = item->shape->obstacle;
  const cprox_curve_info info = cprox_curve_get_info(curve.curve.get());
  Workspace workspace;
  const auto sidesAt = [&](double t) {
    cprox_vec3 point{};
    cprox_curve_evaluate(curve.curve.get(), t, workspace.get(), &point, nullptr, nullptr);
    Side ball;
    ball.margin = radiusAt(curve, t);
    ball.pieces.push_back(
        pieceOf(ShapeType::POINT, Eigen::Vector3d::Zero(), Eigen::Isometry3d(Eigen::Translation3d(toEigen(point)))));
    return std::make_pair(std::move(ball),
                          sideOf(shape, toIsometry(placed.pose), placed.margin, hullsAnswer(query), resources, data));
  };
  tell(opinionOf(data.peer, timesOf(answer, info.t0, info.t1), sidesAt, answer.result.lower, answer.result.upper,
                 simplifiedBy(data.objects, snapshot.robot().get()), stopOf(query)),
       answer);
}

void addSecondOpinion(const RobotMotion::Data &motion, const Query &query, Answer &answer) {
  if (!isWanted(query, answer) || byBalls(query, answer) || !hasPair(query, answer)) return;
  const SecondOpinions::Data &data = query.second_opinion->data();
  const Snapshot &snapshot = *motion.snapshot;
  const auto part = static_cast<std::size_t>(answer.result.obstacle_index);
  const bool self = answer.kind == "self";
  const RobotShape mover = shapeOf(snapshot, answer.a, snapshot.attached().count(answer.a) == 0,
                                   static_cast<std::size_t>(answer.result.mover_part), self);
  const bool by_hull = answer.by_hull;
  const auto sideOfRobot = [&](const RobotShape &shape, const LinkPoses &poses) {
    return sideOf(shape.geometry->description, poses.at(*shape.link) * shape.geometry->pose, shape.padding, by_hull,
                  shape.of_link ? snapshot.robot()->resources() : data.objects, data);
  };
  const cprox_motion_info info = cprox_motion_get_info(motion.core.get());
  const auto sidesAt = [&](double t) {
    const LinkPoses poses = linkPosesOf(motion, t);
    if (self)
      return std::make_pair(sideOfRobot(mover, poses),
                            sideOfRobot(shapeOf(snapshot, answer.b, answer.b_is_link, part, true), poses));
    const SceneObject &object = *snapshot.objects().at(answer.b);
    const cprox_obstacle &placed = object.shapes.at(part).placed.obstacle;
    const ShapeDescription &shape = object.description.shapes.at(part);
    return std::make_pair(sideOfRobot(mover, poses),
                          sideOf(shape, toIsometry(placed.pose), placed.margin, by_hull, data.objects, data));
  };
  tell(opinionOf(data.peer, timesOf(answer, info.t0, info.t1), sidesAt, answer.result.lower, answer.result.upper,
                 simplifiedBy(data.objects, snapshot.robot().get()), stopOf(query)),
       answer);
}

} // namespace curve_proximity
