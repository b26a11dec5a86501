"""Pages of beamid in a real browser: headless Chromium, driven through its DevTools pipe.

Oracles: results.json and the CSV files beside the page; what a browser reports of requests and errors.

Usage: pages_in_browser.py BEAMID TUTORIALS [SCREENSHOTS]
With BEAMID_UPDATE_GOLDEN in the environment the pictures of tests/apps/page_pictures.json are written instead of compared.
"""

import base64
import csv
import json
import math
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
    check_contents(browser, f"{name}, 1300 px", aside=True)
    samples = browser.value("[...document.querySelectorAll('.legend button')].every(b => b.querySelector('.sample svg path'))")
    check(samples, f"{name}: every label of a legend has a sample of its curve")
    browser.screenshot(screenshots and screenshots / f"{name}.png")
    browser.open(page, width=400, dark=True)
    check(browser.value("document.documentElement.scrollWidth <= 401"), f"{name}: the page fits 400 px")
    check_contents(browser, f"{name}, 400 px", aside=False)
    browser.screenshot(screenshots and screenshots / f"{name}_narrow_dark.png")
    browser.open(page, javascript=False)
    browser.call("Emulation.setScriptExecutionDisabled", value=False)
    shown = browser.value("[...document.images].filter(i => i.naturalWidth > 0 && i.offsetWidth > 0).length")
    check(shown >= min(figures, 2), f"{name}: static figures without JavaScript ({shown})")
    check(browser.value("document.querySelectorAll('canvas').length") == 0, f"{name}: nothing half alive without JavaScript")


def check_contents(browser, where, aside):
    """Contents stand beside the title, or below it and the verdict."""
    places = browser.value("['nav', 'h1', '.verdict', 'section > p:not(.verdict)'].map(s => document.querySelector(s)?.getBoundingClientRect())"
                           ".map(r => r && [r.left, r.top, r.right, r.bottom])")
    contents, title, verdict, text = places
    if contents:
        right = contents[2] < title[0] if aside else verdict[3] <= contents[1] and contents[3] <= text[1]
        check(title[1] <= (80 if aside else 40) and right, f"{where}: contents are not above the title ({contents}, {title})")


def check_paper(browser, folder, name):
    """On A4 figures are whole, with their captions and headings: 27.7 cm high, 19 cm wide at 96 px an inch."""
    browser.open(folder / "report.html", width=718)
    browser.value("document.querySelectorAll('details').forEach(part => { part.open = true; })")
    browser.call("Emulation.setEmulatedMedia", media="print")
    heights = browser.value("[...document.querySelectorAll('.plot')].map(f => f.getBoundingClientRect().height)")
    check(max(heights) < 980, f"{name}: figures fit a page of paper {max(heights):.0f} px")
    hidden = browser.value("[...document.querySelectorAll('section nav, .live, .bar, .copy')].every(e => !e.offsetParent)")
    check(hidden, f"{name}: no buttons and no contents on paper")
    shown = browser.value("[...document.images].every(i => i.offsetWidth > 0)")
    check(shown, f"{name}: the static figures are on paper")


PICTURES = pathlib.Path(__file__).resolve().parent / "page_pictures.json"


def picture_of(browser, canvas):
    """What a panel shows inside its axes, where no font is: the mean colours of 96 x 48 fields."""
    return bytes(browser.value(f"""(() => {{
      const c = {canvas}, [l, t, w, h] = c.dataset.box.split(' ').map(Math.round), wide = 96, high = 48;
      const from = c.getContext('2d').getImageData(l, t, w, h).data, sum = new Float64Array(3 * wide * high), count = new Float64Array(wide * high);
      for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) {{
        const field = Math.floor(y * high / h) * wide + Math.floor(x * wide / w);
        count[field] += 1;
        for (let k = 0; k < 3; ++k) sum[3 * field + k] += from[4 * (y * w + x) + k];
      }}
      return Array.from(sum, (s, i) => Math.round(s / Math.max(1, count[Math.floor(i / 3)])));
    }})()"""))


def difference(one, other):
    """The largest of any field, of 255."""
    return max(abs(a - b) for a, b in zip(one, other))


def check_pictures(browser, work, names):
    """The first five panels of the first figure look as they are stored, to a tolerance that each single curve exceeds where it is missing."""
    stored = json.loads(PICTURES.read_text()) if PICTURES.exists() else {}
    made, tolerance = {}, 16
    for name in names:
        browser.open(work / name / "report.html")
        figure = "document.querySelector('figure.plot.alive')"
        count = min(5, browser.value(f"{figure}.querySelectorAll('.cell canvas').length"))
        panels = [f"{figure}.querySelectorAll('.cell canvas')[{k}]" for k in range(count)]
        found = [picture_of(browser, panel) for panel in panels]
        made[name] = [base64.b64encode(zlib.compress(one, 9)).decode() for one in found]
        if not os.environ.get("BEAMID_UPDATE_GOLDEN"):
            away = [difference(one, zlib.decompress(base64.b64decode(known))) for one, known in zip(found, stored.get(name, []))]
            check(len(away) == len(stored.get(name, [])) == count and max(away) < tolerance,
                  f"{name}: {count} panels look as stored, to {max(away, default=math.nan)} of 255")
        for k in range(browser.value(f"{figure}.querySelectorAll('.legend button').length")):
            label = f"{figure}.querySelectorAll('.legend button')[{k}]"
            browser.value(f"{label}.click()")
            browser.settle()
            away = max(difference(picture_of(browser, panel), one) for panel, one in zip(panels, found))
            check(away > tolerance, f"{name}: without '{browser.value(label + '.innerText').strip()}' it would not ({away})")
            browser.value(f"{label}.click()")
    if os.environ.get("BEAMID_UPDATE_GOLDEN"):
        PICTURES.write_text(json.dumps(made, indent=1) + "\n")


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


def check_peak(browser, folder):
    """The half-power width of a spectrum's peak is that of spectrum.csv."""
    rows = list(csv.reader(open(folder / "spectrum.csv", encoding="utf-8")))
    column = next(i for i, head in enumerate(rows[0]) if "measured" in head)
    line = [(float(row[column]), float(row[column + 1])) for row in rows[1:] if row[column]]
    top = max(range(len(line)), key=lambda i: line[i][1])
    half = line[top][1] / 2 ** 0.5
    ends = []
    for step in (-1, 1):
        i = top
        while line[i][1] > half:
            i += step
        (f, low), (g, high) = line[i], line[i - step]
        ends.append(f + (g - f) * (half - low) / (high - low))
    browser.open(folder / "report.html")
    canvas = "document.querySelectorAll('figure.plot.alive')[1].querySelector('canvas')"
    left, top_edge, _, height = place(browser, canvas)
    low, high, from_left, wide = browser.value(
        f"(() => {{ const d = {canvas}.dataset, b = d.box.split(' '); return [...d.x.split(' '), b[0], b[2]].map(Number); }})()")
    x = left + from_left + wide * (line[top][0] - low) / (high - low)
    browser.mouse("mouseMoved", x, top_edge + 0.3 * height)
    browser.settle()
    text = browser.value(f"{canvas}.parentElement.querySelector('.reading').innerText")
    shown = re.search(r"peak ([0-9.]+) Hz: half-power width ([0-9.e-]+) Hz", text)
    wanted = (line[top][0], ends[1] - ends[0])
    close = shown and all(abs(float(shown[k + 1]) - wanted[k]) < 0.01 * wanted[k] for k in (0, 1))
    check(bool(close), f"a peak shows its half-power width: {text!r}, in spectrum.csv {wanted}")


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
    browser.settle()
    alone = browser.value(picture)
    browser.value("(() => { const s = document.querySelectorAll('.motion select')[1]; s.value = 0; s.dispatchEvent(new Event('change')); })()")
    beside = browser.value("document.querySelector('.motion .reading').textContent")
    check(browser.value(picture) != alone and "dashed: mode 1," in beside, f"a second shape swings beside it: {beside}")


def check_motion(browser, folder):
    """The motion of simulate. Oracle: record.csv, whose sensor at the tip moves farthest."""
    browser.open(folder / "report.html")
    canvas, clock = "document.querySelector('canvas.swing')", "document.querySelector('.bar.time input')"
    place(browser, canvas)
    picture = f"{canvas}.toDataURL()"
    browser.value("new Promise(done => setTimeout(() => done(1), 300))")
    check(browser.value(f"Number({canvas}.dataset.time)") > 0, "a motion plays")
    browser.value("[...document.querySelectorAll('.motion button')].find(b => b.textContent === 'Pause').click()")
    rows = list(csv.reader(open(folder / "record.csv", encoding="utf-8")))
    column = next(i for i, head in enumerate(rows[0]) if head.startswith("displacement"))
    record = [(float(row[0]), abs(float(row[column]))) for row in rows[1:]]
    first, last = (browser.value(f"Number({clock}.{end})") for end in ("min", "max"))
    check(first == record[0][0] and abs(last - record[-1][0]) < 0.01, f"the slider goes over the record, {first} to {last} s")
    wrong, pictures = [], set()
    for time, tip in record[::len(record) // 12]:
        browser.value(f"(() => {{ const s = {clock}; s.value = {time}; s.dispatchEvent(new Event('input')); }})()")
        text = browser.value("document.querySelector('.motion .reading').textContent")
        shown = float(re.search(r"largest displacement ([-+0-9.e]+) m of", text)[1])
        pictures.add(browser.value(picture))
        if not 0.98 * tip - 1e-5 <= shown <= 1.02 * tip + 5e-4:  # near rest higher modes move other places farther
            wrong.append((time, shown, tip))
    check(not wrong and len(pictures) > 10, f"the largest displacement is that of record.csv at 13 times {wrong[:2]}")
    before = browser.value(f"Number({canvas}.dataset.time)")
    browser.value(f"{canvas}.dispatchEvent(new KeyboardEvent('keydown', {{key: ','}}))")
    step = before - browser.value(f"Number({canvas}.dataset.time)")
    check(0 < step < 0.01, f"a comma goes back by one picture ({step:.4g} s)")
    left, top, width, height = place(browser, canvas)
    still, x, y = browser.value(picture), left + width / 2, top + height / 2

    def touch(kind, apart):
        points = [{"x": x - apart, "y": y, "id": 0}, {"x": x + apart, "y": y, "id": 1}] if apart else []
        browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)

    for kind, apart in (("touchStart", 20), ("touchMove", 40), ("touchMove", 60), ("touchEnd", 0)):
        touch(kind, apart)
    browser.settle()
    check(browser.value(picture) != still, "two fingers come nearer")


def answer_at(browser, canvas, x, y, x_log=False, y_log=False):
    """Clicks at a point of a panel's axes. @return what the page then shows as text, and its cells"""
    left, top, _, _ = place(browser, canvas)
    box, across, up = browser.value(f"['box', 'x', 'y'].map(k => {canvas}.dataset[k].split(' ').map(Number))")

    def part(value, ends, log):
        value, low, high = (math.log(one) if log else one for one in (value, *ends))
        return (value - low) / (high - low)

    at = {"x": left + box[0] + box[2] * part(x, across, x_log), "y": top + box[1] + box[3] * (1 - part(y, up, y_log)), "button": "left", "clickCount": 1}
    browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=at["x"], y=at["y"])
    browser.call("Input.dispatchMouseEvent", type="mousePressed", **at)
    browser.call("Input.dispatchMouseEvent", type="mouseReleased", **at)
    browser.settle()
    return answer(browser)


def answer(browser):
    """Of the first figure: the text of what was chosen, and the cells of its table by rows."""
    found = "document.querySelector('figure.plot.alive .answer')"
    text = browser.value(f"{found}?.innerText || ''")
    rows = browser.value(f"[...({found}?.querySelectorAll('tr') || [])].map(r => [...r.cells].map(c => c.textContent))")
    return text, rows


def press(browser, key, canvas=FIRST):
    browser.value(f"{canvas}.dispatchEvent(new KeyboardEvent('keydown', {{key: '{key}'}}))")
    browser.settle()


def check_poles(browser, beamid, work):
    """A click on a pole shows its numbers and shape. Oracle: the mode of results.json that is stable at that order."""
    hostile = "<img src=x onerror=document.title='taken'>"
    sensors = "".join(f"[[sensors]]\nquantity = 'acceleration'\nposition_m = {at}\nname = {json.dumps(name)}\nnoise_m_per_s2 = 0.01\n"
                      for at, name in ((0.4, "low"), (0.8, "middle"), (1.1, "tip")))
    (work / "poles.toml").write_text("[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = 3.055\n"
                                     f"[damping]\nratio = 0.01\n{sensors}[simulation]\nduration_s = 5\nsampling_rate_hz = 200\n", encoding="utf-8")
    for words in (["simulate", "--config", "poles.toml", "--out", "poles_record"], ["modal", "poles.csv", "--out", "poles"]):
        subprocess.run([beamid, *words, "--no-progress"], cwd=work, check=False, stdout=subprocess.DEVNULL)
        head, *readings = (work / "poles_record" / "record.csv").read_text(encoding="utf-8").splitlines()
        head = head.replace("acceleration_low_m_per_s2", f'"{hostile} [m/s2]"')
        (work / "poles.csv").write_text("\n".join([head, *readings]) + "\n", encoding="utf-8")
    results = json.loads((work / "poles" / "results.json").read_text())
    mode = results["records"][0]["modes"][1]  # the first pole of a curve is one of the first mode
    browser.open(work / "poles" / "report.html")
    text, rows = answer_at(browser, FIRST, mode["frequency_hz"], mode["stable_orders"][-1])
    numbers = {row[0]: float(row[1].split()[0]) for row in rows}
    close = abs(numbers.get("frequency", 0) / mode["frequency_hz"] - 1) < 0.01 and abs(numbers.get("damping ratio", 0) / mode["damping_ratio"] / 100 - 1) < 0.2
    check(close and f"model order {mode['stable_orders'][-1]}: stable" in text, f"a pole shows frequency and damping ratio: {text!r}")
    sketch = "document.querySelector('canvas.sketch')"
    label = browser.value(f"{sketch}?.getAttribute('aria-label') || ''")
    amplitudes = [one["amplitude"] for one in mode["shape"]]
    shown = [float(one) for one in re.findall(r" (-?[0-9.]+(?:e-?[0-9]+)?) at ", label)]
    wanted = [one / max(amplitudes) for one in amplitudes]
    same = len(shown) == 3 and all(abs(a - b) < 0.03 for a, b in zip(shown, wanted))
    check(same and hostile in label, f"and its mode shape, {shown}, in results.json {wanted}")
    place(browser, sketch)
    first = browser.value(f"{sketch}.toDataURL()")
    browser.value("new Promise(done => setTimeout(() => done(1), 400))")
    check(browser.value(f"{sketch}.toDataURL()") != first, "which swings")
    browser.value("[...document.querySelectorAll('.answer button')].find(b => b.textContent === 'Pause').click()")
    browser.settle()
    still = browser.value(f"{sketch}.toDataURL()")
    browser.value("new Promise(done => setTimeout(() => done(1), 200))")
    check(browser.value(f"{sketch}.toDataURL()") == still, "and stops")
    press(browser, ",")
    before = answer(browser)
    check(before[1] != rows and len(before[1]) >= 2, f"a comma shows the pole before: {before[0]!r}")
    press(browser, "Escape")
    check(answer(browser)[0] == "", "Escape closes it")
    press(browser, "Enter")
    check("damping ratio" in answer(browser)[0], "Enter shows the pole nearest to the reading")
    check(browser.problems() == [] and browser.value("document.title") != "taken", f"and no name is run {browser.problems()[:2]}")


def check_sets(browser, folder):
    """Twins: a click on a set shows its parameters, and its mode swings. Oracle: results.json."""
    results = json.loads((folder / "results.json").read_text())
    browser.open(folder / "report.html")
    number = 1
    parameters = results["sets"][number]["parameters"]
    described = {one["name"]: one["described"] for one in results["parameters"]}
    shift = 0.5 * ((number + 0.5) / len([one for one in results["sets"] if one["fits_as_well"]][:6]) - 0.5)
    first = next(iter(parameters))
    text, rows = answer_at(browser, FIRST, parameters[first] / described[first], 1 + shift)
    shown = {row[0]: float(row[1]) for row in rows[1:]}
    same = shown.keys() == parameters.keys() and all(abs(shown[name] / parameters[name] - 1) < 1e-4 for name in shown)
    check(same and text.startswith(f"set {number + 1}"), f"a set shows its parameters: {text[:80]!r}")
    caption = browser.value("document.querySelector('.motion .reading').textContent")
    check(f"of set {number + 1}," in caption and "dashed: mode 1 as described" in caption, f"and its mode swings: {caption}")


def check_update(browser, folder):
    """Shapes before and after an update swing together. Oracle: results.json."""
    modes = json.loads((folder / "results.json").read_text())["modes"]
    browser.open(folder / "report.html")
    canvas = "document.querySelector('canvas.swing')"
    place(browser, canvas)
    browser.value("new Promise(done => setTimeout(() => done(1), 200))")
    first = browser.value(f"{canvas}.toDataURL()")
    browser.value("new Promise(done => setTimeout(() => done(1), 400))")
    check(browser.value(f"{canvas}.toDataURL()") != first, "update: shapes swing")
    caption = browser.value("document.querySelector('.motion .reading').textContent")
    shown = [float(one) for one in re.findall(r"([0-9.]+) Hz", caption)]
    wanted = [modes[0]["updated_hz"], modes[0]["described_hz"]]
    check(len(shown) == 2 and all(abs(a / b - 1) < 1e-4 for a, b in zip(shown, wanted)), f"update: after and before: {caption}, in results.json {wanted}")
    places = browser.value("['.answer', 'h1', 'table', '.motion'].map(s => document.querySelector(s)?.getBoundingClientRect().top ?? -1)")
    check(places[1] < places[2] < places[3], f"update: title, table of answers, shapes {places}")


def check_cells(browser, beamid, work):
    """A sweep: a click on a point shows its runs; the command that it shows finds the same estimates."""
    folder = work / "tutorials" / "13_sweeps"
    lines = list(csv.DictReader(open(work / "sweep" / "cases.csv", encoding="utf-8")))
    runs = [line for line in lines if line["parameter"] == "stiffness" and float(line["damping.ratio"]) == 0.01]
    errors = [float(line["error"]) / float(line["truth"]) for line in runs]
    rms = 100 * math.sqrt(sum(one * one for one in errors) / len(errors))
    browser.open(work / "sweep" / "report.html")
    text, rows = answer_at(browser, FIRST, 0.01, rms, x_log=True, y_log=True)
    shown = {row[0]: float(row[3]) for row in rows[1:]}
    same = len(shown) == len(runs) and all(abs(shown[line["case"]] / float(line["estimate"]) - 1) < 1e-5 for line in runs)
    check(same and text.startswith("stiffness: ratio = 0.01"), f"a point of a sweep shows its runs: {text[:120]!r}")
    command = browser.value("document.querySelector('.answer pre')?.textContent || ''").split()
    check(command[:2] == ["beamid", "sweep"], f"and what repeats them: {' '.join(command)}")
    subprocess.run([beamid, *command[1:], "--out", work / "cell", "--no-progress"], cwd=folder, check=False, stdout=subprocess.DEVNULL)
    cell = work / "cell" / "cases.csv"
    again = [line["estimate"] for line in csv.DictReader(open(cell, encoding="utf-8")) if line["parameter"] == "stiffness"] if cell.exists() else []
    check(again == [line["estimate"] for line in runs], f"which finds the same estimates {again[:2]}")


def check_long(browser, beamid, work):
    """Of 100 000 samples the page has each: one that stands alone is read at its own time after zooming in."""
    spike, at = 7.25, 87654
    with open(work / "long.csv", "w", encoding="utf-8") as file:
        file.write("time_s,acceleration_m_per_s2\n")
        file.writelines(f"{k / 1000:.3f},{spike if k == at else math.sin(0.05 * k) + 0.001 * (k * 7919 % 1000):.4f}\n" for k in range(100_000))
    subprocess.run([beamid, "inspect", "long.csv", "--out", "long", "--no-progress"], cwd=work, check=False, stdout=subprocess.DEVNULL)
    size = (work / "long" / "report.html").stat().st_size
    check(size <= 1.5e6, f"a page of 100 000 samples has {size / 1000:.0f} kB")
    browser.open(work / "long" / "report.html")
    note = browser.value("document.querySelector('.live .note')?.textContent || ''")
    check(bool(re.match("All [0-9]+ points of the longest curve are here", note)) and "1/65 534" in note, f"and states what it shows: {note}")
    left, top, _, height = place(browser)
    for _ in range(3):
        low, high, from_left, wide = browser.value(
            f"(() => {{ const d = {FIRST}.dataset, b = d.box.split(' '); return [...d.x.split(' '), b[0], b[2]].map(Number); }})()")
        x = left + from_left + wide * (at / 1000 - low) / (high - low)
        y = top + 0.5 * height
        browser.mouse("mousePressed", x - 12, y, button="left", clickCount=1)
        browser.mouse("mouseMoved", x + 12, y, button="left", buttons=1)
        browser.mouse("mouseReleased", x + 12, y, button="left", clickCount=1)
        browser.settle()
    low, high = browser.value(f"{FIRST}.dataset.x.split(' ').map(Number)")
    browser.mouse("mouseMoved", left + from_left + wide * (at / 1000 - low) / (high - low), y)
    browser.settle()
    text = browser.value(f"{FIRST}.parentElement.querySelector('.reading').innerText")
    numbers = [float(one) for one in re.findall(r"(-?[0-9.]+) (?:s|m/s²)", text)]
    found = len(numbers) > 1 and abs(numbers[0] - at / 1000) < 1e-6 and abs(numbers[1] - spike) < 2e-4
    check(found and high - low < 0.1, f"a single sample is read after zooming to {high - low:.4f} s: {text!r}")
    start = browser.value("performance.now()")
    for key in ("-", "-", "+", "+") * 5:
        browser.value(f"{FIRST}.dispatchEvent(new KeyboardEvent('keydown', {{key: '{key}'}}))")
        browser.settle()
    taken = (browser.value("performance.now()") - start) / 20
    check(taken < 100, f"a zoom takes {taken:.0f} ms, less than a tenth of a second")


def check_hostile(browser, beamid, work):
    """Names of files, sensors and titles with markup, quotes, great length and right-to-left text stay text where they stand."""
    markup, left = "<img src=x onerror=document.title='taken'></script>\"'&amp;", "\u05d0\u05d1\u05d2"
    title = f"{markup} \u202eabc " + "long" * 60
    text = (work / "tutorials/02_identify_a_record/cantilever.toml").read_text(encoding="utf-8")
    text = re.sub(r"(?m)^title = .*$", "", text)
    (work / "hostile.toml").write_text(f'title = {json.dumps(title, ensure_ascii=False)}\n{text}', encoding="utf-8")
    beam = "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = 3.055\n"
    sensor = json.dumps(f"{left} {markup[:60]}", ensure_ascii=False)
    (work / "sensor.toml").write_text(f"title = {json.dumps(left)}\n{beam}[[sensors]]\nquantity = 'displacement'\nname = {sensor}\n"
                                      "[simulation]\nduration_s = 2\nsampling_rate_hz = 200\n", encoding="utf-8")
    record = f"<img src=x onerror=document.title=`taken`> \"'& {left}"
    shutil.copyfile(work / "tutorials/02_identify_a_record/tip_acceleration.csv", work / record)
    commands = {"hostile_title": ["modes", "--config", "hostile.toml", "--modes", "3"], "hostile_file": ["modal", record],
                "hostile_sensor": ["simulate", "--config", "sensor.toml"]}
    for name, words in commands.items():
        subprocess.run([beamid, *words, "--out", name, "--no-progress"], cwd=work, check=False, stdout=subprocess.DEVNULL)
    subprocess.run([beamid, "report", *commands, "--out", "hostile.html"], cwd=work, check=True, stdout=subprocess.DEVNULL)
    shown = {"hostile_title": markup, "hostile_file": record, "hostile_sensor": markup[:60], "hostile_joined": markup}
    for name, words in shown.items():
        page = work / name / "report.html"
        if name == "hostile_joined":
            page.parent.mkdir()
            shutil.move(work / "hostile.html", page)
        for width in (1300, 400):
            browser.open(page, width=width)
            browser.value("document.querySelectorAll('details').forEach(part => { part.open = true; })")
            browser.settle()
            check(browser.problems() == [], f"{name}, {width} px: no error and no request {browser.problems()[:2]}")
            fits = browser.value("document.documentElement.scrollWidth <= innerWidth + 1")
            check(fits, f"{name}, {width} px: the page fits")
        everything = browser.value("document.body.textContent")
        check(words in everything, f"{name}: the name is shown as it is written")
        check("\u202e" not in everything, f"{name}: no override of the direction of text")
        check(browser.value("document.title") != "taken", f"{name}: and is not run")
        foreign = browser.value("[...document.images].filter(i => !i.src.startsWith('data:')).length + document.querySelectorAll('script').length")
        check(foreign == 1, f"{name}: no element but the page's own")
    # "2501 samples" behind a name in Hebrew stands at its right.
    browser.open(work / "hostile_file" / "report.html")
    order = browser.value("""(() => {
      const walk = document.createTreeWalker(document.querySelector('main'), NodeFilter.SHOW_TEXT);
      for (let node; (node = walk.nextNode());) {
        const at = node.data.indexOf('2501 samples'), name = node.data.indexOf('\u05d2');
        if (at < 0 || name < 0) continue;
        const left = (k) => { const r = document.createRange(); r.setStart(node, k); r.setEnd(node, k + 1); return r.getBoundingClientRect().left; };
        return [left(name), left(at), left(at + 3)];
      }
    })()""")
    check(order is not None and order[0] < order[1] < order[2], f"numbers stand behind a name in Hebrew {order}")


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
            "reduce": ("02_identify_a_record", "reduce --config cantilever.toml --reduction guyan"),
        }
        answering = {
            "twins": ("16_six_buildings", "twins frequencies.toml --config frame.toml --model-error 0.05"),
            "update": ("16_six_buildings", "update shapes.toml --config frame.toml"),
            "sweep": ("13_sweeps", "sweep --config rig.toml --seeds 6"),
        }
        browser = Browser(work / "profile")
        try:
            for name, (tutorial, command) in (runs | answering).items():
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
            check_peak(browser, work / "identify")
            check_copies(browser, work / "identify")
            check_swing(browser, work / "modes")
            check_poles(browser, beamid, work)
            check_sets(browser, work / "twins")
            check_update(browser, work / "update")
            check_cells(browser, beamid, work)
            check_motion(browser, work / "simulate")
            for name in ("identify", "modes", "compare"):
                check_paper(browser, work / name, name)
            check_hostile(browser, beamid, work)
            check_long(browser, beamid, work)
            check_pictures(browser, work, runs)
            browser.open(work / "identify" / "report.html")
            blue = colours(browser.screenshot(None)).get(bytes((0, 114, 178)), 0)
            check(blue > 200, f"curves are drawn in their colour ({blue} pixels)")
        finally:
            browser.close()
    print(f"{len(failures)} failed")
    return 1 if failures else 0


sys.exit(main())
