#!/usr/bin/env bash
# twin/campaign/cluster/slurm.sbatch for real: a Slurm of one node, started and stopped here. slurm_test.sh SOURCE_DIR PROGRAM
source "$(dirname "$0")/common.sh"
daemons=()
Stop() {
  local pid
  for pid in "${daemons[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${daemons[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap Stop EXIT
for tool in munged slurmctld slurmd sbatch; do
  command -v "$tool" >/dev/null || [[ -x /usr/sbin/$tool ]] ||
    Skip "Slurm is not installed: no $tool (apt-get install slurm-wlm munge)"
done
PATH=$PATH:/usr/sbin
chmod 755 "$work"
host=$(hostname -s)
user=$(id -un)
port=$((40000 + $$ % 10000))

mkdir -m 700 "$work/munge"
mkdir -m 755 "$work/munge_run" "$work/state" "$work/spool"
head -c 1024 /dev/urandom >"$work/munge/key"
chmod 400 "$work/munge/key"
munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge_run/socket" \
  --pid-file="$work/munge_run/pid" --log-file="$work/munge/log" --seed-file="$work/munge/seed" 2>"$work/munged.log" &
daemons+=($!)

export SLURM_CONF=$work/slurm.conf
cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$work/munge_run/socket,cred_expire=5
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
SchedulerParameters=sched_interval=1,bf_interval=1
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=2000 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
for _ in $(seq 50); do [[ -S $work/munge_run/socket ]] && break; sleep 0.1; done
[[ -S $work/munge_run/socket ]] || { cat "$work/munged.log" >&2; Skip "munged does not start"; }
slurmctld -D 2>/dev/null &
daemons+=($!)
slurmd -D -N "$host" 2>/dev/null &
daemons+=($!)
for _ in $(seq 100); do [[ $(sinfo -h -o %t 2>/dev/null) == idle ]] && break; sleep 0.2; done
[[ $(sinfo -h -o %t 2>/dev/null) == idle ]] ||
  { tail -n 5 "$work/slurmctld.log" "$work/slurmd.log" >&2; Skip "a Slurm of one node does not start here"; }

SmallCampaign
cd "$work"
mkdir out
sbatch --quiet --wait --array=0-2 --output="$work/out/slurm-%a.log" "$source_dir/twin/campaign/cluster/slurm.sbatch" C.toml out ||
  { tail -n 5 "$work"/out/slurm-*.log >&2; Fail "the job array failed"; }
Expect "three shards as a Slurm job array" "$work/out"

# 75 is queued again, anything else is not.
FakeProgram "$work/busy" 75 0
FakeProgram "$work/broken" 78 0
code=0
TUBETWIN=$work/broken sbatch --quiet --wait --array=0-0 --output="$work/broken.log" \
  "$source_dir/twin/campaign/cluster/slurm.sbatch" C.toml broken.out || code=$?
[[ $code == 78 && $(Runs "$work/broken") == 1 ]] || Fail "78: exit $code after $(Runs "$work/broken") runs"
TUBETWIN=$work/busy sbatch --quiet --wait --array=0-0 --output="$work/busy.log" \
  "$source_dir/twin/campaign/cluster/slurm.sbatch" C.toml busy.out || Fail "75 was not queued again: $(cat "$work/busy.log")"
[[ $(Runs "$work/busy") == 2 ]] || Fail "75, then 0: $(Runs "$work/busy") runs"
echo "75 is queued again, 78 is not"
