#!/bin/sh
# Runs the @SHARDS@ shards of a plan, one after the other on all processors, and merges. Options for GNU parallel go
# behind this script's name, such as --sshlogin hosts.
set -eu
seq 0 @LAST@ | parallel --quote --jobs 1 "$@" octray run @PLAN@ --shard '{}/@SHARDS@' --quiet
exec octray merge @PLAN@
