"""A visitor of the site in Debian's Chromium, which opens it from its folder as from a memory stick."""

from pathlib import Path

from playwright.sync_api import Page

FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
"""What Chromium needs to start without a window and to ask nothing of the network."""


class Visitor:
    """A tab on the site that keeps what must not happen: messages of errors, and requests beyond the folder."""

    def __init__(self, page: Page, site: Path) -> None:
        """Watch ``page``."""
        self.page = page
        self._site = site
        self.wrong: list[str] = []
        page.on("pageerror", lambda error: self.wrong.append(str(error)))
        page.on("console", lambda message: self.wrong.append(message.text) if message.type == "error" else None)
        page.on("request", lambda request: self._requested(request.url))

    def _requested(self, url: str) -> None:
        if not url.startswith((self._site.as_uri(), "data:", "blob:")):
            self.wrong.append(f"request to {url}")

    def open(self, name: str) -> Page:
        """Go to a page of the site, "index.html#devices"."""
        self.page.goto(f"{self._site.as_uri()}/{name}")
        return self.page
