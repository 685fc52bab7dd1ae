# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of `geomint web` in headless Chromium against the native library: page.py BUILD PAGE.html [SCREENSHOTS], or
page.py BUILD PAGE.html frames [SECONDS [SCENE ...]], which plays that long and prints what frames cost and how much memory
is used.
What its controls do must give the numbers that the same verbs of geomint.h give, its PNG the pixels of `geomint render`, and
nothing may be requested of the network or complained about in the console."""
import asyncio
import base64
import contextlib
import ctypes
import json
import os
import pathlib
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.parse
import urllib.request

import websockets

build, template = (os.path.abspath(path) for path in sys.argv[1:3])
timed = sys.argv[3:4] == ["frames"]
shots = sys.argv[3] if len(sys.argv) > 3 and not timed else None
folder = tempfile.mkdtemp()
environment = dict(os.environ, GEOMINT_WEB=template, GEOMINT_PAINTER="own")
failures = []


def check(what, good, *details):
    print(" " if good else "failed:", what, *([] if good else details), flush=True)
    if not good:
        failures.append(what)


# ---- the native library ----

library = ctypes.CDLL(build + "/library/libgeomint.so.1")
for name in ["explore", "view", "message", "commands"]:
    getattr(library, "geomint_" + name).restype = ctypes.c_void_p if name == "explore" else ctypes.c_char_p


class Native:
    def __init__(self, *words):
        texts = (ctypes.c_char_p * len(words))(*map(str.encode, words))
        self.lab = ctypes.c_void_p(library.geomint_explore(len(words), texts))

    def order(self, name, *values):
        passed = [value.encode() if isinstance(value, str) else ctypes.c_double(value) if isinstance(value, float) else
                  ctypes.c_size_t(value) for value in values]
        getattr(library, "geomint_" + name)(self.lab, *passed)
        return self

    def view(self):
        return json.loads(library.geomint_view(self.lab))

    def message(self):
        return library.geomint_message(self.lab).decode()


# ---- Chromium ----

class Page:
    """A tab, by the protocol of the developers' tools."""

    async def open(self, port, url, width=1280, height=800, dark=False, ratio=1):
        request = urllib.request.Request(f"http://127.0.0.1:{port}/json/new?about:blank", method="PUT")
        target = json.load(urllib.request.urlopen(request))
        self.socket = await websockets.connect(target["webSocketDebuggerUrl"], max_size=None)
        self.number, self.errors, self.requests = 0, [], []
        for domain in ["Runtime", "Log", "Network", "Page"]:
            await self.send(domain + ".enable")
        await self.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio,
                        mobile=width < 600)
        await self.send("Emulation.setEmulatedMedia",
                        features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        await self.send("Browser.setDownloadBehavior", behavior="allow", downloadPath=folder)
        await self.send("Page.navigate", url=url)
        return await self.until("view !== null && document.body.dataset.frames > 0")

    async def send(self, method, **parameters):
        self.number += 1
        await self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(await asyncio.wait_for(self.socket.recv(), 60))
            kind, about = answer.get("method", ""), answer.get("params", {})
            if kind == "Runtime.exceptionThrown" or kind == "Log.entryAdded" and about["entry"]["level"] == "error":
                self.errors.append(json.dumps(about)[:300])
            elif kind == "Runtime.consoleAPICalled" and about["type"] in ["error", "warning", "assert"]:
                self.errors.append(json.dumps(about)[:300])
            elif kind == "Network.requestWillBeSent" and not about["request"]["url"].startswith(("file:", "blob:", "data:")):
                self.requests.append(about["request"]["url"])
            elif answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(answer["error"])
                return answer["result"]

    async def value(self, expression):
        answer = await self.send("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True,
                                 userGesture=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(expression + ": " + json.dumps(answer["exceptionDetails"])[:400])
        return answer["result"].get("value")

    async def until(self, condition, seconds=30):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                if await self.value(f"Boolean({condition})"):
                    return self
            except RuntimeError:
                pass # the page is not there yet
            await asyncio.sleep(0.05)
        raise RuntimeError(f"not within {seconds} s: {condition}: {self.errors} {await self.value('document.body.innerText')}")

    async def act(self, expression):
        """Does something, and waits until the page shows all of it."""
        await self.value(expression)
        await self.value("new Promise(done => setTimeout(done, 30)).then(() => ask('settled'))")

    async def click(self, identity):
        await self.act(f"document.getElementById('{identity}').click()")

    async def view(self):
        return await self.value("view")

    async def press(self, identity):
        """A press of the mouse in the middle of an element."""
        box = await self.value(f"(box => [box.x + box.width / 2, box.y + box.height / 2])(at('{identity}').getBoundingClientRect())")
        for kind in "mousePressed", "mouseReleased":
            await self.send("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", clickCount=1)

    async def shot(self, name):
        if shots:
            data = (await self.send("Page.captureScreenshot", format="png"))["data"]
            with open(os.path.join(shots, name + ".png"), "wb") as file:
                file.write(base64.b64decode(data))


def numbers(view):
    return [[lane[key] for key in ["scheme", "t", "steps", "status", "values"]] for lane in view["lanes"]]


def lesson(name, *words, fails=None):
    path = os.path.join(folder, name)
    answer = subprocess.run([build + "/app/geomint", "web", *words, "-o", path], env=environment, capture_output=True,
                            text=True)
    check(f"geomint web {shlex.join(words)[:60]}", (answer.returncode != 0) == bool(fails), answer.stderr)
    return "file://" + urllib.parse.quote(path)


def pixels(path):
    return subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                          capture_output=True, check=True).stdout


def pictures(path):
    """The sums of a movie's pictures; none of a movie that ended before the first."""
    lines = subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-f", "framemd5", "-"], capture_output=True, check=False, text=True)
    return [line.split(",")[-1] for line in lines.stdout.splitlines() if not line.startswith("#")]


async def arrives(path):
    for _ in range(100):
        if os.path.exists(path):
            break
        await asyncio.sleep(0.1)


async def controls(port):
    words = ["kepler", "scheme=verlet,rk4", "dt=0.05"]
    url = lesson("kepler.html", *words, "--title", "<b>Kepler</b> & </script><script>document.title='no'</script>")
    page, native = await Page().open(port, url), Native(*words)
    check("the title is text", (await page.value("document.title")).startswith("<b>Kepler</b> & </script>"))
    for _ in range(40):
        await page.value("order('forward')")
        native.order("forward")
    await page.click("forward")
    native.order("forward")
    check("steps", numbers(await page.view()) == numbers(native.view()), await page.view())
    await page.act("document.querySelector('[data-scheme=gauss4]').click()")
    check("a click switches", numbers(await page.view()) == numbers(native.order("switch", 0, "gauss4").view()))
    await page.act("document.querySelector('[data-scheme=midpoint]').dispatchEvent(new MouseEvent('click', {shiftKey: true}))")
    check("a click with shift forks", numbers(await page.view()) == numbers(native.order("fork", 0, "midpoint").view()))
    await page.click("forward")
    check("steps after that", numbers(await page.view()) == numbers(native.order("forward").view()))

    await page.click("copy")
    link, command = await page.value("at('link').textContent"), await page.value("at('command').textContent")
    check("the command line", command == json.loads(library.geomint_commands(native.lab))["picture"], command)
    await page.click("close")
    await page.click("save")
    saved, made = folder + "/kepler.png", folder + "/native.png"
    await arrives(saved)
    subprocess.run([build + "/app/geomint", *shlex.split(command)[1:], "--painter", "own", "-o", made], check=True,
                   capture_output=True)
    check("the PNG has the pixels of geomint render", pixels(saved) == pixels(made))
    other = await Page().open(port, link)
    check("the link opens the schemes", [lane["scheme"] for lane in (await other.view())["lanes"]] ==
          [lane["scheme"] for lane in native.view()["lanes"]], link)

    await page.act("[2, 0, 1, 2, 0].forEach(select)")
    check("a lane is chosen", (await page.view())["selected"] == 0)
    await page.act("select(2)")
    await page.click("reverse")
    await page.click("forward")
    check("time is turned", numbers(await page.view()) == numbers(native.order("reverse").order("forward").view()))
    await page.act("(slider => { slider.value = 0.5; slider.dispatchEvent(new Event('input')); })(at('parameter-dt').previousSibling)")
    native.order("slide", (await page.view())["selected"], "dt", 0.5)
    check("a slider", [(p["key"], p["value"]) for p in (await page.view())["parameters"]] ==
          [(p["key"], p["value"]) for p in native.view()["parameters"]])
    check("a slider's state", numbers(await page.view()) == numbers(native.view()))

    wrong, right = "H=p^2/2 - cos(q q=1 p=0", "H=p^2/2 - cos(q) q=1 p=0 scheme=verlet"
    await page.act(f"at('words').value = {json.dumps(wrong)}; at('formula').requestSubmit()")
    refusal = Native("system", "H=p^2/2 - cos(q q=1 p=0").message()
    check("a wrong formula", await page.value("at('fault').textContent") == refusal, refusal)
    check("the view stays", (await page.view())["scene"] == "kepler")
    twice = "H=1+p^2/2+q^2 q=0 p=1+"
    await page.act(f"at('words').value = '{twice}'; at('formula').requestSubmit()")
    check("the place of a mistake", await page.value("at('words').selectionStart") == len(twice), await page.value("at('fault').textContent"))
    for words, changes in [["nothing"], []], [["kepler"], [[0, 0, 0, "dt=x"]]]:
        refused = (await page.value(f"ask('still', {json.dumps({'words': words, 'changes': changes})})")).get("refused")
        check(f"a refused PNG: {refused}", refused)
    await page.shot("fault")
    await page.act(f"at('words').value = {json.dumps(right)}; at('formula').requestSubmit()")
    native = Native("system", "H=p^2/2 - cos(q)", "q=1", "p=0", "scheme=verlet")
    await page.click("forward")
    check("a right formula", numbers(await page.view()) == numbers(native.order("forward").view()))

    await page.value("play(true)")
    movie, moving = folder + "/system.webm", set()
    # a busy machine leaves out pictures, so a movie of one picture is made again, and longer
    for length in 30, 120, 480:
        await page.value("at('record').click()")
        frames = await page.value("Number(document.body.dataset.frames)")
        await page.until(f"view.t > 1 && document.body.dataset.frames > {frames + length}", 120)
        await page.value("at('record').click()")
        await arrives(movie)
        moving = set(pictures(movie))
        if len(moving) > 2:
            break
        pathlib.Path(movie).unlink(missing_ok=True)
    check("a movie moves", len(moving) > 2, moving)
    await page.value("play(false)")
    await page.value("at('line').value = 0.5; at('line').dispatchEvent(new Event('input'))")
    await page.until("view.t <= 0.5")
    check("playing, and the time line", True)

    await page.value("void ask('order', ['nothing'])")
    await page.until("!at('crash').hidden")
    await page.click("revive")
    await page.until("at('crash').hidden && view.t === 0")
    check("a crash has a sentence and a way on", "stopped" in await page.value("at('crash-text').textContent"))
    slide = "(slider => { slider.value = %s; slider.dispatchEvent(new Event('input')); })(at('parameter-dt').previousSibling); "
    await page.act("order('forward')")
    await page.value(slide % 0.7 + "crash('a test')")
    await page.click("revive")
    await page.until("at('crash').hidden && view !== null")
    await page.act(slide % 0.3)
    check("a slider acts after a crash", await page.value("view.parameters.some(({position}) => Math.abs(position - 0.3) < 0.02)"))
    await page.value("void begin()")
    for identity in "restart", "forward", "play":
        await page.press(identity)
    check("they are pressed before", await page.value("document.querySelector('main').inert"))
    await page.until("view !== null && document.body.dataset.frames > 0 && !document.querySelector('main').inert")
    check("controls wait for the program", await page.value("at('crash').hidden && !playing && view.t === 0"),
          await page.value("at('crash-text').textContent"))
    for tab in page, other:
        check("no errors in the console", not tab.errors, tab.errors)
        check("no requests", not tab.requests, tab.requests)


async def choices(port):
    """What is chosen by keys, the mouse and a finger."""
    page = await Page().open(port, lesson("choices.html", "kepler"))
    find = "at('find').value = '%s'; at('find').oninput(); at('find').onkeydown({key: 'Enter'})"
    for word, scheme in ("suzuki4", "suzuki4"), ("", "suzuki4"), ("RK4", "rk4"):
        await page.act(find % word)
        check(f"find '{word}'", await page.value("view.lanes[0].scheme") == scheme, await page.value("view.lanes[0].scheme"))
    await page.act(find % "nonsense")
    check("a scheme that is not there", "nonsense" in await page.value("at('notice').textContent"))
    await page.act("at('find').value = ''; at('find').oninput()")
    focused = "document.activeElement.dataset.scheme || document.activeElement.textContent"
    await page.act("(button => { button.focus(); button.click(); })(document.querySelector('[data-scheme=verlet]'))")
    check("the focus stays on a scheme", await page.value(focused) == "verlet", await page.value(focused))
    await page.act("order('fork', 0, 'rk4').then(() => { const [, lane] = document.querySelectorAll('.lane'); lane.focus(); lane.click(); })")
    check("the focus stays on a lane", await page.value("view.selected === 1 && document.activeElement.matches('.lane[aria-pressed=true]')"),
          await page.value("document.activeElement.outerHTML"))
    await page.act("order('remove', 0)")
    count = await page.value("view.lanes.length")
    await page.act("seek(true); document.dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape'}))")
    await page.act("document.querySelector('[data-scheme=gauss4]').click()")
    check("Escape ends a fork", await page.value("view.lanes.length") == count)
    await page.act("at('scene').append(make('option', {value: 'room'}, 'room')); at('scene').value = 'room'; at('scene').onchange()")
    check("a refused scene is not shown as chosen", await page.value("at('scene').value === 'kepler' && at('notice').firstChild.matches('.bad')"))

    await page.value("words = ['nothing']; void begin()")
    await page.until("view !== null && !document.querySelector('main').inert")
    check("a first view that is refused", await page.value("view.scene === 'kepler' && at('notice').textContent.includes('nothing')"))

    page = await Page().open(port, lesson("phone.html", "disc", "scheme=verlet", "window=-3,3,-3,3"), 500, 900)
    await page.send("Emulation.setTouchEmulationEnabled", enabled=True)
    # a place of a plane, where a press starts an orbit
    box = await page.value("""(async box => {
        for (let place = 11; place < 100; place++) {
            const [x, y] = [place % 10 / 10, Math.floor(place / 10) / 10];
            await order('forward');
            await order('point', canvas.width * x, canvas.height * y);
            await ask('settled');
            if (view.t === 0) {
                return {x: box.x + box.width * x, y: box.y + box.height * y};
            }
        }
    })(canvas.getBoundingClientRect())""")

    async def gesture(*places):
        """Drags a finger over places beside the box, from the time of one step; returns the time after that."""
        await page.act("order('forward')")
        for kind, places in [("touchStart", places[:1]), *[("touchMove", [place]) for place in places[1:]], ("touchEnd", [])]:
            touched = [{"x": box["x"] + x, "y": box["y"] + y} for x, y in places]
            await page.send("Input.dispatchTouchEvent", type=kind, touchPoints=touched)
        await page.act("0")
        return await page.value("view.t")

    async def mouse(kind, button, step=0):
        await page.send("Input.dispatchMouseEvent", type="mouse" + kind, x=box["x"] + step, y=box["y"], button=button,
                        buttons=1, clickCount=1)
        await page.act("0")

    check("a finger that scrolls starts no orbit", await gesture((0, 0), (0, -10), (0, -30), (0, -60)) > 0)
    check("a touch starts an orbit", await gesture((0, 0)) == 0)
    check("a finger that moves sidewards starts an orbit", await gesture((0, 0), (10, 0), (30, 0)) == 0)
    await page.send("Emulation.setTouchEmulationEnabled", enabled=False)
    await page.act("order('forward')")
    await mouse("Pressed", "right")
    await mouse("Released", "right")
    check("a right button starts no orbit", await page.value("view.t") > 0)
    await mouse("Pressed", "left")
    await mouse("Released", "left")
    check("a press starts an orbit", await page.value("view.t") == 0)
    starts = set()
    for kind, step in [("Pressed", 0), ("Moved", 10), ("Moved", 20), ("Released", 20)]:
        await mouse(kind, "left", step)
        starts.add(json.dumps(await page.value("view.lanes[0].values")))
    check("a drag moves the start", len(starts) == 3, starts)

    for scene, scheme, equations in [("burgers", "crank-nicolson", "Burgers"), ("nls", "euler-box", "Schrödinger"), ("nls", "nonsense", "")]:
        await page.act(f"open(['{scene}']).then(() => explain('{scheme}'))")
        text = await page.value("at('sheet-text').innerText")
        about = await page.value(f"ask('certify', {{name: '{scheme}', problem: schemes.find(one => one.scheme === '{scheme}')?.for, on: words}})")
        check(f"the certificate of {scheme} for {scene}", equations in about["certificate"]["for"] and "sine-Gordon" not in text
              and f"geomint certify {scheme}" in text if equations else about["refused"] in text, about, text)
        await page.click("close")


async def other_views(port):
    page = await Page().open(port, lesson("any.html", "disc") + "#nowhere&dt=.1")
    check("unknown words in a link", "nowhere" in await page.value("at('notice').textContent"))
    check("the default view", (await page.view())["scene"] == "disc")
    text = 'name: <img src=x onerror="document.title=1">\nabout: </script><b>\ncoordinates: q\nmomenta: p\nH: p^2/2 + q^2/2\nstart: q = 1, p = 0\n'
    with open(folder + "/mine.system", "w", encoding="utf-8") as file:
        file.write(text)
    page = await Page().open(port, lesson("mine.html", folder + "/mine.system"))
    check("a file goes along, its name is text", (await page.view())["title"].startswith("<img"), await page.view())
    page = await Page().open(port, lesson("tour.html", "--tour", "area"))
    await page.click("next")
    check("a lesson", await page.value("at('tour-title').textContent") == "The simplest scheme")
    await page.click("next")
    await page.until("view.t > 1")
    check("its answer runs", "Larger" in await page.value("at('tour-text').textContent"))
    page = await Page().open(port, lesson("exercises.html", "--tour", "exercises"))
    check("an exercise is graded on request", await page.value("!at('grade').hidden && at('next').textContent === 'next'"))
    await page.value("ask('ahead', 62.9)")
    await page.click("grade")
    native = Native("disc", "scheme=rk4", "dt=pi/6").order("advance", 62.9)
    native.order("grade", "exercises", 1)
    await page.act("document.dispatchEvent(new KeyboardEvent('keydown', {key: 'H'}))")
    check("a hint", await page.value("at('notice').textContent === lesson.steps[0].hint"))
    check("an exercise that is not passed", await page.value("at('verdict').textContent") == native.message())
    await page.act("order('set', 0, 'dt', '1').then(() => order('switch', 0, 'verlet')).then(() => order('restart'))")
    await page.value("ask('ahead', 62.9)")
    await page.click("grade")
    await page.shot("passed")
    await page.value("document.dispatchEvent(new KeyboardEvent('keydown', {key: 'S'}))")
    await arrives(folder + "/exercises-1.answer")
    check("an answer is saved", os.path.exists(folder + "/exercises-1.answer"))
    await page.value("ask('order', ['forward'])")
    os.remove(folder + "/exercises-1.answer")
    await page.click("hand-in")
    await arrives(folder + "/exercises-1.answer")
    with open(folder + "/exercises-1.answer", encoding="utf-8") as file:
        saved = file.read()
    check("an answer is what there is when it is saved", "steps: 63\n" in saved and "is at t = 63" in
          await page.value("at('verdict').textContent"), saved)
    await page.act("order('back')")
    await page.click("grade")
    check("an exercise that is passed", (await page.value("at('verdict').textContent")).startswith("Passed"),
          await page.value("at('tour-text').textContent"))
    # the other exercises, with the verdict of the native program: a near miss, and a right answer
    kutta = "explicit(0, 0, 0 | 1/2, 0, 0 | -1, 2, 0; %s)"
    for step, miss, right in [(2, ["set", 0, "dt", "0.039"], ["set", 0, "dt", "0.0395"]),
                              (3, ["set", 0, "dt", "0.1"], ["switch", 0, "logh-kahan-li8"]),
                              (4, ["switch", 0, kutta % "1/4, 1/2, 1/4"], ["switch", 0, kutta % "1/6, 2/3, 1/6"])]:
        await page.value(f"goTo({step - 1})")
        shown = await page.value(f"lesson.steps[{step - 1}]")
        native = Native(*shown["show"])
        for passes, order in [(False, miss), (True, right)]:
            await page.act(f"ask('play', false).then(() => order(...{json.dumps(order)})).then(() => order('restart'))")
            await page.value(f"ask('ahead', {shown['until']})")
            await page.click("grade")
            native.order(*order).order("restart").order("advance", float(shown["until"])).order("grade", "exercises", step)
            verdict = await page.value("at('verdict').textContent")
            check(f"exercise {step}: {verdict}", verdict == native.message() and verdict.startswith("Passed") == passes,
                  native.message())
    await page.act("open(['disc'])")
    await page.click("grade")
    verdict = await page.value("at('verdict').textContent")
    check("other equations are no answer", "the exercise is about kepler" in verdict, verdict)
    with open(folder + "/between.tour", "w", encoding="utf-8") as file:
        file.write("title: x\nstep: a\nsay: b\nshow: kepler scheme=rk4,rk2 dt=0.3\nuntil: 4\nseconds: 1\nat: 1 lane=2 scheme=verlet\n"
                   "step: c\nsay: d\nuntil: 7\nseconds: 1\n")
    page = await Page().open(port, lesson("between.html", "--tour", folder + "/between.tour"))
    await page.until("!playing && view.t > 3")
    await page.value("goTo(1)")
    await page.until("!playing && view.t > 6")
    native = Native("kepler", "scheme=rk4,rk2", "dt=0.3").order("advance", 1.0).order("switch", 1, "verlet")
    native.order("advance", 7.0)
    check("a change and stops between two steps", numbers(await page.view()) == numbers(native.view()), await page.view())
    check("the change leaves the chosen lane", await page.value("view.selected") == 0)
    await page.value("goTo(0)")
    await page.until("!playing && view.t > 3")
    await page.act("order('reverse').then(() => ask('ahead', -3)).then(() => order('restart'))")
    await page.act("order('switch', 1, 'rk2').then(() => play(true))")
    await page.until("!playing && view.t > 3")
    check("a lesson that was before its start has its stop and changes", await page.value("view.t <= 4 && view.lanes[1].scheme === 'verlet'"))
    # files of a tour keep their folders, so that the tour finds them when it grades
    tour = "title: x\n"
    environment["GEOMINT_SYSTEMS"] = folder + "/named"
    for number, path in enumerate(["lessons/sub/own.system", "systems/own.system", "named/by-name.system"]):
        os.makedirs(os.path.dirname(f"{folder}/{path}"))
        with open(f"{folder}/{path}", "w", encoding="utf-8") as file:
            file.write(f"coordinates: q\nH: p_q^2/2 + {number + 1}*q^2/2\nstart: q = 1, p_q = 0\n")
        shown = "by-name" if number == 2 else os.path.relpath(path, "lessons")
        tour += (f"step: a\nsay: b\nask: c\nanswer: d\nshow: {shown} scheme=verlet dt=0.125\n"
                 "until: 1\nexpect: steps > 7\n")
    with open(folder + "/lessons/exercises.tour", "w", encoding="utf-8") as file:
        file.write(tour)
    page = await Page().open(port, lesson("folders.html", "--tour", folder + "/lessons/exercises.tour"))
    for step in range(3):
        await page.value(f"goTo({step})")
        await page.value("ask('ahead', 1)")
        await page.click("grade")
        verdict = await page.value("at('verdict').textContent")
        check(f"files of folders: {verdict}", verdict == "Passed with Verlet: steps = 8.")
    await page.act("explain('rk4')")
    check("a certificate", await page.value("at('certificate').innerText.includes('symplectic') && "
                                            "at('sheet-text').innerText.includes('order 4')"))
    with open(folder + "/mine.scheme", "w", encoding="utf-8") as file:
        file.write("geomint: 1\ntitle: mine\nkind: explicit\norder: 2\na: 0, 0 | 1/2, 0\nb: 0, 1\n")
    os.makedirs(folder + "/plates/meshes")
    with open(folder + "/plates/meshes/two.msh", "w", encoding="utf-8") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 .5 .8 0\n4 1.5 .8 0\n$EndNodes\n"
                   "$Elements\n2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 2 4 3\n$EndElements\n")
    with open(folder + "/plates/plate.system", "w", encoding="utf-8") as file:
        file.write("mesh: meshes/two.msh\nfield: u = 0-form\nrate: u = laplace(u)\nstart: u = 1 + x\nschemes: rk4\ndt: 0.05\n")
    page = await Page().open(port, lesson("plate.html", folder + "/plates/plate.system"))
    await page.click("forward")
    check("the mesh of a file", numbers(await page.view()) == numbers(Native(folder + "/plates/plate.system").order("forward").view()),
          await page.view())
    page = await Page().open(port, lesson("schemes.html", "kepler", "scheme=composition(verlet; 1/2, 1/2),kutta38," + folder +
                                          "/mine.scheme", "dt=0.05"))
    native = Native("kepler", "scheme=composition(verlet; 1/2, 1/2),kutta38," + folder + "/mine.scheme", "dt=0.05")
    await page.click("forward")
    check("user-defined schemes", [lane["values"] for lane in (await page.view())["lanes"]] ==
          [lane["values"] for lane in native.order("forward").view()["lanes"]], await page.view())
    page = await Page().open(port, lesson("any.html", "disc") + "#room")
    check("a room in a link", "SuiteSparse" in await page.value("at('notice').textContent"))
    lesson("none.html", "form-poisson", fails=True)
    lesson("none/none.html", "disc", fails=True)
    lesson("none.html", "system", "H=p^2/2 + (", fails=True)
    check("refused before it is written", not os.path.exists(folder + "/none.html"))


async def looks(port):
    views = {"disc": ["disc"], "kepler": ["kepler"], "formula": ["system", "H=p^2/2 - cos(q)", "q=1", "p=0"],
             "tour": ["--tour", "area"], "vortices": ["vortices"]}
    for name, words in views.items():
        url = lesson(name + "-look.html", *words)
        for width, height, ratio in [(1280, 800, 1), (390, 844, 2)]:
            for dark in False, True:
                page = await Page().open(port, url, width, height, dark, ratio)
                await page.value("next()" if name == "tour" else "0")
                await page.value("play(true)")
                first = await page.value("at('clock').textContent")
                await page.until(f"playing && at('clock').textContent !== {json.dumps(first)}")
                await asyncio.sleep(1.5)
                await page.act("play(false)")
                check(f"the side of {name} tells of its picture",
                      await page.value("at('clock').textContent === `t = ${digits(view.t)}` && due === null"))
                wide = await page.value("document.documentElement.scrollWidth")
                check(f"{name} fits {width} pixels", wide <= width, wide)
                cost = await page.value("document.body.dataset.cost")
                print("   ", name, width, "draws in", cost, "ms")
                await page.shot(f"{name}-{width}-{'dark' if dark else 'light'}")
                if width < 600 and shots:
                    await page.value("scrollTo(0, 900)")
                    await page.shot(f"{name}-{width}-{'dark' if dark else 'light'}-below")


async def picture(port):
    """The picture page.png of docs/web.md, with fewer colours."""
    page = await Page().open(port, lesson("picture.html", "kepler", "scheme=verlet,rk4"), 960, 600)
    await page.value("ask('ahead', 20)")
    await page.act("order('fork', 0, 'gauss4')")
    await page.shot("page")
    few = "split[a][b];[a]palettegen=max_colors=32:reserve_transparent=0[c];[b][c]paletteuse=dither=none"
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", shots + "/page.png", "-vf", few, folder + "/page.png"],
                   check=True)
    os.replace(folder + "/page.png", shots + "/page.png")


def used(process):
    """Megabytes of a process and of all that it has started, and their seconds of processor time, each by its number."""
    rows = []
    for path in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError): # it has ended
            rows.append([path.parent.name, *path.read_text().rpartition(")")[2].split()])
    family = {str(process)}
    while not family >= (more := {row[0] for row in rows if row[2] in family}):
        family |= more
    own = [row for row in rows if row[0] in family]
    seconds = {row[0]: (int(row[12]) + int(row[13])) / os.sysconf("SC_CLK_TCK") for row in own}
    return sum(int(row[22]) for row in own) * os.sysconf("SC_PAGE_SIZE") / 2**20, seconds


async def frames(port, process, seconds, scenes):
    await asyncio.sleep(5)  # the browser's own start is not the page's
    for scene in scenes:
        url, before = lesson(scene + ".html", scene), used(process)[1]
        page = await Page().open(port, url, width=1648, height=866)
        spent = sum(seconds - before.get(number, 0) for number, seconds in used(process)[1].items())
        await page.value("play(true)")
        await asyncio.sleep(3)
        begun, before, costs = time.monotonic(), used(process)[0], []
        first = int(await page.value("document.body.dataset.frames"))
        while time.monotonic() < begun + seconds:
            await asyncio.sleep(0.1)
            costs.append(float(await page.value("document.body.dataset.cost")))
        count = int(await page.value("document.body.dataset.frames")) - first
        width, height = await page.value("[canvas.width, canvas.height]")
        print(f"{scene}, {width} x {height}: {statistics.median(costs):.1f} ms a frame, {count / seconds:.0f} frames a second; "
              f"{spent:.2f} s of processor time to the first picture; {before:.0f} MB, {used(process)[0]:.0f} MB after "
              f"{seconds} s, t = {await page.value('view.t')}", flush=True)
        await page.send("Page.close")


async def main():
    profile = tempfile.mkdtemp()
    chromium = subprocess.Popen(["chromium", "--headless=new", "--no-sandbox", "--remote-debugging-port=0", "--disable-gpu",
                                 f"--user-data-dir={profile}", "about:blank"], stderr=subprocess.DEVNULL)
    try:
        while not os.path.exists(profile + "/DevToolsActivePort"):
            await asyncio.sleep(0.1)
        port = open(profile + "/DevToolsActivePort", encoding="ascii").readline().strip()
        if timed:
            seconds = int(sys.argv[4]) if len(sys.argv) > 4 else 10
            await frames(port, chromium.pid, seconds, sys.argv[5:] or ["disc", "kepler", "vortices"])
            return
        await controls(port)
        await choices(port)
        await other_views(port)
        if shots:
            await looks(port)
            await picture(port)
    finally:
        chromium.terminate()
        chromium.wait()

asyncio.run(main())
print(len(failures), "failed")
sys.exit(len(failures) > 0)
