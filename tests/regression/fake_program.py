#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: stands in for the program where scripts are tested.
"""Takes the program's command line, FILE.prm --set Section/Parameter=value ..., and leaves a folder like one of its own: a capsule whose D goes to 0.3."""

import math
import pathlib
import sys

COLUMNS = ("time D_xz theta L B W volume volume_error area membrane_energy bending_energy dissipation newton_iterations linear_iterations wall_time alpha delta pressure_jump step cells "
           "theta_continuous S_xx S_yy S_zz S_xy S_xz S_yz intrinsic_viscosity N1 N2 x y z u_x u_y u_z").split()


def main():
    settings = dict(word.split("=", 1) for word in sys.argv[2:] if word != "--set")
    folder = pathlib.Path(settings["Output/Directory"])
    folder.mkdir(parents=True, exist_ok=True)
    lines = [",".join(COLUMNS)]
    for step in range(41):
        t = 0.25 * step
        D = 0.3 * (1 - math.exp(-t))
        values = {"time": t, "D_xz": D, "theta": 0.25 - 0.1 * D, "L": 1 + D, "B": 1 - D, "W": 1, "volume": 4.18, "area": 12.5 + D, "step": 0.25, "alpha": 0.1 * t, "delta": 0.1 * t, "intrinsic_viscosity": 2.5}
        lines.append(",".join(f"{values.get(name, 0):.9g}" for name in COLUMNS))
        print(f"{step} {t} 0.25 2 10 {D} 0.2 0 {10 - t}")
    (folder / "history.csv").write_text("\n".join(lines) + "\n")
    (folder / "contours.csv").write_text("time,x,z\n" + "".join(f"{t},{math.cos(k)},{math.sin(k)}\n" for t in (0, 10) for k in range(7)))
    (folder / "summary.csv").write_text("quantity,value\noutcome,end time\nmode,steady\nfrom,0\n")


if __name__ == "__main__":
    main()
