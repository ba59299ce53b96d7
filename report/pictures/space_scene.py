# Draws `panels` side by side into `output`: a generated script sets both, and `size`, before this. Needs Debian's
# python3-vtk9 and xvfb, for VTK 9.1 wants a display.
import ctypes
import os
import signal
import subprocess


def own_display():
    """A display that nobody sees, under a number that nobody has."""
    reads, writes = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writes), "-screen", "0", "800x600x24", "-nolisten", "tcp", "-noreset"],
        pass_fds=[writes], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        preexec_fn=lambda: ctypes.CDLL(None).prctl(1, signal.SIGTERM))  # PR_SET_PDEATHSIG: it does not outlive us
    os.close(writes)
    number = os.read(reads, 16).decode().strip()
    if not number:
        raise SystemExit("Xvfb did not start")
    os.environ["DISPLAY"] = ":" + number
    return server


def colour_of(text):
    return tuple(int(text[k:k + 2], 16) for k in (1, 3, 5))


def points_of(text, n_numbers):
    """Points of lines `x y z ... colour`, with a list for each further number."""
    points, colours = vtk.vtkPoints(), vtk.vtkUnsignedCharArray()
    colours.SetNumberOfComponents(3)
    further = [[] for _ in range(n_numbers)]
    for line in text.split("\n"):
        words = line.split()
        if words:
            points.InsertNextPoint(*map(float, words[:3]))
            colours.InsertNextTuple3(*colour_of(words[-1]))
            for k in range(n_numbers):
                further[k].append(float(words[3 + k]))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.GetPointData().SetScalars(colours)
    vertices = vtk.vtkCellArray()
    for k in range(points.GetNumberOfPoints()):
        vertices.InsertNextCell(1, [k])
    data.SetVerts(vertices)
    return data, further


def array(name, columns):
    values = vtk.vtkFloatArray()
    values.SetName(name)
    values.SetNumberOfComponents(len(columns))
    for row in zip(*columns):
        values.InsertNextTuple(row)
    return values


def spheres(text):
    data, (radius,) = points_of(text, 1)
    data.GetPointData().AddArray(array("radius", [radius]))
    mapper = vtk.vtkOpenGLSphereMapper()
    mapper.SetInputData(data)
    mapper.SetScaleArray("radius")
    return mapper


def discs(text):
    data, (x, y, z, radius) = points_of(text, 4)
    data.GetPointData().AddArray(array("normal", [x, y, z]))
    data.GetPointData().AddArray(array("radius", [radius]))
    disc = vtk.vtkRegularPolygonSource()  # of radius 1, across x, which becomes the normal
    disc.SetNumberOfSides(16)
    disc.SetRadius(1.0)
    disc.SetNormal(1.0, 0.0, 0.0)
    mapper = vtk.vtkGlyph3DMapper()
    mapper.SetInputData(data)
    mapper.SetSourceConnection(disc.GetOutputPort())
    mapper.SetOrientationArray("normal")
    mapper.SetScaleArray("radius")
    mapper.SetScaleModeToScaleByMagnitude()
    return mapper


def outline(low, high):
    box = vtk.vtkOutlineSource()
    box.SetBounds(low[0], high[0], low[1], high[1], low[2], high[2])
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(box.GetOutputPort())
    return mapper


def actor_of(mapper):
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor


def label(text, x, y, size, colour):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    actor.GetTextProperty().SetFontSize(size)
    actor.GetTextProperty().SetColor(*(c / 255 for c in colour_of(colour)))
    actor.GetTextProperty().SetJustificationToCentered()
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(x, y)
    return actor


def draw():
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    camera = vtk.vtkCamera()
    for k, panel in enumerate(panels):
        renderer = vtk.vtkRenderer()
        renderer.SetViewport(k / len(panels), 0.0, (k + 1) / len(panels), 1.0)
        renderer.SetBackground(1.0, 1.0, 1.0)
        if panel["spheres"].strip():
            renderer.AddActor(actor_of(spheres(panel["spheres"])))
        if panel["discs"].strip():
            actor = actor_of(discs(panel["discs"]))
            actor.GetProperty().SetAmbient(0.45)
            actor.GetProperty().SetDiffuse(0.55)
            actor.GetProperty().SetOpacity(panel.get("opacity", 0.3))
            renderer.AddActor(actor)
        frame = actor_of(outline(*panel["box"]))
        frame.GetProperty().SetColor(0.55, 0.55, 0.55)
        renderer.AddActor(frame)
        renderer.AddActor2D(label(panel["title"], 0.5, 0.955, 17, "#000000"))
        for row, (text, colour) in enumerate(panel["legend"].items()):
            renderer.AddActor2D(label(text, 0.5, 0.055 - 0.028 * row, 14, colour))
        # From the front (x to the right, z up), a little from above and from the right.
        low, high = panel["box"]
        middle = [0.5 * (a + b) for a, b in zip(low, high)]
        renderer.SetActiveCamera(camera)
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(*middle)
        camera.SetPosition(middle[0] + 0.45, middle[1] - 1.0, middle[2] + 0.35)
        camera.SetViewUp(0.0, 0.0, 1.0)
        window.AddRenderer(renderer)
        renderer.ResetCamera(low[0], high[0], low[1], high[1], low[2], high[2])
        width = size[0] / len(panels)
        across = 1.25 * sum((b - a) for a, b in zip(low[:2], high[:2])) / 1.41
        camera.SetParallelScale(0.5 * max((high[2] - low[2]) * 1.1 + 0.3 * across, across * size[1] / width))
        renderer.ResetCameraClippingRange()
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetInputConnection(image.GetOutputPort())
    writer.SetFileName(output)
    writer.Write()
    window.Finalize()


server = own_display()
try:
    import vtk
    draw()
finally:
    server.terminate()
    server.wait()
