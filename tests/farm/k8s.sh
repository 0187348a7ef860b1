#!/usr/bin/env bash
# The emitted Kubernetes manifest against the API's own schema, by kubernetes-validate: no cluster is needed, unknown keys
# and wrong types are refused.
#
#   tests/farm/k8s.sh target/release/octray
set -euo pipefail

octray=$(realpath "$1")
command -v kubernetes-validate >/dev/null || { echo 'skipped: kubernetes-validate is not installed'; exit 0; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cat >'Turn of 2 (ä).toml' <<'END'
scene = "seed"
size = [8, 6]
frames = "1-2"
[[output]]
path = "turn.####.exr"
END
for shards in 1 1000; do
    "$octray" plan 'Turn of 2 (ä).toml' -o 'a "plan".plan' --shards "$shards" --emit k8s >job.yaml
    kubernetes-validate --strict job.yaml
done
# A validator that lets everything pass would show nothing.
sed 's/backoffLimitPerIndex:/backoffLimitPerIndx:/' job.yaml >wrong.yaml
if kubernetes-validate --strict wrong.yaml >/dev/null 2>&1; then
    echo 'a misspelled key passed'
    exit 1
fi
echo 'kubernetes: the manifest is a Job by the schema of the API'
