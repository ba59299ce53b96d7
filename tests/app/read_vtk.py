"""Prints what VTK reads in a time series: of each time a JSON line with all numbers of its file."""

import json
import os
import sys
import xml.etree.ElementTree

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader


def values(array):
    """All numbers of an array, tuple by tuple."""
    return [x for k in range(array.GetNumberOfTuples()) for x in array.GetTuple(k)]


series = sys.argv[1]
for entry in xml.etree.ElementTree.parse(series).getroot().iter("DataSet"):
    is_grid = entry.get("file").endswith(".vtu")
    reader = vtkXMLUnstructuredGridReader() if is_grid else vtkXMLPolyDataReader()
    file = os.path.join(os.path.dirname(series), entry.get("file"))
    if not reader.CanReadFile(file):
        sys.exit(file + " is no file of VTK's")
    reader.SetFileName(file)
    reader.Update()
    data = reader.GetOutput()
    arrays = {}
    of_cells = data.GetCellData()
    of_points = data.GetPointData()
    for attributes in (of_points, of_cells, data.GetFieldData()):
        for k in range(attributes.GetNumberOfArrays()):
            array = attributes.GetArray(k)
            arrays[array.GetName()] = {
                "components": array.GetNumberOfComponents(),
                "values": values(array),
            }
    points = data.GetPoints()
    cell = data.GetCell(0) if data.GetNumberOfCells() else None
    print(
        json.dumps(
            {
                "time": float(entry.get("timestep")),
                "points": values(points.GetData()) if data.GetNumberOfPoints() else [],
                "n_cells": data.GetNumberOfCells(),
                "cell": cell.GetClassName() if cell else "",
                "arrays": arrays,
            }
        )
    )
