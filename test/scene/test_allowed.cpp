/* SPDX-License-Identifier: BSD-3-Clause */
/* The allowed collision matrix, through C++ and scene files, against a model of what moveit_msgs says of it. The
 * messages' side is in test/ros/states.py. */
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include <curve_proximity/motion.hpp>
#include <curve_proximity/srdf.hpp>

#include "support.h"
#include "yaml/bad_input.h"
#include "yaml/scene_yaml.h"

namespace curve_proximity {
namespace {

using test::add;
using test::expectContains;
using test::Random;
using test::shape;
using test::translation;

/* What is said of a pair or a name. */
enum Word { NOTHING, NO, YES };
constexpr std::array<Word, 3> WORDS = {NOTHING, NO, YES};

/* moveit_msgs/AllowedCollisionMatrix as a table, written from its text: rows by what is said of a, columns of b. */
bool allowedByTheText(Word pair, Word a, Word b) {
  constexpr std::array<std::array<bool, 3>, 3> DEFAULTS = {{
      {false, false, true},  /* nothing of a */
      {false, false, false}, /* a: no */
      {true, false, true},   /* a: yes, and so must b be where something is said of b */
  }};
  return pair == NOTHING ? DEFAULTS[a][b] : pair == YES;
}

void say(std::vector<AllowedPair> &matrix, const std::string &a, const std::string &b, Word word) {
  if (word != NOTHING) matrix.push_back({a, b, word == YES});
}

/* Calls work(pair, a, b) for everything that can be said. */
template <class Work>
void forAll(Work work) {
  for (const Word pair : WORDS)
    for (const Word a : WORDS)
      for (const Word b : WORDS) {
        SCOPED_TRACE("pair " + std::to_string(pair) + ", defaults " + std::to_string(a) + " and " + std::to_string(b));
        work(pair, a, b);
      }
}

/* A file of its own, away when the test is over. */
class SceneText {
 public:
  SceneText() : path_(std::filesystem::temp_directory_path() / ("allowed_" + std::to_string(::getpid()) + ".yaml")) {}
  ~SceneText() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  std::vector<AllowedPair> read(const std::string &matrix) const {
    std::ofstream(path_) << "world: {collision_objects: []}\nallowed_collision_matrix: {" << matrix << "}\n";
    yaml::Warnings warnings;
    std::vector<AllowedPair> out = yaml::readScene(path_.string(), warnings).allowed;
    EXPECT_TRUE(warnings.messages().empty());
    return out;
  }
  std::string refusal(const std::string &matrix) const {
    try {
      read(matrix);
    } catch (const yaml::BadUsage &error) {
      return error.what();
    }
    ADD_FAILURE() << "accepted: " << matrix;
    return "";
  }

 private:
  const std::filesystem::path path_;
};

const char *word(bool value) {
  return value ? "true" : "false";
}

/* The matrix of two names as a file has it; `rows` as AllowedCollisionEntry prints them. */
std::string matrixText(Word pair, Word a, Word b, bool rows) {
  std::string text, names, values;
  if (pair != NOTHING) {
    const std::string value = word(pair == YES), open = rows ? "{enabled: [" : "[", close = rows ? "]}" : "]";
    text = "entry_names: [cart, wall], entry_values: [" + open + "false, " + value + close + ", " + open + value +
           ", false" + close + "], ";
  }
  if (a != NOTHING) names = "cart", values = word(a == YES);
  if (b != NOTHING) names += std::string(names.empty() ? "" : ", ") + "wall";
  if (b != NOTHING) values += std::string(values.empty() ? "" : ", ") + word(b == YES);
  return text + "default_entry_names: [" + names + "], default_entry_values: [" + values + "]";
}

TEST(Allowed, everything_that_can_be_said_of_a_pair_means_what_moveit_msgs_says) {
  forAll([](Word pair, Word a, Word b) {
    std::vector<AllowedPair> said;
    say(said, "cart", "wall", pair);
    say(said, "cart", "", a);
    say(said, "wall", "", b);
    std::array<std::size_t, 3> order = {0, 1, 2};
    do { /* in every order, the pair both ways round */
      for (const bool turned : {false, true}) {
        Scene scene;
        SceneChange change;
        for (const std::size_t i : order)
          if (i < said.size()) change.allowed.push_back(said[i]);
        for (AllowedPair &entry : change.allowed)
          if (turned && !entry.b.empty()) std::swap(entry.a, entry.b);
        ASSERT_TRUE(scene.apply(change).empty());
        EXPECT_EQ(scene.snapshot()->mayTouch("cart", "wall"), allowedByTheText(pair, a, b));
        EXPECT_EQ(scene.snapshot()->mayTouch("wall", "cart"), allowedByTheText(pair, a, b));
        EXPECT_FALSE(scene.snapshot()->mayTouch("post", "hand"));
        EXPECT_EQ(scene.snapshot()->mayTouch("cart", "post"), a == YES);
      }
    } while (std::next_permutation(order.begin(), order.end()));
  });
}

TEST(Allowed, scene_files_say_the_same) {
  const SceneText file;
  forAll([&](Word pair, Word a, Word b) {
    for (const bool rows : {false, true}) {
      Scene scene;
      SceneChange change;
      change.allowed = file.read(matrixText(pair, a, b, rows));
      ASSERT_TRUE(scene.apply(change).empty());
      EXPECT_EQ(scene.snapshot()->mayTouch("cart", "wall"), allowedByTheText(pair, a, b));
    }
  });
}

/* A cart on a rail along x that carries a ball, an arm on it that swings about y, a hand on the arm. */
const char *SLIDER = R"(<robot name="slider">
  <link name="rail"/>
  <link name="cart"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="arm"/>
  <link name="hand"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="swing" type="continuous"><parent link="cart"/><child link="arm"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/></joint>
  <joint name="wrist" type="continuous"><parent link="arm"/><child link="hand"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/></joint>
</robot>)";

/* Link and object, carried object and object, link and link, carried object and link. */
TEST(Allowed, pairs_of_every_kind_are_left_out_by_the_matrix_and_by_nothing_else) {
  const std::array<std::array<std::string, 2>, 4> kinds = {
      {{"cart", "wall"}, {"held", "wall"}, {"cart", "hand"}, {"held", "hand"}}};
  for (const auto &names : kinds) {
    forAll([&](Word pair, Word a, Word b) {
      Scene scene(Robot::fromUrdf(SLIDER));
      SceneChange change = test::change({add("wall", {shape(ShapeType::BOX, {1, 4, 4})}, translation(3.5, 0, 0))});
      Attachment held;
      held.link = "cart";
      held.object = add("held", {shape(ShapeType::SPHERE, {0.1})}, translation(0.5, 0, 0)).object;
      change.attachments.push_back(held);
      say(change.allowed, names[0], names[1], pair);
      say(change.allowed, names[0], "", a);
      say(change.allowed, names[1], "", b);
      ASSERT_TRUE(scene.apply(change).empty());

      TrajectoryDescription t;
      t.id = "go";
      t.joints = {"slide", "swing"};
      t.points = {{{0, 0}, {}, {}, 0.0}, {{1, 1}, {}, {}, 1.0}};
      const RobotMotion motion(scene.snapshot(), t, {});
      const bool out = std::any_of(motion.skipped().begin(), motion.skipped().end(), [&](const std::string &message) {
        return message.find("allowed to touch") != std::string::npos &&
               message.find("'" + names[0] + "'") != std::string::npos &&
               message.find("'" + names[1] + "'") != std::string::npos;
      });
      EXPECT_EQ(out, allowedByTheText(pair, a, b)) << names[0] << " " << names[1];
    });
  }
}

/* ---- what an SRDF says ---- */

/* The cart's and the hand's pairs that are asked about, of a scene of a wall and a held object. */
struct Asked {
  bool cart_wall, hand_wall, held_wall, cart_hand, held_hand;
  bool operator==(const Asked &o) const {
    return cart_wall == o.cart_wall && hand_wall == o.hand_wall && held_wall == o.held_wall &&
           cart_hand == o.cart_hand && held_hand == o.held_hand;
  }
};

Asked askedOf(const std::string &inside, const std::vector<AllowedPair> &said = {}, bool clear = false) {
  const Srdf srdf = parseSrdf("<robot name='r'>" + inside + "</robot>");
  Scene scene(Robot::fromUrdf(SLIDER), {}, allowedPairs(srdf));
  if (clear) {
    SceneChange away;
    away.clear = true;
    away.allowed = {{"cart", "", false}};
    EXPECT_TRUE(scene.apply(away).empty());
    away.allowed.clear();
    EXPECT_TRUE(scene.apply(away).empty());
  }
  SceneChange change = test::change({add("wall", {shape(ShapeType::BOX, {1, 4, 4})}, translation(3.5, 0, 0))});
  Attachment held;
  held.link = "cart";
  held.object = add("held", {shape(ShapeType::SPHERE, {0.1})}, translation(0.5, 0, 0)).object;
  change.attachments.push_back(held);
  change.allowed = said;
  EXPECT_TRUE(scene.apply(change).empty());
  TrajectoryDescription t;
  t.id = "go";
  t.joints = {"slide", "swing"};
  t.points = {{{0, 0}, {}, {}, 0.0}, {{1, 1}, {}, {}, 1.0}};
  const RobotMotion motion(scene.snapshot(), t, {}, srdf.disabled);
  const auto asked = [&](const std::string &a, const std::string &b) {
    return std::none_of(motion.skipped().begin(), motion.skipped().end(), [&](const std::string &message) {
      return message.find("'" + a + "'") != std::string::npos && message.find("'" + b + "'") != std::string::npos;
    });
  };
  return {asked("cart", "wall"), asked("hand", "wall"), asked("held", "wall"), asked("cart", "hand"),
          asked("held", "hand")};
}

/* As MoveIt enters them: a default of the link, which meets objects too; an entry beats it; disable_collisions beats
 * all. */
TEST(Allowed, links_that_an_srdf_disables_by_default_may_touch_everything_but_what_it_enables) {
  const std::string by_default = "<disable_default_collisions link='hand'/>",
                    enable = "<enable_collisions link1='hand' link2='cart'/>",
                    disable = "<disable_collisions link1='cart' link2='hand' reason='Never'/>";
  EXPECT_EQ(askedOf(""), (Asked{true, true, true, true, true}));
  EXPECT_EQ(askedOf(enable), (Asked{true, true, true, true, true}));
  EXPECT_EQ(askedOf(by_default), (Asked{true, false, true, false, false}));
  EXPECT_EQ(askedOf(by_default + enable), (Asked{true, false, true, true, false}));
  EXPECT_EQ(askedOf(enable + by_default), (Asked{true, false, true, true, false}));
  EXPECT_EQ(askedOf(by_default + enable + disable), (Asked{true, false, true, false, false}));
  /* the scene's own word comes later: an entry, a default of the other name, a default of the same one */
  EXPECT_EQ(askedOf(by_default, {{"hand", "wall", false}}), (Asked{true, true, true, false, false}));
  EXPECT_EQ(askedOf(by_default, {{"wall", "", false}}), (Asked{true, true, true, false, false}));
  EXPECT_EQ(askedOf(by_default, {{"hand", "", false}}), (Asked{true, true, true, true, true}));
  /* and is gone where the scene was cleared, the SRDF's is not */
  EXPECT_EQ(askedOf(by_default + enable, {}, true), (Asked{true, false, true, true, false}));
}

TEST(Allowed, elements_of_an_srdf_without_their_links_are_refused_by_name) {
  const std::vector<std::string> elements = {"disable_default_collisions link='' ", "enable_collisions link1='a'",
                                             "enable_collisions link2='a'"};
  for (const std::string &element : elements) {
    try {
      parseSrdf("<robot name='r'><" + element + "/></robot>");
      ADD_FAILURE() << element;
    } catch (const Error &error) {
      expectContains(error.what(), "<" + element.substr(0, element.find(' ')) + "> has no link");
    }
  }
}

/* 300 scenes of 5 names, 40 random changes each, against the list of all that was said; the last word on a thing holds.
 */
TEST(Allowed, many_changes_in_any_order_leave_the_last_word) {
  constexpr std::uint64_t SEED = 20261122;
  const std::array<std::string, 5> names = {"a", "ab", "b", "c", "d"};
  Random random(SEED);
  for (int trial = 0; trial < 300; ++trial) {
    Scene scene;
    std::vector<AllowedPair> said;
    for (int step = 0; step < 40; ++step) {
      SceneChange change;
      if (random.below(20) == 0) change.clear = true, said.clear();
      for (std::size_t n = random.below(4); n-- > 0;) {
        const std::size_t other = random.below(names.size() + 2);
        change.allowed.push_back(
            {names[random.below(names.size())], other < names.size() ? names[other] : "", random.below(2) == 0});
        said.push_back(change.allowed.back());
      }
      ASSERT_TRUE(scene.apply(change).empty());

      const auto last = [&](const std::string &a, const std::string &b) {
        Word out = NOTHING;
        for (const AllowedPair &x : said)
          if ((x.a == a && x.b == b) || (!x.b.empty() && !b.empty() && x.a == b && x.b == a))
            out = x.allowed ? YES : NO;
        return out;
      };
      for (const std::string &a : names)
        for (const std::string &b : names)
          ASSERT_EQ(scene.snapshot()->mayTouch(a, b), allowedByTheText(last(a, b), last(a, ""), last(b, "")))
              << "seed " << SEED << ", trial " << trial << ", step " << step << ": " << a << " " << b;
    }
  }
}

TEST(Allowed, matrices_that_contradict_themselves_are_refused) {
  const SceneText file;
  expectContains(file.refusal("entry_names: [a, b], entry_values: [[false, true], [false, false]]"), "'b' and 'a'");
  expectContains(
      file.refusal(
          "entry_names: [a, b, a], entry_values: [[false, true, true], [true, false, false], [true, false, true]]"),
      "contradicts");
  expectContains(file.refusal("default_entry_names: [a, a], default_entry_values: [true, false]"), "'a'");
  expectContains(file.refusal("entry_names: [a, ''], entry_values: [[false, true], [true, false]]"), "must be a name");
  expectContains(file.refusal("default_entry_names: [''], default_entry_values: [true]"), "must be a name");
}

TEST(Allowed, a_pair_without_a_first_name_changes_nothing) {
  Scene scene;
  SceneChange change;
  change.allowed = {{"a", "b", true}, {"", "c", true}};
  const std::vector<std::string> faults = scene.apply(change);
  ASSERT_EQ(faults.size(), 1u);
  expectContains(faults[0], "first name");
  EXPECT_TRUE(scene.snapshot()->allowed().empty());
}

} // namespace
} // namespace curve_proximity
