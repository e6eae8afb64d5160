# SPDX-License-Identifier: GPL-3.0-or-later
"""What `pip install .` builds: the extension and its modules, by CMake. CMAKE_ARGS adds options of CMake's."""
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


def jobs():
    """As scripts/common.sh: some units take 2 GB to compile."""
    try:
        memory = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (ValueError, OSError):
        memory = 0
    return max(1, min(os.cpu_count() or 1, memory // 2_000_000_000))


def pybind11_options():
    """Where pip has put pybind11 for this build; Debian's pybind11-dev CMake finds by itself."""
    try:
        import pybind11

        return [f"pybind11_DIR={pybind11.get_cmake_dir()}"]
    except ImportError:
        return []


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        build = Path(self.build_temp).resolve()
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        options = ["CMAKE_BUILD_TYPE=Release", "EXACTVO_PYTHON=ON", "EXACTVO_UNITY=ON", f"Python3_EXECUTABLE={sys.executable}"]
        options += [f"EXACTVO_{part}=OFF" for part in ("TOOLS", "TESTS", "BENCH", "EXAMPLES")]
        options += pybind11_options()
        given = shlex.split(os.environ.get("CMAKE_ARGS", ""))
        subprocess.run(["cmake", "-S", ROOT, "-B", build, *generator, *(f"-D{o}" for o in options), *given], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "exactvo_python", "--parallel", str(jobs())], check=True)
        target = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        target.mkdir(parents=True, exist_ok=True)
        made = [*(build / "python/exactvo").glob("_exactvo*.so"), *(build / "lib").glob("**/exactvo_*.so")]
        for file in made:  # GDAL's and MPI's modules beside the extension: the first place where it looks
            shutil.copy2(file, target / file.name)


setup(ext_modules=[Extension("exactvo._exactvo", sources=[])], cmdclass={"build_ext": CMakeBuild})
