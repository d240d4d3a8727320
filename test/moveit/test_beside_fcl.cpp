/* SPDX-License-Identifier: BSD-3-Clause */
/* Random states in scenes that random operations change, by FCL's detector, by ours and by the certifier, which answers
 * about a robot that stands. The program's argument is the number of states (default 2000).
 *
 * FCL is wrong by up to NEAR where bodies touch. It pads by moving faces, so that corners stand out further than by a
 * ball: with a padding p what is closer than CORNER p may differ. Its meshes are surfaces: what is wholly inside a link
 * is free for it. A difference that none of these explains is an error.
 *
 * Of a body that only ours finds in contact with a link, points of the link's surface and the winding number of its mesh
 * say what is true: they need neither detector. Distances by FCL do not, of bodies that are inside a mesh it returns
 * memory that nothing was written to. */
#include <geometric_shapes/bodies.h>
#include <geometric_shapes/body_operations.h>
#include <gtest/gtest.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/utils/robot_model_test_utils.h>

#include <random>

#include "certifier.h"

namespace {

namespace cd = collision_detection;

constexpr double NEAR = 1e-4, CORNER = 2.0;
constexpr double SAMPLED = 2e-3; /* [m] between points of a surface */
int states = 2000;

class Beside : public testing::TestWithParam<const char *> {
 protected:
  Beside() : model_(moveit::core::loadTestingRobotModel(GetParam())), fcl_(model_), ours_(model_) {
    ours_.setActiveCollisionDetector(curve_proximity::CollisionDetectorAllocatorCurveProximity::create(), true);
    state().setToDefaultValues();
  }

  static moveit::core::RobotState &stateOf(planning_scene::PlanningScene &scene) {
    return scene.getCurrentStateNonConst();
  }
  moveit::core::RobotState &state() {
    return stateOf(fcl_);
  }

  double random(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(generator_);
  }

  Eigen::Isometry3d randomPose() {
    Eigen::Isometry3d pose(Eigen::Quaterniond::UnitRandom());
    pose.translation() << random(-0.9, 0.9), random(-0.9, 0.9), random(0.0, 1.2);
    return pose;
  }

  shapes::ShapeConstPtr randomShape() {
    switch (below(4)) {
      case 0: return std::make_shared<shapes::Sphere>(random(0.02, 0.2));
      case 1: return std::make_shared<shapes::Cylinder>(random(0.02, 0.15), random(0.05, 0.5));
      case 2: {
        auto mesh = std::make_shared<shapes::Mesh>(4, 4);
        for (unsigned int i = 0; i < 12; ++i) mesh->vertices[i] = random(-0.2, 0.2);
        const unsigned int triangles[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
        std::copy(triangles, triangles + 12, mesh->triangles);
        mesh->computeTriangleNormals();
        mesh->computeVertexNormals();
        return mesh;
      }
      default: return std::make_shared<shapes::Box>(random(0.02, 0.4), random(0.02, 0.4), random(0.02, 0.4));
    }
  }

  template <typename Change>
  void onBoth(const Change &change) {
    change(fcl_);
    change(ours_);
  }

  std::string randomObject() {
    const std::vector<std::string> ids = fcl_.getWorld()->getObjectIds();
    return ids.empty() ? "" : ids[below(ids.size())];
  }
  std::string randomLink() {
    const auto &links = model_->getLinkModelsWithCollisionGeometry();
    return links[below(links.size())]->getName();
  }

  /* The same change of both scenes. */
  void changeScene() {
    const std::string object = randomObject(), link = randomLink();
    const Eigen::Isometry3d pose = randomPose();
    switch (below(10)) {
      case 0:
      case 1:
      case 2: {
        if (fcl_.getWorld()->size() > 12) return;
        const shapes::ShapeConstPtr shape = randomShape();
        const std::string id = "object" + std::to_string(next_++);
        onBoth([&](auto &scene) { scene.getWorldNonConst()->addToObject(id, shape, pose); });
        break;
      }
      case 3: onBoth([&](auto &scene) { scene.getWorldNonConst()->removeObject(object); }); break;
      case 4: onBoth([&](auto &scene) { scene.getWorldNonConst()->setObjectPose(object, pose); }); break;
      case 5: {
        const shapes::ShapeConstPtr shape = randomShape();
        if (!object.empty()) onBoth([&](auto &scene) { scene.getWorldNonConst()->addToObject(object, shape, pose); });
        break;
      }
      case 6: { // attached, or let go of
        if (state().hasAttachedBody("held")) {
          onBoth([](auto &scene) { stateOf(scene).clearAttachedBody("held"); });
          break;
        }
        const shapes::ShapeConstPtr shape = std::make_shared<shapes::Box>(0.05, 0.05, random(0.1, 0.4));
        const moveit::core::LinkModel *last = model_->getLinkModelsWithCollisionGeometry().back();
        std::vector<std::string> touch{last->getName()};
        if (last->getParentLinkModel()) touch.push_back(last->getParentLinkModel()->getName());
        onBoth([&](auto &scene) {
          stateOf(scene).attachBody("held", Eigen::Isometry3d::Identity(), {shape},
                                    {Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.25))}, touch, last->getName());
        });
        break;
      }
      case 7: {
        const bool allowed = below(2) > 0;
        if (!object.empty())
          onBoth([&](auto &scene) { scene.getAllowedCollisionMatrixNonConst().setEntry(object, link, allowed); });
        break;
      }
      case 8: {
        const double paddings[4] = {0.0, 0.005, 0.02, 0.05};
        setPadding(paddings[below(4)]);
        break;
      }
      default: {
        const bool allowed = below(2) > 0;
        if (!object.empty())
          onBoth([&](auto &scene) { scene.getAllowedCollisionMatrixNonConst().setDefaultEntry(object, allowed); });
        break;
      }
    }
  }

  void setPadding(double padding) {
    padding_ = padding;
    onBoth([&](auto &scene) { scene.getCollisionEnvNonConst()->setPadding(padding); });
  }

  void nextState() {
    state().setToRandomPositions();
    state().update();
    stateOf(ours_).setVariablePositions(state().getVariablePositions());
    stateOf(ours_).update();
  }

  /* What a body of no link is made of. */
  std::vector<std::unique_ptr<bodies::Body>> partsOf(const std::string &name) {
    std::vector<std::unique_ptr<bodies::Body>> out;
    const auto add = [&out](const std::vector<shapes::ShapeConstPtr> &shapes,
                            const EigenSTL::vector_Isometry3d &poses) {
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        out.emplace_back(bodies::createBodyFromShape(shapes[i].get()));
        out.back()->setPadding(-NEAR);
        out.back()->setPose(poses[i]);
      }
    };
    if (const cd::World::ObjectConstPtr object = fcl_.getWorld()->getObject(name)) {
      add(object->shapes_, object->global_shape_poses_);
    } else if (const moveit::core::AttachedBody *held = state().getAttachedBody(name)) {
      add(held->getShapes(), held->getGlobalCollisionBodyTransforms());
    }
    return out;
  }

  /* Asks about the corners of each triangle of a link's meshes, until the visitor returns true. */
  template <typename Visitor>
  bool anyTriangle(const moveit::core::LinkModel &link, const Visitor &visitor) {
    for (std::size_t i = 0; i < link.getShapes().size(); ++i) {
      const auto *mesh = dynamic_cast<const shapes::Mesh *>(link.getShapes()[i].get());
      if (!mesh) continue;
      const Eigen::Isometry3d pose = state().getCollisionBodyTransform(&link, i);
      for (unsigned int k = 0; k < mesh->triangle_count; ++k) {
        Eigen::Vector3d corner[3];
        for (unsigned int c = 0; c < 3; ++c)
          corner[c] =
              pose * Eigen::Vector3d(Eigen::Map<Eigen::Vector3d>(mesh->vertices + 3 * mesh->triangles[3 * k + c]));
        if (visitor(corner)) return true;
      }
    }
    return false;
  }

  /* Is a point of the link's surface deeper than NEAR inside the body? */
  bool meets(const moveit::core::LinkModel &link, const bodies::Body &body) {
    return anyTriangle(link, [&body](const Eigen::Vector3d(&corner)[3]) {
      const Eigen::Vector3d u = corner[1] - corner[0], v = corner[2] - corner[0];
      const int n = 1 + static_cast<int>(std::max({u.norm(), v.norm(), (u - v).norm()}) / SAMPLED);
      for (int a = 0; a <= n; ++a)
        for (int b = 0; a + b <= n; ++b)
          if (body.containsPoint(corner[0] + (a * u + b * v) / n)) return true;
      return false;
    });
  }

  /* Is a point of the body inside the link's closed mesh? By the solid angles of its triangles. */
  bool isWithin(const moveit::core::LinkModel &link, const bodies::Body &body) {
    random_numbers::RandomNumberGenerator generator(47);
    Eigen::Vector3d point;
    if (!body.samplePointInside(generator, 1000, point)) return false;
    double angle = 0.0;
    anyTriangle(link, [&](const Eigen::Vector3d(&corner)[3]) {
      const Eigen::Vector3d a = corner[0] - point, b = corner[1] - point, c = corner[2] - point;
      const double x = a.norm(), y = b.norm(), z = c.norm();
      angle += 2.0 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
      return false;
    });
    return std::abs(angle) > 2.0 * M_PI;
  }

  /* Of what ours alone finds in contact, without padding: does each pair touch in truth? Counts what is wholly inside a
   * link and what FCL misses. */
  bool areTrue(const cd::CollisionResult &ours) {
    bool misses = false;
    for (const auto &[names, contacts] : ours.contacts) {
      const bool first = model_->hasLinkModel(names.first);
      const std::string &link = first ? names.first : names.second, &other = first ? names.second : names.first;
      if (!model_->hasLinkModel(link)) return false;
      bool touches = false;
      for (const auto &body : partsOf(other)) {
        const bool crosses = meets(*model_->getLinkModel(link), *body);
        touches = touches || crosses || isWithin(*model_->getLinkModel(link), *body);
        misses = misses || crosses;
      }
      if (!touches) return false;
    }
    ++(misses ? missed_ : inside_);
    return !ours.contacts.empty();
  }

  cd::CollisionResult contactsOf(bool self) {
    cd::CollisionRequest req;
    cd::CollisionResult out;
    req.contacts = true;
    req.max_contacts = 1000;
    const auto &env = *ours_.getCollisionEnvUnpadded();
    if (self) {
      env.checkSelfCollision(req, out, stateOf(ours_), ours_.getAllowedCollisionMatrix());
    } else {
      env.checkRobotCollision(req, out, stateOf(ours_), ours_.getAllowedCollisionMatrix());
    }
    return out;
  }

  void compare() {
    for (int i = 0; i < states;) {
      changeScene();
      for (int k = 0; k < 5; ++k, ++i) {
        nextState();
        compareWithObjects(i);
        compareWithItself(i);
      }
    }
    std::cout << GetParam() << ": " << states << " states, " << hits_ << " in collision with objects, " << self_hits_
              << " with the robot itself; different because near " << near_ << ", because of a padding's corners "
              << corners_ << ", because inside " << inside_ << "; contacts that FCL misses " << missed_ << "\n";
    EXPECT_GT(hits_, states / 50);
    EXPECT_GT(self_hits_, states / 50);
  }

  static bool collides(planning_scene::PlanningScene &scene, bool self) {
    cd::CollisionResult res;
    if (self) {
      scene.checkSelfCollision({}, res);
    } else {
      scene.getCollisionEnv()->checkRobotCollision({}, res, stateOf(scene), scene.getAllowedCollisionMatrix());
    }
    return res.collision;
  }

  void compareWithObjects(int number) {
    const bool by_fcl = collides(fcl_, false), by_us = collides(ours_, false);
    hits_ += by_us;
    if (by_fcl == by_us) return;
    const double distance = ours_.getCollisionEnvUnpadded()->distanceRobot(state(), ours_.getAllowedCollisionMatrix());
    if (std::abs(distance) < NEAR || std::abs(distance - padding_) < NEAR) {
      ++near_;
    } else if (padding_ > 0.0 && std::abs(distance) < CORNER * padding_) {
      ++corners_;
    } else {
      EXPECT_TRUE(by_us && areTrue(contactsOf(false))) << "state " << number << ": FCL " << by_fcl << ", ours " << by_us
                                                       << ", distance " << distance << ", padding " << padding_;
    }
  }

  /* As MoveIt asks: without padding. The certifier leaves out links with fewer than two joints between them. */
  void compareWithItself(int number) {
    const bool by_fcl = collides(fcl_, true), by_us = collides(ours_, true);
    self_hits_ += by_us;
    const auto &env = dynamic_cast<const curve_proximity::CollisionEnvCurveProximity &>(*ours_.getCollisionEnv());
    if (by_fcl != by_us) {
      const double distance = ours_.getCollisionEnv()->distanceSelf(stateOf(ours_), ours_.getAllowedCollisionMatrix());
      if (std::abs(distance) < NEAR) {
        ++near_;
      } else {
        EXPECT_TRUE(by_us && areTrue(contactsOf(true)))
            << "state " << number << ": FCL " << by_fcl << ", ours " << by_us << ", distance " << distance
            << ", padding " << padding_;
      }
      return;
    }
    robot_trajectory::RobotTrajectory standing(model_, nullptr);
    standing.addSuffixWayPoint(stateOf(ours_), 0.0);
    const curve_proximity::RobotMotion motion =
        env.motion(curve_proximity::timed(standing), stateOf(ours_), ours_.getAllowedCollisionMatrix());
    curve_proximity::Query query;
    query.query_type = curve_proximity::QueryType::COLLISION;
    query.allow_empty = true;
    const curve_proximity::Answer answer = curve_proximity::askSelf(motion, query, workspace_);
    const bool is_clear = answer.result.verdict == CPROX_VERDICT_CLEAR;
    if (by_us && is_clear) {
      cd::CollisionRequest req;
      cd::CollisionResult res;
      req.contacts = true;
      req.max_contacts = 1000;
      ours_.checkSelfCollision(req, res);
      for (const auto &[names, contacts] : res.contacts)
        EXPECT_LT(jointsBetween(names.first, names.second), 2)
            << "state " << number << ": " << names.first << ", " << names.second << ", padding " << padding_;
    } else {
      EXPECT_EQ(is_clear, !by_us) << "state " << number << ", padding " << padding_ << ": " << answer.a << ", "
                                  << answer.b << " " << answer.message;
    }
  }

  int jointsBetween(const std::string &a, const std::string &b) {
    std::map<const moveit::core::JointModel *, int> on_path;
    for (const std::string &name : {a, b}) {
      if (!model_->hasLinkModel(name)) return 0; // what is carried: with its link
      for (const moveit::core::LinkModel *link = model_->getLinkModel(name); link; link = link->getParentLinkModel())
        ++on_path[link->getParentJointModel()];
    }
    int out = 0;
    for (const auto &[joint, times] : on_path) out += times == 1 && joint->getType() != moveit::core::JointModel::FIXED;
    return out;
  }

  moveit::core::RobotModelPtr model_;
  planning_scene::PlanningScene fcl_, ours_;
  curve_proximity::Workspace workspace_;
  std::mt19937 generator_{47};
  double padding_ = 0.0;
  int next_ = 0, hits_ = 0, self_hits_ = 0, near_ = 0, corners_ = 0, inside_ = 0, missed_ = 0;
};

} // namespace

TEST_P(Beside, random_operations_leave_both_detectors_with_one_answer) {
  compare();
}

/* Padded links stand nearer to objects, and no nearer to each other. */
TEST_P(Beside, a_padding_counts_against_objects_alone) {
  for (const double padding : {0.0, 0.005, 0.02, 0.05}) {
    setPadding(padding);
    for (int i = 0; i < states / 20; ++i) {
      nextState();
      compareWithItself(i);
      compareWithObjects(i);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, Beside, testing::Values("panda", "fanuc"));

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc > 1) states = std::stoi(argv[1]);
  ros::Time::init();
  return RUN_ALL_TESTS();
}
