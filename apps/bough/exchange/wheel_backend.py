"""Builds the wheel of bough for pip (PEP 517) with CMake and Python's own library, so that nothing is fetched.

The wheel holds the module with the library beside it, the program, and the library of FMUs. They use SUNDIALS, OpenBLAS,
FFTW and libyaml of the system. BOUGH_BUILD names a folder where they are built already.
"""
import base64
import hashlib
import os
import re
import subprocess
import sys
import zipfile

SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), *[".."] * 3))


def _version():
    with open(os.path.join(SOURCE, "CMakeLists.txt")) as file:
        return re.search(r"project\(bough VERSION ([0-9.]+)", file.read()).group(1)


def _build():
    """The folder of the built program and libraries."""
    if "BOUGH_BUILD" in os.environ:
        return os.environ["BOUGH_BUILD"]
    folder = os.path.join(SOURCE, "build", "wheel")
    try:
        subprocess.run(["cmake", "-S", SOURCE, "-B", folder, "-DCMAKE_BUILD_TYPE=Release", "-DBOUGH_TESTS=OFF",
                        "-DCMAKE_INSTALL_LIBDIR=lib"], check=True)
        subprocess.run(["cmake", "--build", folder, "--parallel", str(os.cpu_count() or 1), "--target", "bough",
                        "bough_api"], check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit("bough is not built: %s; './quickstart run' installs what the build needs" % error)
    return folder


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Writes the wheel (https://packaging.python.org, binary distribution format); its name."""
    version, build = _version(), _build()
    tag = "py3-none-linux_" + os.uname().machine
    name = "bough-%s-%s.whl" % (version, tag)
    info, data = "bough-%s.dist-info/" % version, "bough-%s.data/" % version
    record = []
    with zipfile.ZipFile(os.path.join(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:

        def add(to, content, mode=0o644):
            entry = zipfile.ZipInfo(to)
            entry.external_attr = (0o100000 | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record.append("%s,sha256=%s,%d" % (to, digest, len(content)))

        def copy(to, path, mode=0o644):
            with open(path, "rb") as file:
                add(to, file.read(), mode)

        copy("bough/__init__.py", os.path.join(SOURCE, "apps", "bough", "exchange", "bough.py"))
        add("bough/py.typed", b"")
        copy("bough/libbough.so.0", os.path.join(build, "libbough.so.0"), 0o755)
        copy(data + "scripts/bough", os.path.join(build, "bough"), 0o755)
        fmu = os.path.join(build, "bough-fmu.so")
        if os.path.exists(fmu):
            copy(data + "data/lib/bough/bough-fmu.so", fmu, 0o755)
        add(info + "METADATA", ("Metadata-Version: 2.1\nName: bough\nVersion: %s\nSummary: flexible multibody dynamics "
                                "of wind turbines by co-simulation\nRequires-Python: >=3.8\n" % version).encode())
        add(info + "WHEEL", ("Wheel-Version: 1.0\nGenerator: bough\nRoot-Is-Purelib: false\nTag: %s\n" % tag).encode())
        wheel.writestr(info + "RECORD", "\n".join([*record, info + "RECORD,,", ""]))
    return name


def build_sdist(sdist_directory, config_settings=None):
    """There is none: the wheel is built from the source tree."""
    raise NotImplementedError("bough is installed from its source tree: pip install .")
