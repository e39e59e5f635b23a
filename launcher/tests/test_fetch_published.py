# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests fetch published meshes from a server on the loopback address into a temporary cache."""

import hashlib
import http.server
import json
import os
import socket
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[1] / "fetch_published"
STUDIES = SCRIPT.parents[1] / "studies"
CONTENT = b"planar_polygonal_mesh\nnodes 0\n"


class Server:
    """Serves the contents of `files` and counts requests; ends with the test."""

    def __init__(self, files):
        outer = self
        self.asked = []

        class Handler(http.server.BaseHTTPRequestHandler):
            """Answers from memory."""

            def do_GET(self):  # pylint: disable=invalid-name
                outer.asked.append(self.path)
                content = files.get(self.path.lstrip("/"))
                self.send_response(200 if content is not None else 404)
                self.send_header("Content-Length", str(len(content or b"")))
                self.end_headers()
                self.wfile.write(content or b"")

            def log_message(self, *_):
                pass

        self.server = http.server.HTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server.server_port}"
        self.thread = threading.Thread(target=self.server.serve_forever)
        self.thread.start()

    def close(self):
        """Ends the server."""
        self.server.shutdown()
        self.server.server_close()
        self.thread.join()


def free_port():
    """Returns an unused port of the loopback address."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class FetchPublished(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.data = self.folder / "data"
        (self.data / "studies" / "catalogue" / "any").mkdir(parents=True)
        (self.data / "studies" / "catalogue" / "any" / "small.prm").write_text(
            "subsection mesh a\n  set published file = a.mesh\nend\n"
            "subsection mesh b\n  set published file = b.mesh\nend\n")
        (self.data / "studies" / "catalogue" / "any" / "generated.prm").write_text("set title = none\n")
        digest = hashlib.sha256(CONTENT).hexdigest()
        (self.data / "studies" / "published.json").write_text(json.dumps(
            {name: {"url": f"http://127.0.0.1:9/{name}", "sha256": digest} for name in ("a.mesh", "b.mesh")}))
        self.cache = self.folder / "cache" / "smoothfem" / "published"

    def serve(self, files):
        """Starts a server that ends with the test."""
        server = Server(files)
        self.addCleanup(server.close)
        return server

    def fetch(self, study="small", url=None, cache=None):
        """Runs the script."""
        environment = {**os.environ, "XDG_CACHE_HOME": str(cache or self.folder / "cache"), "no_proxy": "*"}
        environment.pop("SMOOTHFEM_PUBLISHED_URL", None)
        if url:
            environment["SMOOTHFEM_PUBLISHED_URL"] = url
        return subprocess.run([sys.executable, SCRIPT, self.data, study], env=environment, text=True,
                              capture_output=True, check=False)

    def assert_one_sentence(self, outcome, *parts):
        """Asserts exit code 2 and one line with these parts, without a traceback."""
        self.assertEqual(outcome.returncode, 2)
        last = [line for line in outcome.stderr.splitlines() if "fetching" not in line]
        self.assertEqual(len(last), 1, outcome.stderr)
        for part in parts:
            self.assertIn(part, last[0])
        self.assertEqual(outcome.stdout, "")

    def kept(self):
        """Returns the names of the files in the cache."""
        return sorted(path.name for path in self.cache.iterdir()) if self.cache.is_dir() else []

    def test_meshes_come_once(self):
        server = self.serve({"a.mesh": CONTENT, "b.mesh": CONTENT})
        for _ in range(2):
            outcome = self.fetch(url=server.url)
            self.assertEqual((outcome.returncode, outcome.stdout.strip()), (0, str(self.cache)), outcome.stderr)
        self.assertEqual(server.asked, ["/a.mesh", "/b.mesh"])
        self.assertEqual(self.kept(), ["a.mesh", "b.mesh"])
        self.assertEqual((self.cache / "a.mesh").read_bytes(), CONTENT)

    def test_damaged_cache_is_mended(self):
        server = self.serve({"a.mesh": CONTENT, "b.mesh": CONTENT})
        self.fetch(url=server.url)
        (self.cache / "b.mesh").write_bytes(CONTENT[:-1])
        self.assertEqual(self.fetch(url=server.url).returncode, 0)
        self.assertEqual((self.cache / "b.mesh").read_bytes(), CONTENT)

    def test_other_content_is_not_kept(self):
        server = self.serve({"a.mesh": CONTENT, "b.mesh": CONTENT + b" "})
        self.assert_one_sentence(self.fetch(url=server.url), "b.mesh", "SHA-256", "nothing was kept")
        self.assertEqual(self.kept(), ["a.mesh"])

    def test_without_network(self):
        outcome = self.fetch(url=f"http://127.0.0.1:{free_port()}")
        self.assert_one_sentence(outcome, "a.mesh cannot be fetched", "download a.mesh and b.mesh into a folder", "--mesh-dir")
        self.assertEqual(self.kept(), [])

    def test_missing_at_the_server(self):
        self.assert_one_sentence(self.fetch(url=self.serve({}).url), "Not Found", "--mesh-dir")

    def test_study_of_ones_own(self):
        server = self.serve({"a.mesh": CONTENT})
        own = self.folder / "own.prm"
        own.write_text("  set published file   = a.mesh\n")
        self.assertEqual(self.fetch(str(own), server.url).returncode, 0)
        own.write_text("set published file = c.mesh\n")
        self.assert_one_sentence(self.fetch(str(own), server.url), "c.mesh", "a.mesh, b.mesh", "--mesh-dir")

    def test_meshes_of_a_study_that_is_included(self):
        server = self.serve({"a.mesh": CONTENT})
        (self.folder / "base.prm").write_text("set published file = a.mesh\ninclude own.prm\n")
        own = self.folder / "own.prm"
        own.write_text("include base.prm  # and itself, which the program refuses\n")
        self.assertEqual(self.fetch(str(own), server.url).returncode, 0)
        self.assertEqual(self.kept(), ["a.mesh"])

    def test_studies_that_have_none(self):
        self.assert_one_sentence(self.fetch("generated"), "generated", "without --published")
        self.assert_one_sentence(self.fetch("nowhere"), "nowhere", "--list")

    def test_cache_that_cannot_be_written(self):
        server = self.serve({"a.mesh": CONTENT, "b.mesh": CONTENT})
        blocked = self.folder / "file"
        blocked.write_text("")
        self.assert_one_sentence(self.fetch(url=server.url, cache=blocked), "cannot be written", "XDG_CACHE_HOME")

    def test_catalogue_of_the_program(self):
        catalogue = json.loads((STUDIES / "published.json").read_text(encoding="utf-8"))
        gear = (STUDIES / "catalogue" / "thesis" / "gear.prm").read_text(encoding="utf-8")
        for name, source in catalogue.items():
            self.assertIn(f"published file = {name}\n", gear)
            self.assertRegex(source["url"], rf"^https://.*/[0-9a-f]{{40}}/.*/{name}$")
            self.assertRegex(source["sha256"], "^[0-9a-f]{64}$")


if __name__ == "__main__":
    unittest.main()
