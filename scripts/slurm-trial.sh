#!/bin/bash
# Runs the batch script of docs/cluster.md, on two ranks, under a Slurm of one node that is started for the purpose.
#
#   scripts/slurm-trial.sh FELDSPAR INPUT.prm FOLDER
#
# Once the first job has a checkpoint it gets the signal that Slurm sends before the end of a job's time; the job that it
# submits goes on. The results are in FOLDER/RUN, the outputs of the jobs in FOLDER/slurm-*.out. Fails if a job does, or
# after five minutes; ends with 77 where Slurm itself does not come up. Needs Debian's slurm-wlm, and root.
set -euo pipefail
program=$(realpath "$1") input=$(realpath "$2") folder=$3
page=$(realpath "$(dirname "$0")/../docs/cluster.md")
mkdir -p "$folder"/{spool,state}
folder=$(realpath "$folder")
munge=$(mktemp --directory) # whose user must get there, whoever may enter FOLDER
host=$(hostname -s)

started=()
end()
{
  scancel --user=root 2>/dev/null || true
  for pid in "${started[@]}"; do kill "$pid" 2>/dev/null || true; done
  wait
  rm --recursive --force "$munge"
}
trap end EXIT

chmod 711 "$munge"
chown munge "$munge"
dd if=/dev/urandom of="$munge/key" bs=1 count=1024 status=none
chown munge "$munge/key"
chmod 400 "$munge/key"
# --force: others may write in a temporary folder, which munged would not have above its socket.
setpriv --reuid munge --regid munge --clear-groups munged --foreground --force --key-file "$munge/key" \
  --socket "$munge/socket" --pid-file "$munge/pid" --log-file "$munge/log" \
  --seed-file "$munge/seed" >"$folder/munged.log" 2>&1 &
started+=($!)
for _ in $(seq 50); do
  [[ -S $munge/socket ]] && break
  sleep 0.1
done
[[ -S $munge/socket ]] || { cat "$folder/munged.log"; exit 77; }

cat >"$folder/slurm.conf" <<END
ClusterName=trial
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$munge/socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldPort=16817
SlurmdPort=16818
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=pmix
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=trial Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$folder/slurm.conf
slurmctld -D >"$folder/slurmctld.log" 2>&1 &
started+=($!)
slurmd -D >"$folder/slurmd.log" 2>&1 &
started+=($!)
is_up() { sinfo --noheader --format=%T 2>/dev/null | grep --quiet idle; }
for _ in $(seq 60); do
  is_up && break
  sleep 0.5
done
is_up || { cat "$folder"/slurm*.log; exit 77; }

# The page's script with the names and the size of this trial.
cd "$folder"
sed --quiet '/^#!\/bin\/bash/,/^```/{/^```/!p}' "$page" |
  sed "s|INPUT.prm|$input|; s|feldspar multiscale|$program multiscale|
    s|--nodes=[0-9]*|--nodes=1|; s|--ntasks-per-node=[0-9]*|--ntasks-per-node=2|; s|--cpus-per-task=[0-9]*|--cpus-per-task=1|" >job.sh
job=$(sbatch --parsable job.sh)

# wait_until COMMAND...
wait_until()
{
  local deadline=$((SECONDS + 300))
  until "$@"; do
    ((SECONDS < deadline)) || { echo "in vain: $*" && cat slurm-*.out && exit 1; }
    sleep 0.02
  done
}
has_checkpoint() { compgen -G 'RUN/states/*/step-*' >/dev/null; }
has_no_jobs() { [[ -z $(squeue --noheader) ]]; }

wait_until has_checkpoint
scancel --signal=USR1 "$job"
wait_until has_no_jobs
tail --lines=30 slurm-*.out
scontrol --oneliner show job | grep --only-matching 'JobId=[0-9]*\|JobState=[A-Z]*\|ExitCode=[0-9:]*' | paste - - -
! scontrol --oneliner show job | grep --quiet --invert-match 'JobState=COMPLETED'
