# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests fetch published meshes from a server on the loopback address into a temporary cache."""

import hashlib
import http.server
import importlib.util
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
SETS = ("hexalab", "mesquite", "sfepy")


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

    def write_set(self, files):
        """Writes the catalogue of the set `few`."""
        (self.data / "studies" / "published").mkdir(exist_ok=True)
        (self.data / "studies" / "published" / "few.json").write_text(json.dumps({
            "repository": "https://example.org/few", "address": "http://127.0.0.1:9/some/",
            "files": {path: {"family": "f", "sha256": hashlib.sha256(content).hexdigest()} for path, content in files.items()}}))

    def fetch(self, study="small", url=None, cache=None, sets=()):
        """Runs the script."""
        environment = {**os.environ, "XDG_CACHE_HOME": str(cache or self.folder / "cache"), "no_proxy": "*"}
        environment.pop("SMOOTHFEM_PUBLISHED_URL", None)
        if url:
            environment["SMOOTHFEM_PUBLISHED_URL"] = url
        return subprocess.run([sys.executable, SCRIPT, self.data, study, *sets], env=environment, text=True,
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

    def test_sets(self):
        files = {"2d/one mesh.vtk": CONTENT, "3d/two.mesh": CONTENT + b"2"}
        self.write_set(files)
        server = self.serve({"few/2d/one%20mesh.vtk": files["2d/one mesh.vtk"], "few/3d/two.mesh": files["3d/two.mesh"]})
        for _ in range(2):
            outcome = self.fetch(url=server.url, sets=["few"])
            self.assertEqual((outcome.returncode, outcome.stdout.strip()), (0, str(self.cache)), outcome.stderr)
        self.assertEqual(len(server.asked), 2)
        for path, content in files.items():
            self.assertEqual((self.cache / "few" / path).read_bytes(), content)

    def test_a_folder_may_be_the_mirror(self):
        self.write_set({"2d/one mesh.vtk": CONTENT})
        mirror = self.folder / "a mirror" / "few" / "2d"
        mirror.mkdir(parents=True)
        (mirror / "one mesh.vtk").write_bytes(CONTENT)
        outcome = self.fetch(url=(self.folder / "a mirror").as_uri(), sets=["few"])
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        self.assertEqual((self.cache / "few" / "2d" / "one mesh.vtk").read_bytes(), CONTENT)

    def test_sets_of_other_content_or_without_network(self):
        self.write_set({"a.mesh": CONTENT, "b.mesh": CONTENT})
        server = self.serve({"few/a.mesh": CONTENT, "few/b.mesh": CONTENT[1:]})
        self.assert_one_sentence(self.fetch(url=server.url, sets=["few"]), "b.mesh", "SHA-256", "nothing was kept")
        self.assertEqual(sorted(path.name for path in (self.cache / "few").iterdir()), ["a.mesh"])
        self.assert_one_sentence(self.fetch(url=f"http://127.0.0.1:{free_port()}", sets=["few"]), "b.mesh cannot be fetched",
                                 "copy the folder")

    def test_catalogues_of_sets(self):
        """Each study collection-SET has its catalogue. Pairs of hexalab are complete, and in one family."""
        self.assertEqual(sorted(path.stem for path in (STUDIES / "published").glob("*.json")), sorted(SETS))
        for name in SETS:
            study = (STUDIES / "catalogue" / "collections" / f"collection-{name}.prm").read_text(encoding="utf-8")
            self.assertRegex(study, rf"\nset published\s*= {name}\n")
            known = json.loads((STUDIES / "published" / f"{name}.json").read_text(encoding="utf-8"))
            owner = known["repository"].removeprefix("https://github.com/")
            self.assertTrue(known["address"].startswith(f"https://raw.githubusercontent.com/{owner}/{known['commit']}/"))
            self.assertRegex(known["commit"], "^[0-9a-f]{40}$")
            self.assertTrue(known["address"].endswith("/") and known["licence"])
            self.assertFalse(set(known["files"]) & set(known["left_out"]))
            for path, facts in known["files"].items():
                self.assertFalse(path.startswith("/") or ".." in path, path)
                self.assertRegex(facts["sha256"], "^[0-9a-f]{64}$")
                if name == "hexalab":
                    self.assertEqual(known["files"][path.replace("_in.", "_out.")]["family"], facts["family"])
                    self.assertIn(path.replace("_out.", "_in."), known["files"])

    def test_making_a_catalogue(self):
        """From a repository with one good mesh, its copy, and one that is no mesh; a stand-in says the quality."""
        found = importlib.util.spec_from_file_location("make_published", SCRIPT.parents[1] / "tools" / "make_published.py")
        made = importlib.util.module_from_spec(found)
        found.loader.exec_module(made)
        program = self.folder / "program"
        program.write_text("#!/bin/sh\nif grep -q bad \"$2\"; then echo \"smoothfem: $2:3: no mesh\" >&2; exit 2; fi\n"
                           "echo '" + json.dumps({"n_nodes": 90, "n_fixed_nodes": 20, "n_cells": 70, "cells": {"triangle": 70}, "n_invalid": 0,
                                                  "q_min": 0.5, "q_mean": 0.7, "findings": []}) + "'\n")
        program.chmod(0o755)
        repository = self.folder / "repository"
        (repository / "the meshes" / "2d").mkdir(parents=True)
        for name, text in (("2d/a_1.mesh", "good"), ("b.vtk", "good, too"), ("c.mesh", "bad"), ("README", "text")):
            (repository / "the meshes" / name).write_text(text)
        for words in (("init", "-q"), ("add", "."), ("-c", "user.name=n", "-c", "user.email=e@example.org", "commit", "-q", "-m", "m")):
            subprocess.run(["git", "-C", repository, *words], check=True)
        chosen = {"repository": "https://github.com/o/r", "folder": "the meshes", "licence": "any", "most_nodes": 100,
                  "families": [("(a)_.", r"\1")]}
        catalogue = made.catalogue(chosen, str(repository), str(program))
        self.assertEqual(catalogue["files"], {"2d/a_1.mesh": {"family": "a", "sha256": hashlib.sha256(b"good").hexdigest()}})
        self.assertEqual(catalogue["left_out"], {"b.vtk": "the same mesh as 2d/a_1.mesh", "c.mesh": "no mesh"})
        self.assertTrue(catalogue["address"].endswith(f"/o/r/{catalogue['commit']}/the%20meshes/"))
        quality = {"n_nodes": 101, "n_fixed_nodes": 0, "cells": ["triangle"], "n_invalid": 0, "findings": []}
        for changed, part in (({}, "more than 100 nodes (101)"), ({"n_corners": 0}, "surface"), ({"cells": ["5-gon"]}, "polygons"),
                              ({"cells": ["tetrahedron", "pyramid"]}, "degree 2"),
                              ({"n_fixed_nodes": 60}, "fewer than 50 free nodes (41)"),
                              ({"findings": [{"kind": "hanging-nodes"}]}, "hanging nodes")):
            self.assertIn(part, made.reason_to_leave_out("none", program, {**quality, **changed}, 100))

    def test_catalogue_of_the_program(self):
        catalogue = json.loads((STUDIES / "published.json").read_text(encoding="utf-8"))
        gear = (STUDIES / "catalogue" / "thesis" / "gear.prm").read_text(encoding="utf-8")
        for name, source in catalogue.items():
            self.assertIn(f"published file = {name}\n", gear)
            self.assertRegex(source["url"], rf"^https://.*/[0-9a-f]{{40}}/.*/{name}$")
            self.assertRegex(source["sha256"], "^[0-9a-f]{64}$")


if __name__ == "__main__":
    unittest.main()
