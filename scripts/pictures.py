# SPDX-License-Identifier: MIT
"""Renders a mesh to a PNG, off screen. Called by scripts/pictures with the Python that has VTK.

    pictures.py MESH PNG WIDTHxHEIGHT [up=x,y,z] [from=x,y,z] [zoom=F] [color=r,g,b] [opacity=F]...

`from` is the direction from the middle of the mesh to the eye. MESH is binary PLY or GLB; the second
and later meshes of a GLB take the second and later `color` and `opacity`. A mesh with colours of its
own (COLOR_0) shows those.
"""

import sys

from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR, vtkUnsignedCharArray
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkImagingCore import vtkImageResize  # noqa: F401
from vtkmodules.vtkIOGeometry import vtkGLTFReader
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)
import vtkmodules.vtkRenderingOpenGL2 as opengl


def numbers(text):
    return [float(word) for word in text.split(",")]


def meshes(path):
    """Poly data, one for each mesh of the file."""
    if path.endswith(".ply"):
        reader = vtkPLYReader()
        reader.SetFileName(path)
        reader.Update()
        return [reader.GetOutput()]
    reader = vtkGLTFReader()
    reader.SetFileName(path)
    reader.Update()
    found = []
    leaves = reader.GetOutput().NewIterator()
    while not leaves.IsDoneWithTraversal():
        surface = vtkGeometryFilter()
        surface.SetInputData(leaves.GetCurrentDataObject())
        surface.Update()
        found.append(surface.GetOutput())
        leaves.GoToNextItem()
    return found


def screen_colors(linear):
    """Linear colours (0 to 255, or 0 to 1) as bytes of sRGB."""
    most = 255 if linear.GetDataType() == VTK_UNSIGNED_CHAR else 1
    colors = vtkUnsignedCharArray()
    colors.SetNumberOfComponents(3)
    colors.SetNumberOfTuples(linear.GetNumberOfTuples())
    for n in range(linear.GetNumberOfTuples()):
        for component in range(3):
            share = linear.GetComponent(n, component) / most
            screen = 12.92 * share if share <= 0.0031308 else 1.055 * share ** (1 / 2.4) - 0.055
            colors.SetComponent(n, component, round(255 * screen))
    return colors


def actor(mesh, color, opacity):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(mesh)
    if mesh.GetPointData().HasArray("COLOR_0"):
        mesh.GetPointData().SetScalars(screen_colors(mesh.GetPointData().GetArray("COLOR_0")))
        mapper.SetColorModeToDirectScalars()
    else:
        mapper.ScalarVisibilityOff()
    it = vtkActor()
    it.SetMapper(mapper)
    look = it.GetProperty()
    look.SetInterpolationToPhong()
    look.SetColor(color)
    look.SetOpacity(opacity)
    look.SetAmbient(0.2)
    look.SetDiffuse(0.85)
    look.SetSpecular(0.12)
    look.SetSpecularPower(20)
    return it


def light(position, intensity, color):
    it = vtkLight()
    it.SetLightTypeToCameraLight()
    it.SetPosition(position)
    it.SetFocalPoint(0, 0, 0)
    it.SetIntensity(intensity)
    it.SetColor(color)
    return it


def shade_creases(renderer, size):
    """Screen-space ambient occlusion, `size` being the length of the scene's diagonal."""
    occlusion = opengl.vtkSSAOPass()
    occlusion.SetRadius(0.06 * size)
    occlusion.SetBias(0.001 * size)
    occlusion.SetKernelSize(128)
    occlusion.BlurOn()
    occlusion.SetDelegatePass(opengl.vtkRenderStepsPass())
    renderer.SetPass(occlusion)


def main():
    path, png, size, *rest = sys.argv[1:]
    options = {"up": "0,1,0", "from": "1,0.7,1", "zoom": "1"}
    looks = {"color": [], "opacity": []}
    for word in rest:
        name, value = word.split("=")
        looks[name].append(value) if name in looks else options.update({name: value})

    renderer = vtkRenderer()
    renderer.SetBackground(0.93, 0.94, 0.95)
    renderer.SetBackground2(0.80, 0.84, 0.88)
    renderer.GradientBackgroundOn()
    for n, mesh in enumerate(meshes(path)):
        color = looks["color"][n] if n < len(looks["color"]) else "0.80,0.78,0.74"
        opacity = looks["opacity"][n] if n < len(looks["opacity"]) else "1"
        renderer.AddActor(actor(mesh, numbers(color), float(opacity)))
    renderer.RemoveAllLights()
    renderer.AutomaticLightCreationOff()
    renderer.AddLight(light((-0.6, 0.9, 0.9), 1.0, (1, 0.97, 0.92)))
    renderer.AddLight(light((0.9, 0.2, 0.8), 0.5, (0.80, 0.88, 1)))

    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(numbers(options["from"]))
    camera.SetViewUp(numbers(options["up"]))
    camera.SetViewAngle(28)
    renderer.ResetCamera()
    camera.Zoom(float(options["zoom"]))
    low_high = renderer.ComputeVisiblePropBounds()
    diagonal = sum((low_high[2 * a + 1] - low_high[2 * a]) ** 2 for a in range(3)) ** 0.5
    if not any(float(o) < 1 for o in looks["opacity"]):
        shade_creases(renderer, diagonal)

    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(*(int(side) for side in size.split("x")))
    window.SetAlphaBitPlanes(1)
    renderer.SetUseDepthPeeling(1)
    renderer.SetMaximumNumberOfPeels(8)
    renderer.UseFXAAOn()
    window.AddRenderer(renderer)
    window.Render()

    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.SetInputBufferTypeToRGB()
    image.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetFileName(png)
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
