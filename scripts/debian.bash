# SPDX-License-Identifier: BSD-3-Clause
# Sourced after environment.bash by scripts that work in another Debian: a folder with a system by debootstrap, as root.

# Makes the system, unless the folder has one, and brings the last commit of this checkout into it, as root's clone.
# Files that have not changed keep their times: a second build there compiles what has changed.
make_debian() { # make_debian SUITE ROOT
  local clone=$2/root/curve_proximity
  [ "$(id -u)" -eq 0 ] || { echo "debootstrap and chroot need root" >&2; return 2; }
  if [ ! -e "$2/etc/debian_version" ] || [ -d "$2/debootstrap" ]; then
    command -v debootstrap >/dev/null || apt-get install -y --no-install-recommends debootstrap
    mkdir -p "$2"
    debootstrap --variant=minbase --include=ca-certificates,git "$1" "$2" http://deb.debian.org/debian
  fi
  [ -e "$2/etc/hosts" ] || cp /etc/hosts "$2/etc/hosts" # roscore looks its own machine up
  [ -e "$clone/.git" ] || git clone --quiet "$REPO" "$clone"
  git -C "$clone" fetch --quiet "$REPO" HEAD
  git -C "$clone" reset --quiet --hard FETCH_HEAD
}

# Runs a command of the clone in the system, which sees nothing of this one's environment and processes.
in_debian() { # in_debian ROOT COMMAND [ARGUMENT...]
  # shellcheck disable=SC2016
  unshare --mount --pid --fork bash -c 'mount -t proc proc "$0/proc" && mount -t devpts devpts "$0/dev/pts" &&
    exec chroot "$0" env -i HOME=/root PATH=/usr/bin:/bin:/usr/sbin:/sbin LANG=C.UTF-8 bash -c "cd /root/curve_proximity && exec \"\$@\"" in_debian "$@"' "$@"
}
