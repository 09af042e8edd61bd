"""The package as such: documentation, types, wheels."""
import ast
import doctest
import importlib
import inspect
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

import alhazen
import alhazen.raycasting
import alhazen.trimesh

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))


def without_package():
    return {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}


def pip_for_this_python():
    """The command of pip that works for this Python, its own or another one's; () if there is none."""
    pip = shutil.which("pip")
    for command in ((sys.executable, "-m", "pip"), *([(pip, "--python", sys.executable)] if pip else [])):
        if subprocess.run([*command, "--version"], env=without_package(), capture_output=True).returncode == 0:
            return command
    return ()


def parameters_of(function):
    """How many parameters a compiled function has, by the signature in its docstring."""
    signature = re.search(r"\((.*)\) ->", function.__doc__).group(1)
    return len(re.findall(r"\b\w+: ", signature))


class Package(unittest.TestCase):
    def test_the_examples_of_the_docstrings_hold(self):
        tried = 0
        for name in ("", "._picture", "._scene", ".trimesh", ".raycasting", ".blocks"):
            result = doctest.testmod(importlib.import_module("alhazen" + name))
            self.assertEqual(result.failed, 0)
            tried += result.attempted
        self.assertGreater(tried, 8)

    def test_stubs_have_every_block_with_its_keys(self):
        with open(os.path.join(os.path.dirname(alhazen.__file__), "blocks.pyi"), encoding="utf-8") as file:
            functions = {node.name: node for node in ast.parse(file.read()).body if isinstance(node, ast.FunctionDef)}
        for name, _, keys in alhazen.blocks.VOCABULARY:
            self.assertEqual([argument.arg for argument in functions[name].args.kwonlyargs], [key for key, *_ in keys])
            self.assertEqual(ast.get_docstring(functions[name]), getattr(alhazen, name).__doc__)

    def test_stubs_of_the_compiled_part_are_those_of_the_module(self):
        with open(os.path.join(os.path.dirname(alhazen.__file__), "_alhazen.pyi"), encoding="utf-8") as file:
            tree = ast.parse(file.read())
        module = alhazen._alhazen
        found = {}
        for node in tree.body:
            if isinstance(node, ast.ClassDef):
                found[node.name] = {part.name: part for part in node.body if isinstance(part, ast.FunctionDef)}
                found[node.name].update({part.target.id: part for part in node.body if isinstance(part, ast.AnnAssign)})
            elif isinstance(node, ast.FunctionDef):
                found[node.name] = node
            elif isinstance(node, ast.AnnAssign):
                found[node.target.id] = node
        self.assertEqual(set(found), {name for name in vars(module) if not name.startswith("__")})
        compared = 0
        for name, stub in found.items():
            member = getattr(module, name)
            if isinstance(stub, dict):
                parts = {part for part in vars(member) if not part.startswith("_")} | {"__init__"} & set(stub)
                self.assertEqual(set(stub), parts, name)
            for part, function in (stub.items() if isinstance(stub, dict) else [(None, stub)]):
                if isinstance(function, ast.FunctionDef):
                    compared += 1
                    real = parameters_of(member if part is None else getattr(member, part))
                    self.assertEqual(len(function.args.args), real, f"{name} {part}: the number of parameters")
        self.assertGreater(compared, 30)

    def test_functions_that_take_arrays_name_their_shapes(self):
        arrays = {"rays", "points", "query_points", "vertices", "faces", "vertex_positions", "ray_origins"}
        checked = 0
        for owner in (alhazen, alhazen.Scene, alhazen.trimesh.RayMeshIntersector, alhazen.raycasting.RaycastingScene):
            names = ["Scene", "traced_in_place"] if owner is alhazen else [n for n in vars(owner) if n[0] != "_"]
            for name in names:
                member = getattr(owner, name)
                if callable(member) and arrays & set(inspect.signature(member).parameters):
                    self.assertRegex(member.__doc__, r"\((\.\.\.|n|m|h)(, \d)?,?\)", f"{owner} {name}")
                    checked += 1
        self.assertGreater(checked, 15)

    def test_public_functions_are_documented(self):
        for owner in (alhazen, alhazen.Scene, alhazen.trimesh.RayMeshIntersector, alhazen.raycasting.RaycastingScene):
            names = owner.__all__ if owner is alhazen else [n for n in vars(owner) if not n.startswith("_")]
            for name in names:
                if name not in ("INVALID_ID",):
                    self.assertTrue(getattr(owner, name).__doc__, f"{owner} {name}")

    def check_wheel(self, folder):
        """The only wheel in the folder can be imported alone."""
        name, = [name for name in os.listdir(folder) if name.endswith(".whl")]
        with tempfile.TemporaryDirectory() as place:
            with zipfile.ZipFile(os.path.join(folder, name)) as wheel:
                self.assertIsNone(wheel.testzip())
                wheel.extractall(place)
            env = {**os.environ, "PYTHONPATH": place}
            code = "import alhazen; print(alhazen.__file__, alhazen.Scene().add(alhazen.box()).measure()[0]['name'])"
            output = subprocess.run([sys.executable, "-c", code], env=env, check=True, capture_output=True,
                                    text=True).stdout
            self.assertEqual(output.split(), [os.path.join(place, "alhazen", "__init__.py"), "box"])

    def test_a_wheel_holds_all_of_the_package(self):
        sys.path.insert(0, os.path.join(ROOT, "bindings", "python", "tools"))
        import wheel_backend
        with tempfile.TemporaryDirectory() as place:
            wheel_backend.pack(os.path.dirname(alhazen.__file__), place)
            self.check_wheel(place)

    @unittest.skipUnless(pip_for_this_python(), "no pip for this Python")
    def test_pip_makes_a_wheel(self):
        build = os.path.join(os.path.dirname(alhazen.__file__), "..", "..")
        with tempfile.TemporaryDirectory() as place:
            result = subprocess.run(
                [*pip_for_this_python(), "wheel", ".", "--no-deps", "--no-build-isolation", "--no-cache-dir",
                 "--config-settings=build=" + build, "--wheel-dir", place], cwd=ROOT, env=without_package(),
                capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            self.check_wheel(place)

    def test_errors_are_those_of_python_too(self):
        for kind, python in ((alhazen.UsageError, ValueError), (alhazen.SceneError, ValueError),
                             (alhazen.FileError, OSError), (alhazen.ResourceError, MemoryError),
                             (alhazen.RenderError, RuntimeError)):
            self.assertTrue(issubclass(kind, alhazen.Error) and issubclass(kind, python))

    @unittest.skipUnless(shutil.which("mypy"), "mypy is not installed")
    def test_types_of_the_package_hold(self):
        result = subprocess.run(["mypy", "--python-executable", sys.executable, "--ignore-missing-imports",
                                 "--cache-dir", os.devnull, os.path.dirname(alhazen.__file__)],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout)


if __name__ == "__main__":
    unittest.main()
