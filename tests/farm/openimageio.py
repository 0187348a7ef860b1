"""Reads a picture of tests/farm/openimageio.sh with OpenImageIO and checks it against its definitions."""

import json
import sys

import numpy as np
import OpenImageIO as oiio

FLOATS = "R G B N.X N.Y N.Z Ng.X Ng.Y Ng.Z P.X P.Y P.Z albedo.R albedo.G albedo.B depth.Z uv.U uv.V".split()
UINTS = "id.material id.object id.primitive mask.hit samples.count".split()

path = sys.argv[1]
image = oiio.ImageInput.open(path)
spec = image.spec()
kinds = dict(zip(spec.channelnames, map(str, spec.channelformats)))
assert kinds == {name: "float" for name in FLOATS} | {name: "uint" for name in UINTS}, kinds
assert not image.seek_subimage(1, 0), "one part"
image.seek_subimage(0, 0)


def channel(name):
    at = spec.channelnames.index(name)
    return image.read_image(0, 0, at, at + 1, oiio.UINT if name in UINTS else oiio.FLOAT)[..., 0]


def vector(layer, axes="XYZ"):
    return np.stack([channel(f"{layer}.{axis}") for axis in axes], -1)


hit = channel("mask.hit") == 1
assert hit.any() and not hit.all()
assert (channel("samples.count") == 4).all()
for name in set(FLOATS + UINTS) - set("R G B depth.Z samples.count".split()):
    assert (channel(name)[~hit] == 0).all(), f"{name} where nothing is hit"
depth = channel("depth.Z")
assert np.isposinf(depth[~hit]).all() and np.isfinite(depth[hit]).all()

# Ids, from 1 as the scene file lists objects and materials; the cylinder has no material.
sphere, cylinder = channel("id.object") == 1, channel("id.object") == 2
assert (sphere | cylinder == hit).all() and sphere.any() and cylinder.any()
assert (channel("id.material") == np.where(sphere, 1, 0)).all()
assert len(np.unique(channel("id.primitive")[hit])) == 2
assert (vector("albedo", "RGB")[sphere] == [0.5, 0.25, 0.125]).all()
assert np.allclose(vector("N")[sphere], vector("P")[sphere], atol=1e-6), "normals of a unit sphere at the origin"

# The camera's file: where points of the world are seen, and how far along the view axis.
with open(path.replace(".exr", ".camera.json")) as file:
    camera = json.load(file)
to_camera, to_world = np.array(camera["world_to_camera"]), np.array(camera["camera_to_world"])
assert np.allclose(to_camera @ to_world, np.eye(4))
points = vector("P")
seen = points @ to_camera[:3, :3].T + to_camera[:3, 3]
assert np.allclose(seen[..., 2][hit], depth[hit], rtol=1e-6)
along = 1 if camera["projection"]["kind"] == "orthographic" else seen[..., 2]
with np.errstate(divide="ignore", invalid="ignore"):
    x = camera["fx"] * seen[..., 0] / along + camera["cx"]
    y = camera["fy"] * seen[..., 1] / along + camera["cy"]
rows, columns = np.mgrid[0 : spec.height, 0 : spec.width]
assert np.abs(x - columns - 0.5)[hit].max() < 1e-3 and np.abs(y - rows - 0.5)[hit].max() < 1e-3

# Normals: unit length, towards the camera.
orthographic = camera["projection"]["kind"] == "orthographic"
towards = np.broadcast_to(to_world[:3, 2], points.shape) if orthographic else points - to_world[:3, 3]
for layer in ("N", "Ng"):
    normals = vector(layer)
    assert np.allclose(np.linalg.norm(normals, axis=-1)[hit], 1, atol=1e-5)
    assert ((normals * towards).sum(-1)[hit] < 1e-4).all()
