# SPDX-License-Identifier: GPL-3.0-or-later
"""Run by freecadcmd: a plate of 14 x 8 x 3/4 inches, corners and upper edges rounded, eight holes, as STEP in inches.
HEW_STEP_FILES names the file."""
import os

import FreeCAD
import Part

INCH = 25.4
plate = Part.makeBox(14 * INCH, 8 * INCH, 0.75 * INCH)
upright = [e for e in plate.Edges if abs(e.Vertexes[0].Z - e.Vertexes[1].Z) > 1]
plate = plate.makeFillet(1.125 * INCH, upright)
upper = [e for e in plate.Edges if all(abs(v.Z - 0.75 * INCH) < 1e-6 for v in e.Vertexes)]
plate = plate.makeFillet(0.125 * INCH, upper)
for x in (1.5, 5, 9, 12.5):
    for y in (1.5, 6.5):
        hole = Part.makeCylinder(0.3125 * INCH, 2 * INCH, FreeCAD.Vector(x * INCH, y * INCH, -INCH))
        plate = plate.cut(hole)
Part.setStaticValue("write.step.unit", "INCH")
plate.exportStep(os.environ["HEW_STEP_FILES"])
