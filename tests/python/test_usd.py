"""USD to glTF, compared with the output of `insonify scene`."""

import json
import random
import subprocess
import sys

import numpy as np
import pytest
from conftest import INSONIFY, ROOT

pytest.importorskip("pxr", reason="usd-core is not installed; scripts/setup installs it")

HEAD = '#usda 1.0\n(\n    metersPerUnit = {metres}\n    upAxis = "{up}"\n)\n'


def converted(folder, body, metres=1, up="Z", name="scene.usda"):
    """Returns the script's outcome, and the content of the scene."""
    (folder / name).write_text(HEAD.format(metres=metres, up=up) + body)
    return run(folder, name)


def run(folder, name):
    done = subprocess.run([sys.executable, ROOT / "scripts/scenes/usd_to_glb", name, "out.glb"], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        return done, None
    done_scene = subprocess.run([INSONIFY, "scene", folder / "out.glb", "--json"], capture_output=True, text=True, check=True)
    return done, json.loads(done_scene.stdout)


def objects(scene):
    return {each["name"]: each for each in scene["objects"]}


def box_of(each):
    centre, size = np.array(each["bounds"]["centre"]), np.array(each["bounds"]["size"])
    return np.round([centre - size / 2, centre + size / 2], 4).tolist()


MESH = """def Mesh "{name}" {more}
{{
    int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
    int[] faceVertexIndices = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5]
    point3f[] points = [(0,0,0), (1,0,0), (0,1,0), (1,1,0), (0,0,1), (1,0,1), (0,1,1), (1,1,1)]
    uniform token subdivisionScheme = "none"
    {body}
}}
"""


def test_units_axes_and_transforms_are_converted_to_the_world(tmp_path):
    body = """def Xform "rov"
{
    double3 xformOp:translate = (500, -200, 100)
    float3 xformOp:rotateXYZ = (0, 0, 90)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]
    def Cube "hull"
    {
        double size = 100
        double3 xformOp:scale = (2, 1, 1)
        uniform token[] xformOpOrder = ["xformOp:scale"]
    }
}
"""
    _, scene = converted(tmp_path, body, metres=0.01)
    assert box_of(objects(scene)["hull"]) == [[4.5, -3, 0.5], [5.5, -1, 1.5]]  # two metres along y, once turned
    _, scene = converted(tmp_path, body, metres=0.01, up="Y")
    # In a world with y up, the file's (x, y, z) is (x, -z, y): it is 2 m below, and turned about the axis that points
    # back.
    assert box_of(objects(scene)["hull"]) == [[4.5, -1.5, -3], [5.5, -0.5, -1]]


@pytest.mark.parametrize(
    "prim, box",
    [
        ('def Sphere "s"\n{\n double radius = 2\n}', [[-2, -2, -2], [2, 2, 2]]),
        ('def Cylinder "s"\n{\n double radius = 1\n double height = 6\n uniform token axis = "X"\n}', [[-3, -1, -1], [3, 1, 1]]),
        ('def Cone "s"\n{\n double radius = 1\n double height = 4\n uniform token axis = "Z"\n}', [[-1, -1, -2], [1, 1, 2]]),
        ('def Capsule "s"\n{\n double radius = 1\n double height = 4\n uniform token axis = "Y"\n}', [[-1, -3, -1], [1, 3, 1]]),
        ('def Plane "s"\n{\n double width = 4\n double length = 2\n uniform token axis = "Z"\n}', [[-2, -1, 0], [2, 1, 0]]),
        (MESH.format(name="s", more="", body=""), [[0, 0, 0], [1, 1, 1]]),
    ],
)
def test_each_shape_has_its_size(tmp_path, prim, box):
    _, scene = converted(tmp_path, prim)
    np.testing.assert_allclose(box_of(objects(scene)["s"]), box, atol=0.012)


@pytest.mark.parametrize("orientation", ["rightHanded", "leftHanded"])
def test_faces_look_outward_in_either_orientation(tmp_path, orientation):
    flipped = MESH if orientation == "rightHanded" else MESH.replace(
        "[0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5]",
        "[1, 3, 2, 0, 6, 7, 5, 4, 4, 5, 1, 0, 3, 7, 6, 2, 2, 6, 4, 0, 5, 7, 3, 1]")
    converted(tmp_path, flipped.format(name="s", more="", body=f'uniform token orientation = "{orientation}"'))
    data = (tmp_path / "out.glb").read_bytes()
    gltf = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    start = 28 + int.from_bytes(data[12:16], "little")
    part = gltf["meshes"][0]["primitives"][0]

    def array(accessor, kind, width):
        view = gltf["bufferViews"][gltf["accessors"][accessor]["bufferView"]]
        raw = data[start + view["byteOffset"] : start + view["byteOffset"] + view["byteLength"]]
        return np.frombuffer(raw, kind).reshape(-1, width)

    corners = array(part["attributes"]["POSITION"], "<f4", 3)[array(part["indices"], "<u2", 3)]
    assert np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6 == pytest.approx(1)


def test_materials_of_subsets_have_their_names_and_acoustics(tmp_path):
    body = """def Scope "Looks"
{
    def Material "Steel" (customData = {
        dictionary acoustics = {
            string material = "steel"
        }
    })
    {
    }
    def Material "rubber_black"
    {
    }
}
""" + MESH.format(name="s", more='(prepend apiSchemas = ["MaterialBindingAPI"])', body="""rel material:binding = </Looks/Steel>
    def GeomSubset "top" (prepend apiSchemas = ["MaterialBindingAPI"])
    {
        uniform token elementType = "face"
        uniform token familyName = "materialBind"
        int[] indices = [1]
        rel material:binding = </Looks/rubber_black>
    }""")
    _, scene = converted(tmp_path, body)
    materials = {each["name"]: each for each in scene["materials"]}
    assert materials["Steel"]["triangles"] == 10 and materials["Steel"]["matter"] == "steel" and materials["Steel"]["source"] == "file"
    assert materials["rubber_black"]["triangles"] == 2


def test_references_instances_and_instancers_are_converted(tmp_path):
    (tmp_path / "rock.usda").write_text('#usda 1.0\n(\n defaultPrim = "rock"\n)\ndef Xform "rock"\n{\n def Sphere "ball"\n {\n double radius = 0.5\n }\n}\n')
    body = ""
    for i in range(3):
        body += (f'def "rock_{i}" (instanceable = true\n prepend references = @rock.usda@)\n{{\n'
                 f' double3 xformOp:translate = ({10 * i}, 0, 0)\n uniform token[] xformOpOrder = ["xformOp:translate"]\n}}\n')
    body += """def PointInstancer "field"
{
    int[] protoIndices = [0, 0]
    point3f[] positions = [(0, 20, 0), (0, 30, 0)]
    rel prototypes = [</field/stone>]
    def Cube "stone"
    {
        double size = 1
    }
}
"""
    done, scene = converted(tmp_path, body)
    centres = sorted(tuple(np.round(each["bounds"]["centre"], 3)) for each in scene["objects"])
    assert centres == [(0, 0, 0), (0, 20, 0), (0, 30, 0), (10, 0, 0), (20, 0, 0)]
    assert "2 meshes" in done.stdout  # one for all instances of a prototype


@pytest.mark.parametrize("seed", range(12))
def test_referenced_layers_are_in_their_own_units(tmp_path, seed):
    """A chain of layers, each in a unit and up axis of its own: the cube is where its layers place it, in metres."""
    draw = random.Random(seed)
    layers = [(draw.choice([1, 0.01, 0.001, 0.3048]), draw.choice("YZ")) for _ in range(3)]
    centre, size = np.array([draw.uniform(-3, 3) for _ in range(3)]), draw.uniform(0.5, 2)
    expected = centre.copy()
    body = f'def Cube "box"\n{{\n double size = {size}\n double3 xformOp:translate = {tuple(centre.tolist())}\n uniform token[] xformOpOrder = ["xformOp:translate"]\n}}\n'
    for i, (metres, up) in enumerate(reversed(layers)):
        name = "scene.usda" if i == 2 else f"layer{i}.usda"
        head = HEAD.format(metres=metres, up=up).replace("#usda 1.0\n(", '#usda 1.0\n(\n    defaultPrim = "top"')
        inside = draw.choice([True, False])  # who places the layer: the layer itself or the one that refers to it
        move = np.array([draw.uniform(-3, 3) for _ in range(3)])
        place = f' double3 xformOp:translate = {tuple(move.tolist())}\n uniform token[] xformOpOrder = ["xformOp:translate"]\n'
        (tmp_path / name).write_text(f'{head}def Xform "top"\n{{\n{place}{body}}}\n')
        expected = expected + move
        if i < 2:
            outer_metres, outer_up = layers[1 - i]
            own = np.array([draw.uniform(-3, 3) for _ in range(3)])
            turn = np.eye(3) if up == outer_up else np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]) if up == "Y" else np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
            if inside:
                expected = turn @ expected * (metres / outer_metres)
                over = ""
            else:  # its own place is overridden, in the unit of the layer that refers to it
                expected = turn @ (expected - move) * (metres / outer_metres) + own
                over = f' double3 xformOp:translate = {tuple(own.tolist())}\n uniform token[] xformOpOrder = ["xformOp:translate"]\n'
            arc = draw.choice(["references", "payload"])
            body = f'def Xform "part" (\n prepend {arc} = @./{name}@\n)\n{{\n{over}}}\n'
            size *= metres / outer_metres
    metres, up = layers[0]
    x, y, z = expected * metres
    done, scene = run(tmp_path, "scene.usda")
    assert done.returncode == 0, done.stderr
    box = scene["objects"][0]["bounds"]
    assert np.allclose(box["centre"], (x, y, z) if up == "Z" else (x, -z, y), atol=1e-5)
    assert np.allclose(box["size"], size * metres, rtol=1e-5)
    assert ("converted: layer" in done.stdout) == (len(set(layers)) > 1)


def test_animated_prims_are_reported(tmp_path):
    body = 'def Cube "box"\n{\n double3 xformOp:translate.timeSamples = {\n 10: (5, 0, 0),\n 20: (25, 0, 0),\n }\n uniform token[] xformOpOrder = ["xformOp:translate"]\n}\n'
    done, _ = converted(tmp_path, body)
    assert "1 animated prims, which are where they start" in done.stdout


def test_omitted_prims_are_reported(tmp_path):
    body = """def Cube "there"
{
}
def Cube "gone"
{
    token visibility = "invisible"
}
def Cube "guide"
{
    uniform token purpose = "guide"
}
def BasisCurves "hair"
{
}
def Camera "eye"
{
}
"""
    done, scene = converted(tmp_path, body)
    assert list(objects(scene)) == ["there"]
    omitted = ("1 invisible prims", "1 guides and proxies", "1 BasisCurves prims", "1 Camera prims")
    assert all(what in done.stdout for what in omitted), done.stdout


@pytest.mark.parametrize(
    "text, message",
    [
        (None, "is no file"),
        ("no usd at all", "cannot be read as USD"),
        ('#usda 1.0\ndef Cube "a" { double size = 1 }}\n', "bad.usda:2:16: Expected }"),
        ("#usda 1.0\n", "has nothing with triangles"),
        (HEAD.format(metres=1, up="Z") + MESH.format(name="m", more="", body="").replace("1, 3, 7, 5]", "1, 3, 7, 50]"),
         "/m: a face has point 50; there are 8"),
        (HEAD.format(metres=1, up="Z") + MESH.format(name="m", more="", body="").replace("4, 4, 4]", "4, 4, 5]"),
         "/m: has 24 corners; its faces have 25"),
    ],
)
def test_an_error_is_one_line_and_exit_code_2(tmp_path, text, message):
    if text is not None:
        (tmp_path / "bad.usda").write_text(text)
    done, _ = run(tmp_path, "bad.usda")
    assert done.returncode == 2 and message in done.stderr and done.stderr.count("\n") == 1, done.stderr
    assert not (tmp_path / "out.glb").exists()
