/* SPDX-License-Identifier: BSD-3-Clause */
#include "constraint_lines.h"

#include <cstdio>

#include "csv.h"

namespace curve_proximity::cli {
namespace {

const char *kHeader =
    "id,provider,status,value,lower,upper,valid,t,ga_vx,ga_vy,ga_vz,ga_wx,ga_wy,ga_wz,gb_vx,gb_vy,gb_vz,gb_wx,gb_wy,"
    "gb_wz,a_x,a_y,a_z,b_x,b_y,b_z,n_x,n_y,n_z,g_radius,g_start,g_end,g_parameters,touching_least,"
    "touching_most,microseconds,message,n,g0x,g0y,g0z\n";

const char *kMotionHeader =
    "id,provider,status,value,lower,upper,valid,t,t0,t1,kind,a,b,ga_vx,ga_vy,ga_vz,ga_wx,ga_wy,ga_wz,gb_vx,gb_vy,gb_vz,"
    "gb_wx,gb_wy,gb_wz,a_x,a_y,a_z,b_x,b_y,b_z,n_x,n_y,n_z,g_duration,g_start,microseconds,message";

void appendVector(std::string &line, const Eigen::Vector3d &v, bool known = true) {
  for (int i = 0; i < 3; ++i) appendField(line, v[i], known);
}

void appendGradient(std::string &line, const ConstraintGradient &gradient) {
  appendVector(line, gradient.linear);
  appendVector(line, gradient.angular);
}

void appendWitness(std::string &line, const ConstraintValue &value) {
  for (const Eigen::Vector3d *point : {&value.witness_a, &value.witness_b, &value.normal})
    appendVector(line, *point, value.has_points);
}

/* Value and bounds, each with the comma before it. */
void appendValue(std::string &line, double value, bool bounded, double lower, double upper) {
  appendField(line, value);
  appendField(line, lower, bounded);
  appendField(line, upper, bounded);
}

/* Numbers in one field, with blanks between them. */
std::string listed(const Eigen::VectorXd &numbers) {
  std::string text;
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    std::string field;
    appendField(field, numbers[i]);
    text += (i == 0 ? "" : " ") + field.substr(1);
  }
  return text;
}

std::string microseconds(const ConstraintRow &row) {
  char text[40];
  std::snprintf(text, sizeof text, ",%.1f,", row.microseconds);
  return text;
}

/* The lists that the points of a trajectory have, with the letter of their columns. */
struct List {
  char letter;
  bool given;
  Eigen::MatrixXd MotionRow::*gradient;
};

std::vector<List> listsOf(const TrajectoryDescription &trajectory) {
  bool velocities = false, accelerations = false;
  for (const TrajectoryPoint &point : trajectory.points) {
    velocities = velocities || !point.velocities.empty();
    accelerations = accelerations || !point.accelerations.empty();
  }
  return {{'q', true, &MotionRow::positions},
          {'v', velocities, &MotionRow::velocities},
          {'a', accelerations, &MotionRow::accelerations}};
}

std::size_t columnsOf(const TrajectoryDescription &trajectory) {
  std::size_t lists = 0;
  for (const List &list : listsOf(trajectory)) lists += list.given ? 1 : 0;
  return lists * trajectory.points.size() * trajectory.joints.size();
}

void appendList(std::string &line, const Eigen::MatrixXd &matrix, const TrajectoryDescription &trajectory) {
  const auto n = static_cast<Eigen::Index>(trajectory.points.size()),
             m = static_cast<Eigen::Index>(trajectory.joints.size());
  const bool known = matrix.rows() == n && matrix.cols() == m;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < m; ++k) appendField(line, known ? matrix(i, k) : 0.0, known);
}

/* Of lines about trajectories: the columns from value to microseconds, and from t to g_start. */
constexpr std::size_t FROM_VALUE = 34, FROM_T = 29;

std::string motionLine(const ConstraintRow &row, const MotionRow &one, const TrajectoryDescription &trajectory) {
  std::string line = quotedField(row.id) + ',' + quotedField(row.provider) + ',' + statusName(row);
  appendValue(line, one.value, one.bounded, one.lower, one.upper);
  line += one.valid ? ",true" : ",false";
  for (const double t : {one.t, one.t0, one.t1}) appendField(line, t);
  for (const std::string &name : {one.kind, one.side_a, one.side_b}) line += ',' + quotedField(name);
  appendGradient(line, one.a);
  appendGradient(line, one.b);
  appendWitness(line, one);
  appendField(line, one.duration);
  appendField(line, one.start);
  line += microseconds(row) + quotedField(one.reason.empty() ? row.message : one.reason);
  for (const List &list : listsOf(trajectory))
    if (list.given) appendList(line, one.*list.gradient, trajectory);
  return line + '\n';
}

} // namespace

std::string constraintsHeader() {
  return kHeader;
}

std::string constraintsHeader(const TrajectoryDescription &trajectory) {
  std::string header = kMotionHeader;
  for (const List &list : listsOf(trajectory)) {
    if (!list.given) continue;
    for (std::size_t i = 0; i < trajectory.points.size(); ++i)
      for (const std::string &joint : trajectory.joints)
        header += ',' + quotedField(list.letter + std::to_string(i) + '_' + joint);
  }
  return header + '\n';
}

std::string gradientsHeader() {
  return "id,provider,status,verdict,derivatives,derivative,gradient,difference,misfit,doubt,message\n";
}

std::string constraintsLine(const ConstraintRow &row) {
  const ConstraintValue &value = row.value;
  std::string line = quotedField(row.id) + ',' + quotedField(row.provider) + ',' + statusName(row);
  if (row.status < 0) return line + std::string(34, ',') + quotedField(row.message) + ",,,,\n";
  appendValue(line, value.value, value.bounded, value.lower, value.upper);
  line += value.valid ? ",true" : ",false";
  const bool along = value.points.cols() > 0;
  appendField(line, value.t, std::isfinite(value.t));
  appendGradient(line, value.a);
  appendGradient(line, value.b);
  appendWitness(line, value);
  for (const double by : {value.radius, value.range_start, value.range_end}) appendField(line, by);
  line += ',' + listed(value.parameters);
  appendField(line, value.touching_least, value.penalty);
  appendField(line, value.touching_most, value.penalty);
  line += microseconds(row) + quotedField(row.message) + ',' + std::to_string(value.points.cols());
  for (Eigen::Index i = 0; i < value.points.cols(); ++i) appendVector(line, value.points.col(i));
  return line + (along ? "\n" : ",,,\n");
}

std::string constraintsLines(const ConstraintRow &row, const TrajectoryDescription &trajectory) {
  std::string start = quotedField(row.id) + ',' + quotedField(row.provider) + ',' + statusName(row);
  const std::size_t gradients = columnsOf(trajectory);
  if (row.status < 0)
    return start + std::string(FROM_VALUE + 1, ',') + quotedField(row.message) + std::string(gradients, ',') + '\n';
  std::string lines;
  for (const MotionRow &one : row.motion->rows) lines += motionLine(row, one, trajectory);
  if (!lines.empty()) return lines;

  // No row: the value alone.
  const MotionValue &all = *row.motion;
  appendValue(start, all.value, all.bounded, all.lower, all.upper);
  start += row.value.valid ? ",true" : ",false";
  return start + std::string(FROM_T, ',') + microseconds(row) + quotedField(row.message) + std::string(gradients, ',') +
         '\n';
}

std::string gradientsLine(const ConstraintRow &row, const GradientCheck *check) {
  std::string line = quotedField(row.id) + ',' + quotedField(row.provider) + ',' + statusName(row) + ',';
  if (!check) return line + std::string(7, ',') + quotedField(row.message) + '\n';
  line += cprox_verdict_name(verdictOf(*check));
  line += ',' + std::to_string(check->count) + ',';
  const GradientMisfit &worst = check->worst;
  if (check->count == 0) return line + ",,,,," + quotedField(check->reason) + '\n';
  line += quotedField(worst.derivative);
  for (const double number : {worst.gradient, worst.difference, worst.misfit, worst.doubt}) appendField(line, number);
  return line + ',' + quotedField(check->reason) + '\n';
}

} // namespace curve_proximity::cli
