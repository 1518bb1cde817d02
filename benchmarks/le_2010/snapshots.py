# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: pictures of the shell in space, coloured by its velocity along the flow.
"""Reads the shell_NNNN.vtu that the program writes (no VTK needed) and draws them with matplotlib: the smooth surface, whose points, velocities and normals the
files hold at the corners of its subdivided faces."""

import base64
import pathlib
import xml.etree.ElementTree as ElementTree

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import TriMesh
from matplotlib.tri import Triangulation

CAMERA = 32, -62  # elevation and azimuth in degrees; the shear plane is seen from the front
LAMP = 50, -150
TYPES = {"Float64": np.float64, "Int64": np.int64, "Int32": np.int32, "UInt8": np.uint8}


def read_vtu(file):
    """{"points": n x 3, "faces": m x 3, field: array}."""
    arrays = {}
    for element in ElementTree.parse(file).getroot().iter("DataArray"):
        data = base64.b64decode(element.text.strip())[8:]  # without the number of bytes in front
        columns = int(element.get("NumberOfComponents", "1"))
        values = np.frombuffer(data, dtype=TYPES[element.get("type")])
        arrays[element.get("Name")] = values.reshape(-1, columns) if columns > 1 else values
    arrays["faces"] = arrays["connectivity"].reshape(-1, 3)
    arrays["points"] = next(value for name, value in arrays.items() if name.lower() in ("points", "positions"))
    return arrays


def snapshots_of(folder):
    """[(time, file)] of shell.pvd."""
    series = pathlib.Path(folder) / "shell.pvd"
    if not series.is_file():
        return []
    entries = ElementTree.parse(series).getroot().iter("DataSet")
    return [(float(entry.get("timestep")), series.parent / entry.get("file")) for entry in entries]


def marker_of(points):
    """The point that lies furthest along the long axis of the section at the start; it moves with the material."""
    x, z = points[:, 0], points[:, 2]
    angle = 0.5 * np.arctan2(2 * np.sum(x * z), np.sum(x * x) - np.sum(z * z))
    return int(np.argmax(x * np.cos(angle) + z * np.sin(angle)))


def direction(elevation, azimuth):
    """Unit vector from the capsule towards whom or what is there, seen from it at these angles in degrees."""
    elevation, azimuth = np.radians(elevation), np.radians(azimuth)
    return np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])


EYE = direction(*CAMERA)
SCREEN = np.array([np.cross([0.0, 0.0, 1.0], EYE) / np.cos(np.radians(CAMERA[0])), direction(CAMERA[0] + 90, CAMERA[1])])  # to the right and up


def with_normals(shell):
    """A shell whose file holds no normals of the surface, as earlier ones: flat faces, each with its own vertices."""
    if "normals" in shell:
        return shell
    corners = shell["points"][shell["faces"]]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flat /= np.linalg.norm(flat, axis=1)[:, None]
    return {"points": corners.reshape(-1, 3), "faces": np.arange(shell["faces"].size).reshape(-1, 3), "normals": np.repeat(flat, 3, axis=0),
            "velocity": shell["velocity"][shell["faces"]].reshape(-1, 3)}


def colors_of(shell, limit):
    """Of the vertices: velocity along the flow, under the light of a lamp and of the surroundings."""
    colors = plt.cm.coolwarm(0.5 + 0.5 * np.clip(shell["velocity"][:, 0] / limit, -1, 1))
    lamp = direction(*LAMP)
    half = (lamp + EYE) / np.linalg.norm(lamp + EYE)
    diffuse, highlight = np.clip(shell["normals"] @ lamp, 0, 1), np.clip(shell["normals"] @ half, 0, 1) ** 40  # Lambert, Blinn and Phong
    colors[:, :3] = np.clip(colors[:, :3] * (0.45 + 0.6 * diffuse)[:, None] + 0.15 * highlight[:, None], 0, 1)
    return colors


def draw_shell(axis, shell, marker, limit):
    """The side that is turned to us, in parallel projection, and the marker, which is hollow when it is on the far side."""
    shown = with_normals(shell)
    points, faces = shown["points"], shown["faces"]
    flat = points @ SCREEN.T
    edges = flat[faces[:, 1:]] - flat[faces[:, :1]]
    in_front = faces[edges[:, 0, 0] * edges[:, 1, 1] > edges[:, 0, 1] * edges[:, 1, 0]]
    in_front = in_front[np.argsort((points @ EYE)[in_front].mean(axis=1))]  # the nearest last
    mesh = TriMesh(Triangulation(flat[:, 0], flat[:, 1], in_front))
    mesh.set_facecolor(colors_of(shown, limit))
    axis.add_collection(mesh)
    place = SCREEN @ shell["points"][marker]
    is_visible = shown["normals"][np.argmin(np.linalg.norm(points - shell["points"][marker], axis=1))] @ EYE > 0
    axis.plot(*place, "o", color="black", markersize=5, markerfacecolor="black" if is_visible else "none", zorder=10)
    axis.set(xlim=(-1.85, 1.85), ylim=(-1.6, 1.6), aspect="equal")
    axis.set_axis_off()


def draw(results, wanted=6):
    """A row of pictures for each run."""
    rows = [(result, snapshots_of(result.folder)) for result in results if result.series]
    rows = [(result, shots) for result, shots in rows if len(shots) > 1]
    if not rows:
        return None
    figure = plt.figure(figsize=(2.1 * wanted, 2.1 * len(rows)))
    for i, (result, shots) in enumerate(rows):
        chosen = [shots[k] for k in np.unique(np.linspace(0, len(shots) - 1, wanted).astype(int))]
        marker = marker_of(read_vtu(shots[0][1])["points"])
        shells = [(time, read_vtu(file)) for time, file in chosen]
        limit = max(np.abs(shell["velocity"][:, 0]).max() for _, shell in shells)
        for k, (time, shell) in enumerate(shells):
            axis = figure.add_subplot(len(rows), wanted, i * wanted + k + 1)
            draw_shell(axis, shell, marker, limit)
            axis.set_title(rf"$\hat\kappa$ = {result.khat:g}, $\dot\gamma t$ = {time:.3g}", fontsize=8)
    return figure
