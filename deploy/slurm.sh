#!/bin/sh
# An array job of Slurm. Each task flies one shard of a campaign. docs/clusters.md describes it.
#
#   sbatch --array=1-20 deploy/slurm.sh my-campaign.toml --flights 1000000
#
# Submit the same line again for what was lost: finished shards end at once, and the others go on where their files end.
#
#SBATCH --job-name=betadeck
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=256M
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=betadeck-%a.log
set -eu

# The folder of the parts, on a file system that all nodes share.
PARTS=${PARTS:-parts}
mkdir -p "$PARTS"

exec "${BETADECK:-betadeck}" campaign "$@" \
    --shard slurm \
    --jobs "${SLURM_CPUS_PER_TASK:-1}" \
    --out "$PARTS/part-$SLURM_ARRAY_TASK_ID.jsonl"
