#!/bin/sh
# Submits the @SHARDS@ shards of a plan, and the merge. Options for sbatch (partition, time, memory) go behind this
# script's name: sh FILE --partition=short --cpus-per-task=8 --time=1:00:00
set -eu
array=$(sbatch --parsable --job-name=@NAME@ --array=0-@LAST@ --requeue --open-mode=append \
    --signal=B:USR1@30 --output=@NAME@-%a.log "$@" <<'END'
#!/bin/sh
exec octray run @PLAN@ --shard auto --progress plain
END
)
echo "array $array"
sbatch --job-name=@NAME@-merge --dependency=afterany:"$array" --open-mode=append \
    --output=@NAME@-merge.log "$@" <<'END'
#!/bin/sh
exec octray merge @PLAN@
END
