/* SPDX-License-Identifier: BSD-3-Clause */
#include "options.h"

#include <algorithm>
#include <sstream>

namespace curve_proximity::cli {
namespace {

/* Columns of results. */
#define CPROX_COLUMNS                                                                                              \
  "id,kind,status,verdict,lower,upper,t,a_x,a_y,a_z,b_x,b_y,b_z,a,b, nodes,distance_queries,microseconds,t_b,lod," \
  "message. "
#define CPROX_ROW CPROX_COLUMNS "With --second-opinion also second_opinion,second_distance"
constexpr const char *ROW = CPROX_ROW;
constexpr const char *ROBUST = CPROX_COLUMNS
    "Also certified_scale, refused_scale: with all bounds times the first, all executions are clear; times the second, "
    "they were not";
constexpr const char *MATRIX =
    "a,b,contact,disabled_before,disabled,lower,upper,nodes,distance_queries,posture,message, a row for each pair of "
    "links with collision geometry. contact: never, possible (they touch at the posture), always (no joint between "
    "them "
    "moves) or undecided; disabled: the reason in NEW.srdf, empty: it does not disable the pair";
constexpr const char *SWEPT =
    "id,cells,inside,volume,volume_inside,gap,poses: how many cells, and of them inside; m3; every point of a cell is "
    "within gap of a point that the robot passes through";
constexpr const char *CONTACT = CPROX_ROW ". Also t_contact_lower: there is no contact at any smaller parameter";
#undef CPROX_ROW
#undef CPROX_COLUMNS
constexpr const char *PROFILE =
    "id,kind,status,t0,t1,lower,upper,t,a_x,a_y,a_z,b_x,b_y,b_z,a,b,message: a row an interval";
constexpr const char *SPEED =
    "id,status,t0,t1,lower,override,constant_override,unwatched_override,a,b,message: a row an interval of trajectory "
    "time. override: no more times the trajectory's own speed there; constant_override: the least of them; "
    "unwatched_override: persons whom nobody watches cannot come near at this constant override and above";
constexpr const char *MARGINS =
    "id,status,object,direction,x,y,z,free,blocked,t,a,message: a row an object and direction, any or an axis of the "
    "fixed frame. free: moved by less than this in the direction x,y,z the motion is clear of it; blocked: moved by "
    "this it is not; t,a: when, and which link";
constexpr const char *VIOLATIONS =
    "id,kind,status,verdict,enter_lower,enter_upper,leave_lower,leave_upper,upper,t,a,b,message, a row each: farther "
    "than D before enter_lower and after leave_upper, within D from enter_upper to leave_lower; or one row 'clear' "
    "without numbers";
constexpr const char *CONSTRAINTS =
    "id,provider,status,value,lower,upper,valid,t, gradients ga_ and gb_ by a step of side a and b (v: position, w: "
    "turning), a_, b_ and n_ (nearest points, normal), g_radius,g_start,g_end (by the ends of the "
    "curve's range),g_parameters (by its parameters, with blanks between them),touching_least,touching_most (of a "
    "penalty),microseconds,message,n,g0x,g0y,g0z,... by the curve's "
    "points. Of trajectories: t0,t1,kind,a,b (as of distance), g_duration, g_start, and a column for each number of "
    "each "
    "point: q0_JOINT, v0_JOINT, a0_JOINT by its position, velocity and acceleration; ga_ is by a step of the robot's "
    "base, gb_ by one of the object b. With --check-gradient: id,provider,status,verdict,derivatives (how many were "
    "compared),derivative (the one that fits least),gradient,difference,misfit,doubt,message; verdict: clear (all "
    "agree "
    "within 1e-3 of 1 + the difference), violated (one does not, by more than four times what a smaller step changes: "
    "doubt) or undecided";
constexpr const char *CERTIFIED = "shards, files that 'merge' joins";
constexpr const char *MERGED = "the rows of the dataset: doc/datasets.md has the columns";

} // namespace

const std::vector<Command> &commands() {
  static const std::vector<Command> table = {
      {"distance", Action::CURVES, "INPUTS", "the least distance",
       "distance --curves examples/tool.csv --scene examples/formats/scene.yaml\n"
       "distance --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml --self",
       ROW},
      {"tolerance", Action::CURVES, "--delta D INPUTS",
       "verdict: clear (farther than D everywhere), violated or undecided",
       "tolerance --delta 0.05 --curves examples/tool.csv --scene examples/formats/scene.yaml\n"
       "tolerance --delta 0.01 --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml "
       "--scene examples/formats/scene.yaml",
       ROW, QueryType::TOLERANCE},
      {"collision", Action::CURVES, "INPUTS",
       "verdict: clear (no common point), violated (a common point) or undecided",
       "collision --curves examples/tool.csv --scene examples/formats/scene.yaml\n"
       "collision --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml --self",
       ROW, QueryType::COLLISION},
      {"time-of-contact", Action::CURVES, "INPUTS",
       "where along the curve or trajectory the first contact is; never late. Without --against",
       "time-of-contact --curves examples/tool.csv --scene examples/formats/scene.yaml\n"
       "time-of-contact --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml "
       "--scene examples/formats/scene.yaml",
       CONTACT, QueryType::COLLISION, question::Contact{}},
      {"profile", Action::CURVES, "INPUTS", "the clearance on each interval of the parameter. Without --against",
       "profile --intervals 20 --curves examples/tool.csv --scene examples/formats/scene.yaml\n"
       "profile --per-link --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml "
       "--scene examples/formats/scene.yaml --out profile.csv",
       PROFILE, QueryType::DISTANCE, question::Profile{}},
      {"violations", Action::CURVES, "--delta D INPUTS",
       "all intervals of the parameter within D of something. Without --against",
       "violations --delta 0.2 --curves examples/tool.csv --scene examples/formats/scene.yaml\n"
       "violations --delta 0.2 --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml "
       "--scene examples/formats/scene.yaml",
       VIOLATIONS, QueryType::TOLERANCE, question::Violations{}},
      {"nearest", Action::CURVES, "INPUTS", "the pairs that come closest, nearest first. Without --against",
       "nearest --pairs 3 --curves examples/tool.csv --scene examples/formats/scene.yaml\n"
       "nearest --within 0.5 --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml --self",
       ROW, QueryType::DISTANCE, question::Nearest{}},
      {"pairs", Action::PAIRS, "--in PAIRS.yaml", "signed distance of static pairs of bodies",
       "pairs --in examples/formats/pairs.yaml\n"
       "pairs --in examples/formats/pairs.yaml --second-opinion fcl",
       ROW},
      {"constraints", Action::CONSTRAINTS,
       "--provider NAME --in CASES.yaml [--scene SCENE.yaml] [--parameters \"name: value, ...\"]\n"
       "--provider NAME --trajectory T.yaml --robot URDF [--srdf SRDF --state TEXT] [--scene SCENE.yaml]",
       "value and gradient of clearance constraints by a plugin",
       "constraints --provider curve_proximity/CurveDistance --in examples/formats/cases.yaml --scene "
       "examples/formats/scene.yaml --robot examples/formats/arm.urdf\n"
       "constraints --provider curve_proximity/RobotDistance --robot examples/formats/arm.urdf --trajectory "
       "examples/formats/trajectory.yaml --scene examples/formats/scene.yaml --check-gradient",
       CONSTRAINTS},
      {"robust", Action::ROBUST,
       "--errors ERRORS.yaml --trajectory T.yaml --robot URDF [--srdf SRDF] [--scene SCENE.yaml] [--delta D]",
       "verdict for every execution within bounds of its errors, and by how much these may grow",
       "robust --errors examples/formats/errors.yaml --robot examples/formats/arm.urdf --trajectory "
       "examples/formats/trajectory.yaml --scene examples/formats/scene.yaml\n"
       "robust --errors examples/formats/errors.yaml --delta 0.01 --robot examples/formats/arm.urdf --trajectory "
       "examples/formats/trajectory.yaml --self",
       ROBUST, QueryType::TOLERANCE},
      {"acm", Action::ACM, "--robot URDF [--srdf SRDF] --out NEW.srdf",
       "which links can touch each other within the limits of the joints, proven; and an SRDF that disables the others",
       "acm --robot examples/formats/arm.urdf --out new.srdf\n"
       "acm --robot examples/formats/arm.urdf --srdf examples/formats/arm.srdf --out new.srdf",
       MATRIX, QueryType::COLLISION},
      {"speed", Action::SPEED,
       "--separation S.yaml --objects LIST --trajectory T.yaml --robot URDF [--srdf SRDF] --scene SCENE.yaml",
       "how fast the robot may go while persons in the objects of LIST may walk up to it",
       "speed --separation examples/formats/separation.yaml --objects can --robot examples/formats/arm.urdf "
       "--trajectory examples/formats/trajectory.yaml --scene examples/formats/scene.yaml\n"
       "speed --intervals 500 --separation examples/formats/separation.yaml --objects \"can, ramp\" --robot "
       "examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml --scene examples/formats/scene.yaml "
       "--json",
       SPEED},
      {"margins", Action::MARGINS,
       "--trajectory T.yaml --robot URDF [--srdf SRDF] --scene SCENE.yaml [--delta D] [--within R]",
       "how far each object may be moved before the motion is no longer clear of it",
       "margins --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml --scene "
       "examples/formats/scene.yaml\n"
       "margins --delta 0.01 --within 0.3 --objects can --robot examples/formats/arm.urdf --trajectory "
       "examples/formats/trajectory.yaml --scene examples/formats/scene.yaml",
       MARGINS, QueryType::TOLERANCE},
      {"sweep", Action::SWEEP,
       "--robot URDF --trajectory T.yaml [--srdf SRDF] [--resolution R] --out FILE.bt [--inside FILE.bt]",
       "the cells of a grid that the robot can touch along a trajectory, as an octree or a mesh; it touches no other",
       "sweep --resolution 0.02 --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml --out "
       "swept.bt\n"
       "sweep --resolution 0.02 --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml --out "
       "swept.stl --inside core.stl",
       SWEPT, QueryType::COLLISION},
      {"report", Action::REPORT, "INPUTS [--delta D] --out REPORT.html",
       "one page to look at: verdict, clearance over time per link, closest pairs, 3-D view. Without --against",
       "report --curves examples/tool.csv --scene examples/formats/scene.yaml --out report.html\n"
       "report --delta 0.05 --robot examples/formats/arm.urdf --trajectory examples/formats/trajectory.yaml --scene "
       "examples/formats/scene.yaml --out report.html",
       ""},
      {"send", Action::SEND, "SCENE.yaml [--replace | --add] [--node NAME]", "hands a scene file to a running node",
       "send examples/formats/scene.yaml\n"
       "send examples/formats/scene.yaml --add --node /curve_proximity",
       ""},
      {"check", Action::CHECK, "FILE (the inputs of the query)", "what the certificates in FILE prove",
       "distance --curves examples/tool.csv --scene examples/formats/scene.yaml --certificate proofs.txt\n"
       "check proofs.txt --curves examples/tool.csv --scene examples/formats/scene.yaml",
       ""},
      {"certify", Action::CERTIFY, "--dataset MANIFEST --out FOLDER [--shards N [--shard I]]",
       "answers the rows of a dataset, shard by shard",
       "certify --dataset examples/formats/dataset.jsonl --out results\n"
       "certify --dataset examples/formats/dataset.jsonl --out parts --shards 2 --shard 0",
       CERTIFIED},
      {"merge", Action::MERGE, "FOLDER", "all shards as one table; refuses gaps and shards of different runs",
       "merge results\n"
       "merge results --out results.csv",
       MERGED},
  };
  return table;
}

const std::vector<Option> &options() {
  static const std::vector<Option> table = {
      {"--curves", "FILE", "queries report check",
       "one curve a row: id,basis,degree,t0,t1,radius,n,x0,y0,z0,...[,knots][,parameters] [,restrict_t0,restrict_t1]; "
       "basis bezier, bspline, polynomial, legendre, lagrange (nodes for knots), trigonometric, rational_bezier, nurbs "
       "(weights for parameters), clothoid, dubins, involute, pythagorean_hodograph or piecewise (the next n rows); "
       "doc/formats.md has them all. A radius that changes has the coefficients of 1, t, t², ..., separated by blanks. "
       "Lines that begin with # and a header row are skipped"},
      {"--against", "FILE", "distance tolerance collision check", "curves, too: instead of a scene"},
      {"--synchronized", "", "distance tolerance collision check",
       "with --against: both curves are at the same parameter, so that they may cross each other's way"},
      {"--scene", "FILE", "queries report constraints check robust speed margins sweep",
       "moveit_msgs/PlanningScene as YAML; may be left out where there is a robot"},
      {"--robot", "FILE", "queries report constraints check robust acm speed margins sweep",
       "a URDF: its links are objects, too; meshes answer as meshes (see --max-lod)"},
      {"--trajectory", "FILE", "queries report constraints check robust speed margins sweep",
       "a joint trajectory: joint_trajectory, interpolation, fixed_joints, virtual_joint"},
      {"--errors", "FILE", "robust profile time-of-contact speed report",
       "bounds of the errors of an execution: every_joint, joints, timing, base, objects, sensor, flex "
       "(doc/robust.md)"},
      {"--separation", "FILE", "speed",
       "the constants of ISO/TS 15066: person: {speed, position}, robot: {reaction_time, stopping_time, position, "
       "speed}, intrusion (doc/separation.md)"},
      {"--movers", "", "queries check",
       "what moves in the scene, instead of curves or a robot: against what stands there, and against each other"},
      {"--path", "FILE", "queries check",
       "nav_msgs/Path, as rostopic prints it: straight from pose to pose, turning at a constant rate, at the times of "
       "the stamps; where these do not ascend, t counts poses"},
      {"--body", "FILE", "queries check",
       "with --path: {id, pose, padding, primitives, meshes, bodies, ...} as an object of a scene; with an id alone: "
       "the object of that id that a link of --robot carries, along poses of the link"},
      {"--radius", "R", "queries check", "with --path, instead of --body: a ball of R metres (default 0, a point)"},
      {"--self", "", "queries report check robust", "how close the robot comes to itself, too"},
      {"--shortest-way", "", "queries report check certify constraints robust speed margins sweep",
       "continuous joints turn the shorter way between two waypoints, from 3.1 to -3.1 by 0.083 rad"},
      {"--signed", "", "distance nearest",
       "distances inside a body are negative: minus the deepest penetration (of meshes a bound, by their hulls)"},
      {"--srdf", "FILE", "queries report constraints check robust acm speed margins sweep",
       "links that are not checked against each other, and the frame in which the robot stands (its virtual joint's "
       "parent_frame)"},
      {"--state", "TEXT", "queries report constraints check robust speed margins sweep",
       "joint values in radians or metres; others as in the scene's robot_state, else 0 (mid-range where 0 is beyond "
       "the limits)"},
      {"--in", "FILE", "pairs constraints",
       "a list of {id, a: BODY, b: BODY}; of 'constraints' the request of ~evaluate_constraints: cases: [{id, a: "
       "{pose, bodies: [BODY], ...} or {id: an object of --scene}, b, curve}] Each FILE that is read may be -, "
       "standard input. doc/formats.md shows all formats"},
      {"--provider", "NAME", "constraints",
       "curve_proximity/CurveDistance, .../SuperquadricDistance, .../FourierGap, .../GrowthDistance, .../RobotDistance "
       "(of trajectories), or another package's"},
      {"--parameters", "LIST", "constraints", "\"name: value, ...\": what the provider is set to"},
      {"--check-gradient", "", "constraints", "holds the gradients against central differences"},
      {"--certificate", "FILE", "distance tolerance collision time-of-contact profile violations report",
       "writes proofs of the answers to FILE, which 'check' verifies, and adds the column proof: apart, near, before "
       "(of the time of contact) or none. Of profiles and violations it proves each part of the range and adds no "
       "column. The answers are the same as without. A link that is a mesh is taken by its "
       "convex hull: that it is far can be proven, that it is near cannot"},
      {"--epsilon", "E", "queries report pairs certify robust acm speed margins",
       "width of the intervals asked for, metres, above 0 (default 1e-06)"},
      {"--delta", "D", "tolerance violations report robust margins",
       "the clearance asked of 'tolerance' and 'violations', of 'robust' and 'margins' (default 0), and of 'report' if "
       "its verdict "
       "is wanted, "
       "metres"},
      {"--max-nodes", "N", "queries report pairs certify robust acm speed margins",
       "budget for each result, in distance queries (default 500000: about 1 s)"},
      {"--threads", "N", "queries pairs constraints certify check acm sweep",
       "how many rows are worked on at once (default: the machine's cores); the answers do not depend on it"},
      {"--per-object", "", "queries", "rows for each curve and object or link, not for the nearest alone"},
      {"--per-link", "", "queries", "with --trajectory: rows for each link and each object that a link carries"},
      {"--allow-empty", "", "queries report certify robust speed margins",
       "nothing to measure is an answer: clear, at an infinite distance. Without it such a row has the status 'empty', "
       "and its verdict is undecided"},
      {"--objects", "LIST", "queries report robust speed margins",
       "these objects alone, \"shelf, table\"; with --curves and --links also those links"},
      {"--links", "LIST", "queries report robust speed margins sweep",
       "with --curves: these links of --robot alone. With --trajectory: what these links do, or objects that they "
       "carry; with --self pairs of which they are one"},
      {"--moving-links-only", "", "queries report",
       "with --trajectory, --movers: links that the motion does not move are left out, with --self pairs that it does "
       "not move against each other; else all count. The rows' messages say so"},
      {"--intervals", "N", "profile report speed", "N intervals of equal length (default 100)"},
      {"--breaks", "LIST", "profile report", "where intervals begin and end instead, \"0, 0.5, 2\""},
      {"--horizon", "H", "profile", "clearance beyond H metres is only bounded: lower > H, which is less work"},
      {"--pairs", "K", "nearest report", "at most K pairs for each curve or trajectory (default 10)"},
      {"--resolution", "R", "violations sweep",
       "of 'violations' how finely the ends are searched, in units of the parameter (default: a thousandth of all of "
       "it); of 'sweep' the edge of a cell in metres (default 0.01)"},
      {"--inside", "FILE", "sweep", "the cells that the robot fills at some time, too: several times the work"},
      {"--within", "D", "nearest margins",
       "only pairs that come within D metres; of 'margins': objects are moved by at most D metres (default 1)"},
      {"--second-opinion", "PEER", "distance tolerance collision nearest time-of-contact pairs",
       "fcl or libccd: the pair of each row is measured again by this library, at the row's t and at both ends; the "
       "columns second_opinion (agrees, disagrees or unknown) and second_distance are added"},
      {"--max-lod", "R", "queries report pairs certify robust acm speed margins",
       "the finest model that may answer: mesh (default), hull (meshes by their convex hulls) or sphere (bodies by "
       "their bounding spheres); a coarser one is never farther away"},
      {"--dataset", "FILE", "certify",
       "JSON Lines, or CSV with a header: id, robot, srdf, scene, trajectory, query, delta, self a row"},
      {"--shards", "N", "certify", "the dataset is cut into N parts of equal length (default 1)"},
      {"--shard", "I", "certify",
       "part I alone, from 0 to N-1 (default: all of them). A part that is whole is skipped"},
      {"--failed", "WHY", "certify",
       "of --shard I: answers no row; each becomes a row 'failed' with this message. For whoever drives shards and has "
       "seen one crash: 'merge' then has no gap"},
      {"--progress", "P", "certify", "line (default, on a terminal) or json, a line a second on standard error"},
      {"--skipped", "", "queries pairs robust acm speed margins sweep",
       "tell on standard error what takes no part, and why"},
      {"--timings", "", "queries robust acm speed margins sweep",
       "tell on standard error how long loading the robot and the scene takes, mesh by mesh"},
      {"--mesh-tolerance", "M", "queries report robust acm speed margins sweep",
       "replace meshes by ones with fewer triangles that contain them: nothing is clear that the mesh would hit; what "
       "is closer than 2 M metres may read as a hit"},
      {"--allow-missing-geometry", "", "queries report robust acm speed margins sweep",
       "go on without collision elements of the robot that cannot be used; the answers are 'partial', never clear"},
      {"--package", "LIST", "queries report pairs constraints certify check robust acm speed margins sweep",
       "folders of packages that package:// names, \"arm=/data/arm, hand=/data/hand\"; they come before the folders "
       "above the URDF, ROS_PACKAGE_PATH, and share/ of CMAKE_PREFIX_PATH and /usr"},
      {"--out", "FILE", "queries report pairs constraints certify merge robust acm speed margins sweep",
       "the results, instead of standard output; of 'certify' the folder of the shards, of 'report' the page"},
      {"--json", "", "queries pairs constraints merge check robust acm speed margins sweep",
       "a JSON object a row, on a line of its own, by the names of the CSV's columns: an infinite number is the text "
       "\"inf\" or \"-inf\", a field without a value is null"},
      {"--strict", "", "queries pairs robust speed margins",
       "a row that does not cover all that was given (status partial or rounded) counts as one without an answer: the "
       "exit code is 2, not 3"},
      {"--quiet", "", "queries report pairs constraints certify merge check robust acm speed margins sweep",
       "no warnings and no progress on standard error, only why a run cannot be made"},
      {"-v", "", "queries pairs check robust acm speed margins sweep",
       "--skipped and --timings, and at the end how many rows there were, and which; of check the digests of its "
       "files, "
       "and on what it rests"},
      {"--replace", "", "send",
       "the file takes the place of the node's scene (default, unless the file says is_diff: true)"},
      {"--add", "", "send", "the file is added to the node's scene"},
      {"--node", "NAME", "send", "the node that 'send' talks to (default /curve_proximity)"},
  };
  return table;
}

const Command *findCommand(const std::string &word) {
  const auto found =
      std::find_if(commands().begin(), commands().end(), [&](const Command &command) { return word == command.word; });
  return found == commands().end() ? nullptr : &*found;
}

const Option *findOption(const std::string &name) {
  const auto found =
      std::find_if(options().begin(), options().end(), [&](const Option &option) { return name == option.name; });
  return found == options().end() ? nullptr : &*found;
}

std::vector<std::string> commandsOf(const Option &option) {
  std::vector<std::string> out;
  std::istringstream text(option.commands);
  for (std::string word; text >> word;) {
    if (word == "queries") {
      for (const Command &command : commands())
        if (command.action == Action::CURVES) out.emplace_back(command.word);
    } else {
      out.push_back(word);
    }
  }
  return out;
}

bool takes(const Command &command, const Option &option) {
  const std::vector<std::string> words = commandsOf(option);
  return std::find(words.begin(), words.end(), command.word) != words.end();
}

} // namespace curve_proximity::cli
