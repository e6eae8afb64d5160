# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs pytest on files, or with --script a script; exit status 77, which ctest calls skipped, where numpy or pytest is missing."""
import importlib.util
import runpy
import sys

for package in ("numpy", "pytest"):
    if importlib.util.find_spec(package) is None:
        print(f"skipped: {package} is missing for {sys.executable} (Debian: python3-{package})")
        sys.exit(77)

if sys.argv[1] == "--script":
    sys.argv = sys.argv[2:]
    runpy.run_path(sys.argv[0], run_name="__main__")
else:
    import pytest

    sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", *sys.argv[1:]]))
