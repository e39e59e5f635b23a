# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests the manual as a site in a browser (headless Chromium): narrow and wide screens, search, links."""

import functools
import http.server
import re
import subprocess
import sys
import threading
import unittest
from html.parser import HTMLParser
from urllib.parse import unquote, urldefrag, urljoin

from launcher.tests.build_folder import BUILD, SOURCE

SITE = BUILD / "docs" / "site"
WIDTHS = (390, 1280)
HEIGHT = 900
SECONDS = 30


class Quiet(http.server.SimpleHTTPRequestHandler):
    """Serves files without logging each request."""

    def log_message(self, *_):
        """Logs nothing."""


class Links(HTMLParser):
    """Collects the links and the anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = set(), set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        for name in ("href", "src"):
            if attrs.get(name):
                self.links.add(attrs[name])
        if attrs.get("id"):
            self.anchors.add(attrs["id"])
        if tag == "a" and attrs.get("name"):
            self.anchors.add(attrs["name"])


def html_pages():
    """Returns the paths of the manual's pages, relative to the site, without Doxygen's pages below cpp."""
    return sorted(path.relative_to(SITE).as_posix() for path in SITE.rglob("*.html")
                  if path.relative_to(SITE).parts[0] not in ("cpp", "_static"))


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not (SITE / "index.html").is_file():
            subprocess.run([sys.executable, "-B", SOURCE / "docs" / "build", BUILD, SITE], check=True)
        handler = functools.partial(Quiet, directory=str(SITE))
        cls.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=cls.server.serve_forever, daemon=True).start()
        cls.addClassCleanup(cls.server.server_close)
        cls.addClassCleanup(cls.server.shutdown)
        cls.url = f"http://127.0.0.1:{cls.server.server_port}/"

    def test_internal_links_resolve(self):
        read = functools.lru_cache(maxsize=None)(lambda path: Links(path.read_text(encoding="utf-8", errors="replace")))
        n_links = 0
        for page in html_pages():
            for link in read(SITE / page).links:
                if re.match(r"[a-z]+:", link):
                    continue
                target, anchor = urldefrag(urljoin("/" + page, link))
                path = SITE / unquote(target).split("?")[0].lstrip("/")
                n_links += 1
                self.assertTrue(path.is_file() or (path / "index.html").is_file(), f"{page}: {link}")
                if anchor and path.suffix == ".html" and path.is_relative_to(SITE) and "cpp" not in path.relative_to(SITE).parts:
                    self.assertIn(unquote(anchor), read(path).anchors | {""}, f"{page}: {link}")
        self.assertGreater(n_links, 500)

    def test_every_page_of_the_sources_is_there(self):
        for path in (SOURCE / "docs").rglob("*.md"):
            name = path.relative_to(SOURCE / "docs").with_suffix(".html").as_posix()
            if path.name != "doxygen.md":
                self.assertIn(name, html_pages())
        for name in ("commands", "study-keys", "columns", "methods", "presets", "metrics", "domains", "solutions", "formats", "python"):
            self.assertGreater((SITE / "reference" / f"{name}.html").stat().st_size, 5000, name)
        self.assertIn("smoothfem.smooth", (SITE / "reference" / "python.html").read_text(encoding="utf-8"))

    def browser(self, width):
        """Returns a browser whose window has this width."""
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service

        options = webdriver.ChromeOptions()
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars"):
            options.add_argument(argument)
        options.binary_location = "/usr/bin/chromium"
        driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.addCleanup(driver.quit)
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                               {"width": width, "height": HEIGHT, "deviceScaleFactor": 1, "mobile": width < 500})
        return driver

    def test_pages_do_not_scroll_sideways(self):
        for width in WIDTHS:
            driver = self.browser(width)
            for page in html_pages():
                driver.get(self.url + page)
                seen, whole = driver.execute_script("return [window.innerWidth, document.documentElement.scrollWidth]")
                self.assertEqual(seen, width)
                self.assertLessEqual(whole, width, f"{page} at {width} px")

    def test_search_finds_a_page(self):
        from selenium.webdriver.common.by import By
        from selenium.webdriver.common.keys import Keys
        from selenium.webdriver.support.ui import WebDriverWait

        for width in WIDTHS:
            driver = self.browser(width)
            driver.get(self.url + "index.html")
            box = driver.find_element(By.CSS_SELECTOR, "input[name=q]")
            driver.execute_script("arguments[0].focus()", box)
            if not box.is_displayed() or width < 1000:  # behind the menu: its form is sent from there
                driver.execute_script("arguments[0].value = 'untangle'; arguments[0].form.submit()", box)
            else:
                box.send_keys("untangle", Keys.ENTER)
            WebDriverWait(driver, SECONDS).until(lambda d: d.find_elements(By.CSS_SELECTOR, "ul.search li a"))
            found = [a.get_attribute("href") for a in driver.find_elements(By.CSS_SELECTOR, "ul.search li a")]
            self.assertTrue(any("untangle-and-slide" in href for href in found), found)


if __name__ == "__main__":
    unittest.main()
