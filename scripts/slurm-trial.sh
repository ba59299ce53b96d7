#!/bin/bash
# Runs the batch script of docs/cluster.md under a Slurm of one node, started for the purpose in a folder of its own.
# Needs Debian's slurm-wlm and root: scripts/slurm-trial.sh FELDSPAR INPUT.prm FOLDER
set -euo pipefail
program=$(realpath "$1"); input=$(realpath "$2"); folder=$3
page=$(realpath "$(dirname "$0")/../docs/cluster.md")
mkdir -p "$folder"/{spool,state,munge}; folder=$(realpath "$folder")
host=$(hostname -s)
started=()
end() { for pid in "${started[@]}"; do kill "$pid" 2> /dev/null || true; done; }
trap end EXIT

chmod 711 "$folder"; chown munge "$folder/munge"; chmod 711 "$folder/munge"
dd if=/dev/urandom of="$folder/munge/key" bs=1 count=1024 status=none
chown munge "$folder/munge/key"; chmod 400 "$folder/munge/key"
setpriv --reuid munge --regid munge --clear-groups munged --foreground --force --key-file "$folder/munge/key" \
  --socket "$folder/munge/socket" --pid-file "$folder/munge/pid" --log-file "$folder/munge/log" --seed-file "$folder/munge/seed" & started+=($!)

cat > "$folder/slurm.conf" <<END
ClusterName=trial
SlurmctldHost=$host
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
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
NodeName=$host CPUs=$(nproc) State=UNKNOWN
PartitionName=trial Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$folder/slurm.conf
slurmctld -D > "$folder/slurmctld.log" 2>&1 & started+=($!)
slurmd -D > "$folder/slurmd.log" 2>&1 & started+=($!)
for _ in $(seq 30); do sinfo -h -o %T 2> /dev/null | grep -q idle && break; sleep 1; done
sinfo

# The page's script, with names put in.
cd "$folder"
sed -n '/^#!\/bin\/bash/,/^```/{/^```/!p}' "$page" | sed "s|INPUT.prm|$input|; s|feldspar multiscale|$program multiscale|" > job.sh
sbatch --nodes=1 --ntasks-per-node=2 --cpus-per-task=1 job.sh
while squeue -h | grep -q .; do sleep 2; done
tail -n 30 slurm-*.out
