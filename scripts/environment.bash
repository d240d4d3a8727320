# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the scripts beside it: where the checkout and the workspace are, and a PATH on which ROS works.

REPO=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
WORKSPACE=${CURVE_PROXIMITY_WS:-${XDG_CACHE_HOME:-$HOME/.cache}/curve_proximity/ws}
LOGS=$WORKSPACE/logs
export REPO WORKSPACE LOGS

# ROS speaks to the system's Python; another python3 that comes first on the PATH, or its module path, breaks catkin.
export PATH=/usr/bin:$PATH
unset PYTHONHOME PYTHONPATH

# catkin's setup files read variables that may not be set.
source_setup() {
  set +u
  # shellcheck disable=SC1090
  source "$1"
  set -u
}

# Debian's ROS lives in /usr and needs no setup; Ubuntu's is sourced.
source_ros() {
  if [ -f /opt/ros/noetic/setup.bash ]; then
    source_setup /opt/ros/noetic/setup.bash
  fi
}

# Runs a command with its output in a log; shows the log's end only when the command fails.
quietly() { # quietly LOG COMMAND...
  local log=$1
  shift
  mkdir -p "$(dirname "$log")"
  if ! "$@" >"$log" 2>&1 </dev/null; then
    echo "failed: $*" >&2
    echo "---- the end of $log" >&2
    grep -nE '(error|Error|undefined reference)' "$log" | head -20 >&2 || true
    tail -25 "$log" >&2
    return 1
  fi
}
