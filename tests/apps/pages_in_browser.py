"""Pages of beamid in a real browser: headless Chromium, driven through its DevTools pipe.

Oracles: results.json and the CSV files beside the page; what a browser reports of requests and errors.

Usage: pages_in_browser.py BEAMID TUTORIALS [SCREENSHOTS]
"""

import base64
import csv
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
import zlib

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Browser:
    """A browser behind two pipes: messages are JSON, each ended by a zero byte."""

    def __init__(self, profile):
        to_browser, self._out = os.pipe()
        self._in, from_browser = os.pipe()
        command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", "--no-first-run",
                   "--disable-background-networking", f"--user-data-dir={profile}", "about:blank"]
        script = f'exec "$@" 3<&{to_browser} 4>&{from_browser}'
        self._process = subprocess.Popen(["bash", "-c", script, "bash", *command], pass_fds=(to_browser, from_browser),
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self._buffer, self._number, self.events = b"", 0, []
        target = self.call("Target.createTarget", session=None, url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", session=None, targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")

    def _message(self):
        while b"\0" not in self._buffer:
            read = os.read(self._in, 1 << 16)
            if not read:
                raise RuntimeError("the browser has ended")
            self._buffer += read
        message, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, session="own", **parameters):
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if session == "own":
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._message()
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def open(self, page, javascript=True, width=1300, height=900, dark=False):
        self.call("Emulation.setScriptExecutionDisabled", value=not javascript)
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.call("Emulation.setEmulatedMedia", media="",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.events.clear()
        self.call("Page.navigate", url=page.resolve().as_uri())
        while not any(event["method"] == "Page.loadEventFired" for event in self.events):
            self.events.append(self._message())
        if javascript:
            self.settle()

    def value(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def settle(self):
        self.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def problems(self):
        """Errors of the page and requests for anything but the page and what it holds."""
        found = []
        for event in self.events:
            method, parameters = event["method"], event["params"]
            if method == "Runtime.exceptionThrown":
                found.append(json.dumps(parameters["exceptionDetails"])[:300])
            elif method == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
                found.append(parameters["entry"]["text"])
            elif method == "Runtime.consoleAPICalled":
                found.append("console: " + json.dumps(parameters["args"])[:300])
            elif method == "Network.requestWillBeSent":
                address = parameters["request"]["url"]
                if not address.startswith("data:") and not address.endswith("/report.html"):
                    found.append("request: " + address[:200])
        return found

    def screenshot(self, file):
        picture = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        if file:
            file.write_bytes(picture)
        return picture

    def close(self):
        self.call("Browser.close", session=None)
        self._process.wait(30)


def colours(png):
    """How many pixels of a PNG have each colour (8 bits a channel, not interlaced)."""
    at, data = 8, b""
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at:at + 8])
        if kind == b"IHDR":
            width, height, _, colour = struct.unpack(">IIBB", png[at + 8:at + 18])
        elif kind == b"IDAT":
            data += png[at + 8:at + 8 + length]
        at += 12 + length
    size = {2: 3, 6: 4}[colour]
    raw, found, before = zlib.decompress(data), {}, bytearray(width * size)
    for row in range(height):
        start = row * (width * size + 1)
        kind, line = raw[start], bytearray(raw[start + 1:start + 1 + width * size])
        for i in range(len(line)):
            left, up = line[i - size] if i >= size else 0, before[i]
            corner = before[i - size] if i >= size else 0
            if kind == 1:
                line[i] = (line[i] + left) & 255
            elif kind == 2:
                line[i] = (line[i] + up) & 255
            elif kind == 3:
                line[i] = (line[i] + (left + up) // 2) & 255
            elif kind == 4:
                guess = left + up - corner
                distances = (abs(guess - left), abs(guess - up), abs(guess - corner))
                line[i] = (line[i] + (left, up, corner)[distances.index(min(distances))]) & 255
        before = line
        for i in range(0, len(line), size):
            key = bytes(line[i:i + 3])
            found[key] = found.get(key, 0) + 1
    return found


failures = []


def check(true, what):
    print(("ok      " if true else "FAILED  ") + what)
    if not true:
        failures.append(what)


FIRST = "document.querySelector('figure.plot.alive canvas')"


def place(browser, canvas=FIRST):
    return browser.value(f"(() => {{ const c = {canvas}; c.scrollIntoView({{block: 'center'}}); const r = c.getBoundingClientRect();"
                         " return [r.left, r.top, r.width, r.height]; })()")


def check_page(browser, folder, name, screenshots):
    page = folder / "report.html"
    browser.open(page)
    check(browser.problems() == [], f"{name}: no error and no request {browser.problems()[:3]}")
    figures = browser.value("document.querySelectorAll('figure[data-figure]').length")
    alive = browser.value("document.querySelectorAll('figure.plot.alive').length")
    check(figures == alive and figures > 0, f"{name}: all {figures} figures answer")
    browser.value("document.querySelectorAll('details').forEach(part => { part.open = true; })")
    browser.settle()
    browser.settle()
    empty = browser.value(
        "[...document.querySelectorAll('canvas')].filter(c => c.clientWidth && (() => {"
        " const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data, seen = new Set();"
        " for (let i = 0; i < d.length; i += 4) seen.add(d[i] << 16 | d[i + 1] << 8 | d[i + 2]);"
        " return seen.size < 4; })()).length")
    check(empty == 0, f"{name}: no canvas is empty")
    check(browser.value("[...document.images].every(i => i.alt)"), f"{name}: every static picture has a text")
    wide = browser.value("document.documentElement.scrollWidth <= innerWidth")
    check(wide, f"{name}: the page fits 1300 px")
    browser.screenshot(screenshots and screenshots / f"{name}.png")
    browser.open(page, width=400, dark=True)
    check(browser.value("document.documentElement.scrollWidth <= 401"), f"{name}: the page fits 400 px")
    browser.screenshot(screenshots and screenshots / f"{name}_narrow_dark.png")
    browser.open(page, javascript=False)
    browser.call("Emulation.setScriptExecutionDisabled", value=False)
    shown = browser.value("[...document.images].filter(i => i.naturalWidth > 0 && i.offsetWidth > 0).length")
    check(shown >= min(figures, 2), f"{name}: static figures without JavaScript ({shown})")
    check(browser.value("document.querySelectorAll('canvas').length") == 0, f"{name}: nothing half alive without JavaScript")


def check_values(browser, folder):
    """The value under the pointer is the one in the CSV file beside the page; zoom changes the axis."""
    browser.open(folder / "report.html")
    left, top, width, height = place(browser)
    browser.mouse("mouseMoved", left + 0.6 * width, top + 0.5 * height)
    browser.settle()
    text = browser.value(f"{FIRST}.parentElement.querySelector('.reading').innerText")
    number = r"(-?[0-9.]+(?:e-?[0-9]+)?)"
    time = re.search(rf"time {number} s", text)
    measured = re.search(rf"measured {number} m/s²", text)
    check(bool(time and measured), f"the reading has time and record with units: {text!r}")
    if time and measured:
        rows = list(csv.reader(open(folder / "reproduction.csv", encoding="utf-8")))
        column = next(i for i, head in enumerate(rows[0]) if "| measured |" in head)  # time, then the record
        pairs = [(float(row[column]), float(row[column + 1])) for row in rows[1:] if row[column]]
        nearest = min(pairs, key=lambda pair: abs(pair[0] - float(time[1])))
        close = abs(nearest[0] - float(time[1])) < 1e-5 and abs(nearest[1] - float(measured[1])) < 1e-5
        check(close, f"the reading {time[1]}, {measured[1]} is that of reproduction.csv {nearest}")
    axis = f"{FIRST}.dataset.x.split(' ').map(Number)"
    before = browser.value(axis)
    browser.mouse("mousePressed", left + 0.4 * width, top + 0.5 * height, button="left", clickCount=1)
    browser.mouse("mouseMoved", left + 0.6 * width, top + 0.5 * height, button="left", buttons=1)
    browser.mouse("mouseReleased", left + 0.6 * width, top + 0.5 * height, button="left", clickCount=1)
    browser.settle()
    after = browser.value(axis)
    check(before[0] < after[0] < after[1] < before[1], f"a dragged box zooms in: {before} to {after}")
    linked = browser.value("[...document.querySelectorAll('figure.plot.alive')][0].querySelectorAll('canvas').length")
    check(linked > 1, "the first figure has several panels")
    browser.value("[...document.querySelectorAll('figure.plot.alive .bar button')].find(b => b.textContent === 'Reset').click()")
    browser.settle()
    check(browser.value(axis) == before, "Reset puts the axis back")
    ink = ("(() => { const c = %s, d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0;"
           " for (let i = 0; i < d.length; i += 4) n += d[i] + d[i + 1] + d[i + 2] < 600; return n; })()" % FIRST)
    browser.mouse("mouseMoved", 1, 1)
    browser.settle()
    full = browser.value(ink)
    browser.value("document.querySelectorAll('figure.plot.alive .legend button').forEach(b => b.click())")
    browser.settle()
    check(browser.value(ink) < 0.8 * full, "curves go off by the legend")
    browser.value("document.querySelectorAll('figure.plot.alive .legend button').forEach(b => b.click())")
    browser.settle()
    check(browser.value(ink) == full, "and on again")


def check_copies(browser, folder):
    """What PNG, SVG and CSV save. Oracle: reproduction.csv; an XML parser; the signature of a PNG."""
    browser.open(folder / "report.html")
    saved = {}
    for kind in ("CSV", "SVG", "PNG"):
        saved[kind] = bytes(browser.value(
            "new Promise(done => { beamid.save = async (name, blob) => done([...new Uint8Array(await blob.arrayBuffer())]);"
            f" [...document.querySelectorAll('figure.plot.alive .bar button')].find(b => b.textContent === '{kind}').click(); }})"))
    rows = list(csv.reader(saved["CSV"].decode().splitlines()))
    wanted = list(csv.reader(open(folder / "reproduction.csv", encoding="utf-8")))
    column, same = (next(i for i, head in enumerate(table[0]) if "| measured |" in head) for table in (rows, wanted))
    found = {round(float(row[column]), 6): float(row[column + 1]) for row in rows[1:] if row[column]}
    pairs = [(round(float(row[same]), 6), float(row[same + 1])) for row in wanted[1:] if row[same]]
    known = [(time, reading) for time, reading in pairs if time in found]
    close = all(abs(found[time] - reading) < 1e-6 for time, reading in known)
    check(close and len(known) > 100, f"CSV saves the values of reproduction.csv, {len(known)} compared")
    root = xml.etree.ElementTree.fromstring(saved["SVG"].decode())
    check(root.tag.endswith("svg") and len(list(root.iter())) > 50, "SVG saves a picture")
    check(saved["PNG"][:8] == b"\x89PNG\r\n\x1a\n" and len(saved["PNG"]) > 10000, "PNG saves a picture")


def check_estimate(browser, folder):
    """A frequency on the page is that of results.json."""
    estimate = json.loads((folder / "results.json").read_text())["frequency_hz"]["estimate"]
    shown = browser.value("[...document.querySelectorAll('td')].find(c => c.textContent.startsWith('frequency')).nextElementSibling.innerText")
    check(abs(float(shown.strip("\u2007\u2008 ")) - estimate) < 1e-3, f"the table shows the frequency of results.json, {estimate}")


def check_swing(browser, folder):
    browser.open(folder / "report.html")
    canvas = "document.querySelector('canvas.swing')"
    place(browser, canvas)
    picture = f"{canvas}.toDataURL()"
    browser.value("new Promise(done => setTimeout(() => done(1), 200))")
    first = browser.value(picture)
    browser.value("new Promise(done => setTimeout(() => done(1), 400))")
    check(browser.value(picture) != first, "a mode shape swings")
    browser.value("[...document.querySelectorAll('.motion button')].find(b => b.textContent === 'Pause').click()")
    browser.settle()
    still = browser.value(picture)
    browser.settle()
    check(browser.value(picture) == still, "and stops")
    left, top, width, height = place(browser, canvas)
    browser.mouse("mousePressed", left + 0.5 * width, top + 0.5 * height, button="left", clickCount=1)
    browser.mouse("mouseMoved", left + 0.6 * width, top + 0.4 * height, button="left", buttons=1)
    browser.mouse("mouseReleased", left + 0.6 * width, top + 0.4 * height, button="left", clickCount=1)
    browser.settle()
    check(browser.value(picture) != still, "the pointer turns it")
    browser.value("(() => { const s = document.querySelector('.motion select'); s.value = 1; s.dispatchEvent(new Event('change')); })()")
    modes = json.loads((folder / "results.json").read_text())["modes"]
    name = browser.value("document.querySelector('.motion .reading').textContent")
    shown = float(re.search(r"([0-9.]+) Hz", name)[1])
    wanted = modes[1]["frequency_hz"]
    check(abs(shown - wanted) < 1e-3 * wanted, f"the second mode's frequency is that of results.json: {name}")


def check_hostile(browser, beamid, work):
    """Names with markup, quotes and right-to-left text stay text."""
    title = "<img src=x onerror=document.title='taken'></script>\"'&amp; \u202eabc " + "long" * 60
    text = (work / "tutorials/02_identify_a_record/cantilever.toml").read_text(encoding="utf-8")
    text = re.sub(r"(?m)^title = .*$", "", text)
    (work / "hostile.toml").write_text(f'title = {json.dumps(title, ensure_ascii=False)}\n{text}', encoding="utf-8")
    subprocess.run([beamid, "modes", "--config", "hostile.toml", "--modes", "3", "--out", "hostile", "--no-progress"], cwd=work, check=True,
                   stdout=subprocess.DEVNULL)
    browser.open(work / "hostile" / "report.html", width=400)
    check(browser.problems() == [], f"a hostile title makes no error {browser.problems()[:2]}")
    check("<img src=x" in browser.value("document.querySelector('h1').textContent"), "and is shown as it is written")
    check(browser.value("document.title") != "taken", "and is not run")
    check(browser.value("document.documentElement.scrollWidth <= 401"), "and fits 400 px")


def main():
    beamid, tutorials = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    screenshots = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
    if screenshots:
        screenshots.mkdir(parents=True, exist_ok=True)
    if not BROWSER:
        print("SKIPPED: no browser; the package chromium has one")
        return 0
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        work = pathlib.Path(folder)
        shutil.copytree(tutorials, work / "tutorials")
        runs = {
            "identify": ("02_identify_a_record", "identify tip_acceleration.csv --config cantilever.toml"),
            "modal": ("02_identify_a_record", "modal tip_acceleration.csv"),
            "modes": ("18_space_frame", "modes --config tower.toml"),
            "simulate": ("02_identify_a_record", "simulate --duration 5"),
            "compare": ("02_identify_a_record", "compare tip_acceleration.csv --config cantilever.toml"),
            "inspect": ("02_identify_a_record", "inspect tip_acceleration.csv"),
        }
        browser = Browser(work / "profile")
        try:
            for name, (tutorial, command) in runs.items():
                results = subprocess.run([beamid, *command.split(), "--out", work / name, "--no-progress"], cwd=work / "tutorials" / tutorial,
                                         capture_output=True, text=True)
                if not (work / name / "report.html").exists():
                    check(False, f"{name}: no page: {results.stderr[:300]}")
                    continue
                size = (work / name / "report.html").stat().st_size
                check(size <= 1.5e6, f"{name}: the page has {size / 1000:.0f} kB")
                check_page(browser, work / name, name, screenshots)
            check_values(browser, work / "identify")
            check_estimate(browser, work / "identify")
            check_copies(browser, work / "identify")
            check_swing(browser, work / "modes")
            check_hostile(browser, beamid, work)
            browser.open(work / "identify" / "report.html")
            blue = colours(browser.screenshot(None)).get(bytes((0, 114, 178)), 0)
            check(blue > 200, f"curves are drawn in their colour ({blue} pixels)")
        finally:
            browser.close()
    print(f"{len(failures)} failed")
    return 1 if failures else 0


sys.exit(main())
