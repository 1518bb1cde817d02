# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: pictures of the shell in space, coloured by its velocity along the flow.
"""Reads the shell_NNNN.vtu that the program writes (no VTK needed) and draws them with matplotlib."""

import base64
import pathlib
import xml.etree.ElementTree as ElementTree

import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

ELEVATION, AZIMUTH = 32, -62  # degrees; the shear plane is seen from the front
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
    """The vertex that lies furthest along the long axis of the section at the start, the one that the program follows."""
    x, z = points[:, 0], points[:, 2]
    angle = 0.5 * np.arctan2(2 * np.sum(x * z), np.sum(x * x) - np.sum(z * z))
    return int(np.argmax(x * np.cos(angle) + z * np.sin(angle)))


def draw_shell(axis, shell, marker, limit):
    """Shaded faces and the marker, which is hollow when it is on the far side."""
    points, faces = shell["points"], shell["faces"]
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    light = 0.65 + 0.35 * np.clip(normals @ np.array([-0.3, -0.8, 0.52]), 0, 1)
    colors = plt.cm.coolwarm(0.5 + 0.5 * np.clip(shell["velocity"][faces, 0].mean(axis=1) / limit, -1, 1))
    colors[:, :3] *= light[:, None]
    axis.add_collection3d(Poly3DCollection(corners, facecolors=colors, edgecolors=colors, linewidths=0.2))
    elevation, azimuth = np.radians(ELEVATION), np.radians(AZIMUTH)
    towards_us = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    is_visible = normals[(faces == marker).any(axis=1)].sum(axis=0) @ towards_us > 0
    axis.plot(*points[marker][:, None], "o", color="black", markersize=5, markerfacecolor="black" if is_visible else "none", zorder=10)
    reach = 0.95  # the picture shows more than the limits of the axes
    axis.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach), box_aspect=(1, 1, 1))
    axis.view_init(elev=ELEVATION, azim=AZIMUTH)
    axis.set_axis_off()


def draw(results, wanted=6):
    """A row of pictures for each run."""
    rows = [(result, snapshots_of(result.folder)) for result in results if result.series]
    rows = [(result, shots) for result, shots in rows if len(shots) > 1]
    if not rows:
        return None
    figure = plt.figure(figsize=(2.1 * wanted, 2.2 * len(rows)))
    for i, (result, shots) in enumerate(rows):
        chosen = [shots[k] for k in np.unique(np.linspace(0, len(shots) - 1, wanted).astype(int))]
        marker = marker_of(read_vtu(shots[0][1])["points"])
        shells = [(time, read_vtu(file)) for time, file in chosen]
        limit = max(np.abs(shell["velocity"][:, 0]).max() for _, shell in shells)
        for k, (time, shell) in enumerate(shells):
            axis = figure.add_subplot(len(rows), wanted, i * wanted + k + 1, projection="3d")
            draw_shell(axis, shell, marker, limit)
            axis.set_title(rf"$\hat\kappa$ = {result.khat:g}, $\dot\gamma t$ = {time:.3g}", fontsize=8)
    return figure
