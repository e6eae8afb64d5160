# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory is flat over many calls of every public function, those that are refused included.

Some hundred calls of each here; EXACTVO_PYTHON_CALLS=100000 for the long run (ten to twenty minutes). What is in use is asked
exactly: blocks of Python's own allocator, and bytes of the C library's."""
import ctypes
import gc
import os
import sys
import time
from pathlib import Path

import pytest

import exactvo

sys.path.insert(0, str(Path(__file__).parent))
from good_calls import good_calls  # noqa: E402
from raising_calls import raising_calls  # noqa: E402

CALLS = int(os.environ.get("EXACTVO_PYTHON_CALLS", "400"))
#: One call in so many of what takes a millisecond or more: free velocities, files, pages, pictures. The others take microseconds.
ONE_IN = {
    "vo.FreeVelocities": 20,
    "vo.free_velocities": 20,
    "vo.FreeVelocities.compare": 20,
    "vo.FreeVelocities.exact": 10,
    "vo.FreeVelocities.exact: ArgumentError": 20,
    "simulation.simulate": 10,
    "simulation.read_recording": 10,
    "simulation.Recording.audit": 10,
    "simulation.Recording.to_dataframe": 10,
    "simulation.Recording.write": 20,
    "simulation.Recording.view": 20,
    "simulation.Recording.plot": 500,
    "explorer.ExplorerPage.write": 20,
    "datasets.batch": 100,
    "datasets.convert": 20,
    "datasets.write": 20,
}
#: A FuncAnimation of matplotlib leaves some eighty blocks behind by itself; `plot` draws the same.
NOT_ASKED = {"explorer.view", "simulation.Recording.animate"}  # the first takes recordings; Recording.view calls it
#: And of what is refused.
ONE_IN_REFUSED = 10


class Mallinfo2(ctypes.Structure):
    _fields_ = [(n, ctypes.c_size_t) for n in "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost".split()]


def mallinfo2():
    function = getattr(ctypes.CDLL(None), "mallinfo2", None)
    if function is not None:
        function.restype = Mallinfo2
    return function


def in_use(mallinfo):
    """Blocks of Python, bytes of malloc."""
    info = mallinfo()
    return sys.getallocatedblocks(), info.uordblks + info.hblkhd


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def grows(call, count, mallinfo):
    """What is left behind where each of three rounds of calls leaves half a block or eight bytes a call; else "". Caches fill
    in a round or two, and what waits for the collector is gone in the second; a leak is in all."""
    for k, calls in enumerate((max(2, count // 3), max(2, count // 3), 2 * max(2, count // 3))):
        if k > 0:
            gc.collect()
        blocks, size = in_use(mallinfo)
        for _ in range(calls):
            call()
        if k > 0:
            gc.collect()
        more_blocks, more_size = (after - before for after, before in zip(in_use(mallinfo), (blocks, size)))
        if more_blocks < 0.5 * calls + 64 and more_size < 8 * calls + 4096:
            return ""
    return f"{more_blocks} blocks and {more_size} bytes in {calls} calls"


def all_calls(folder):
    (folder / "good").mkdir()
    (folder / "raising").mkdir()
    for name, function, given in good_calls(folder / "good"):
        if name not in NOT_ASKED:
            yield name, (lambda function=function, given=given: function(**given)), max(6, CALLS // ONE_IN.get(name, 1))
    for name, exception, function in raising_calls(folder / "raising"):

        def refused(function=function):
            try:
                function()
            except (exactvo.ExactVOError, IndexError, ValueError, RuntimeError):
                pass

        name = f"{name}: {exception}"
        yield name, refused, max(6, CALLS // ONE_IN.get(name, ONE_IN_REFUSED))


def test_memory_is_flat(tmp_path):
    mallinfo = mallinfo2()
    if mallinfo is None:
        pytest.skip("the C library has no mallinfo2")
    growing, tried, began = {}, 0, resident()
    gc.freeze()  # what is there by now need not be looked through again and again
    for name, call, count in all_calls(tmp_path):
        if name.startswith("simulation.Recording.plot"):
            import matplotlib.pyplot as plt

            call = (lambda call=call, plt=plt: (call(), plt.close("all")))
        for _ in range(min(count, 20)):  # caches
            call()
        start = time.perf_counter()
        what = grows(call, count, mallinfo)
        if what:
            growing[name] = what
        tried += count
        if CALLS > 1000:
            print(f"{name}: {count} calls, {1e6 * (time.perf_counter() - start) / count:.1f} us a call, {(resident() - began) >> 10} kB", flush=True)
    assert not growing
    assert tried > 50 * CALLS


def test_a_leak_is_seen():
    """The measure itself: an object kept for each call, and a C buffer."""
    mallinfo = mallinfo2()
    if mallinfo is None:
        pytest.skip("the C library has no mallinfo2")
    kept = []
    assert grows(lambda: kept.append(object()), 1000, mallinfo)
    assert grows(lambda: kept.append(bytes(1000)), 100, mallinfo)
    libc = ctypes.CDLL(None)
    libc.malloc.restype = ctypes.c_void_p
    assert grows(lambda: libc.malloc(40) and None, 1000, mallinfo)
