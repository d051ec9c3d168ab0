"""Makes the tutorial's picture of the playground: its first page with a success, in a Chromium that is installed."""

from __future__ import annotations

import subprocess
import sys
from io import BytesIO
from pathlib import Path
from shutil import which

from PIL import Image
from playwright.sync_api import ViewportSize, sync_playwright

SIZE = ViewportSize(width=1180, height=800)


def main(folder: Path) -> None:
    """Write the picture, from a server that is ended afterwards."""
    command = [sys.executable, "-m", "tltlc", "serve", "--port", "0"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, encoding="utf-8") as server, sync_playwright() as playwright:
        try:
            assert server.stderr is not None
            address = next(word for word in server.stderr.readline().split() if word.startswith("http")).rstrip(",")
            browser = playwright.chromium.launch(executable_path=which("chromium"), args=["--no-sandbox"])
            page = browser.new_page(viewport=SIZE, device_scale_factor=1.25)
            page.goto(address)
            page.click("text=Show a success")
            page.wait_for_selector("tbody >> text=holding")
            shot = Image.open(BytesIO(page.screenshot(full_page=True))).convert("RGB")
            shot.quantize(64, dither=Image.Dither.NONE).save(folder / "playground.png", optimize=True)
            browser.close()
        finally:
            server.terminate()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
