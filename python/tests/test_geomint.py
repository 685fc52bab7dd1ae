# SPDX-License-Identifier: GPL-3.0-or-later
"""The package against NumPy and SciPy, which know nothing of it."""
import gc
import json
import os
import re
import shlex
import subprocess
import sys
import threading
import weakref
from html.parser import HTMLParser

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import geomint
from geomint import _library

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))


# ---- numbers

def test_kepler_against_dop853():
    orbit = geomint.run("kepler", scheme="gauss6", eccentricity=0.5, dt=0.01, until=20)
    reference = solve_ivp(lambda t, y: [y[2], y[3], *(-y[:2] / np.hypot(*y[:2]) ** 3)], (0, 20),
                          [*orbit.q[0], *orbit.p[0]], method="DOP853", rtol=1e-13, atol=1e-13, t_eval=orbit.t)
    assert orbit.q.shape == (2001, 2)
    assert np.abs(orbit.q - reference.y[:2].T).max() < 1e-8
    assert np.abs(orbit.p - reference.y[2:].T).max() < 1e-8
    energy = (orbit.p ** 2).sum(1) / 2 - 1 / np.hypot(orbit.q1, orbit.q2)
    assert np.allclose(orbit.energy_error, np.abs(energy / energy[0] - 1), atol=1e-15)


def test_order_against_dop853():
    """Halving the step of leapfrog quarters its error."""
    end = solve_ivp(lambda t, y: [y[1], -y[0] ** 3], (0, 8), [1, 0], method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    well = geomint.system(H="p^2/2 + q^4/4", q=1, p=0)
    errors = [np.abs(geomint.run(well, scheme="verlet", dt=dt, until=8).q[-1] - end[0]) for dt in (0.02, 0.01, 0.005)]
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.02)
    assert errors[1] / errors[2] == pytest.approx(4, rel=0.02)


def test_leapfrog_by_numpy():
    run = geomint.run(geomint.system(H="p^2/2 + q^2/2", q=1, p=0), scheme="verlet", dt=0.125, steps=100)
    q, p = np.empty(101), np.empty(101)
    q[0], p[0] = 1, 0
    for i in range(100):
        half = p[i] - 0.0625 * q[i]
        q[i + 1] = q[i] + 0.125 * half
        p[i + 1] = half - 0.0625 * q[i + 1]
    assert np.allclose(run.q, q, atol=1e-14) and np.allclose(run.p, p, atol=1e-14)


def test_formula_equals_file(tmp_path):
    path = tmp_path / "well.system"
    path.write_text("geomint: 1\ncoordinates: q\nmomenta: p\nH: p^2/2 + q^4/4\nstart: q = 1.5, p = 0\ndt: 0.1\n")
    words = dict(scheme=["verlet", "gauss4"], dt=0.1, until=50)
    typed = geomint.run(geomint.system(H="p^2/2 + q^4/4"), q=1.5, p=0, **words)
    filed = geomint.run(geomint.system(str(path)), **words)
    for one, other in zip(typed, filed):
        assert one.q.tobytes() == other.q.tobytes() and one.p.tobytes() == other.p.tobytes()


def test_lagrangian_and_rates():
    spring = geomint.system(L="v^2/2 - k*q^2/2", k=4, q=1, v=0)
    run = geomint.run(spring, scheme="gauss4", dt=0.01, until=2)
    assert np.abs(run.q - np.cos(2 * run.t)).max() < 1e-7
    circle = geomint.run(geomint.system(rate={"x": "y", "y": "-x"}, x=0, y=1), scheme="rk4", dt=0.01, until=2)
    assert np.abs(circle.x - np.sin(circle.t)).max() < 1e-8


def test_field():
    run = geomint.run("sine-gordon", steps=20)
    name = next(key for key in run.keys() if run[key].ndim == 2)
    assert run[name].shape[0] == 21 == len(run.t)
    assert "grid" in run.keys() and run.grid.shape == run[name].shape[1:]


def test_ensemble():
    run = geomint.run("disc", scheme="midpoint", steps=10)
    assert run.q.ndim == 2 and run.q.shape[0] == 11
    assert run.state.shape == (6, run.q.shape[1])  # with the tangent
    assert np.array_equal(run.state[0], run.q[-1]) and np.array_equal(run.state[3], run.p[-1])


def test_flow():
    run = geomint.run("couette", steps=2)
    assert run.velocity.shape == (3, len(run.triangles), 2) and run.points.shape[1] == 2
    assert run.triangles.min() == 0 and run.triangles.max() == len(run.points) - 1 == run.vorticity.shape[1] - 1


def test_own_time():
    run = geomint.run("oscillator", scheme="variational-rectangle-restart", until=3)
    assert run.t[0] == 0 and run.t[-1] >= 3 > run.t[-2]
    assert np.all(np.diff(run.t) >= 0)  # a restart takes a step, and no time
    assert len(run.t) == run.steps + 1


def test_every():
    run = geomint.run("kepler", dt=0.01, steps=1005, every=100)
    assert len(run.t) == 12 and run.t[-1] == pytest.approx(10.05)
    whole = geomint.run("kepler", dt=0.01, steps=1005)
    assert np.array_equal(run.q[:-1], whole.q[:1001:100]) and np.array_equal(run.q[-1], whole.q[-1])
    end = geomint.run("kepler", dt=0.01, steps=200001, every=200001)
    assert len(end.t) == 2 and end.t[-1] == pytest.approx(2000.01)


def test_pieces():
    """Where a run ends does not depend on how it went there."""
    whole = geomint.run("kepler", scheme="rk4", dt=0.01, steps=70001, every=70001).state
    stepped = geomint.open("kepler", scheme="rk4", dt=0.01).step(70001).state
    timed = geomint.open("kepler", scheme="rk4", dt=0.01).until(700.01).state
    assert np.array_equal(whole, stepped) and np.array_equal(whole, timed)
    rows = geomint.run("kepler", scheme="rk4", dt=0.01, steps=70001, every=3)
    assert len(rows.t) == 1 + 23333 + 1 and np.array_equal(rows.state, whole)


def test_until_lies_between_steps():
    run = geomint.run("kepler", dt=0.3, until=1)
    assert run.t[-1] == 1 and run.steps == 4 and run.message == ""
    run = geomint.run("kepler", scheme="gsl-rk4", dt=0.3, until=1)
    assert run.t[-1] == 1 and run.steps == 4 and run.message == ""


def test_blow_up_is_content():
    run = geomint.run(geomint.system(H="p^2/2 - q^4/4", q=1, p=1), scheme="explicit-euler", dt=0.5, until=100)
    assert run.status == "blow-up" and "led beyond" in run.message
    assert np.isfinite(run.q).all() and len(run.t) == run.steps + 1 < 200


def test_stop(tmp_path):
    path = tmp_path / "fall.system"
    path.write_text("geomint: 1\ncoordinates: q\nmomenta: p\nH: p^2/2 + q\nstart: q = 2, p = 0\nstop: q\ndt: 0.01\n")
    run = geomint.open(str(path), scheme="verlet").step(10 ** 9)
    assert run.status == "ok" and run.time == pytest.approx(2, abs=1e-6) and run.state[0] == pytest.approx(0, abs=1e-6)
    whole = geomint.run(str(path), scheme="verlet", until=100, every=1000)
    assert len(whole.t) == 2 and whole.t[-1] == pytest.approx(2, abs=1e-6)


# ---- memory

def test_nothing_is_copied():
    run = geomint.run("kepler", steps=100)
    assert run.q.base is not None and np.shares_memory(run.q, run.p1.base)
    assert np.shares_memory(run.q, run.q1) and np.shares_memory(run.energy_error, run.q.base)


def test_state_lives():
    run = geomint.open("kepler")
    state = run.state
    before = state.copy()
    run.step(10)
    assert run.state is state and not np.array_equal(state, before)
    with pytest.raises(ValueError):
        state[0] = 1
    kept = state.copy()
    run.close()
    del run
    gc.collect()
    assert np.array_equal(state, kept)  # it keeps what it looks at


def test_memory_goes_at_once():
    """Nothing waits for the collector of circles, which does not know how much a handle holds."""
    closed = []
    gc.disable()
    try:
        run = geomint.run("kepler", steps=2)
        lane = run[0]
        weakref.finalize(run._opened, closed.append, True)
        del run
        assert lane.steps == 2 and not closed
        del lane
        assert closed
    finally:
        gc.enable()


def test_closed():
    with geomint.open("kepler") as run:
        run.step()
    for use in (run.step, lambda: run.time, lambda: run.state, lambda: run.until(1), lambda: run.observe("energy_error"),
                run.picture, lambda: run.about):
        with pytest.raises(geomint.ClosedError, match="this run is closed"):
            use()
    assert "closed" in repr(run)
    assert run._repr_png_() is None and run._repr_svg_() is None  # a notebook shows what can be shown
    run.close()


# ---- refusals

@pytest.mark.parametrize("words, sentence", [
    (dict(scene="keplr"), "did you mean kepler"),
    (dict(scene="kepler", eccentrcity=0.5), "did you mean eccentricity"),
    (dict(scene="kepler", scheme="verlett"), "verlet"),
    (dict(scene="kepler", observe="energy"), "energy_error"),
    (dict(scene="kepler", dt=np.ones((2, 2))), r"dt has the shape \(2, 2\)"),
    (dict(scene="kepler", dt=[]), "empty list"),
    (dict(scene="kepler", dt={}), "not dict"),
    (dict(scene="kepler", dt=float("nan")), "dt"),
    (dict(scene="kepler", every=0), "1 or more"),
    (dict(scene="kepler\0", steps=1), "zero byte"),
    (dict(scene="kepler", scheme="verlet\0x"), "zero byte"),
    (dict(scene="kepler", observe="energy_error\0,"), "zero byte"),
    (dict(scene="kepler", scheme="\ud800"), "UTF-8"),
    (dict(scene="kepler", steps=10 ** 9), "every="),
    (dict(scene=3), "not int"),
    (dict(scene=geomint.system(H="p^2/2 + k*q^2")), "k"),
    (dict(scene=geomint.system(H="p^2/2 + 2q", q=1, p=0)), r"\*"),
])
def test_refusals(words, sentence):
    with pytest.raises(geomint.UsageError, match=sentence):
        geomint.run(words.pop("scene"), **words)


def test_more_refusals(tmp_path):
    with pytest.raises(geomint.FileError):
        geomint.run("/nowhere/such.system")
    with pytest.raises(geomint.UsageError, match="key=value"):
        geomint.run("kepler", "dt")
    with pytest.raises(geomint.UsageError, match="a formula"):
        geomint.system(q=1)
    run = geomint.run("kepler", scheme=["rk4", "verlet"], steps=10)
    assert len(run) == 2 and run[1].q.shape == (11, 2)
    with pytest.raises(AttributeError, match=r"run\[0\].q"):
        run.q
    with pytest.raises(AttributeError, match="energy_error"):
        run[0].energy
    with pytest.raises(KeyError):
        run[0]["energy"]
    with pytest.raises(geomint.UsageError, match=r"\.png"):
        run.picture(100, 100).save(tmp_path / "picture.bmp")
    for width, height in (0, 100), (100, 10 ** 12), (63, 100):
        with pytest.raises(geomint.UsageError, match="from 64 to 16384"):
            run.picture(width, height)
    with pytest.raises(geomint.UsageError, match="as large"):
        run.picture(100, 100, scale=float("nan")).svg


def test_texts_end_where_they_end():
    """Nothing is read of a text up to a zero byte."""
    run = geomint.run("kepler", steps=1)
    for use in (lambda: geomint.scheme("verlet\0"), lambda: geomint.certify("verlet\0"), lambda: run.observe("energy_error\0"),
                lambda: run.picture(title="a\0b"), lambda: run.picture().save("a.png\0")):
        with pytest.raises(geomint.UsageError, match="zero byte"):
            use()


def test_huge_numbers():
    run = geomint.run("kepler", dt=0.01, steps=10, every=10 ** 30)
    assert len(run.t) == 2
    with pytest.raises(geomint.UsageError):
        geomint.open("kepler").until(float("inf"))
    with pytest.raises(geomint.UsageError):
        geomint.open("kepler").step(-1)


INTERRUPTED = """
import os, signal, sys, threading
import geomint
signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell starts in the background ignores it
threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    eval(sys.argv[1])
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.parametrize("call", [
    "geomint.run('kepler', dt=1e-3, steps=10**12, every=10**12)",
    "geomint.open('kepler', dt=1e-3).step(10**12)",
    "geomint.open('kepler', dt=1e-3).until(1e9)",
    "geomint.sweep('kepler', dt=[1e-3, 1e-3, 1e-3], steps=10**12, jobs=2)",
])
def test_keyboard_interrupts(call):
    """These would take days."""
    done = subprocess.run([sys.executable, "-c", INTERRUPTED, call], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip() == "interrupted"


def import_with(folder, **environment):
    code = "import sys; sys.path[:0] = sys.argv[1:]; import geomint"
    package = os.path.dirname(os.path.dirname(geomint.__file__))
    done = subprocess.run([sys.executable, "-c", code, str(folder), package], capture_output=True, text=True,
                          env={**os.environ, **environment})
    return done.returncode, done.stderr.strip().splitlines()[-1] if done.stderr else ""


def test_no_numpy(tmp_path):
    (tmp_path / "numpy.py").write_text("raise ImportError('none')\n")
    status, error = import_with(tmp_path)
    assert status and error.startswith("ImportError: geomint needs NumPy")


def test_no_library(tmp_path):
    status, error = import_with(tmp_path, GEOMINT_LIBRARY=str(tmp_path / "libnone.so"))
    assert status and error.startswith("ImportError: libgeomint could not be loaded")


def test_older_library(tmp_path, monkeypatch):
    monkeypatch.setattr(_library, "__version__", "99.0.0")
    with pytest.raises(ImportError, match="is older than this package, 99.0.0"):
        _library.load()


def test_declarations():
    """What the package declares is what the header says."""
    def functions(text):
        text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
        return {" ".join(found.split()) for found in re.findall(r"^[a-z][^;{}#]*?\bgeomint_\w+\([^;]*?\);", text, re.M)}

    with open(os.path.join(SOURCE, "library", "geomint.h"), encoding="utf-8") as header:
        expected = functions(header.read())
    assert len(expected) > 25 and functions(_library.DECLARATIONS) == expected
    assert geomint.__version__ == _library.ffi.string(_library.library.geomint_version()).decode()


# ---- threads

def test_threads():
    """Two runs at once have the bits of two runs one after the other."""
    jobs = [("kepler", dict(scheme="rk4", dt=0.01, steps=20000)),
            (geomint.system(H="p^2/2 - cos(q)", q=2, p=0), dict(scheme="gauss4", dt=0.1, steps=5000))]
    alone = [geomint.run(scene, **words).state.tobytes() for scene, words in jobs]
    beside = [None, None]

    def work(i):
        beside[i] = geomint.run(jobs[i][0], **jobs[i][1]).state.tobytes()

    threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert beside == alone


def test_threads_of_one_run():
    """They take turns: no text is gone while it is read, and no orbit that is followed."""
    run = geomint.open("henon-heiles", scheme="verlet")
    wrong = []

    def work():
        try:
            for _ in range(200):
                run.step(5)
                assert run.about["scene"] == "henon-heiles"
                run.observe("megno")
        except Exception as error:
            wrong.append(error)

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    sys.setswitchinterval(interval)
    assert not wrong


# ---- sweeps, schemes, pictures

def test_sweep():
    steps = np.array([0.02, 0.01])
    sweep = geomint.sweep("kepler", scheme=["rk4", "verlet"], dt=steps, until=1, jobs=2)
    assert sweep.shape == (2, 2) and list(sweep.axes) == ["scheme", "dt"]
    for i, scheme in enumerate(["rk4", "verlet"]):
        for k, dt in enumerate(steps):
            assert sweep["energy_error"][i, k] == geomint.run("kepler", scheme=scheme, dt=dt, until=1).energy_error[-1]
    assert (sweep["status"] == "ok").all()
    with pytest.raises(geomint.UsageError, match="did you mean eccentricity"):
        geomint.sweep("kepler", eccentrcity=[0.1, 0.2])
    with pytest.raises(geomint.UsageError, match="1 or more"):
        geomint.sweep("kepler", dt=[0.1], steps=1, jobs=0)
    assert geomint.sweep("kepler", dt=np.array(0.1), steps=1).shape == ()


def test_sweep_over_components(tmp_path):
    """The runs of a sweep may have components that others have not."""
    path = tmp_path / "some.system"
    path.write_text("geomint: 1\nparameter: N = 2; 1 .. 5\ncomponents: x[1..N]\nrate: x[i] = -x[i]\nstart: x[i] = i\n"
                    "observe: last = x[N]\nlet: first = x[1]\n")
    sweep = geomint.sweep(str(path), N=[3, 2], scheme="rk4", dt=0.1, steps=1)
    assert sweep["last"][0] / sweep["last"][1] == pytest.approx(1.5)


def test_time_is_there_once():
    """Of a system that carries the time, too, it is that of the rows."""
    run = geomint.run(geomint.system(H="p^2/2 - q*cos(t)", q=1, p=0), scheme="rk4", dt=0.1, steps=1000)
    assert np.array_equal(run.t, np.arange(1001) * 0.1) and list(run.keys())[:3] == ["t", "q", "p"]


def test_scheme():
    verlet = geomint.scheme("verlet")
    assert verlet.order == 2 and "symplectic" in verlet.claims
    own = geomint.scheme("composition(verlet; 1/2, 1/2)")
    run = geomint.run("kepler", scheme=own, dt=0.02, steps=50)
    twice = geomint.run("kepler", scheme=verlet, dt=0.01, steps=100, every=2)
    assert np.allclose(run.q, twice.q, atol=1e-12)
    with pytest.raises(geomint.UsageError, match="did you mean verlet"):
        geomint.scheme("verlett")
    assert "kepler" in geomint.scenes() and "verlet" in geomint.schemes()


def test_certify():
    certificate = geomint.certify("verlet", on=geomint.system(H="p^2/2 + q^4/4", q=1, p=0))
    assert certificate and certificate.order == 2 and certificate.measured_order == pytest.approx(2, abs=0.05)
    assert certificate.claims["symplectic"]["defect"] < 1e-12
    assert certificate.theory["order"] == 2 and certificate.theory["symplectic"]
    assert not geomint.certify("rk2").claims["symplectic"]["claimed"]


def test_false_claim(tmp_path):
    path = tmp_path / "false.scheme"
    path.write_text("geomint: 1\nkind: runge-kutta\norder: 2\nclaims: symplectic\na: 0, 0 | 1, 0\nb: 1/2, 1/2\n")
    certificate = geomint.certify(str(path))
    assert not certificate and not certificate.theory["symplectic"] and "BROKEN" in repr(certificate)


def test_picture(tmp_path):
    picture = geomint.render("kepler", width=320, height=180, until=5)
    assert picture._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n" and "<svg" in picture._repr_svg_()
    assert picture.pdf[:5] == b"%PDF-"
    pixels = picture.rgba
    assert pixels.shape == (180, 320, 4) and (pixels[..., 3] == 255).all() and len(np.unique(pixels)) > 10
    picture.save(tmp_path / "orbit.svg")
    assert b"geomint:arguments" in (tmp_path / "orbit.svg").read_bytes()
    run = geomint.run("kepler", until=5)
    assert run.picture(320, 180).png == picture.png  # looked at or not, the same motion


class Elements(HTMLParser):
    """What a page is made of, and what a browser makes comments of."""

    def __init__(self, text):
        super().__init__()
        self.names, self.odd = [], []
        self.feed(f"<div>{text}</div>")

    def handle_starttag(self, tag, attrs):
        self.names.append(tag)

    def handle_pi(self, data):
        self.odd.append(data)

    handle_decl = unknown_decl = handle_pi


def test_picture_in_html():
    """A notebook puts the picture into a page, where there is one XML declaration at most: none."""
    run = geomint.run("kepler", until=1)
    for shown in run, run.picture(320, 180):
        page = Elements(shown._repr_svg_())
        assert shown._repr_svg_().startswith("<svg ") and page.names[:2] == ["div", "svg"] and page.odd == []
    assert run.picture(320, 180).svg.startswith(b"<?xml")  # of a file


SYSTEMS = ["double-pendulum", "bowl", "lorenz", "heavy-top", "phi4", "bbm", "nonlinear-dirac"]  # one of each kind


@pytest.mark.skipif("GEOMINT_PROGRAM" not in os.environ, reason="the program is not named")
@pytest.mark.parametrize("scene", geomint.scenes() + SYSTEMS)
def test_picture_is_that_of_render(tmp_path, scene):
    """A picture of the library is that of the program, byte for byte: maps of space and time, too."""
    program = os.environ["GEOMINT_PROGRAM"]
    told = json.loads(subprocess.run([program, "list", scene, "--json"], check=True, capture_output=True).stdout)
    words = [told["run"] if "run" in told else f"scheme={told['schemes'][0]}", "steps=24"]
    words += ["rows=14", "columns=10"] if scene == "cavity" else []
    file = tmp_path / "render.png"
    subprocess.run([program, "render", scene, *words, "--size", "320x240", "-o", file], check=True, capture_output=True)
    # render adds the scene's own lanes: the picture names all of its words
    content = file.read_bytes()
    at = content.index(b"tEXtgeomint:arguments")
    drawn = content[at + 4 : at + 4 + int.from_bytes(content[at - 4 : at], "big")].partition(b"\0")[2].decode()
    run = geomint.open(scene, *shlex.split(drawn)[1:])
    for lane in run:
        lane.step(24)
    assert run.picture(320, 240).png == content


# ---- exploring

def kepler(*typed, **parameters):
    return geomint.explore("kepler", *typed, dt=0.125, eccentricity=0.5, **parameters)


def single(scheme, steps, **parameters):
    return geomint.open("kepler", **{"dt": 0.125, "eccentricity": 0.5, "scheme": scheme, **parameters})[0].step(steps).state


def test_explored_lanes_are_runs():
    lab = kepler(scheme=["verlet", "rk4"])
    assert lab.advance(10).t == 10 and len(lab) == 2
    assert np.array_equal(lab.state(0), single("verlet", 80)) and np.array_equal(lab.state(1), single("rk4", 80))
    assert np.array_equal(lab.forward().state(1), single("rk4", 81))
    assert np.array_equal(lab.back().state(1), single("rk4", 80))
    assert lab.observe("energy_error", 1) == lab.view["lanes"][1]["values"]["energy_error"] > 0
    assert np.array_equal(lab.picture(320, 200).rgba[..., 3], np.full((200, 320), 255))
    assert repr(lab) == "<exploring kepler at t = 10: verlet, rk4>"


def test_explored_lanes_fork_and_switch():
    forked, switched = kepler(scheme="verlet").advance(5), kepler(scheme="verlet").advance(5)
    forked.fork("rk4").advance(9)
    switched.switch("rk4").advance(9)
    assert np.array_equal(forked.state(1), switched.state(0)) and np.array_equal(forked.state(0), single("verlet", 72))
    assert switched.undo().view["lanes"][0]["scheme"] == "verlet"
    forked.add(geomint.scheme("rk2")).advance(10)
    assert np.array_equal(forked.state(2), single("rk2", 80))
    assert len(forked.remove(0)) == 2 and np.array_equal(forked.state(1), single("rk2", 80))


def test_explored_time_runs_back():
    lab = kepler(scheme="verlet").advance(8)
    assert np.array_equal(lab.visit(3).state(), single("verlet", 24)) and lab.visit(99).t == 8
    there = lab.reverse().advance(0).state()
    start = lab.restart().state()
    assert lab.t == 0 and 0 < np.abs(there - start).max() < 1e-12


def test_explored_parameters():
    lab = kepler(scheme="verlet").advance(2)
    assert lab.set("dt", 0.25).forward().t == 2.25
    lab.set("dt", 0.125).set("eccentricity", 0.25).advance(2)
    assert np.array_equal(lab.state(), single("verlet", 16, eccentricity=0.25))
    values = {row["key"]: row["value"] for row in lab.slide("eccentricity", 0.75).view["parameters"]}
    assert values["eccentricity"] == "0.75"
    assert {row["key"]: row["value"] for row in lab.set("eccentricity").view["parameters"]}["eccentricity"] != "0.75"
    assert np.array_equal(lab.set("eccentricity", 0.5).press(".").press(".").press(",").state(), single("verlet", 1))
    assert {"verlet", "rk4", "gauss4"} <= {scheme["scheme"] for scheme in lab.schemes}


def test_exercise(tmp_path):
    lab = geomint.explore("disc", scheme="rk4", dt=1).advance(62)
    passed, verdict = lab.grade("exercises", 1)
    assert not passed and verdict.startswith("Not passed: RK4 misses area_error < 1e-10")
    lab.switch("verlet").restart().advance(62)
    assert lab.grade("exercises", 1) == (True, "Passed with Verlet: area_error = 2.20872e-16, energy_error = 0.25, evaluations = 63.")
    answer = lab.answer("exercises", 1)
    assert "\nsteps: 62\n" in answer and len(answer) < 200
    if "GEOMINT_PROGRAM" in os.environ:  # the program has the same verdict
        (tmp_path / "x.answer").write_text(answer)
        done = subprocess.run([os.environ["GEOMINT_PROGRAM"], "grade", tmp_path / "x.answer"], capture_output=True, text=True)
        assert (done.returncode, done.stdout.split("\n", 1)[1].strip()) == (0, lab.grade("exercises", 1)[1])
    for tour, step, sentence in (("exercizes", 1, "exercises"), ("exercises", 9, "is a step"), ("area", 1, "is a step"),
                                 ("exercises", -1, "no step -1"), ("exercises", 1.5, "1.5 is not the number of a step"),
                                 (None, 1, "None is not a text")):
        with pytest.raises(geomint.UsageError, match=sentence):
            lab.grade(tour, step)
        with pytest.raises(geomint.UsageError, match=sentence):
            lab.answer(tour, step)


@pytest.mark.parametrize("verb, sentence", [
    (lambda lab: lab.switch("midpiont"), "did you mean midpoint"),
    (lambda lab: lab.fork("preissmann"), "does not fit"),
    (lambda lab: lab.add("rk44"), "no scheme"),
    (lambda lab: lab.remove(0), "The last lane stays"),
    (lambda lab: lab.remove(-1), "no lane -1"),
    (lambda lab: lab.set("eccentricty", 0.5), "did you mean eccentricity"),
    (lambda lab: lab.set("eccentricity", 2), "out of range"),
    (lambda lab: lab.slide("shape", 0.5), "has no range"),
    (lambda lab: lab.advance(float("nan")), "finite"),
    (lambda lab: lab.back(), "This is the start"),
    (lambda lab: lab.undo(), "nothing to undo"),
    (lambda lab: lab.press("space"), "explorer"),
    (lambda lab: lab.state(3), "no lane 3"),
    (lambda lab: geomint.explore("keplr"), "kepler"),
])
def test_explored_refusals(verb, sentence):
    lab = kepler(scheme="verlet")
    with pytest.raises(geomint.UsageError, match=sentence):
        verb(lab)
    assert lab.t == 0 and len(lab) == 1
    lab.close()
    with pytest.raises(geomint.ClosedError):
        lab.forward()


def test_widget():
    """The widget's parts call the verbs."""
    pytest.importorskip("ipywidgets")
    lab = kepler(scheme=["verlet", "rk4"])
    panel = lab.widget()

    def click(name):
        panel.buttons[name]._click_handlers(panel.buttons[name])

    first = panel.image.value
    assert first.startswith(b"\x89PNG")
    click("step-forward")
    assert lab.t == 0.125 and panel.image.value != first and panel.note.value == "t = 0.125"
    panel.play.value = 1
    assert lab.t > 0.125
    panel.other.value = "midpoint"
    click("code-fork")
    panel.lanes.children[1].value = "gauss4"
    assert [lane["scheme"] for lane in lab.view["lanes"]] == ["verlet", "gauss4", "midpoint"]
    panel.sliders["eccentricity"].value = 0.25
    assert panel.values["eccentricity"].value == "0.25" and lab.t == 0
    click("step-backward")
    assert panel.note.value == "This is the start."
    click("undo")
    assert panel.values["eccentricity"].value == "0.5"


def test_no_widgets(capsys, monkeypatch):
    """Without ipywidgets a sentence names it."""
    monkeypatch.setitem(sys.modules, "ipywidgets", None)
    with pytest.raises(ImportError, match="python3-ipywidgets"):
        kepler().widget()
    shown = type(sys)("IPython.display")
    shown.display = None
    monkeypatch.setitem(sys.modules, "IPython", type(sys)("IPython"))
    monkeypatch.setitem(sys.modules, "IPython.display", shown)
    kepler()._ipython_display_()
    assert capsys.readouterr().out.count("\n") == 1


def test_example_notebook():
    """The cells of the example run one after the other."""
    with open(os.path.join(SOURCE, "python", "example.ipynb"), encoding="utf-8") as file:
        cells = json.load(file)["cells"]
    scope: dict = {}
    for cell in cells:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), "example.ipynb", "exec"), scope)
    assert scope["orbits"][1].energy_error.max() < 1e-2


def test_example_in_jupyter(tmp_path):
    """The example as Jupyter runs it, with its pictures, where it is installed."""
    pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    done = tmp_path / "done.ipynb"
    subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output", done,
                    os.path.join(SOURCE, "python", "example.ipynb")], check=True, timeout=300)
    shown = [output["data"] for cell in json.loads(done.read_text())["cells"]
             for output in cell.get("outputs", []) if "data" in output]
    assert any("image/png" in data for data in shown)
    subprocess.run([sys.executable, "-m", "nbconvert", "--to", "html", "--output", tmp_path / "done.html", done],
                   check=True, timeout=300)
    page = (tmp_path / "done.html").read_text()
    assert "<svg" in page and "<?xml" not in page
