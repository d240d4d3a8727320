/* SPDX-License-Identifier: BSD-3-Clause */
/** Many curves a call, and many clients: the node beside a service of the same type that computes nothing. */
#ifndef BENCH_ROS_CROWDS_H
#define BENCH_ROS_CROWDS_H

#include <ros/node_handle.h>

#include <string>

namespace bench {

/** The empty service, as a process: as many rows as curves, each the same; on four threads, as ours. */
int serveEmpty(int argc, char **argv);

/** Clients that ask the same again and again, as a process: --crowd SERVICE KIND, KIND of heavy, lost. */
int runCrowd(int argc, char **argv);

/** Prints all rows, or those of many curves a call alone. node: the server that is asked; its scene is replaced. */
void measureCrowds(ros::NodeHandle &handle, const std::string &node, bool quick, bool many_alone);

} // namespace bench
#endif
