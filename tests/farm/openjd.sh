#!/usr/bin/env bash
# The emitted Open Job Description template, run on this machine by openjd-cli: the bytes of a local run.
#
#   tests/farm/openjd.sh target/release/octray
set -euo pipefail

octray=$(realpath "$1")
command -v openjd >/dev/null || { echo 'skipped: openjd is not installed'; exit 0; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
ln -s "$octray" "$work/bin/octray"
export PATH=$work/bin:$PATH
cd "$work"
cat >turn.toml <<'END'
scene = "seed"
size = [80, 60]
spp = 40
frames = "1-2"
[[output]]
path = "turn.####.exr"
aovs = ["depth", "object_id"]
END
octray plan turn.toml --split samples --shards 3 --emit openjd >turn.yaml
openjd check turn.yaml
openjd run turn.yaml -p Plan="$work/turn.plan" -p Output="$work/out" >log.txt || { cat log.txt; exit 1; }
octray batch turn.toml -o local --quiet
for picture in turn.0001.exr turn.0002.exr turn.0001.camera.json; do
    cmp "out/$picture" "local/$picture"
done
echo 'openjd: 3 shards and their merge: the bytes of a local run'
