#!/bin/bash
# tests/cluster/cluster_test.sh AIRLIGHT: runs sweep.sbatch for real, as an array of four and a job that joins them, on a
# cluster of this machine alone, and compares with one run. A task is killed, and the array is submitted again. Needs
# root, and Debian's slurmctld, slurmd, slurm-client and munge; where they are missing or do not start it says so and
# exits with 77.
set -euo pipefail
export AIRLIGHT
AIRLIGHT=$(realpath "$1")
script=$(realpath "$(dirname "$0")/sweep.sbatch")

skip() {
  echo "skipped: $1"
  exit 77
}
[ "$(id -u)" -eq 0 ] || skip "Slurm needs root here"
for program in munged slurmctld slurmd sbatch sinfo squeue; do
  command -v "$program" >/dev/null || skip "$program is not installed (slurmctld, slurmd, slurm-client, munge)"
done

work=$(mktemp -d)
daemons=()
finish() {
  local pid
  for pid in "${daemons[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${daemons[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap finish EXIT
cd "$work"
mkdir state spool munge
chmod 711 . munge  # whoever has a socket must be able to reach it

# A cluster of one node.
dd if=/dev/urandom of=munge/key bs=1024 count=1 status=none
chmod 400 munge/key
munged --foreground --key-file "$work/munge/key" --socket "$work/munge/socket" --pid-file "$work/munge/pid" \
  --log-file "$work/munge/log" --seed-file "$work/munge/seed" >munged.out 2>&1 &
daemons+=($!)
port=$((20000 + $$ % 20000))
cat >slurm.conf <<CONF
ClusterName=airlight
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=1
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
CONF
export SLURM_CONF=$work/slurm.conf
slurmctld -D >slurmctld.out 2>&1 &
daemons+=($!)
slurmd -D >slurmd.out 2>&1 &
daemons+=($!)
deadline=$((SECONDS + 30))
until state=$(timeout 5 sinfo -h -o %T 2>/dev/null || true) && [ "$state" = idle ] || [ $SECONDS -gt $deadline ]; do
  sleep 0.5
done
[ "${state:-}" = idle ] || skip "Slurm does not start here: $(tail -qn 1 munged.out slurmctld.log slurmd.log 2>/dev/null | tr '\n' ' ')"

options=(cornell --size 16x16 --theta 32 --frames 2 --quiet --volume 'vsv:alpha={8,16,32}:phi={128,256}' --shadow-map '{16,32}')
submit() {
  # afterany: of the array in which a task dies, too, what there is is joined.
  array=$(sbatch --parsable --array=1-4 "$script" out "${options[@]}")
  joining=$(sbatch --parsable --dependency="afterany:$array" "$script" out)
}
wait_for_jobs() {
  for _ in $(seq 400); do
    [ -n "$(squeue -h)" ] || return 0
    sleep 0.3
  done
  echo "jobs do not end:"
  squeue
  exit 1
}
# Keys, errors and memory: all of a run that does not depend on when and where it ran.
told() {
  sed -E 's/^\{"key":"([0-9a-f]+)".*("bytes":.*),"timing":.*/\1 \2/' "$@" | sort
}

# A task is killed a second after it was seen to run.
submit
for _ in $(seq 200); do
  victim=$(squeue -h -t R -o %i -j "$array" | head -n 1)
  [ -n "$victim" ] && break
  sleep 0.1
done
sleep 1
scancel --signal=KILL --full "$victim" || true
wait_for_jobs
killed=$(cat out/runs-*-of-4.jsonl | wc -l)

# The array once more: what is there is not measured again.
submit
wait_for_jobs
"$AIRLIGHT" sweep "${options[@]}" -o whole
told whole/runs.jsonl >expected
if ! diff expected <(told out/runs-*-of-4.jsonl) || ! diff expected <(told out/runs.jsonl); then
  echo "the shards joined are not the whole"
  cat airlight-*.log
  exit 1
fi
[ "$(wc -l <expected)" -eq 12 ] || { echo "not 12 runs"; exit 1; }
grep -q '"runs": 12' out/front.json || { echo "the front lacks runs"; exit 1; }
echo "$killed of 12 runs after $victim was killed, 12 after the array ran again; shards joined equal one run"
