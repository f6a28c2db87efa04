#!/usr/bin/env bash
# Builds and tests the last commit on Debian 13: debian13.sh FOLDER [COMMAND...]
#
# Makes a Debian 13 system in FOLDER with debootstrap, unless it exists, and copies the last commit to its /src/dolp. There
# it runs COMMAND, by default the quickstart and those tests that depend on libraries, driver or display of the system.
# Needs root for chroot, and to mount /dev and /proc in FOLDER while it runs.
set -euo pipefail

# No tests that need new namespaces, which do not work in a chroot.
parts='Table|HardCases|Devices|Window|Explore|Python|Install.Works|Octave|Hardening|file_limit|endless|SecondDriver|manual_test'

fail() {
  echo "debian13.sh: $1" >&2
  exit 1
}
(($# > 0)) || fail "usage: debian13.sh FOLDER [COMMAND...]"
((EUID == 0)) || fail "needs root"
mkdir -p "$1"
system=$(realpath "$1")
shift
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

if [[ ! -x $system/usr/bin/apt-get ]]; then
  command -v debootstrap >/dev/null || fail "needs the package debootstrap"
  debootstrap --variant=minbase --include=ca-certificates,git trixie "$system"
fi
git init -q "$system/src/dolp"
git -C "$system/src/dolp" fetch -q --depth 1 "file://$project" HEAD
git -C "$system/src/dolp" checkout -q --detach FETCH_HEAD

(($# > 0)) || set -- bash -ec "time bash host/quickstart.sh; time bash tests/run.sh -R '$parts'"
# The mounts exist only in the new namespace and end with it.
exec unshare --mount bash -ec '
  system=$1
  shift
  mount --rbind /dev "$system/dev"
  mount -t proc proc "$system/proc"
  cd "$system/src/dolp"
  exec chroot "$system" env -i -C /src/dolp HOME=/root LC_ALL=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"
' bash "$system" "$@"
