/* SPDX-License-Identifier: BSD-3-Clause */
/* Adds to an answer what the peer of its query says. Where the query has none, or the answer is none, nothing. */
#ifndef CURVE_PROXIMITY_SCENE_SECOND_OPINION_H
#define CURVE_PROXIMITY_SCENE_SECOND_OPINION_H

#include "motion/motion_data.h"
#include "scene_obstacles.h"

namespace curve_proximity {

/* Of a curve: answer.b and obstacle_index name a shape of the obstacles. */
void addSecondOpinion(const SceneObstacles::Data &obstacles, const CompiledCurve &curve, const Query &query,
                      Answer &answer);

/* Of a robot in motion: answer.a, mover_part, b and obstacle_index name both shapes. */
void addSecondOpinion(const RobotMotion::Data &motion, const Query &query, Answer &answer);

/* The answer is about something that no peer is asked about. */
void refuseSecondOpinion(const Query &query, const std::string &why, Answer &answer);

} // namespace curve_proximity
#endif
