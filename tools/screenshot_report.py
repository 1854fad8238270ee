#!/usr/bin/env python3
"""Pictures of a report's page at 400 and 1400 pixels, and on paper; fails if the page is wider than its window.

usage: tools/screenshot_report.py REPORT.html OUT_FOLDER [--widths 400,1400] [--dark] [--no-pictures]

Writes OUT_FOLDER/report-WIDTH-N.png, from the top down, and report.pdf. Exits 1 where the page scrolls sideways, asks
for anything but itself, or an element is cut off or text smaller than 9 pixels; 77 where Chromium is not installed
(Debian: apt-get install chromium).
"""
import argparse
import base64
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PIECE = 3000  # pixels of height a picture

# What is wider than the window though it is in no box that scrolls; and text too small to read.
LOOK = """(() => {
  const width = document.documentElement.clientWidth;
  const name = e => e.tagName.toLowerCase() + '.' + (e.getAttribute('class') || '') + ' "' +
      (e.textContent || '').trim().slice(0, 40) + '"';
  const wide = [], small = [];
  for (const e of document.body.querySelectorAll('*')) {
    const box = e.getBoundingClientRect();
    if (box.width === 0 || e.closest('title')) continue;
    if (box.right > width + 1 && !e.closest('.scroll, pre')) wide.push(name(e));
    if (e.tagName.toLowerCase() === 'text') {
      const scale = e.ownerSVGElement.getBoundingClientRect().width / e.ownerSVGElement.viewBox.baseVal.width;
      if (parseFloat(getComputedStyle(e).fontSize) * scale < 9) small.push(name(e));
    } else if (parseFloat(getComputedStyle(e).fontSize) < 9) small.push(name(e));
  }
  const svgs = [...document.querySelectorAll('svg.chart')].filter(s => s.getBoundingClientRect().width > 0);
  return {width, scroll: document.documentElement.scrollWidth, height: document.documentElement.scrollHeight,
          charts: svgs.length, wide: wide.slice(0, 5), small: small.slice(0, 5)};
})()"""


class Browser:
    """Chromium, spoken to through a pair of pipes: no port, no library."""

    def __init__(self, program, folder):
        down_read, self.down = os.pipe()
        self.up, up_write = os.pipe()
        flags = ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
                 "--disable-component-update", "--disable-sync", "--disable-quic", "--hide-scrollbars",
                 "--remote-debugging-pipe", f"--user-data-dir={folder}", "about:blank"]
        # The protocol's descriptors are 3 and 4.
        self.process = subprocess.Popen(
            ["bash", "-c", f'exec "$@" 3<&{down_read} 4>&{up_write}', "bash", program, *flags],
            pass_fds=(down_read, up_write), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(down_read)
        os.close(up_write)
        self.buffer, self.last, self.session, self.events = b"", 0, None, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def receive(self):
        while b"\0" not in self.buffer:
            piece = os.read(self.up, 1 << 20)
            if not piece:
                sys.exit("screenshot_report: Chromium ended")
            self.buffer += piece
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **parameters):
        self.last += 1
        message = {"id": self.last, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.down, data):]
        while True:
            answer = self.receive()
            if answer.get("id") == self.last:
                if "error" in answer:
                    sys.exit(f"screenshot_report: {method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)

    def wait(self, method):
        while not any(e.get("method") == method for e in self.events):
            self.events.append(self.receive())

    def close(self):
        self.process.terminate()
        self.process.wait()


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n")[0])
    parser.add_argument("report", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--widths", default="400,1400")
    parser.add_argument("--dark", action="store_true")
    parser.add_argument("--no-pictures", action="store_true")
    options = parser.parse_args()
    program = next((p for p in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if p), None)
    if program is None:
        print("screenshot_report: skipped: Chromium is not installed (Debian: apt-get install chromium)")
        return 77
    if not options.report.is_file():
        print(f"screenshot_report: no file {options.report}", file=sys.stderr)
        return 2
    options.folder.mkdir(parents=True, exist_ok=True)
    address = options.report.resolve().as_uri()
    bad = False
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(program, profile)
        try:
            browser.call("Page.enable")
            browser.call("Network.enable")
            for width in map(int, options.widths.split(",")):
                browser.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1,
                             mobile=width < 600)
                browser.call("Emulation.setEmulatedMedia", features=[
                    {"name": "prefers-color-scheme", "value": "dark" if options.dark else "light"}])
                browser.events.clear()
                browser.call("Page.navigate", url=address)
                browser.wait("Page.loadEventFired")
                seen = browser.call("Runtime.evaluate", expression=LOOK, returnByValue=True)["result"]["value"]
                asked = [e["params"]["request"]["url"] for e in browser.events
                         if e.get("method") == "Network.requestWillBeSent"]
                strange = [url for url in asked if url != address and not url.startswith("data:")]
                print(f"{width} pixels: window {seen['width']}, page {seen['scroll']} wide, {seen['height']} high, "
                      f"{seen['charts']} charts, other requests {len(strange)}")
                if seen["width"] != width:
                    print(f"  the window is not {width} pixels wide: nothing is shown by this")
                    bad = True
                if seen["scroll"] > seen["width"]:
                    print("  the page scrolls sideways")
                    bad = True
                for what, found in (("beyond the window", seen["wide"]), ("text under 9 pixels", seen["small"]),
                                    ("asks for", strange)):
                    for item in found:
                        print(f"  {what}: {item}")
                        bad = True
                if options.no_pictures:
                    continue
                for top in range(0, seen["height"], PIECE):
                    clip = {"x": 0, "y": top, "width": width, "height": min(PIECE, seen["height"] - top), "scale": 1}
                    picture = browser.call("Page.captureScreenshot", format="png", clip=clip,
                                           captureBeyondViewport=True)
                    path = options.folder / f"report-{width}-{top // PIECE + 1}.png"
                    path.write_bytes(base64.b64decode(picture["data"]))
            if not options.no_pictures:
                browser.call("Emulation.clearDeviceMetricsOverride")
                paper = browser.call("Page.printToPDF", preferCSSPageSize=True, printBackground=True, paperWidth=8.27,
                                     paperHeight=11.69)
                (options.folder / "report.pdf").write_bytes(base64.b64decode(paper["data"]))
        finally:
            browser.close()
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
