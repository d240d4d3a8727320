/* SPDX-License-Identifier: BSD-3-Clause */
/* What is wrong is told in a line that names it. */
#include "support.h"

#include <cmath>
#include <limits>

namespace curve_proximity {
namespace {

std::string error_of(const std::function<void()> &work) {
  return messageOf(work);
}

#define EXPECT_SAYS(message, word) EXPECT_NE((message).find(word), std::string::npos) << (message)

std::string refusal(const std::string &type, const ParameterMap &parameters) {
  try {
    const ProviderSet set({{"good", "curve_proximity/CurveDistance", {}}, {"bad", type, parameters}});
    return "";
  } catch (const ProviderError &error) {
    EXPECT_EQ(error.place(), 1u);
    return error.what();
  }
}

TEST(Parameters, of_a_wrong_name_type_or_value_are_refused_by_name) {
  const std::string curve = "curve_proximity/CurveDistance", pair = "curve_proximity/SuperquadricDistance",
                    gap = "curve_proximity/FourierGap";
  EXPECT_EQ(refusal(curve, {}), "");
  EXPECT_EQ(refusal(curve, {{"epsilon", 1}, {"signed", true}, {"margin", 0.5}}), "");
  EXPECT_SAYS(refusal(curve, {{"epsilo", 1e-9}}), "parameter epsilo: there is no such parameter");
  EXPECT_SAYS(refusal(curve, {{"epsilon", std::string("small")}}), "parameter epsilon: a number is expected");
  EXPECT_SAYS(refusal(curve, {{"epsilon", -1.0}}), "parameter epsilon: -1 is not at least 0");
  EXPECT_SAYS(refusal(curve, {{"epsilon", NAN}}), "parameter epsilon");
  EXPECT_SAYS(refusal(curve, {{"max_nodes", 0}}), "parameter max_nodes");
  EXPECT_SAYS(refusal(curve, {{"max_nodes", 2.5}}), "parameter max_nodes: a whole number");
  EXPECT_SAYS(refusal(curve, {{"signed", 1}}), "parameter signed: true or false");
  EXPECT_SAYS(refusal(curve, {{"margin", std::vector<double>{1, 2}}}), "parameter margin");
  EXPECT_SAYS(refusal(pair, {{"most_exponent", 1.5}}),
              "parameter most_exponent: 1.5 is not at least 2 and at most 1000");
  EXPECT_SAYS(refusal(gap, {{"mode", std::string("sure")}}),
              "parameter mode: 'sure' is none of certified, guide, signal");
  EXPECT_SAYS(refusal(gap, {{"mode", std::string("tuned")}}), "falls again outwards beyond contact");
  EXPECT_SAYS(refusal(gap, {{"mode", std::string("guide")}, {"delta", 0.1}}), "parameter delta");
  EXPECT_SAYS(refusal(gap, {{"mode", std::string("guide")}, {"samples", 7}}), "parameter samples");
  EXPECT_SAYS(refusal(gap, {{"mode", std::string("guide")}, {"dimension", 2}}), "guide is for space");
  EXPECT_SAYS(refusal(gap, {{"mode", 3}}), "parameter mode");
  EXPECT_SAYS(refusal(gap, {{"dimension", 4}}), "parameter dimension");
  EXPECT_SAYS(refusal(gap, {{"samples", 16}}), "parameter samples");
  EXPECT_SAYS(refusal(gap, {{"samples", 1}}), "parameter samples");
  EXPECT_SAYS(refusal(gap, {{"level", 1.0}}), "parameter level");
}

TEST(Providers, that_no_package_declares_are_refused_with_those_that_are) {
  const std::string why = refusal("curve_proximity/NoSuchThing", {});
  EXPECT_SAYS(why, "'curve_proximity/NoSuchThing'");
  EXPECT_SAYS(why, "curve_proximity/FourierGap");
}

TEST(Providers, of_the_same_name_are_refused) {
  EXPECT_SAYS(error_of([] {
                const ProviderSet set(
                    {{"one", "curve_proximity/CurveDistance", {}}, {"one", "curve_proximity/FourierGap", {}}});
              }),
              "'one' is given twice");
}

TEST(Pairs, that_a_provider_cannot_answer_for_are_refused_by_type) {
  const Loaded curve("curve_proximity/CurveDistance", {}), pair("curve_proximity/SuperquadricDistance", {}),
      gap("curve_proximity/FourierGap", {}), plane("curve_proximity/FourierGap", {{"dimension", 2}});
  ConstraintPair standing;
  standing.a = side({shape(ShapeType::SPHERE, {0.1})});
  standing.b = side({shape(ShapeType::HALFSPACE, {0, 0, 1, 0})});
  ConstraintPair along = standing;
  along.along_curve = true;
  EXPECT_EQ(error_of([&] { curve->prepare(standing); }), "");
  EXPECT_EQ(error_of([&] { pair->prepare(along); }), "");
  standing.is_named = along.is_named = false;
  EXPECT_SAYS(error_of([&] { curve->prepare(standing); }), "SuperquadricDistance answers about standing bodies");
  ConstraintPair balls = standing;
  balls.b = balls.a;
  const Loaded growth("curve_proximity/GrowthDistance", {});
  EXPECT_SAYS(error_of([&] { growth->prepare(balls); }), "SuperquadricDistance answers about standing bodies");
  balls.is_named = true;
  EXPECT_EQ(error_of([&] { growth->prepare(balls); }), "");
  EXPECT_SAYS(error_of([&] { pair->prepare(along); }), "CurveDistance answers about curves");
  const Loaded round("curve_proximity/SuperquadricDistance", {{"most_exponent", 8.0}});
  along.is_named = true;
  EXPECT_SAYS(error_of([&] { round->prepare(along); }), "most_exponent is about standing bodies");
  EXPECT_SAYS(error_of([&] { gap->prepare(along); }), "side b: halfspace");
  EXPECT_SAYS(error_of([&] { gap->prepare(standing); }), "side b: halfspace");
  EXPECT_EQ(error_of([&] { pair->prepare(standing); }), "");
  standing.b = side({shape(ShapeType::CONE, {1, 1})});
  EXPECT_EQ(error_of([&] { gap->prepare(standing); }), "");
  EXPECT_EQ(error_of([&] { plane->prepare(standing); }), ""); // its section is a disc
  standing.b = side({shape(ShapeType::HALFSPACE, {0, 0, 1, 0})});
  EXPECT_SAYS(error_of([&] { plane->prepare(standing); }), "side b: halfspace");
  standing.b = {};
  EXPECT_SAYS(error_of([&] { pair->prepare(standing); }), "side b has no shape");
  EXPECT_SAYS(error_of([&] { gap->prepare(standing); }), "side b");
}

TEST(Places, that_do_not_suit_the_pair_are_refused) {
  const Loaded curve("curve_proximity/CurveDistance", {}), pair("curve_proximity/SuperquadricDistance", {});
  ConstraintPair standing;
  standing.a = standing.b = side({shape(ShapeType::SPHERE, {0.1})});
  ConstraintPair along = standing;
  along.along_curve = true;
  ConstraintCurve line;
  line.description.points = Eigen::Matrix3Xd::Identity(3, 2);
  line.curve = compile(line.description).curve;
  ConstraintPlace with_curve, without;
  with_curve.curve = &line;
  Workspace workspace;
  EXPECT_SAYS(error_of([&] { curve->evaluate(along, without, workspace); }), "there is none");
  EXPECT_SAYS(error_of([&] { pair->evaluate(standing, with_curve, workspace); }), "not along one");
  ConstraintPlace broken;
  broken.b.orientation = {0, 0, 0, 0};
  EXPECT_NE(error_of([&] { pair->evaluate(standing, broken, workspace); }), "");
  broken = without;
  broken.a.position.x = NAN;
  EXPECT_NE(error_of([&] { pair->evaluate(standing, broken, workspace); }), "");
}

/* The case reader refuses them too; these come from C++ itself. */
TEST(Places, without_a_rotation_and_sides_with_a_padding_below_0_are_refused_by_all_providers) {
  Workspace workspace;
  for (const char *type : {"CurveDistance", "SuperquadricDistance", "GrowthDistance", "FourierGap"}) {
    const Loaded provider(std::string("curve_proximity/") + type, {});
    ConstraintPair standing;
    standing.a = standing.b = side({shape(ShapeType::BOX, {0.2, 0.3, 0.4})});
    for (const double x : {0.0, 1e-200, 1e200, std::numeric_limits<double>::quiet_NaN()}) {
      ConstraintPlace broken;
      broken.b.orientation = {0.0, x, 0.0, 0.0};
      EXPECT_SAYS(error_of([&] { provider->evaluate(standing, broken, workspace); }), "quaternion");
    }
    for (const double padding : {-0.05, std::numeric_limits<double>::quiet_NaN()}) {
      standing.a.padding = padding;
      EXPECT_NE(error_of([&] { provider->evaluate(standing, {}, workspace); }), "") << type << ' ' << padding;
    }
  }
}

TEST(Cases, that_are_wrong_become_rows_and_the_others_are_answered) {
  ProviderSet set(
      {{"curves", "curve_proximity/CurveDistance", {}}, {"pairs", "curve_proximity/SuperquadricDistance", {}}});
  Workspace workspace;
  ConstraintCase asked;
  asked.id = "x";
  asked.a.shapes = asked.b.shapes = {shape(ShapeType::SPHERE, {0.5})};
  asked.b.pose.translation().x() = 3.0;

  // By name: both answer, and alike.
  asked.providers = {"curves", "pairs"};
  std::vector<ConstraintRow> rows = answerCase(set, asked, {}, workspace);
  ASSERT_EQ(rows.size(), 2u);
  for (const ConstraintRow &row : rows) {
    EXPECT_EQ(row.status, CPROX_OK) << row.message;
    EXPECT_NEAR(row.value.value, 2.0, 1e-9);
  }

  // Without names those that apply; what is wrong with the case is told by them.
  asked.providers.clear();
  rows = answerCase(set, asked, {}, workspace);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].provider, "pairs");
  EXPECT_EQ(rows[0].status, CPROX_OK);
  ProviderSet curves(std::vector<ProviderSpec>{{"curves", "curve_proximity/CurveDistance", {}}});
  rows = answerCase(curves, asked, {}, workspace);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].status, CPROX_INVALID);
  EXPECT_SAYS(rows[0].message, "no constraint provider applies");

  asked.providers = {"nobody", "pairs"};
  rows = answerCase(set, asked, {}, workspace);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_SAYS(rows[0].message, "there is no provider 'nobody'");
  EXPECT_EQ(rows[1].status, CPROX_OK);

  asked.providers = {"pairs"};
  asked.a.shapes[0].dimensions = {-1.0};
  EXPECT_SAYS(answerCase(set, asked, {}, workspace)[0].message, "a: shape 0: sphere dimension 0");
  asked.a.shapes[0].dimensions = {1.0};
  asked.a.padding = -1.0;
  EXPECT_SAYS(answerCase(set, asked, {}, workspace)[0].message, "padding");
  asked.a.padding = 0.0;
  asked.b.pose.translation().x() = NAN;
  EXPECT_SAYS(answerCase(set, asked, {}, workspace)[0].message, "b: the pose");
  asked.b.pose.setIdentity();
  asked.curve = CurveDescription();
  asked.curve->basis = "nurbs";
  EXPECT_SAYS(answerCase(set, asked, {}, workspace)[0].message, "nurbs");

  asked.providers.clear();
  ProviderSet none({});
  EXPECT_SAYS(answerCase(none, asked, {}, workspace)[0].message, "there are no constraint providers");
}

TEST(Sentences, are_made_of_whatever_is_thrown) {
  EXPECT_EQ(messageOf([] {}), "");
  EXPECT_EQ(messageOf([] { throw Error("so"); }), "so");
  EXPECT_EQ(messageOf([] { throw std::bad_alloc(); }), "out of memory");
  EXPECT_EQ(messageOf([] { throw 7; }), "it threw what is no exception");
  EXPECT_NE(messageOf([] { throw std::runtime_error(""); }), "");
}

} // namespace
} // namespace curve_proximity
