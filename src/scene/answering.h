/* SPDX-License-Identifier: BSD-3-Clause */
/* What questions about curves and about robots share: the core's verbs, and what the core does not know. */
#ifndef CURVE_PROXIMITY_SCENE_ANSWERING_H
#define CURVE_PROXIMITY_SCENE_ANSWERING_H

#include <string>
#include <vector>

#include <curve_proximity/query.hpp>

namespace curve_proximity {

/* What the question asks for and its answer would not heed, as a sentence; "" where there is nothing. Of a robot in motion, of which
 * `in_all` has one answer for all objects or pairs. */
std::string faultOf(const Question &question);
std::string faultOfMotion(const Question &question, bool in_all);

/* The answer to such a question. */
Answer refusal(const std::string &id, const std::string &kind, const std::string &why);

/* The part of epsilon that rounding takes is not the core's to use. */
cprox_options withoutRounding(cprox_options options, double rounding);

/* The verb that the question asks. */
cprox_status askCore(const Question &question, const cprox_options &options, const cprox_mover &mover,
                     const std::vector<cprox_target> &targets, Workspace &workspace, cprox_result &result);

/* Widens the core's interval by what it does not know: rounding before it; what it was not shown is farther than left_out. The
 * verdict is reviewed by the interval as it then is. */
void widen(const Question &question, double rounding, double left_out, cprox_result &result);

/* There is nothing to measure against. */
void answerNothing(const Question &question, cprox_result &result);

} // namespace curve_proximity
#endif
