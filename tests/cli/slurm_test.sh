#!/usr/bin/env bash
# A Slurm job array of spectile upsample converts every image exactly once: a whole Slurm on this machine alone, in a
# temporary folder, as the present user. usage: slurm_test.sh SPECTILE. Exits 77, saying why, where Slurm
# cannot run.
set -uo pipefail
tool=$1
images=11

skip() { echo "SKIPPED: $1"; exit 77; }
fail() {
  echo "FAILED: $1"
  for log in "$dir"/*.log "$dir"/job-*; do
    [ -s "$log" ] && { echo "--- $log"; tail -n 20 "$log"; }
  done
  exit 1
}

for program in munged slurmctld slurmd sbatch scancel squeue sinfo; do
  PATH=$PATH:/usr/sbin command -v "$program" >/dev/null || skip "there is no $program (Debian: munge, slurmctld, slurmd, slurm-client)"
done
PATH=$PATH:/usr/sbin

# munged wants a folder that nobody else may write to; a socket's path has at most 107 characters.
dir=$(mktemp -d /tmp/spectile-slurm-XXXXXX)
pids=()
cleanup() {
  [ -S "$dir/munge.socket" ] && timeout 10 env SLURM_CONF="$dir/slurm.conf" scancel --quiet --user="$(id -un)" 2>/dev/null
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null; done
  for pid in "${pids[@]}"; do
    for _ in $(seq 50); do kill -0 "$pid" 2>/dev/null || break; sleep 0.1; done
    kill -9 "$pid" 2>/dev/null
    wait "$pid" 2>/dev/null
  done
  # Steps leave their slurmd's family; they are known by the configuration that they were started with.
  for environment in /proc/[0-9]*/environ; do
    if tr '\0' '\n' <"$environment" 2>/dev/null | grep -qxF "SLURM_CONF=$dir/slurm.conf"; then
      pid=${environment#/proc/}
      kill -9 "${pid%/environ}" 2>/dev/null
    fi
  done 2>/dev/null
  rm -rf "$dir"
}
trap cleanup EXIT
trap 'exit 130' INT TERM

chmod 755 "$dir"
mkdir "$dir/state" "$dir/spool" "$dir/in"
head -c 1024 /dev/urandom >"$dir/munge.key"
chmod 600 "$dir/munge.key"
host=$(hostname -s)
user=$(id -un)
# Ports that nobody listens on: two runs side by side must not meet.
free_port() {
  local port
  while :; do
    port=$((20000 + RANDOM % 12000))
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port"; return; }
  done
}
cat >"$dir/slurm.conf" <<CONF
ClusterName=spectile
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
CredType=cred/munge
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
SlurmdParameters=config_overrides
# Array tasks run beside each other even on one core.
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 RealMemory=1000 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=5 State=UP
CONF

munged --foreground --force --key-file="$dir/munge.key" --socket="$dir/munge.socket" --pid-file="$dir/munge.pid" \
  --log-file="$dir/munged.log" --seed-file="$dir/munge.seed" --num-threads=2 >"$dir/munged-out.log" 2>&1 &
pids=($!)
for _ in $(seq 50); do [ -S "$dir/munge.socket" ] && break; sleep 0.1; done
[ -S "$dir/munge.socket" ] || skip "munged does not start: $(tail -n 1 "$dir/munged-out.log" "$dir/munged.log" 2>/dev/null | tr '\n' ' ')"
export SLURM_CONF="$dir/slurm.conf"
slurmctld -D -c >"$dir/slurmctld.log" 2>&1 &
pids=($! "${pids[@]}")
slurmd -D -N "$host" >"$dir/slurmd.log" 2>&1 &
pids=($! "${pids[@]}")
export -n SLURM_CONF
slurm() { timeout 120 env SLURM_CONF="$dir/slurm.conf" "$@"; }
up=
for _ in $(seq 100); do
  if slurm sinfo --noheader --format=%t 2>/dev/null | grep -q idle; then up=yes; break; fi
  kill -0 "${pids[0]}" 2>/dev/null || skip "slurmd does not stay up: $(grep -iE 'fatal|error' "$dir/slurmd.log" | tail -n 1)"
  kill -0 "${pids[1]}" 2>/dev/null || skip "slurmctld does not stay up: $(grep -iE 'fatal|error' "$dir/slurmctld.log" | tail -n 1)"
  sleep 0.2
done
[ -n "$up" ] || skip "the node does not come up: $(slurm sinfo 2>&1 | tail -n 1); $(grep -i error "$dir"/slurm*.log | tail -n 1)"

image=$dir/demo/chart.exr
"$tool" demo "$dir/demo" --quiet || fail "no image to convert"
for i in $(seq "$images"); do cp "$image" "$dir/in/$i.exr"; touch -d '1 minute ago' "$dir/in/$i.exr"; done

# --- four tasks: every image once ---------------------------------------------------------------------------------------
slurm sbatch --quiet --wait --chdir="$dir" --output="$dir/job-%a" --array=0-3 \
  --wrap="'$tool' upsample in/*.exr -o out/ --manifest manifest.jsonl" || fail "sbatch: exit $?"
made=$(find "$dir/out" -name '*.exr' | wc -l)
[ "$made" -eq "$images" ] || fail "$made outputs of $images images"
listed() { sed -n "s/.*\"input\":\"\([^\"]*\)\".*\"shard\":\"\([^\"]*\)\".*\"status\":\"$1\".*/\1 \2/p" "$dir/manifest.jsonl" | sort; }
once=$(listed converted | cut -d' ' -f1 | uniq -u | wc -l)
lines=$(wc -l <"$dir/manifest.jsonl")
[ "$once" -eq "$images" ] && [ "$lines" -eq "$images" ] || fail "$once of $images images once in $lines lines"
shards=$(listed converted | cut -d' ' -f2 | sort | uniq -c | awk '{print $1, $2}' | tr '\n' ';')
[ "$shards" = "3 0/4;3 1/4;3 2/4;2 3/4;" ] || fail "shards: $shards"
for task in 0 1 2 3; do grep -q "^shard $task/4: " "$dir/job-$task" || fail "task $task does not say its shard"; done
"$tool" upsample "$image" -o "$dir/alone.exr" --quiet && cmp "$dir/alone.exr" "$dir/out/7.exr" || fail "other bytes than alone"

# --- again, from task 1 in steps of 2: all is up to date but what is missing --------------------------------------------
rm "$dir/out/5.exr" "$dir/manifest.jsonl"
slurm sbatch --quiet --wait --chdir="$dir" --output="$dir/job-again-%a" --array=1-5:2 \
  --wrap="'$tool' upsample in/*.exr -o out/ -u --manifest manifest.jsonl" || fail "sbatch: exit $?"
[ "$(listed up-to-date | wc -l)" -eq $((images - 1)) ] || fail "not all but one up to date"
[ "$(listed converted | cut -d' ' -f1)" = in/5.exr ] || fail "the missing one is not made anew"
[ "$(listed up-to-date | cut -d' ' -f2 | sort -u | tr '\n' ' ')" = "0/3 1/3 2/3 " ] || fail "other shards than 0 to 2 of 3"

# --- a task that fails fails the array -----------------------------------------------------------------------------------
echo "no image" >"$dir/in/2.exr"
slurm sbatch --quiet --wait --chdir="$dir" --output="$dir/job-bad-%a" --array=0-1 \
  --wrap="'$tool' upsample in/*.exr -o out/ -u"
[ $? -eq 1 ] || fail "an image that cannot be read does not fail the array"
echo "PASSED: $images images by 4 tasks, then by 3"
