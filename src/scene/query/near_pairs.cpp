/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/near_pairs.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "answering.h"
#include "geometry/placing.h"
#include "world/world.h"

namespace curve_proximity {
namespace {

/* The first search, where the reach is larger [m]; each further one reaches REACH_FACTOR times as far. */
constexpr double FIRST_REACH = 0.05;
constexpr double REACH_FACTOR = 4.0;

/* Widths [m] that are tried before the one asked for, where only a verdict is asked for. */
constexpr double COARSE[] = {1e-2, 1e-4};

/* A collision element in the frame of its link. */
struct Element {
  const std::string *owner;
  const AttachedObject *attached; /* NULL: the link's own */
  std::size_t link;               /* its number in the robot */
  int part;
  const LinkGeometry *geometry;
  double margin;
  double own;                   /* [m] of the margin, what does not belong to the link */
  double reach;                 /* [m] the largest distance of its points from its own origin, without the margin */
  Eigen::Vector3d centre, half; /* its box in its own frame, without the margin */
  double radius;                /* of a ball about the centre of cprox_body_get_info() */
  Eigen::Vector3d ball;         /* that centre */
};

Element makeElement(const std::string *owner, const AttachedObject *attached, std::size_t link, int part,
                    const LinkGeometry &geometry, double link_padding) {
  const double own = attached ? attached->description.padding : 0.0;
  Element out{owner,
              attached,
              link,
              part,
              &geometry,
              own + link_padding + geometry.geometry.margin,
              own + geometry.geometry.margin,
              0.0,
              {},
              {},
              0.0,
              {}};
  const cprox_body *body = geometry.geometry.body.get();
  const cprox_body_info info = cprox_body_get_info(body);
  out.ball = toEigen(info.centre);
  out.radius = info.radius;
  out.reach = out.ball.norm() + info.radius;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    const double high = cprox_body_support(body, toVec3(along), nullptr);
    const double low = -cprox_body_support(body, toVec3(-along), nullptr);
    out.centre[axis] = 0.5 * (high + low);
    out.half[axis] = 0.5 * (high - low);
  }
  return out;
}

/* An element or an item of the world, placed. */
struct Body {
  PairSide side;
  const AttachedObject *attached;
  std::size_t link;      /* its number in the robot; of an object none */
  bool wanted;           /* the query is about its link */
  cprox_obstacle placed; /* padding included */
  cprox_obstacle hull;   /* a mesh by its hull */
  double own;            /* [m] of the robot: the margin in pairs within it, without the padding of the link */
  double rounding;       /* [m] how far rounding can have moved a point of it, and for its hull further … */
  double hull_excess;
  Eigen::AlignedBox3d box; /* with margin and rounding */
};

Body placeElement(const Element &element, const Eigen::Isometry3d &link, bool wanted) {
  const Geometry &geometry = element.geometry->geometry;
  const Eigen::Isometry3d pose = link * element.geometry->pose;
  Body out{{element.owner, element.attached ? BodyOwner::ATTACHED : BodyOwner::LINK, element.part},
           element.attached,
           element.link,
           wanted,
           at(geometry.body, pose, element.margin),
           at(geometry.hull, pose, element.margin),
           element.own,
           geometry.excess + placingError(link, element.geometry->pose, element.reach),
           geometry.hull_excess,
           {}};
  const Eigen::Vector3d middle = pose * element.centre;
  const double spread = element.margin + out.rounding + BOXING * (element.reach + pose.translation().norm());
  const Eigen::Vector3d half = pose.linear().cwiseAbs() * element.half + Eigen::Vector3d::Constant(spread);
  out.box = Eigen::AlignedBox3d(middle - half, middle + half);
  /* a long body that is turned fits its ball better */
  const Eigen::Vector3d ball = pose * element.ball, round = Eigen::Vector3d::Constant(element.radius + spread);
  out.box = out.box.intersection(Eigen::AlignedBox3d(ball - round, ball + round));
  return out;
}

Body bodyOf(const Item &item) {
  requireBody(item);
  const PlacedShape &shape = *item.shape;
  return {{item.owner, BodyOwner::OBJECT, item.part},
          nullptr,
          0,
          false,
          shape.obstacle,
          shape.hull,
          0.0,
          shape.rounding,
          shape.hull_excess,
          shape.box};
}

/* As it is in pairs within the robot. */
Body withoutLinkPadding(Body body) {
  body.placed.margin = body.hull.margin = body.own;
  return body;
}

bool isHalfspace(const cprox_obstacle &body) {
  return cprox_body_get_info(body.body).kind == CPROX_BODY_HALFSPACE;
}

/* ---- one pair ---- */

void widen(double rounding, cprox_result &result) {
  result.lower -= rounding;
  result.upper = result.upper > 0.0 ? result.upper + rounding : std::min(0.0, result.upper + rounding);
  result.verdict = result.lower > 0.0    ? CPROX_VERDICT_CLEAR
                   : result.upper <= 0.0 ? CPROX_VERDICT_VIOLATED
                                         : CPROX_VERDICT_UNDECIDED;
}

/* How far rounding can have moved a body against a halfspace, whose turning counts by the distance. */
double turningOf(const PlacedShape &shape, const Body &body) {
  if (!(shape.turning > 0.0)) return 0.0;
  const Eigen::Vector3d from = toEigen(shape.obstacle.pose.position);
  return shape.turning * (body.box.center() - from).norm() + shape.turning * 0.5 * body.box.diagonal().norm();
}

/* `turning`: what a halfspace adds to the rounding. */
cprox_result measure(const Body &a, const Body &b, double turning, const NearPairsQuery &query, Workspace &workspace) {
  const bool by_hull = isHalfspace(b.placed); // the depth of a mesh in a halfspace is that of its hull
  const cprox_obstacle &of_a = by_hull ? a.hull : a.placed;
  const double rounding = a.rounding + b.rounding + turning + (by_hull ? a.hull_excess : 0.0);
  cprox_options options = query.options;
  if (query.verdicts_only) {
    for (const double epsilon : COARSE) {
      if (epsilon <= query.options.epsilon) break;
      options.epsilon = epsilon;
      cprox_result coarse = pair(of_a, b.placed, options, workspace);
      widen(rounding, coarse);
      if (coarse.verdict != CPROX_VERDICT_UNDECIDED) return coarse;
    }
    options.epsilon = query.options.epsilon;
  }
  cprox_result result = pair(of_a, b.placed, withoutRounding(options, rounding), workspace);
  widen(rounding, result);
  return result;
}

/* A lower bound of the distance that costs little: that of the hulls. */
double hullGap(const Body &a, const Body &b, Workspace &workspace) {
  if (a.hull.body == a.placed.body && b.hull.body == b.placed.body) return 0.0;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = COARSE[0];
  const cprox_result hulls = pair(a.hull, b.hull, options, workspace);
  return hulls.lower - a.rounding - b.rounding - a.hull_excess - b.hull_excess;
}

/* What two surfaces that touch do not know: no way apart is longer than that of their hulls. */
void addDepth(const Body &a, const Body &b, const NearPairsQuery &query, Workspace &workspace, cprox_result &result) {
  const cprox_result hulls = pair(a.hull, b.hull, query.options, workspace);
  if (hulls.status < 0 || hulls.upper > 0.0) return;
  const double rounding = a.rounding + b.rounding + a.hull_excess + b.hull_excess;
  result.lower = std::max(result.lower, hulls.lower - rounding);
  result.normal = hulls.normal;
}

/* ---- which pairs ---- */

bool isTouchLink(const Body &object, const Body &link) {
  if (!object.attached || link.side.owner != BodyOwner::LINK) return false;
  const std::vector<std::string> &touch = object.attached->touch_links;
  return std::find(touch.begin(), touch.end(), *link.side.name) != touch.end();
}

/* Pairs that no rule of the query brings in. */
bool isExempt(const Body &a, const Body &b, bool carriers) {
  if (a.link == b.link && (!carriers || !a.attached == !b.attached)) return true;
  return isTouchLink(a, b) || isTouchLink(b, a);
}

/* Two of the bodies, the second one perhaps an item of the world, and a lower bound of their distance. */
struct Candidate {
  double gap;
  std::size_t a, b;
  bool is_self;
};

/* Visits the candidates of one search. */
class Visit {
 public:
  Visit(const Snapshot &snapshot, std::vector<Body> bodies, const NearPairsQuery &query, Workspace &workspace,
        const NearPairVisitor &visitor)
      : snapshot_(snapshot),
        bodies_(std::move(bodies)),
        query_(query),
        workspace_(workspace),
        visitor_(visitor),
        reach_(query.reach) {}

  void run() {
    /* Ever wider searches, as long as the visitor's reach is not covered. */
    double done = -1.0;
    for (double next = std::min(reach_, FIRST_REACH); reach_ >= 0.0 && done < reach_;) {
      const bool all = collect(done, next);
      std::sort(candidates_.begin(), candidates_.end(),
                [](const Candidate &x, const Candidate &y) { return x.gap < y.gap; });
      for (const Candidate &candidate : candidates_) {
        if (!(candidate.gap <= reach_)) break;
        visit(candidate);
      }
      if (all) return;
      done = next;
      next = std::min(reach_, REACH_FACTOR * next);
    }
  }

 private:
  /* Pairs that are farther than `beyond` and within `reach`; true if there are none farther. */
  bool collect(double beyond, double reach) {
    bool all = true;
    candidates_.clear();
    const auto consider = [&](double gap, std::size_t a, std::size_t b, bool is_self) {
      if (gap > reach) {
        all = false;
      } else if (gap > beyond) {
        candidates_.push_back({gap, a, b, is_self});
      }
    };
    if (query_.pairs != RobotPairs::ENVIRONMENT) {
      for (std::size_t i = 0; i < bodies_.size(); ++i)
        for (std::size_t k = i + 1; k < bodies_.size(); ++k) {
          if (!bodies_[i].wanted && !bodies_[k].wanted) continue;
          consider(boxGap(bodies_[i].box, bodies_[k].box), i, k, true);
        }
    }
    if (query_.pairs == RobotPairs::SELF) return all;
    const World &world = snapshot_.world();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!bodies_[i].wanted) continue;
      near_.clear();
      if (std::isfinite(reach)) world.within({bodies_[i].box}, reach, near_);
      std::sort(near_.begin(), near_.end());
      near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
      if (near_.size() < world.bounded().size()) all = false;
      for (const std::uint32_t k : near_) consider(boxGap(bodies_[i].box, world.items()[k].shape->box), i, k, false);
      for (const std::uint32_t k : world.unbounded()) consider(0.0, i, k, false);
    }
    return all;
  }

  void visit(const Candidate &candidate) {
    const Item *item = candidate.is_self ? nullptr : &snapshot_.world().items()[candidate.b];
    const Body a = item ? bodies_[candidate.a] : withoutLinkPadding(bodies_[candidate.a]);
    const Body b = item ? bodyOf(*item) : withoutLinkPadding(bodies_[candidate.b]);
    if (!item && isExempt(a, b, query_.carriers)) return;
    if (query_.may_touch ? query_.may_touch(*a.side.name, *b.side.name)
                         : snapshot_.mayTouch(*a.side.name, *b.side.name))
      return;
    const double turning = item ? turningOf(*item->shape, a) : 0.0;
    if (hullGap(a, b, workspace_) - turning > reach_) return;
    NearPair near{a.side, b.side, measure(a, b, turning, query_, workspace_)};
    if (near.result.lower > reach_) return;
    if (near.result.status == CPROX_OVERLAP && !query_.verdicts_only) addDepth(a, b, query_, workspace_, near.result);
    reach_ = std::min(reach_, visitor_(near));
  }

  const Snapshot &snapshot_;
  const std::vector<Body> bodies_;
  const NearPairsQuery &query_;
  Workspace &workspace_;
  const NearPairVisitor &visitor_;
  double reach_;
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> near_;
};

} // namespace

struct StandingRobot::Elements {
  std::vector<Element> elements;
  std::vector<const std::string *> links; /* in the order of their numbers */
};

StandingRobot::StandingRobot(SnapshotPtr snapshot) : snapshot_(std::move(snapshot)) {
  if (!snapshot_->robot()) throw Error("a robot is asked about, and the scene has none");
  const auto out = std::make_shared<Elements>();
  for (const auto &[name, of_robot] : snapshot_->robot()->links()) {
    const std::vector<LinkGeometry> &geometries = snapshot_->linkGeometry(name);
    for (std::size_t i = 0; i < geometries.size(); ++i)
      out->elements.push_back(makeElement(&name, nullptr, out->links.size(), static_cast<int>(i), geometries[i],
                                          snapshot_->linkPadding(name)));
    out->links.push_back(&name);
  }
  elements_ = out;
}

void StandingRobot::visit(const RobotPlacement &placement, const NearPairsQuery &query, Workspace &workspace,
                          const NearPairVisitor &visitor) const {
  const std::vector<const std::string *> &links = elements_->links;
  if (placement.links.size() != links.size())
    throw Error("the robot has " + std::to_string(links.size()) + " links, and " +
                std::to_string(placement.links.size()) + " poses were given");
  if (!(query.reach >= 0.0)) throw Error("the reach of a query about pairs must be at least 0");
  const std::string fault = query.pairs == RobotPairs::SELF ? "" : faultOfMoving(*snapshot_, {});
  if (!fault.empty()) throw Error(fault);

  std::vector<Body> bodies;
  const auto add = [&](const Element &element) {
    const Eigen::Isometry3d &pose = placement.links[element.link];
    checkPose(pose, "the pose of a link");
    const bool wanted = query.links.empty() || query.links.count(*links[element.link]) > 0;
    bodies.push_back(placeElement(element, pose, wanted));
  };
  for (const Element &element : elements_->elements) add(element);
  for (const auto &[id, object] : placement.attached) {
    const auto link = std::lower_bound(links.begin(), links.end(), object->link,
                                       [](const std::string *a, const std::string &b) { return *a < b; });
    if (link == links.end() || **link != object->link)
      throw Error("attached object '" + id + "': robot '" + snapshot_->robot()->name() + "' has no link '" +
                  object->link + "'");
    for (std::size_t i = 0; i < object->shapes.size(); ++i)
      add(makeElement(&object->description.id, object.get(), static_cast<std::size_t>(link - links.begin()),
                      static_cast<int>(i), object->shapes[i], snapshot_->linkPadding(object->link)));
  }
  Visit(*snapshot_, std::move(bodies), query, workspace, visitor).run();
}

} // namespace curve_proximity
