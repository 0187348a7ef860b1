#!/usr/bin/env bash
# Pictures with every value beside colour, as OpenImageIO reads them: names and types of the channels, and whether the numbers
# are those of their definitions and of the camera's file. Needs Python with the packages OpenImageIO and numpy.
#
#   tests/farm/openimageio.sh target/release/octray
set -euo pipefail

octray=$(realpath "$1")
check=$(realpath "$(dirname "$0")/openimageio.py")
python3 -c 'import OpenImageIO, numpy' 2>/dev/null || { echo 'skipped: OpenImageIO is not installed'; exit 0; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
scene() {
    cat <<END
[render]
size = [96, 64]
spp = 4
aovs = ["depth", "position", "geometric_normal", "shading_normal", "uv", "object_id", "primitive_id", "material_id", "albedo", "hit", "sample_count"]
[camera]
position = [1, 2, -6]
look_at = [0.3, 0, 0]
up = [0.1, 1, 0]
$1
[[light.point]]
position = [-4, 5, -3]
intensity = 56
[[material]]
name = "red"
kind = "diffuse"
kd = [0.5, 0.25, 0.125]
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "red"
[[cylinder]]
from = [-2, -1, 0]
to = [-2, 1, 0]
radius = 0.4
END
}
for camera in 'fov_deg = 50' $'kind = "orthographic"\nheight = 6' $'fov_deg = 50\naperture_radius = 0.1' $'fov_deg = 50\nhandedness = "left"'; do
    scene "$camera" >scene.toml
    "$octray" render scene.toml -o a.exr --quiet
    python3 "$check" a.exr
done
echo 'OpenImageIO: 4 pictures are what they say'
