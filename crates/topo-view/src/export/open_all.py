"""Opens every file of exported folders with VTK's own XML readers or numpy, and says what is in them as JSON."""

import json
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

READERS = {
    ".vtp": vtk.vtkXMLPolyDataReader,
    ".vtu": vtk.vtkXMLUnstructuredGridReader,
    ".vti": vtk.vtkXMLImageDataReader,
}


def finite(values):
    return values.dtype.kind not in "fc" or bool(np.isfinite(values).all())


def opened(path):
    """What a reader of VTK finds, and whatever it says on its error output."""
    errors = vtk.vtkStringOutputWindow()
    vtk.vtkOutputWindow.SetInstance(errors)
    reader = READERS[path.suffix]()
    found = {"can_read": bool(reader.CanReadFile(str(path)))}
    reader.SetFileName(str(path))
    reader.Update()
    found["said"] = errors.GetOutput() + ("" if reader.GetErrorCode() == 0 else f" error code {reader.GetErrorCode()}")
    data = reader.GetOutput()
    found["points"], found["cells"] = data.GetNumberOfPoints(), data.GetNumberOfCells()
    at_points = data.GetPointData()
    found["arrays"], found["not_finite"] = {}, []
    for k in range(at_points.GetNumberOfArrays()):
        array = at_points.GetArray(k)
        found["arrays"][array.GetName()] = array.GetNumberOfComponents()
        if array.GetNumberOfTuples() != found["points"]:
            found["said"] += f" {array.GetName()} has {array.GetNumberOfTuples()} tuples"
        if not finite(vtk_to_numpy(array)):
            found["not_finite"].append(array.GetName())
    if found["points"] > 0 and not np.isfinite(data.GetBounds()).all():
        found["said"] += " points that are not finite"
    field = data.GetFieldData()
    found["facts"] = {}
    for k in range(field.GetNumberOfArrays()):
        array = field.GetAbstractArray(k)
        if isinstance(array, vtk.vtkStringArray):
            found["facts"][array.GetName()] = array.GetValue(0)
        else:
            values = vtk_to_numpy(array).ravel().tolist()
            found["facts"][array.GetName()] = values[0] if len(values) == 1 else values
    if path.suffix == ".vtp":
        found["corners"] = []
        for k in range(found["cells"]):
            # the same object for every cell
            ids = data.GetCell(k).GetPointIds()
            found["corners"].append([ids.GetId(i) for i in range(ids.GetNumberOfIds())])
        for name, of in (("component", at_points), ("component_of_lines", data.GetCellData())):
            array = of.GetArray("component")
            found[name] = None if array is None else vtk_to_numpy(array).tolist()
    return found


def archive(path):
    found = {"arrays": {}, "not_finite": [], "facts": {}}
    with np.load(path, allow_pickle=False) as all_of_it:
        for name in all_of_it.files:
            values = all_of_it[name]
            found["arrays"][name] = list(values.shape)
            if not finite(values):
                found["not_finite"].append(name)
            elif values.ndim == 0:
                found["facts"][name] = values.item()
    return found


def collection(path):
    entries = ElementTree.parse(path).getroot().iter("DataSet")
    return {"files": [[float(e.get("timestep")), e.get("file")] for e in entries]}


found = {}
for folder in sys.argv[1:]:
    found[folder] = {}
    for path in sorted(Path(folder).iterdir()):
        look = {".npz": archive, ".pvd": collection}.get(path.suffix, opened)
        found[folder][path.name] = look(path)
print(json.dumps(found))
