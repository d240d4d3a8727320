# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the scripts beside it: where the checkout and the workspace are, and a PATH on which ROS works.

REPO=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

# A checkout has a workspace of its own: `ws`, unless another checkout that is still there has taken it.
own_workspace() {
  local base=${XDG_CACHE_HOME:-$HOME/.cache}/curve_proximity/ws owner
  owner=$(readlink "$base/src/curve_proximity" || true)
  if [ "$owner" = "$REPO" ] || [ ! -d "$owner" ]; then
    echo "$base"
  else
    echo "$base-$(cksum <<<"$REPO" | cut -d' ' -f1)"
  fi
}
WORKSPACE=${CURVE_PROXIMITY_WS:-$(own_workspace)}
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

# Says every 15 seconds how far a log is that CMake's make or apt writes: the last `[ 42%]`, and the time that is left.
report_progress() { # report_progress LOG WHAT
  local since=$SECONDS percent left
  while sleep 15 >/dev/null 2>&1 9>&-; do # it outlives this loop: it holds neither the output nor a lock
    percent=$(grep -oE '^\[ *[0-9]+%\]' "$1" 2>/dev/null | tail -1 | tr -dc 0-9 || true)
    if [ "${percent:-0}" -gt 0 ]; then
      left=$(((SECONDS - since) * (100 - percent) / percent))
      echo "$2: $percent %, about $((left / 60)):$(printf %02d $((left % 60))) left"
    else
      echo "$2: $((SECONDS - since)) s"
    fi
  done
}

# Runs a command with its output in a log; shows the log's end only when the command fails. With WHAT in PROGRESS it says
# how far the command is.
quietly() { # [PROGRESS=WHAT] quietly LOG COMMAND...
  local log=$1 watcher='' failed=0
  shift
  mkdir -p "$(dirname "$log")"
  : >"$log"
  if [ -n "${PROGRESS:-}" ]; then
    report_progress "$log" "$PROGRESS" &
    watcher=$!
  fi
  "$@" >"$log" 2>&1 </dev/null || failed=1
  if [ -n "$watcher" ]; then
    kill "$watcher" 2>/dev/null
    wait "$watcher" 2>/dev/null || true
  fi
  if [ "$failed" = 1 ]; then
    echo "failed: $*" >&2
    echo "---- the end of $log" >&2
    grep -nE '(error|Error|undefined reference)' "$log" | head -20 >&2 || true
    tail -25 "$log" >&2
    return 1
  fi
}
