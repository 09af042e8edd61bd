"""Builds a wheel of the package with CMake: the build backend that pyproject.toml names (PEP 517, PEP 427).

It needs no other packages than those of scripts/setup --python. The wheel is for the Python that runs pip, and links
the libraries of this machine. An existing build/release is used, or the build folder that pip is told by
--config-settings=build=FOLDER.
"""
import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))


def version():
    with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
        return re.search(r"project\(alhazen VERSION ([\d.]+)", file.read()).group(1)


def tag():
    python = "cp%d%d" % sys.version_info[:2]
    return f"{python}-{python}-{re.sub(r'[-.]', '_', sysconfig.get_platform())}"


def metadata():
    return (f"Metadata-Version: 2.1\nName: alhazen\nVersion: {version()}\n"
            "Summary: Ray tracing of exact solids and meshes\nLicense: Apache-2.0\nRequires-Python: >=3.9\n"
            "Requires-Dist: numpy>=1.20\n")


def pack(package, folder):
    """Writes the wheel of the package folder, and returns its name."""
    name = f"alhazen-{version()}-{tag()}.whl"
    info = f"alhazen-{version()}.dist-info"
    files = {f"alhazen/{file}": os.path.join(package, file) for file in sorted(os.listdir(package))
             if os.path.isfile(os.path.join(package, file))}
    texts = {f"{info}/METADATA": metadata(),
             f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: alhazen\nRoot-Is-Purelib: false\nTag: {tag()}\n"}
    record = []
    with zipfile.ZipFile(os.path.join(folder, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for target in [*files, *texts]:
            if target in files:
                with open(files[target], "rb") as file:
                    data = file.read()
            else:
                data = texts[target].encode()
            wheel.writestr(target, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{target},sha256={digest},{len(data)}\n")
        wheel.writestr(f"{info}/RECORD", "".join(record) + f"{info}/RECORD,,\n")
    return name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    given = (config_settings or {}).get("build")
    build = os.path.abspath(given) if given else os.path.join(ROOT, "build", "release")
    # pip hides the packages of the system, numpy among them, from its builds.
    env = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "PIP_"))}

    def run(*command):
        subprocess.run(command, check=True, cwd=ROOT, env=env)

    run("cmake", *([build] if given else ["--preset", "release"]), "-DALHAZEN_PYTHON=ON",
        f"-DPython3_EXECUTABLE={sys.executable}")
    run("cmake", "--build", build, "--parallel", "--target", "alhazen_python_package")
    return pack(os.path.join(build, "python", "alhazen"), wheel_directory)
