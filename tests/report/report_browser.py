#!/usr/bin/env python3
"""Opens a report in headless Chromium and checks what a reader relies on.

usage: report_browser.py PAGE.html SUMMARY.json [FOLDER]

Checks: no message of level error on the console, no exception, nothing is asked for but the page
itself, numbers as shown are those of summary.json, charts and 3-D view are drawn, the theme switch
works. Prints how long opening took. Writes pictures (light, dark, phone, print) to FOLDER when given.
Speaks the DevTools protocol through a pipe; needs nothing but Python and chromium.
"""
import base64
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time


class Browser:
    def __init__(self, profile):
        self.read_fd, child_out = os.pipe()
        child_in, self.write_fd = os.pipe()

        def place_pipes():  # The browser reads from 3 and writes to 4.
            saved_in, saved_out = os.dup(child_in), os.dup(child_out)
            os.dup2(saved_in, 3)
            os.dup2(saved_out, 4)

        self.process = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--remote-debugging-pipe",
             "--disable-background-networking", "--disable-component-update", "--no-first-run",
             "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--hide-scrollbars", "--user-data-dir=" + profile],
            preexec_fn=place_pipes, close_fds=False,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(child_in)
        os.close(child_out)
        self.buffer = b""
        self.number = 0
        self.events = []
        self.session = None

    def receive(self, deadline):
        while b"\0" not in self.buffer:
            if time.monotonic() > deadline:
                raise TimeoutError("the browser says nothing")
            chunk = os.read(self.read_fd, 1 << 20)
            if not chunk:
                raise EOFError("the browser ended")
            self.buffer += chunk
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write_fd, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive(time.monotonic() + 60)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)

    def open_tab(self):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def size(self, width, height, phone=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=phone)

    def go(self, url):
        """Seconds until everything that the page does when opening is done."""
        began = time.monotonic()
        self.call("Page.navigate", url=url)
        self.evaluate("new Promise(done => document.readyState === 'complete' ? done() :"
                      " addEventListener('load', done))")
        # Two frames later charts and 3-D view are drawn.
        self.evaluate("new Promise(done => requestAnimationFrame(() =>"
                      " requestAnimationFrame(() => setTimeout(done, 0))))")
        return time.monotonic() - began

    def evaluate(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True,
                           returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(str(result["exceptionDetails"]))
        return result["result"].get("value")

    def wait(self, condition, said):
        """Waits until the condition holds; machines may be busy, so long."""
        held = self.evaluate(f"""new Promise(done => {{
          const end = performance.now() + 20000;
          (function ask() {{
            if ({condition}) done(true);
            else if (performance.now() > end) done(false);
            else setTimeout(ask, 30);
          }})();
        }})""")
        assert held, said

    def picture(self, path):
        height = self.evaluate("document.documentElement.scrollHeight")
        width = self.evaluate("innerWidth")
        self.size(width, min(height, 9000), width < 600)
        self.evaluate("new Promise(done => setTimeout(done, 400))")
        shot = self.call("Page.captureScreenshot", format="png")
        with open(path, "wb") as out:
            out.write(base64.b64decode(shot["data"]))

    def close(self):
        self.session = None
        try:
            self.call("Browser.close")
        except (EOFError, OSError):
            pass
        self.process.wait(timeout=30)


def complaints(browser, page_url):
    """What the page did that it must not."""
    found = []
    for event in browser.events:
        method, what = event.get("method", ""), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            found.append("exception: " + what["exceptionDetails"].get("text", "") +
                         str(what["exceptionDetails"].get("exception", {}).get("description", "")))
        elif method == "Runtime.consoleAPICalled" and what["type"] in ("error", "assert"):
            found.append("console: " + str([a.get("value") for a in what["args"]]))
        elif method == "Log.entryAdded" and what["entry"]["level"] == "error":
            found.append("log: " + what["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            if what["request"]["url"] not in (page_url, "about:blank"):
                found.append("asks for " + what["request"]["url"])
    return found


def at(document, pointer):
    for key in pointer.split("/")[1:]:
        document = document[int(key) if isinstance(document, list) else key]
    return document


def check_numbers(browser, summary):
    """Every number that says where it comes from, against summary.json. Returns how many."""
    shown = browser.evaluate("[...document.querySelectorAll('data[data-at]')].map(e =>"
                             " [e.dataset.at, e.value, e.textContent])")
    for pointer, value, text in shown:
        number = at(summary, pointer)
        assert json.loads(value) == number, f"{pointer}: {value} on the page, {number} in the file"
        digits = len(text.partition(".")[2])
        scale = 100 if "95/" in pointer.replace("wilson95", "95").replace("cluster95", "95") else 1
        assert abs(float(text) - scale * number) <= 0.5001 * 10 ** -digits, f"{pointer}: {text}"
    shares = browser.evaluate("[...document.querySelectorAll('[data-share]')].map(e =>"
                              " [e.dataset.share, e.textContent])")
    for pointer, text in shares:
        rate = at(summary, pointer)
        assert abs(float(text) - 100 * rate["k"] / rate["n"]) <= 0.0501, f"{pointer}: {text}"
    inside = browser.evaluate("JSON.parse(document.getElementById('data').textContent).summary")
    assert inside == summary, "the summary inside the page is another one"
    return len(shown) + len(shares)


def check_drawn(browser):
    painted = """(id) => {
      const c = document.getElementById(id);
      if (!c || c.width === 0) return false;
      const p = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
      return p.some(v => v !== 0);
    }"""
    assert browser.evaluate("document.querySelectorAll('svg.chart-svg, svg.wide-chart').length") >= 1
    if browser.evaluate("!!document.getElementById('times-chart')"):
        browser.evaluate("document.getElementById('times-chart').scrollIntoView()")
        browser.wait(f"({painted})('times-chart')", "the chart of times is empty")
    if not browser.evaluate("!!document.getElementById('stage')"):
        return "no 3-D view"
    browser.evaluate("document.getElementById('stage').scrollIntoView()")
    browser.wait("!!tubetwin.viewer", "the 3-D view did not start")
    browser.wait(f"({painted})('force-chart')", "the chart of loads is empty")
    if not browser.evaluate("tubetwin.viewer.has3d"):
        return "no WebGL here"
    colours = """(() => {
      const c = document.querySelector('#stage canvas'), t = document.createElement('canvas');
      t.width = c.width; t.height = c.height;
      const d = t.getContext('2d');
      d.drawImage(c, 0, 0);
      return new Set(new Uint32Array(d.getImageData(0, 0, t.width, t.height).data.buffer)).size;
    })()"""
    browser.wait(f"{colours} > 50", "the 3-D view is empty")
    image = "document.querySelector('#stage canvas').toDataURL()"
    browser.evaluate(f"tubetwin.viewer.set(0); window.before = {image}")
    browser.evaluate("tubetwin.viewer.set(Number(document.getElementById('time').max) / 2)")
    browser.wait(f"{image} !== window.before", "stepping through time changes nothing")
    browser.evaluate(f"window.before = {image}")
    box = browser.evaluate("(() => { const b = document.querySelector('#stage canvas')"
                           ".getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2];"
                           " })()")
    for kind, shift in (("mousePressed", 0), ("mouseMoved", 80), ("mouseReleased", 80)):
        browser.call("Input.dispatchMouseEvent", type=kind, x=box[0] + shift, y=box[1],
                     button="left", buttons=1, clickCount=1)
    browser.wait(f"{image} !== window.before", "the mouse turns nothing")
    return "3-D view turns and steps"


def check_theme(browser):
    colour = "getComputedStyle(document.body).backgroundColor"
    before = browser.evaluate(colour)
    browser.evaluate("document.getElementById('theme').click()")
    assert browser.evaluate(colour) != before, "the switch between light and dark does nothing"
    browser.evaluate("document.getElementById('theme').click()")


def main():
    page, summary_file = os.path.abspath(sys.argv[1]), sys.argv[2]
    folder = sys.argv[3] if len(sys.argv) > 3 else None
    with open(summary_file, encoding="utf-8") as file:
        summary = json.load(file)
    profile = tempfile.mkdtemp(prefix="tubetwin_browser_")
    browser = Browser(profile)
    try:
        browser.open_tab()
        browser.size(1280, 900)
        url = "file://" + page
        opened_s = browser.go(url)
        numbers = check_numbers(browser, summary)
        assert numbers >= 8, f"only {numbers} numbers say where they come from"
        drawn = check_drawn(browser)
        check_theme(browser)
        wide = browser.evaluate("document.documentElement.scrollWidth - innerWidth")
        browser.size(375, 800, phone=True)
        narrow = browser.evaluate("document.documentElement.scrollWidth - innerWidth")
        assert wide <= 0 and narrow <= 0, f"the page is wider than the window: {wide}, {narrow}"
        if folder:
            os.makedirs(folder, exist_ok=True)
            for name, width, theme in (("light", 1280, "light"), ("dark", 1280, "dark"),
                                       ("phone", 375, "light")):
                browser.size(width, 900, width < 600)
                browser.call("Emulation.setEmulatedMedia",
                             features=[{"name": "prefers-color-scheme", "value": theme}])
                browser.go(url)
                browser.picture(os.path.join(folder, name + ".png"))
            browser.size(794, 1123)  # A4 at 96 dots per inch.
            browser.call("Emulation.setEmulatedMedia", media="print")
            browser.picture(os.path.join(folder, "print.png"))
        found = complaints(browser, url)
        assert not found, "\n".join(found)
        print(f"opened in {opened_s:.2f} s, {os.path.getsize(page)} bytes, {numbers} numbers equal "
              f"to summary.json, {drawn}")
    finally:
        browser.close()
        shutil.rmtree(profile, ignore_errors=True)


if __name__ == "__main__":
    main()
