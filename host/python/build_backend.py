"""The build backend of `pip install ./host/python` (PEP 517): CMake builds the package, and a wheel takes it in.

The build folder is build/release, which host/quickstart.sh uses, too, so that pip builds only what is missing.
`--config-settings=build-dir=FOLDER` names another folder.
"""
import base64
import hashlib
import pathlib
import re
import subprocess
import sysconfig
import tempfile
import tomllib
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def run(*command):
    subprocess.run(["cmake", *map(str, command)], check=True)


def build(build_dir):
    """Builds the package. Returns its version, and the contents of its files by their names in the wheel."""
    cache = build_dir / "CMakeCache.txt"
    if not cache.exists():
        run("-S", ROOT, "-B", build_dir, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF",
            "-DDOLP_BENCH=OFF")
    run("--build", build_dir, "--target", "dolp_python")
    with tempfile.TemporaryDirectory() as prefix:
        run("--install", build_dir, "--prefix", prefix, "--component", "python")
        package = pathlib.Path(prefix, "lib/python3/dist-packages/dolp")
        files = {f"dolp/{path.name}": path.read_bytes() for path in sorted(package.iterdir())}
    files["dolp/libdolp.so.0"] = (build_dir / "libdolp.so.0").read_bytes()
    return re.search(r"^CMAKE_PROJECT_VERSION:STATIC=(.*)$", cache.read_text(encoding="utf-8"), re.M)[1], files


def metadata(version):
    project = tomllib.loads((HERE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}", f"Summary: {project['description']}",
             f"Requires-Python: {project['requires-python']}"]
    return "\n".join(lines + [f"Requires-Dist: {name}" for name in project["dependencies"]]) + "\n"


def record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    build_dir = pathlib.Path((config_settings or {}).get("build-dir", ROOT / "build/release")).resolve()
    version, files = build(build_dir)
    if not any(name.endswith(sysconfig.get_config_var("EXT_SUFFIX")) for name in files):
        raise SystemExit(f"dolp: {sysconfig.get_path('stdlib')} is not the Python for which {build_dir} was configured; "
                         "use the system's, /usr/bin/python3 -m pip")
    python = f"cp{sysconfig.get_config_var('py_version_nodot')}"
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    info = f"dolp-{version}.dist-info"
    files[f"{info}/METADATA"] = metadata(version).encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: dolp\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = "".join(record_line(name, content) for name, content in files.items()) + f"{info}/RECORD,,\n"
    wheel = f"dolp-{version}-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in (files | {f"{info}/RECORD": record.encode()}).items():
            archive.writestr(name, content)
    return wheel


class UnsupportedOperation(NotImplementedError):
    """PEP 517: this backend does not make this kind of distribution."""


def build_sdist(sdist_directory, config_settings=None):
    raise UnsupportedOperation("dolp is built from its repository, not from a source distribution")
