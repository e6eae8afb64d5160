# SPDX-License-Identifier: GPL-3.0-or-later
import os
import subprocess
from pathlib import Path

import pytest


@pytest.fixture
def source():
    return Path(os.environ["EXACTVO_SOURCE"])


@pytest.fixture
def program():
    """Runs `exactvo` and gives its stdout; an exit status of 1 is an answer."""

    def run(*arguments, input=None):
        done = subprocess.run(
            [os.environ["EXACTVO_PROGRAM"], *map(str, arguments)], input=input, capture_output=True, text=True, check=False
        )
        assert done.returncode in (0, 1), done.stderr
        return done.stdout

    return run
