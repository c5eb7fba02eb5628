"""What pip asks for a wheel (PEP 517, 660), with CMake and the standard library alone, so that no network
is needed.

    pip install .
    pip install -e .      modules of the checkout, and the library of its build as it is built again
    pip install --config-settings=build-dir=build/release .    takes a build that is there

The library is compiled as a release in build/python, or where build-dir, or $GRAINLAW_BUILD, says.
"""
import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import tomllib
import zipfile

here = pathlib.Path(__file__).resolve().parent
root = here.parent.parent
headers = [root / "include/grainlaw" / name for name in ("grainlaw.h", "points.h", "march.h", "particles.h")]
needed = "g++ make cmake libsuitesparse-dev libeigen3-dev libfmt-dev libtomlplusplus-dev libxxhash-dev"
in_sdist = ("CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "pyproject.toml", "adapters/python",
            "include", "src")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """The name of the wheel that was written."""
    built = library(build_directory(config_settings))
    files = {f"grainlaw/{file.name}": file.read_bytes() for file in modules()}
    files["grainlaw/names.py"] = names()
    files[f"grainlaw/{built.name}"] = stripped(built)
    return write_wheel(wheel_directory, files)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """The name of a wheel that leads to links to this checkout, in `editable` of its build."""
    built = library(build_directory(config_settings))
    package = built.parent / "editable/grainlaw"
    shutil.rmtree(package, ignore_errors=True)
    package.mkdir(parents=True)
    for file in [*modules(), built]:
        (package / file.name).symlink_to(file)
    (package / "names.py").write_bytes(names())
    return write_wheel(wheel_directory, {"grainlaw.pth": f"{package.parent}\n".encode()})


def modules():
    """The files of the package that are not made."""
    return [*sorted((here / "grainlaw").glob("*.py")), here / "grainlaw/py.typed"]


def names():
    """names.py, from the headers."""
    return subprocess.run([sys.executable, here / "make_names", *headers], check=True,
                          stdout=subprocess.PIPE).stdout


def write_wheel(directory, files):
    """The name of the wheel of these files that was written."""
    name = f"grainlaw-{version()}-{tag()}.whl"
    info = f"grainlaw-{version()}.dist-info"
    files |= {f"{info}/{file}": data for file, data in information().items()}
    record = [f"{file},sha256={digest(data)},{len(data)}" for file, data in files.items()]
    files[f"{info}/RECORD"] = "\n".join([*record, f"{info}/RECORD,,", ""]).encode()
    with zipfile.ZipFile(pathlib.Path(directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for file, data in files.items():
            entry = zipfile.ZipInfo(file)   # of 1980: the same sources make the same bytes
            entry.external_attr = 0o100644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)
    return name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """The name of the directory that was written: what the wheel will say of itself."""
    directory = pathlib.Path(metadata_directory) / f"grainlaw-{version()}.dist-info"
    directory.mkdir(parents=True)
    for file, data in information().items():
        (directory / file).write_bytes(data)
    return directory.name


prepare_metadata_for_build_editable = prepare_metadata_for_build_wheel


def build_sdist(sdist_directory, config_settings=None):
    """The name of the archive of sources that was written: what the wheel is made of."""
    name = f"grainlaw-{version()}"
    with tarfile.open(pathlib.Path(sdist_directory) / f"{name}.tar.gz", "w:gz") as archive:
        for path in in_sdist:
            archive.add(root / path, f"{name}/{path}",
                        filter=lambda entry: None if "__pycache__" in entry.name else entry)
    return f"{name}.tar.gz"


def build_directory(config_settings):
    """Where the library is compiled. Ends with the reason where it cannot be of this checkout."""
    build = pathlib.Path((config_settings or {}).get("build-dir") or os.environ.get("GRAINLAW_BUILD")
                         or root / "build/python").resolve()
    cache = build / "CMakeCache.txt"
    known = dict(re.findall(r"^(\w+):\w+=(.*)$", cache.read_text(), re.M)) if cache.exists() else {}
    home = pathlib.Path(known.get("CMAKE_HOME_DIRECTORY", root)).resolve()
    if home != root:
        sys.exit(f"build-dir {build} is of another checkout, {home}; expected one of {root}, or a new "
                 "directory")
    if known.get("BUILD_SHARED_LIBS", "ON").upper() in ("OFF", "FALSE", "NO", "0"):
        sys.exit(f"build-dir {build} makes a static library; expected one with BUILD_SHARED_LIBS=ON")
    if known.get("GRAINLAW_SANITIZE"):
        sys.exit(f"build-dir {build} is of GRAINLAW_SANITIZE={known['GRAINLAW_SANITIZE']}, which "
                 "Python cannot load; expected one without sanitizers")
    return build


def library(build):
    """Path of the shared library, compiled where it is not up to date."""
    major = version().split(".", maxsplit=1)[0]
    if not shutil.which("cmake"):
        sys.exit(f"grainlaw is compiled by CMake, which is not found: apt-get install {needed}")
    jobs = str(len(os.sched_getaffinity(0)))
    try:
        if not (build / "CMakeCache.txt").exists():
            subprocess.run(["cmake", "-S", root, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                            "-DGRAINLAW_TESTS=OFF", "-DGRAINLAW_VERIFICATION=OFF",
                            "-DGRAINLAW_ADAPTERS=OFF"], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "grainlaw", "--parallel", jobs],
                       check=True)
    except subprocess.CalledProcessError:
        sys.exit(f"grainlaw could not be compiled, see above. It needs: apt-get install {needed}")
    built = build / f"libgrainlaw.so.{major}"
    if not built.exists():
        sys.exit(f"{build} makes no shared library")
    return built


def stripped(built):
    """The library without the names that nobody needs."""
    if not shutil.which("strip"):
        return built.read_bytes()
    with tempfile.TemporaryDirectory() as directory:
        small = pathlib.Path(directory) / built.name
        subprocess.run(["strip", "--strip-unneeded", "-o", small, built], check=True)
        return small.read_bytes()


def version():
    """That of the header."""
    numbers = re.findall(r"#define GRAINLAW_VERSION_\w+ (\d+)", headers[0].read_text())
    return ".".join(numbers)


def tag():
    """Any Python 3, as ctypes is all that is asked of it, on this kind of machine."""
    return "py3-none-" + re.sub(r"\W", "_", sysconfig.get_platform())


def information():
    """Files of the wheel about itself."""
    wheel = f"Wheel-Version: 1.0\nGenerator: grainlaw\nRoot-Is-Purelib: false\nTag: {tag()}\n"
    return {"METADATA": metadata().encode(), "WHEEL": wheel.encode(),
            "LICENSE": (root / "LICENSE").read_bytes()}


def metadata():
    """METADATA of the wheel, from pyproject.toml."""
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version()}",
             f"Summary: {project['description']}", "License: BSD-3-Clause",
             f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {one}" for one in project["dependencies"]]
    for extra, packages in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}",
                  *(f'Requires-Dist: {one}; extra == "{extra}"' for one in packages)]
    readme = (root / project["readme"]).read_text()
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme])


def digest(data):
    """As RECORD has it."""
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
