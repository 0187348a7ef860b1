#!/usr/bin/env bash
# A real Slurm on this machine's loopback: the emitted script in 8 shards, one task requeued in the middle, the merge by
# dependency, and the bytes of a local run. Needs Debian's slurm-wlm and munge, and root to start them; no systemd.
#
#   tests/farm/slurm.sh target/release/octray
set -euo pipefail

octray=$(realpath "$1")
for program in munged slurmctld slurmd sbatch; do
    command -v "$program" >/dev/null || { echo "skipped: $program is not installed"; exit 0; }
done
[ "$(id -u)" = 0 ] || { echo 'skipped: starting Slurm needs root'; exit 0; }

work=$(mktemp -d)
chmod 755 "$work"
pids=()
stop() {
    for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
    for file in "$work"/*.pid; do [ -f "$file" ] && kill "$(cat "$file")" 2>/dev/null || true; done
    wait 2>/dev/null || true
    rm -rf "$work"
}
trap stop EXIT

# Reads a condition until it holds, or for so many seconds.
holds_within() {
    local seconds=$1
    shift
    for _ in $(seq "$((seconds * 4))"); do
        "$@" && return
        sleep 0.25
    done
    echo "gave up waiting: $*"
    tail -n 20 "$work"/*.log || true
    return 1
}
await() { holds_within "$@" || exit 1; }
# A machine may have the packages and still not let them run.
await_start() { holds_within "$@" || { echo 'skipped: Slurm does not start here'; exit 0; }; }

start_munge() {
    install -d -m 700 -o munge -g munge "$work/munge"
    dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 status=none
    chown munge:munge "$work/munge/key"
    chmod 400 "$work/munge/key"
    install -d -m 755 -o munge -g munge /run/munge
    runuser -u munge -- munged --force --foreground --key-file="$work/munge/key" --socket="/run/munge/munge.socket.2" \
        --pid-file="$work/munge/munged.pid" --log-file="$work/munge/munged.log" --seed-file="$work/munge/seed" 2>/dev/null &
    pids+=($!)
    await_start 10 test -S /run/munge/munge.socket.2
}

start_slurm() {
    local host
    host=$(hostname -s)
    cat >"$work/slurm.conf" <<END
ClusterName=octray
SlurmctldHost=$host(127.0.0.1)
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
AuthType=auth/munge
AuthInfo=socket=/run/munge/munge.socket.2
CredType=cred/munge
SlurmUser=root
SlurmctldPort=17000
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd-%n.pid
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool-%n
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=17001 CPUs=1 State=UNKNOWN
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=17002 CPUs=1 State=UNKNOWN
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
END
    export SLURM_CONF=$work/slurm.conf
    mkdir "$work/state"
    slurmctld -D -f "$SLURM_CONF" >/dev/null 2>&1 &
    pids+=($!)
    for node in n1 n2; do
        slurmd -D -N "$node" -f "$SLURM_CONF" >/dev/null 2>&1 &
        pids+=($!)
    done
    await_start 30 sh -c '[ "$(sinfo -h -t idle -o %D 2>/dev/null)" = 2 ]'
}

plan_work() {
    mkdir "$work/job" "$work/bin"
    ln -s "$octray" "$work/bin/octray"
    export PATH=$work/bin:$PATH
    cd "$work/job"
    cat >turn.toml <<'END'
scene = "seed"
size = [160, 120]
spp = 256
frames = "1-2"
[[keyframes]]
key = "camera.fov_deg"
frames = [1, 2]
values = [30, 60]
[[output]]
path = "turn.####.exr"
aovs = ["depth", "object_id"]
END
    octray plan turn.toml --split samples --shards 8 --emit slurm >submit.sh
}

# The number of tasks of an array in some state.
tasks() { squeue -h -r -j "$1" -t "$2" -o %i 2>/dev/null | wc -l; }
some_task_runs() { [ "$(tasks "$1" RUNNING)" -gt 0 ]; }
is_merged() { grep -q 'turn: 2 of 2 pictures' octray-turn-merge.log 2>/dev/null; }

start_munge
start_slurm
plan_work
array=$(sh submit.sh --cpus-per-task=1 | sed -n 's/^array //p')
await 20 some_task_runs "$array"
victim=$(squeue -h -r -j "$array" -t RUNNING -o %i | head -n 1)
# Slurm holds a task that is put back for two minutes.
victim=${victim:-${array}_0}
scontrol requeue "$victim"
echo "requeued $victim"
await 240 is_merged
octray batch turn.toml -o local --quiet
for picture in turn.0001.exr turn.0002.exr turn.0001.camera.json; do
    cmp "$picture" "local/$picture"
done
echo 'slurm: 8 shards, one requeued, merged by dependency: the bytes of a local run'
