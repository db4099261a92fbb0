"""Drives a headless Chromium: python3 browse.py CHROMIUM URL [SCRIPT]

Reads lines of JSON and answers each with one. SCRIPT runs before those of the page. An expression that throws gives
{"error": TEXT}; so does an element that a person could not reach.

    {"eval": EXPRESSION}                   returns its value
    {"until": EXPRESSION, "seconds": S}    waits until it is true
    {"click": EXPRESSION}                  scrolls the element into view with the wheel and clicks its middle
    {"type": TEXT}                         presses the keys of a text, one after the other
    {"press": ["Tab", "Shift+Tab"]}        presses keys by name
    {"mouse": {"type": KIND, ...}}         a mouse event, as in Input.dispatchMouseEvent
    {"touch": {"type": KIND, ...}}         a touch event, as in Input.dispatchTouchEvent
    {"downloads": FOLDER}                  where the browser saves files
    {"size": [W, H, SCALE]}                sets the window's size, on a screen of SCALE pixels per CSS pixel
    {"screenshot": FILE}                   writes a PNG
    {"tab": URL}                           opens another tab behind this one
"""

import asyncio
import base64
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

import websockets
from keys import events_of

FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--no-first-run",
    "--disable-extensions",
    "--disable-background-networking",
    "--disable-dev-shm-usage",
    "--disable-smooth-scrolling",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--window-size=1600,900",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
]

# The middle of an element, the element that covers it, and a place where the wheel scrolls to it: not over a canvas, where
# the wheel zooms.
LOOK = """(() => {
  const element = %s;
  if (!element) throw new Error('there is no such element');
  const box = element.getBoundingClientRect(), middle = [box.left + box.width / 2, box.top + box.height / 2];
  const seen = document.elementFromPoint(...middle);
  let frame = element.parentElement;
  while (frame && !(frame.scrollHeight > frame.clientHeight && /auto|scroll/.test(getComputedStyle(frame).overflowY)))
    frame = frame.parentElement;
  const edge = frame && frame !== document.body ? frame.getBoundingClientRect() : {left: 0, right: innerWidth, top: 0, bottom: innerHeight};
  const x = (edge.left + edge.right) / 2, low = Math.max(0, edge.top), high = Math.min(innerHeight, edge.bottom);
  const places = Array.from({length: 50}, (_, i) => [x, low + (high - low) * (i + 0.5) / 50]);
  return {middle, wheel: places.findLast((place) => document.elementFromPoint(...place)?.tagName !== 'CANVAS') ?? places[0],
          hidden: element.contains(seen) ? '' : seen?.outerHTML.slice(0, 80) ?? 'the edge of the window',
          empty: !box.width || !box.height};
})()"""


def start(chromium, profile):
    """Starts the browser; returns it and the address of its only page for tools."""
    browser = subprocess.Popen(
        [chromium, *FLAGS, f"--user-data-dir={profile}", "about:blank"],
        env={**os.environ, "TMPDIR": profile},  # its temporary files are removed too
        stderr=subprocess.PIPE,
        text=True,
    )
    for line in browser.stderr:
        found = re.search(r"ws://([^/]+)/", line)
        if found:
            break
    else:
        raise SystemExit("browser did not start")
    threading.Thread(target=lambda: [None for _ in browser.stderr], daemon=True).start()  # a full pipe would block it
    end = time.monotonic() + 60
    while time.monotonic() < end:
        pages = json.load(urllib.request.urlopen(f"http://{found[1]}/json/list"))
        if pages:
            return browser, pages[0]["webSocketDebuggerUrl"]
        time.sleep(0.05)
    raise SystemExit("browser has no page")


class Page:
    def __init__(self, socket):
        self.socket = socket
        self.last_id = 0

    async def send(self, method, **parameters):
        self.last_id += 1
        await self.socket.send(json.dumps({"id": self.last_id, "method": method, "params": parameters}))
        while True:
            message = json.loads(await self.socket.recv())
            if message.get("id") == self.last_id:
                return message.get("result", message)

    async def act(self, method, **parameters):
        """Like send, for messages without a result."""
        answer = await self.send(method, **parameters)
        return {"error": answer["error"]} if "error" in answer else {"value": True}

    async def evaluate(self, expression):
        answer = await self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            return {"error": answer["exceptionDetails"].get("exception", {}).get("description", "unknown")}
        if "result" not in answer:  # an object that JSON cannot represent
            return {"error": str(answer)}
        return {"value": answer["result"].get("value")}

    async def until(self, expression, seconds):
        end = time.monotonic() + seconds
        while True:
            answer = await self.evaluate(expression)
            if answer.get("value"):
                return {"value": True}
            if time.monotonic() > end:
                return {"error": f"not true after {seconds} s: {answer}"}
            await asyncio.sleep(0.05)

    async def screenshot(self, file):
        png = await self.send("Page.captureScreenshot", format="png")
        pathlib.Path(file).write_bytes(base64.b64decode(png["data"]))
        return {"value": True}

    async def click(self, expression):
        before = None
        while True:
            answer = await self.evaluate(LOOK % expression)
            if "error" in answer:
                return answer
            look = answer["value"]
            if look["empty"]:
                return {"error": f"nothing is seen of {expression}"}
            if not look["hidden"]:
                break
            if look["middle"] == before:
                return {"error": f"{expression} is behind {look['hidden']}"}
            before = look["middle"]
            x, y = look["wheel"]
            far = before[1] - y
            await self.act("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=far)
            await self.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        x, y = look["middle"]
        for kind in ("mousePressed", "mouseReleased"):
            await self.act("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
        return {"value": True}

    async def press(self, keys):
        for key in keys:
            for event in events_of(key):
                answer = await self.act("Input.dispatchKeyEvent", **event)
                if "error" in answer:
                    return answer
        return {"value": True}

    async def size(self, width, height, scale):
        return await self.act(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=False
        )

    async def answer(self, asked):
        if "eval" in asked:
            return await self.evaluate(asked["eval"])
        if "until" in asked:
            return await self.until(asked["until"], asked["seconds"])
        if "click" in asked:
            return await self.click(asked["click"])
        if "type" in asked:
            return await self.press(asked["type"])
        if "press" in asked:
            return await self.press(asked["press"])
        if "mouse" in asked:
            return await self.act("Input.dispatchMouseEvent", **asked["mouse"])
        if "touch" in asked:
            return await self.act("Input.dispatchTouchEvent", **asked["touch"])
        if "downloads" in asked:
            return await self.act("Page.setDownloadBehavior", behavior="allow", downloadPath=asked["downloads"])
        if "size" in asked:
            return await self.size(*asked["size"])
        if "tab" in asked:
            return await self.act("Target.createTarget", url=asked["tab"], background=True)
        return await self.screenshot(asked["screenshot"])


async def serve(address, url, script):
    async with websockets.connect(address, max_size=None, open_timeout=60, ping_interval=None) as socket:
        page = Page(socket)
        await page.send("Page.enable")
        await page.send("Page.addScriptToEvaluateOnNewDocument", source=script)
        await page.send("Page.navigate", url=url)
        while line := await asyncio.to_thread(sys.stdin.readline):
            print(json.dumps(await page.answer(json.loads(line))), flush=True)


with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
    browser, address = start(sys.argv[1], profile)
    try:
        asyncio.run(serve(address, sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else ""))
    finally:
        browser.terminate()
        browser.wait()
