# SPDX-License-Identifier: GPL-3.0-or-later
"""Run by freecadcmd: what FreeCAD makes of STEP files. HEW_STEP_FILES lists them, one a line; one line of JSON a file."""
import json
import os
import time

import Part

for name in os.environ["HEW_STEP_FILES"].split("\n"):
    started = time.process_time()
    shape = Part.Shape()
    shape.read(name)
    seconds = time.process_time() - started
    solids = shape.Solids
    box = shape.BoundBox
    radii = sorted(f.Surface.Radius for f in shape.Faces if f.Surface.TypeId == "Part::GeomCylinder")
    angles = sorted(f.Surface.SemiAngle for f in shape.Faces if f.Surface.TypeId == "Part::GeomCone")
    tubes = sorted(f.Surface.MinorRadius for f in shape.Faces if f.Surface.TypeId == "Part::GeomToroid")
    print("judged " + json.dumps({
        "file": os.path.basename(name), "type": shape.ShapeType, "solids": len(solids),
        "valid": shape.isValid() and all(s.isValid() for s in solids),
        "closed": all(s.isClosed() for s in solids), "faces": len(shape.Faces),
        "volume_mm3": sum(s.Volume for s in solids), "size_mm": [box.XLength, box.YLength, box.ZLength],
        "cylinder_radii_mm": radii, "cone_half_angles": angles, "tube_radii_mm": tubes, "cpu_s": round(seconds, 2)}), flush=True)
