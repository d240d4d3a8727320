# SPDX-License-Identifier: BSD-3-Clause
# The built package in a container: Debian 12 with its own ROS, or Noetic.
#   docker build -t curve_proximity .
#   docker build -t curve_proximity --build-arg BASE=ros:noetic-ros-base-focal .
#   docker run --rm curve_proximity cprox distance --curves examples/tool.csv --scene examples/formats/scene.yaml
ARG BASE=debian:bookworm
FROM ${BASE}
COPY . /root/curve_proximity
WORKDIR /root/curve_proximity
RUN scripts/build && rm -rf /var/lib/apt/lists/*
ENTRYPOINT ["scripts/run"]
CMD ["cprox", "--help"]
