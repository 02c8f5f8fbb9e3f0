"""Each row of what embreex answers with a crash, a hang or a lie, behind the guard of `Accel`, in a process apart (catalogue A12)."""

import functools
import json
import subprocess
import sys
import textwrap

import pytest

PRELUDE = """
import numpy as np
from glanz.engine.world.accel import Accel
from glanz.engine.errors import AccelError
V = np.array([[0, 1, 0], [0, 0, 1], [0, 0, 0]], np.float32)
T = np.array([[0], [1], [2]], np.int32)
N = 1000
O = np.repeat(np.array([[0.2], [0.2], [1.0]], np.float32), N, 1)
D = np.repeat(np.array([[0.0], [0.0], [-1.0]], np.float32), N, 1)
FAR = np.full(N, np.inf, np.float32)

def refused(call, kind=AccelError):
    try:
        call()
    except kind as error:
        assert str(error), "an error without a text"
        return
    raise AssertionError("not refused")

a = Accel(V, T)
"""
ROWS = {
    "fewer directions than origins": "refused(lambda: a.closest(O, D[:, :5])); refused(lambda: a.occluded(O, D[:, :5], FAR))",
    "one direction for many origins": "refused(lambda: a.closest(O, D[:, :1]))",
    "limit shorter than the rays": "refused(lambda: a.occluded(O, D, FAR[:5])); refused(lambda: a.occluded(O, D, np.float32(1)))",
    "None as vertices": "refused(lambda: Accel(None, T))",
    "None as triangles": "refused(lambda: Accel(V, None))",
    "None as origins": "refused(lambda: a.closest(None, D)); refused(lambda: a.occluded(None, D, FAR))",
    "None as directions": "refused(lambda: a.closest(O, None))",
    "limits of the nearest hit": """
        far = np.full(N, 0.5, np.float32)
        m = a.closest(O, D, far)
        assert (m.prim == -1).all() and (m.t == 0.5).all() and (far == 0.5).all() and (m.u == 0).all()
        m = a.closest(O, D, FAR)
        assert (m.prim == 0).all() and np.allclose(m.t, 1)
        assert (a.closest(O, D, np.full(N, np.inf, np.float32)).t == a.closest(O, D).t).all()
        some = np.where(np.arange(N) % 2, FAR, np.float32(0.5)).astype(np.float32)
        assert ((a.closest(O, D, some).prim == 0) == (np.arange(N) % 2 == 1)).all()
        for bad in (-1.0, -np.inf, np.nan):
            assert (a.closest(O, D, np.full(N, bad, np.float32)).prim == -1).all()
        for bad in (FAR[:5], FAR.astype(float), np.float32(1)):
            refused(lambda bad=bad: a.closest(O, D, bad))
        bad = O.copy(); bad[0, 3] = np.nan
        m = a.closest(bad, D, FAR)
        assert m.prim[3] == -1 and (np.delete(m.prim, 3) == 0).all()
        """,
    "None as limit": "refused(lambda: a.occluded(O, D, None))",
    "memory exhausted": """
        from glanz.engine import MemoryShortage, memory
        free, memory.free = memory.free, lambda: 2**20
        refused(lambda: Accel(np.zeros((3, 3), np.float32), np.zeros((3, 10**6), np.int32)), MemoryShortage)
        memory.free = free
        """,
    "NaN and inf in rays, many triangles": """
        rng = np.random.default_rng(1)
        v = rng.random((3, 300_000), np.float32)
        big = Accel(v, np.arange(300_000).reshape(-1, 3).T)
        d = np.full((3, 200_000), np.nan, np.float32)
        o = rng.random((3, 200_000), np.float32)
        assert (big.closest(o, d).prim == -1).all()
        assert not big.occluded(o, d, np.full(200_000, 1, np.float32)).any()
        assert (big.closest(d, o).prim == -1).all()
        assert (big.closest(o, d * 0 + np.inf).prim == -1).all()
        """,
    "origins of two rows": "refused(lambda: a.closest(O[:2], D)); refused(lambda: a.closest(O[:2], D[:2]))",
    "no flags are uninitialised memory": "assert a.occluded(O, D, FAR).dtype == bool; assert a.occluded(O, D, FAR).all()",
    "limits are not overwritten": "limit = FAR.copy(); a.occluded(O, D, limit); a.closest(O, D); assert (limit == FAR).all()",
    "limits that are negative or NaN": """
        for bad in (-1.0, -np.inf, np.nan):
            assert not a.occluded(O, D, np.full(N, bad, np.float32)).any()
        """,
    "limits of float64": "refused(lambda: a.occluded(O, D, FAR.astype(float)))",
    "index beyond the vertices": "refused(lambda: Accel(V, T + 1))",
    "negative index": "refused(lambda: Accel(V, T - 1))",
    "index of 2^31 and more": "L = T.astype(np.int64); refused(lambda: Accel(V, L + 2**40)); refused(lambda: Accel(V, L * 2**31))",
    "float and complex indices": "refused(lambda: Accel(V, T.astype(float))); refused(lambda: Accel(V, T.astype(complex)))",
    "float64 vertices": "refused(lambda: Accel(V.astype(float), T))",
    "vertices that are not finite": """
        for bad in (np.nan, np.inf, 1e30):
            v = V.copy(); v[0, 0] = bad
            assert (Accel(v, T).closest(O, D).prim == -1).all()
        """,
    "wrong number of dimensions": "for c in (lambda: Accel(V[0], T), lambda: Accel(V, T[0]), lambda: a.closest(O[0], D[0])): refused(c)",
    "float64 rays": "refused(lambda: a.closest(O.astype(float), D.astype(float)))",
    "lists": "refused(lambda: a.closest(O.tolist(), D.tolist())); refused(lambda: Accel(V.tolist(), T.tolist()))",
    "big-endian": "refused(lambda: a.closest(O.astype('>f4'), D.astype('>f4'))); refused(lambda: Accel(V.astype('>f4'), T))",
    "no triangles": "e = Accel(V, T[:, :0]); assert (e.closest(O, D).prim == -1).all(); assert not e.occluded(O, D, FAR).any()",
    "no vertices": "e = Accel(V[:, :0], T[:, :0]); assert (e.closest(O, D).prim == -1).all()",
    "no rays": "assert a.closest(O[:, :0], D[:, :0]).prim.shape == (0,); assert a.occluded(O[:, :0], D[:, :0], FAR[:0]).shape == (0,)",
    "degenerate triangles": """
        v = np.zeros((3, 30_000), np.float32); v[0] = np.arange(30_000)
        assert (Accel(v, np.arange(30_000).reshape(-1, 3).T).closest(O, D).prim == -1).all()
        assert (Accel(V, T[[0, 0, 1]]).closest(O, D).prim == -1).all()
        """,
    "coincident triangles": """
        many = Accel(V, np.repeat(T, 10_000, 1))
        once, twice = many.closest(O[:, :20], D[:, :20]), many.closest(O[:, :20], D[:, :20])
        assert (once.prim >= 0).all() and (once.prim == twice.prim).all()
        assert np.allclose(once.t, 1, atol=1e-6)
        """,
    "zero direction": "assert (a.closest(O, 0 * D).prim == -1).all(); assert not a.occluded(O, 0 * D, FAR).any()",
    "inf origin": "assert (a.closest(O * np.float32(np.inf), D).prim == -1).all()",
    "a miss": "m = a.closest(O, -D); assert (m.prim == -1).all() and (m.u == 0).all() and (m.v == 0).all()",
    "a ray that starts on a triangle": "o = O.copy(); o[2] = 0; assert a.closest(o, D).prim.shape == (N,)",
    "read-only, reversed and strided rays": """
        o, d = np.repeat(O, 2, 1)[:, ::2], D[:, ::-1]
        o.flags.writeable = d.flags.writeable = False
        assert (a.closest(o, d).prim == 0).all()
        assert a.occluded(o, d, np.repeat(FAR, 2)[::2]).all()
        """,
    "eight threads on one scene": """
        from concurrent.futures import ThreadPoolExecutor
        with ThreadPoolExecutor(8) as pool:
            assert all((r.prim == 0).all() for r in pool.map(lambda _: a.closest(O, D), range(64)))
        """,
    "two hundred scenes": """
        scenes = [Accel(V, T) for _ in range(200)]
        assert all((s.closest(O, D).prim == 0).all() for s in scenes)
        """,
    "arrays of the caller may go": """
        v, t = V.copy(), T.copy()
        s = Accel(v, t); v[:] = 99; t[:] = 0; del v, t
        assert (s.closest(O, D).prim == 0).all()
        """,
}


PROGRAM = """
import json, sys
sys.path[:], rows = json.load(sys.stdin)
for name, code in rows:
    exec(code, {})
    print(name, flush=True)
"""


@functools.cache
def faults():
    """{row: how its process ended} of those that did not go well. One process takes all rows, and after such a row another the rest."""
    found, left = {}, list(ROWS)
    while left:
        rows = [(row, PRELUDE + textwrap.dedent(ROWS[row])) for row in left]
        command, words = [sys.executable, "-c", PROGRAM], json.dumps((sys.path, rows))
        done = subprocess.run(command, input=words, capture_output=True, text=True, timeout=300, check=False)
        if done.returncode == 0 and done.stdout.splitlines() == left:
            break
        at = min(done.stdout.count("\n"), len(left) - 1)
        found[left[at]] = f"exit status {done.returncode}: {done.stderr}"
        left = left[at + 1 :]
    return found


@pytest.mark.parametrize("row", ROWS)
def test_bad_input_is_refused_or_answered_and_kills_no_process(row):
    """A12: exit status 0 of a process that does nothing else; a crash or a hang would be seen here."""
    assert row not in faults(), faults()[row]
