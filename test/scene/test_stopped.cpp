/* SPDX-License-Identifier: BSD-3-Clause */
/* Every question about every kind of subject, stopped at its first, second, middle and last look: nothing that it says
 * contradicts the complete answer, nothing that is left out is nearer than what it says of the rest, and what has not
 * been looked at to the end never says so. */
#include <algorithm>

#include "query/subject.h"
#include "support.h"

namespace curve_proximity {
namespace {

using test::add;
using test::change;
using test::dataRobot;
using test::Random;
using test::shape;
using test::translation;

constexpr double DELTA = 0.15, CLOSE = 1e-5;

struct Looks {
  unsigned seen = 0, stop_at = 0; /* 0: never */
};

bool look(void *user) {
  auto *looks = static_cast<Looks *>(user);
  return ++looks->seen >= looks->stop_at && looks->stop_at > 0;
}

struct Asked {
  std::string name;
  Question question;
  QueryType type;
  bool per_object;
};

std::vector<Asked> allQuestions() {
  const double endless = std::numeric_limits<double>::infinity();
  std::vector<Asked> all;
  for (const bool each : {false, true}) {
    const std::string of = each ? " of each" : "";
    all.push_back({"distance" + of, question::Search{}, QueryType::DISTANCE, each});
    all.push_back({"tolerance" + of, question::Search{}, QueryType::TOLERANCE, each});
    all.push_back({"collision" + of, question::Search{}, QueryType::COLLISION, each});
  }
  all.push_back({"gradient", question::Gradient{}, QueryType::DISTANCE, false});
  all.push_back({"nearest pairs", question::Nearest{{4, endless}}, QueryType::DISTANCE, false});
  all.push_back({"pairs within", question::Nearest{{1000, 0.5}}, QueryType::DISTANCE, false});
  all.push_back({"time of contact", question::Contact{}, QueryType::COLLISION, false});
  all.push_back({"profile", question::Profile{6, {}, endless}, QueryType::DISTANCE, false});
  all.push_back({"violations", question::Violations{}, QueryType::TOLERANCE, false});
  return all;
}

/* ---- what must hold ---- */

bool contradict(cprox_verdict a, cprox_verdict b) {
  return a != b && a != CPROX_VERDICT_UNDECIDED && b != CPROX_VERDICT_UNDECIDED;
}

void expectCommon(double lower, double upper, const cprox_result &full) {
  EXPECT_LE(lower, upper);
  EXPECT_LE(lower, full.upper + CLOSE);
  EXPECT_GE(upper, full.lower - CLOSE);
}

void expectAnswer(const Answer &full, const Answer &cut) {
  ASSERT_GE(cut.result.status, 0) << cut.message;
  expectCommon(cut.result.lower, cut.result.upper, full.result);
  EXPECT_FALSE(contradict(full.result.verdict, cut.result.verdict));
  if (!full.gap) {
    EXPECT_EQ(cut.result.status == CPROX_STOPPED, cut.status == "stopped");
  }
  if (full.result.verdict == CPROX_VERDICT_VIOLATED) {
    EXPECT_LE(cut.result.t_contact_lower, full.result.t + CLOSE);
  }
}

/* A pair that is not listed is at least as far as the row of all others says. */
void expectPairs(const std::vector<Row> &full, const std::vector<Row> &cut, double within) {
  double others = within;
  bool complete = true;
  for (const Row &row : cut) {
    EXPECT_LE(row.answer.result.lower, row.answer.result.upper);
    if (row.answer.is_unlisted) others = std::min(others, row.answer.result.lower), complete = false;
  }
  for (const Row &row : full) {
    const Answer &pair = row.answer;
    if (pair.is_unlisted) continue;
    const auto again = std::find_if(cut.begin(), cut.end(), [&](const Row &other) {
      return !other.answer.is_unlisted && other.answer.a == pair.a && other.answer.b == pair.b &&
             other.answer.result.obstacle_index == pair.result.obstacle_index &&
             other.answer.result.mover_part == pair.result.mover_part;
    });
    if (again != cut.end()) {
      expectCommon(again->answer.result.lower, again->answer.result.upper, pair.result);
    } else {
      EXPECT_FALSE(complete) << pair.a << " and " << pair.b << " are left out in silence";
      EXPECT_LE(others, pair.result.upper + CLOSE);
    }
  }
}

void expectProfile(const std::vector<ClearanceInterval> &full, const std::vector<ClearanceInterval> &cut) {
  ASSERT_EQ(full.size(), cut.size());
  for (std::size_t i = 0; i < full.size(); ++i) {
    EXPECT_LE(cut[i].lower, full[i].upper + CLOSE);
    EXPECT_GE(cut[i].upper, full[i].lower - CLOSE);
    if (cut[i].status == CPROX_OK) {
      EXPECT_LE(cut[i].upper - cut[i].lower, CLOSE);
    }
  }
}

void expectViolations(const Violations &full, const Violations &cut) {
  for (const Violation &known : full.list) {
    if (known.verdict != CPROX_VERDICT_VIOLATED) continue;
    EXPECT_TRUE(std::any_of(cut.list.begin(), cut.list.end(),
                            [&](const Violation &open) {
                              return open.enter_lower <= known.enter_upper + CLOSE &&
                                     known.leave_lower <= open.leave_upper + CLOSE;
                            }))
        << known.enter_upper << " to " << known.leave_lower << " is left out";
  }
  for (const Violation &claimed : cut.list) {
    if (claimed.verdict != CPROX_VERDICT_VIOLATED) continue;
    const double middle = 0.5 * (claimed.enter_upper + claimed.leave_lower);
    EXPECT_TRUE(std::any_of(full.list.begin(), full.list.end(),
                            [&](const Violation &known) {
                              return known.enter_lower - CLOSE <= middle && middle <= known.leave_upper + CLOSE;
                            }))
        << middle << " is not within delta";
  }
}

void expectRows(const Asked &asked, const std::vector<Row> &full, const std::vector<Row> &cut) {
  if (const auto *nearest = std::get_if<question::Nearest>(&asked.question)) {
    expectPairs(full, cut, nearest->limits.within);
    return;
  }
  ASSERT_EQ(full.size(), cut.size());
  for (std::size_t i = 0; i < full.size(); ++i) {
    if (const auto *profile = std::get_if<std::vector<ClearanceInterval>>(&full[i].detail))
      expectProfile(*profile, std::get<std::vector<ClearanceInterval>>(cut[i].detail));
    else if (const auto *violations = std::get_if<Violations>(&full[i].detail))
      expectViolations(*violations, std::get<Violations>(cut[i].detail));
    else
      expectAnswer(full[i].answer, cut[i].answer);
  }
}

bool saysStopped(const std::vector<Row> &rows) {
  return std::any_of(rows.begin(), rows.end(), [](const Row &row) {
    if (const auto *profile = std::get_if<std::vector<ClearanceInterval>>(&row.detail))
      return std::any_of(profile->begin(), profile->end(),
                         [](const ClearanceInterval &i) { return i.status == CPROX_STOPPED; });
    if (const auto *violations = std::get_if<Violations>(&row.detail)) return violations->status == CPROX_STOPPED;
    return row.answer.result.status == CPROX_STOPPED;
  });
}

struct Count {
  std::size_t answered = 0, stopped = 0;
};

/* Targets hold the query that they are made for: they are made anew for each. */
using SubjectFor = std::function<void(const Query &, const std::function<void(const Subject &)> &)>;

std::vector<Row> rowsOf(const SubjectFor &subject, const Asked &asked, Looks &looks, Workspace &workspace) {
  Query query;
  query.query_type = asked.type;
  query.delta = asked.type == QueryType::TOLERANCE ? DELTA : 0.0;
  query.per_object = asked.per_object;
  query.options.stop = look;
  query.options.stop_user = &looks;
  std::vector<Row> rows;
  subject(query, [&](const Subject &made) {
    looks.seen = 0; /* not those of making it */
    rows = answerParts(made, partsOf(made, asked.question, query, false), asked.question, query, Beside::NOTHING,
                       workspace);
  });
  return rows;
}

Count stopAll(const SubjectFor &subject) {
  Workspace workspace;
  Count count;
  for (const Asked &asked : allQuestions()) {
    SCOPED_TRACE(asked.name);
    Looks looks;
    std::vector<Row> full;
    try {
      full = rowsOf(subject, asked, looks, workspace);
    } catch (const Error &) {
      continue; /* the subject has no answer to this */
    }
    if (full.empty() || full.front().answer.result.status < 0) continue;
    ++count.answered;
    const unsigned all = looks.seen;
    for (const unsigned at : {1u, 2u, all / 2, all}) {
      if (at == 0 || at > all) continue;
      SCOPED_TRACE("stopped at look " + std::to_string(at) + " of " + std::to_string(all));
      Looks cut{0, at};
      const std::vector<Row> rows = rowsOf(subject, asked, cut, workspace);
      expectRows(asked, full, rows);
      count.stopped += saysStopped(rows);
    }
  }
  return count;
}

/* ---- the subjects ---- */

struct Stopped : ::testing::Test {
  Scene scene{dataRobot("panda")};
  Random random{606};

  void SetUp() override {
    std::vector<Operation> operations;
    for (int i = 0; i < 6; ++i) {
      const auto type = i % 3 == 0 ? ShapeType::BOX : i % 3 == 1 ? ShapeType::SPHERE : ShapeType::CYLINDER;
      const std::vector<double> size = i % 3 == 0   ? std::vector<double>{0.1, 0.2, 0.3}
                                       : i % 3 == 1 ? std::vector<double>{0.08}
                                                    : std::vector<double>{0.3, 0.05};
      Eigen::Isometry3d pose = random.pose(0.3);
      pose.translation() += Eigen::Vector3d(i % 2 ? 0.6 : -0.7, i < 3 ? 0.4 : -0.5, 0.6);
      operations.push_back(add("thing" + std::to_string(i), {shape(type, size)}, pose));
    }
    ASSERT_TRUE(scene.apply(change(operations)).empty());
  }

  std::shared_ptr<const RobotMotion> motion(std::size_t points) {
    TrajectoryDescription t;
    t.id = "arm";
    for (int j = 1; j <= 7; ++j) t.joints.push_back("panda_joint" + std::to_string(j));
    for (std::size_t i = 0; i < points; ++i) {
      TrajectoryPoint point;
      const double rest[7] = {0, -0.5, 0, -2.2, 0, 1.8, 0.7};
      for (const double at : rest) point.positions.push_back(at + random.uniform(-0.5, 0.5));
      point.time = static_cast<double>(i);
      t.points.push_back(point);
    }
    return std::make_shared<const RobotMotion>(scene.snapshot(), t, JointPositions{},
                                               std::vector<std::array<std::string, 2>>{},
                                               Eigen::Isometry3d::Identity());
  }
};

TEST_F(Stopped, a_curve_says_what_it_knows) {
  for (int i = 0; i < 6; ++i) {
    const CurveDescription description = test::randomBezier(random, 5, 0.9);
    const CompiledCurve curve = compile(description);
    const Count count = stopAll([&](const Query &query, const std::function<void(const Subject &)> &then) {
      const SceneObstacles targets(scene.snapshot(), {}, query);
      then(CurveSubject{targets, curve, &description});
    });
    EXPECT_GE(count.answered, 11u);
    EXPECT_GE(count.stopped, 11u);
  }
}

TEST_F(Stopped, an_arm_says_what_it_knows) {
  for (const std::size_t points : {1u, 2u, 5u}) {
    const auto arm = motion(points);
    for (const bool self : {false, true}) {
      SCOPED_TRACE(std::to_string(points) + (self ? " points, itself" : " points"));
      const Count count = stopAll([&](const Query &, const std::function<void(const Subject &)> &then) {
        then(MotionSubject{*arm, self});
      });
      EXPECT_GE(count.answered, 8u);
      EXPECT_GE(count.stopped, 8u);
    }
  }
}

TEST_F(Stopped, an_arm_with_errors_says_what_it_knows) {
  ErrorBounds errors;
  errors.every_joint.tracking = 0.002;
  const auto arm = motion(3);
  for (const bool self : {false, true}) {
    const Count count = stopAll([&](const Query &, const std::function<void(const Subject &)> &then) {
      then(MotionSubject{*arm, self, &errors});
    });
    EXPECT_GE(count.answered, 4u);
    EXPECT_GE(count.stopped, 4u);
  }
}

TEST_F(Stopped, movers_say_what_they_know) {
  const auto arm = motion(4);
  MovingObject cart;
  cart.object.id = "cart";
  cart.object.shapes = {shape(ShapeType::BOX, {0.3, 0.2, 0.2})};
  for (int i = 0; i < 3; ++i) cart.poses.push_back({static_cast<double>(i), translation(1.0 - 0.6 * i, 0.7, 0.4)});
  const MovingRobot robot{"arm", arm, 0.5};
  const Movers movers(scene.snapshot(), {robot}, {cart});
  for (const Against against : {Against::OBJECTS, Against::MOVERS, Against::BOTH, Against::OTHERS}) {
    const Count count = stopAll([&](const Query &, const std::function<void(const Subject &)> &then) {
      then(MoversSubject{movers, nullptr, against, "", {}});
    });
    EXPECT_GE(count.answered, 8u);
    EXPECT_GE(count.stopped, 8u);
  }
  for (const bool body : {false, true}) {
    const Count count = stopAll([&](const Query &, const std::function<void(const Subject &)> &then) {
      then(MoversSubject{movers, body ? nullptr : &robot, Against::OTHERS, body ? "cart" : "", {0.0, 2.0}});
    });
    EXPECT_GE(count.answered, 8u);
    EXPECT_GE(count.stopped, 8u);
  }
}

} // namespace
} // namespace curve_proximity
