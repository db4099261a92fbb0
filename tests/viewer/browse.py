"""A headless Chromium that does what is asked: python3 browse.py CHROMIUM URL [SCRIPT]

Reads lines of JSON and answers each with one: {"eval": EXPRESSION} gives its value, {"until": EXPRESSION, "seconds": S}
waits until it is true, {"screenshot": FILE} writes a PNG, {"type": TEXT} types it and Enter, {"mouse": {"type": KIND,
"x": X, "y": Y, ...}} is what the mouse does, {"size": [W, H]} makes the window so large. An expression that throws gives {"error": TEXT}. SCRIPT runs before those of the page.
"""

import asyncio
import base64
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

import websockets

FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--no-first-run",
    "--disable-extensions",
    "--disable-background-networking",
    "--disable-dev-shm-usage",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--window-size=1600,900",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
]


def start(chromium, profile):
    """The browser, and the address of its only page for tools."""
    browser = subprocess.Popen(
        [chromium, *FLAGS, f"--user-data-dir={profile}", "about:blank"], stderr=subprocess.PIPE, text=True
    )
    for line in browser.stderr:
        found = re.search(r"ws://([^/]+)/", line)
        if found:
            break
    else:
        raise SystemExit("browser did not start")
    threading.Thread(target=lambda: [None for _ in browser.stderr], daemon=True).start()  # or it fills and holds up
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

    async def evaluate(self, expression):
        answer = await self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            return {"error": answer["exceptionDetails"].get("exception", {}).get("description", "unknown")}
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


    async def type(self, text):
        await self.send("Input.insertText", text=text)
        for kind in ("rawKeyDown", "keyUp"):
            await self.send("Input.dispatchKeyEvent", type=kind, key="Enter", code="Enter", windowsVirtualKeyCode=13)
        return {"value": True}

    async def mouse(self, event):
        await self.send("Input.dispatchMouseEvent", **event)
        return {"value": True}

    async def size(self, width, height):
        await self.send(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False
        )
        return {"value": True}


async def serve(address, url, script):
    async with websockets.connect(address, max_size=None, open_timeout=60, ping_interval=None) as socket:
        page = Page(socket)
        await page.send("Page.enable")
        await page.send("Page.addScriptToEvaluateOnNewDocument", source=script)
        await page.send("Page.navigate", url=url)
        while line := await asyncio.to_thread(sys.stdin.readline):
            asked = json.loads(line)
            if "eval" in asked:
                answer = await page.evaluate(asked["eval"])
            elif "until" in asked:
                answer = await page.until(asked["until"], asked["seconds"])
            elif "type" in asked:
                answer = await page.type(asked["type"])
            elif "mouse" in asked:
                answer = await page.mouse(asked["mouse"])
            elif "size" in asked:
                answer = await page.size(*asked["size"])
            else:
                answer = await page.screenshot(asked["screenshot"])
            print(json.dumps(answer), flush=True)


with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
    browser, address = start(sys.argv[1], profile)
    try:
        asyncio.run(serve(address, sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else ""))
    finally:
        browser.terminate()
        browser.wait()
