#!/usr/bin/env bash
# Tests host/cluster on a real Slurm with one node: cluster_test.sh DOLP. Kills a task, which Slurm then queues again. The
# merged table must equal the table of one run.
set -euo pipefail

((EUID == 0)) || exec sudo --preserve-env bash "${BASH_SOURCE[0]}" "$@"
export DOLP=$1
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
dir=$(mktemp -d)
stop() {
  bash "$tests/slurm_one_node.sh" "$dir/slurm" stop
  sleep 1
  rm -rf "$dir"
}
trap stop EXIT
fail() {
  echo "FAILED: $1" >&2
  tail -n 20 "$dir"/*.log "$dir"/slurm/log/*.log >&2 || true
  exit 1
}

cd "$dir"
cat >scene.toml <<'SCENE'
[surface]
n = 1.5
sigma = 0.3
masking = "v-cavity"
[emission]
temperature_K = 300
[spectrum]
wavelength_um = 10
[grid]
theta_deg = { from = 0, to = 89, count = 640 }
sigma = { from = 0.1, to = 0.8, count = 64 }
q = { from = 1.8, to = 6, count = 64 }
[accuracy]
tolerance = 1e-2
SCENE

bash "$tests/slurm_one_node.sh" "$dir/slurm" || fail "no Slurm"
export SLURM_CONF=$dir/slurm/slurm.conf
shards=2
read -r tasks merge < <(bash "$tests/../../host/cluster/submit.sh" scene.toml t.nc $shards)

# Waits until a task has written its first part, and kills it before the second.
for _ in $(seq 600); do
  compgen -G '*-of-2.nc.partial.txt' >/dev/null && break
  sleep 0.05
done
pkill -KILL --newest --full "$DOLP table scene.toml" || fail "no task to kill"

for _ in $(seq 240); do
  [[ -z $(squeue --noheader --jobs="$tasks,$merge" 2>/dev/null) ]] && break
  sleep 0.5
done
grep -q "queued again" t.nc.*.log || fail "no task was queued again"
[[ -f t.nc ]] || fail "no merged table"
compgen -G '*-of-2.nc' >/dev/null && fail "shards are left"

"$DOLP" table scene.toml -o one.nc --quiet
/usr/bin/python3 - <<'PYTHON' || fail "the tables differ"
import netCDF4

one, merged = netCDF4.Dataset("one.nc"), netCDF4.Dataset("t.nc")
assert list(one.variables) == list(merged.variables)
for name in one.variables:
    a, b = one[name], merged[name]
    a.set_auto_mask(False)
    b.set_auto_mask(False)
    assert a.shape == b.shape and a[:].tobytes() == b[:].tobytes(), name
PYTHON
echo "cluster: a killed task was queued again, and the table is that of one run"
