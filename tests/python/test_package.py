# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds for the package as a whole: its types, its documentation, its errors."""
import doctest
import importlib
import inspect
import pkgutil
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import exactvo
from exactvo import errors

FOLDER = Path(exactvo.__file__).parent
MODULES = sorted(m.name for m in pkgutil.iter_modules([str(FOLDER)]) if not m.name.startswith("_"))


def test_the_package_passes_mypy_strict(source):
    mypy = shutil.which("mypy", path="/usr/bin") or shutil.which("mypy")
    if mypy is None:
        pytest.skip("mypy is missing (Debian: mypy)")
    done = subprocess.run(
        [mypy, "--config-file", source / "tools/python/mypy.ini", "--cache-dir", FOLDER.parent / ".mypy_cache", FOLDER, *(source / "examples/python").glob("*.py")],
        cwd=FOLDER.parent, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert (FOLDER / "py.typed").exists()


def test_the_stub_names_what_the_extension_has():
    from exactvo import _exactvo

    stub = (FOLDER / "_exactvo.pyi").read_text()
    for name, value in vars(_exactvo).items():
        if name.startswith("__"):
            continue
        assert any(text in stub for text in (f"def {name}(", f"class {name}:", f"{name}: ")), name
        if inspect.isclass(value):
            for member in vars(value):
                if not member.startswith("_"):
                    assert f"def {member}(" in stub, f"{name}.{member}"


@pytest.mark.parametrize("name", MODULES)
def test_every_public_name_is_documented(name):
    module = importlib.import_module(f"exactvo.{name}")
    assert module.__doc__
    for public in getattr(module, "__all__", []):
        value = getattr(module, public)
        if not (inspect.isclass(value) or inspect.isfunction(value)):
            continue
        assert value.__doc__ and not value.__doc__.startswith(f"{public}("), public
        for member, descriptor in vars(value).items() if inspect.isclass(value) else ():
            if member.startswith("_") or not (inspect.isfunction(descriptor) or isinstance(descriptor, property)):
                continue
            assert inspect.getdoc(getattr(value, member)), f"{public}.{member}"


@pytest.mark.parametrize("name", ["__init__", *MODULES])
def test_the_examples_in_the_documentation_are_true(name):
    module = exactvo if name == "__init__" else importlib.import_module(f"exactvo.{name}")
    assert doctest.testmod(module, optionflags=doctest.ELLIPSIS).failed == 0


def test_every_error_is_raised_in_a_test(source):
    text = "".join(p.read_text() for p in (source / "tests/python").glob("test_*.py") if p.name != "test_package.py")
    for name in errors.__all__:
        if name != "ExactVOError":  # a base
            assert f"raises(exactvo.{name}" in text, name


def test_errors_have_one_base_and_the_standard_ones():
    error = errors.RouteNotProvenError("words")
    assert isinstance(error, exactvo.ExactVOError) and isinstance(error, RuntimeError) and error.code == "E_ROUTE_NOT_PROVEN"
    for kind in (exactvo.ArgumentError, exactvo.DataError, exactvo.CrowdError):
        assert issubclass(kind, exactvo.ExactVOError) and issubclass(kind, ValueError)


def test_it_is_imported_from_anywhere(tmp_path):
    code = "import exactvo, sys; print(exactvo.__version__, len(exactvo.datasets.readable_formats()))"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.startswith(exactvo.__version__)


def test_another_python_is_named_in_the_error(tmp_path):
    shutil.copytree(FOLDER, tmp_path / "exactvo", ignore=shutil.ignore_patterns("*.so"))
    (tmp_path / "exactvo/_exactvo.cpython-37m-x86_64-linux-gnu.so").touch()
    done = subprocess.run([sys.executable, "-c", "import exactvo"], cwd=tmp_path, env={}, capture_output=True, text=True, check=False)
    last = done.stderr.splitlines()[-1]
    assert last.startswith("ImportError: exactvo: ") and sys.executable in last and "cpython-37m-x86_64-linux-gnu" in last, done.stderr


def test_a_mistyped_name_gets_a_suggestion():
    with pytest.raises(AttributeError, match="did you mean 'simulate'"):
        exactvo.Simulate
    done = subprocess.run([sys.executable, "-c", "import exactvo; exactvo.Simulate"], capture_output=True, text=True, check=False)
    assert done.stderr.lower().count("did you mean") == 1, done.stderr
    assert exactvo.rvo2.PyRVOSimulator and not hasattr(exactvo, "__wrapped__")
