#!/usr/bin/env bash
# Runs a Slurm cluster of this one machine, as root and without systemd:
#
#   slurm_one_node.sh DIR        starts Slurm with all its files in DIR; clients need SLURM_CONF=DIR/slurm.conf
#   slurm_one_node.sh DIR stop   ends Slurm
set -euo pipefail

dir=$1
daemons=(slurmd slurmctld munged)
if [[ ${2:-start} == stop ]]; then
  for daemon in "${daemons[@]}"; do
    if [[ -f $dir/$daemon.pid ]]; then kill "$(<"$dir/$daemon.pid")" 2>/dev/null || true; fi
  done
  exit 0
fi

mkdir -p "$dir"/{state,spool,log}
host=$(hostname -s)
# cred_expire: a job that is queued again waits until its old credentials expire, here 5 s.
cat >"$dir/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge.sock,cred_expire=5
CryptoType=crypto/munge
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldPort=16837
SlurmdPort=16838
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdLogFile=$dir/log/slurmd.log
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
(
  umask 077
  head -c 1024 /dev/urandom >"$dir/munge.key"
)
munged --force --key-file="$dir/munge.key" --socket="$dir/munge.sock" --pid-file="$dir/munged.pid" \
  --log-file="$dir/log/munged.log" --seed-file="$dir/munge.seed"
export SLURM_CONF=$dir/slurm.conf
slurmctld -c
slurmd
for _ in $(seq 60); do
  if sinfo --noheader --format=%T 2>/dev/null | grep -q idle; then exit 0; fi
  sleep 0.5
done
echo "slurm_one_node.sh: the node does not get idle; see $dir/log" >&2
exit 1
