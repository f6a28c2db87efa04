#!/usr/bin/env bash
# Installs, uses and removes the Debian package in an overlay over the root file system: package_test.sh BUILD
set -euo pipefail

build=$1
as_root=()
((EUID == 0)) || as_root=(sudo)
work=$(mktemp -d)
trap '"${as_root[@]}" rm -rf "$work"' EXIT
fail() {
  echo "package_test: $1" >&2
  exit 1
}

(cd "$build" && cpack -B "$work/packing" > "$work/log") || { cat "$work/log"; fail "cpack fails"; }
cp "$work"/packing/dolp_*.deb "$work/dolp.deb"

cat > "$work/use.sh" <<'END'
cd /empty
dpkg --install dolp.deb > log 2>&1 || { cat log; exit 1; }
dolp table /usr/share/dolp/scenes/night_paint.toml -o t.nc --quiet
/usr/bin/python3 -c 'import dolp; print(dolp.lookup("t.nc", theta_deg=60).dolp.item())'
test -e /usr/share/man/man1/dolp.1
dpkg --remove dolp > log
test ! -e /usr/bin/dolp
END

# All writes go to a tmpfs that ends with the namespace, so the machine does not change.
mkdir "$work/memory" "$work/root"
"${as_root[@]}" env -u PYTHONPATH HOME=/empty unshare --mount bash -euo pipefail -c '
  cd "$1"
  mount -t tmpfs none memory
  mkdir memory/upper memory/work
  mount -t overlay overlay -o lowerdir=/,upperdir=memory/upper,workdir=memory/work root
  mount -t proc proc root/proc
  mkdir root/empty
  cp dolp.deb use.sh root/empty
  chroot root bash -euo pipefail /empty/use.sh' package "$work" ||
  fail "the package does not work where it is installed"
echo "the package installs, works and goes"
