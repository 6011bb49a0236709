#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How other machines and headsets reach the server: addresses, QR code, https with Embody's own certificate or one that is named.

Usage: reach.py EMBODY
"""
import http.client
import json
import os
import pathlib
import re
import signal
import ssl
import socket
import stat
import subprocess
import sys
import tempfile
import unittest

from viewer import Viewer

EMBODY = sys.argv.pop(1)


class Reach(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.tls = self.folder / "embody" / "tls"
        self.server = None

    def words(self, *more: str) -> list:
        return [EMBODY, "serve", "--port", "0", "--database", str(self.folder / "models.sqlite"), *more]

    def environment(self) -> dict:
        return {**os.environ, "XDG_DATA_HOME": str(self.folder)}

    def start(self, *more: str) -> str:
        """What the server prints until it serves."""
        self.server = subprocess.Popen(self.words(*more), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=self.environment())
        printed = ""
        while "Stop with Ctrl+C" not in printed:
            line = self.server.stdout.readline()
            self.assertTrue(line, printed)
            printed += line
        self.port = int(re.search(r"^Studio: https?://[^/]*:(\d+)/", printed)[1])
        return printed

    def stop(self):
        self.server.send_signal(signal.SIGINT)
        self.server.communicate(timeout=60)
        self.assertEqual(self.server.returncode, 0)
        self.server = None

    def tearDown(self):
        if self.server is not None:
            self.server.kill()
            self.server.communicate()

    def refusal(self, *more: str) -> str:
        ended = subprocess.run(self.words(*more), capture_output=True, text=True, env=self.environment(), timeout=60)
        self.assertNotEqual(ended.returncode, 0)
        return ended.stderr

    def trusting(self) -> ssl.SSLContext:
        """Trusts the server's own certificate and no other, and checks the name."""
        return ssl.create_default_context(cafile=str(self.tls / "certificate.pem"))

    def get(self, path: str, host: str = "127.0.0.1", **headers: str):
        connection = http.client.HTTPSConnection(host, self.port, context=self.trusting(), timeout=60)
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer, body

    def test_https_serves_pages_models_and_websockets(self):
        printed = self.start("--tls")
        self.assertIn("Studio: https://127.0.0.1:", printed)
        self.assertIn("fingerprint", printed)
        self.assertEqual(stat.S_IMODE((self.tls / "key.pem").stat().st_mode), 0o600)
        for host in ("127.0.0.1", "localhost"):
            answer, body = self.get("/api/health", host)
            self.assertEqual((answer.status, json.loads(body)["name"]), (200, "embody"))
        viewer = Viewer(self.port, context=self.trusting())
        self.assertTrue(viewer.do("hello")["server"]["tls"])
        # Larger than what TLS sends at once.
        viewer.do("scene.load", scene={"embody_scene": 1, "description": "x" * 3_000_000, "entities": []})
        self.assertEqual(len(viewer.do("hello")["scene"]["description"]), 3_000_000)
        viewer.close()
        upload = http.client.HTTPSConnection("127.0.0.1", self.port, context=self.trusting(), timeout=60)
        upload.request("POST", "/import?name=one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + "# x\n" * 300_000)
        self.assertEqual(json.loads(upload.getresponse().read())["added"], 1)
        upload.close()
        self.stop()

    def test_plain_http_is_sent_to_https_and_pages_of_http_are_foreign(self):
        self.start("--tls")
        plain = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        plain.request("GET", "/?scene=x")
        answer = plain.getresponse()
        self.assertEqual((answer.status, answer.getheader("Location")), (307, f"https://127.0.0.1:{self.port}/?scene=x"))
        answer.read()
        plain.close()
        plain = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        plain.request("POST", "/import?name=a.obj", "v 0 0 0")
        self.assertEqual(plain.getresponse().status, 403)
        plain.close()
        here = f"127.0.0.1:{self.port}"
        self.assertEqual(self.get("/api/health", Origin=f"https://{here}")[0].status, 200)
        self.assertEqual(self.get("/api/health", Origin=f"http://{here}")[0].status, 403)
        # Who talks neither, or stops in between, hinders nobody.
        for begin in (b"\x16\x03\x01\x02\x00\x01\x00", b"\x16\x03\x01\x00\x05hello", b"\x00\x01\x02"):
            odd = socket.create_connection(("127.0.0.1", self.port))
            odd.sendall(begin)
            self.addCleanup(odd.close)
        self.assertEqual(self.get("/api/health")[0].status, 200)
        self.stop()

    def test_the_own_certificate_stays_and_named_ones_are_checked(self):
        self.start("--tls")
        self.stop()
        before = (self.tls / "certificate.pem").read_bytes()
        self.start("--tls")
        self.stop()
        self.assertEqual((self.tls / "certificate.pem").read_bytes(), before)
        named = [self.folder / "named.pem", self.folder / "named.key"]
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj", "/CN=own",
                        "-addext", "subjectAltName=IP:127.0.0.1", "-out", str(named[0]), "-keyout", str(named[1])], check=True, capture_output=True)
        self.assertNotIn("fingerprint", self.start("--certificate", str(named[0]), "--key", str(named[1])))
        context = ssl.create_default_context(cafile=str(named[0]))
        with socket.create_connection(("127.0.0.1", self.port)) as plain, context.wrap_socket(plain, server_hostname="127.0.0.1") as secure:
            self.assertGreaterEqual(secure.version(), "TLSv1.2")
        self.stop()
        self.assertIn("is not the key of", self.refusal("--certificate", str(named[0]), "--key", str(self.tls / "key.pem")))
        self.assertIn("cannot be read", self.refusal("--certificate", str(self.folder / "none.pem"), "--key", str(named[1])))
        self.assertIn("--key", self.refusal("--certificate", str(named[0])))

    def test_other_machines_get_addresses_with_the_token(self):
        printed = self.start("--address", "0.0.0.0", "--qr")
        self.assertRegex(printed, r"Studio: http://127\.0\.0\.1:\d+/\?token=[0-9a-f]{32}\n")
        others = re.findall(r"^    (http://(\S+):\d+/\?token=[0-9a-f]{32})$", printed, re.M)
        local = subprocess.run(["hostname", "-I"], capture_output=True, text=True).stdout.split()
        for _, address in others:
            self.assertIn(address, local)
            self.assertFalse(address.startswith(("127.", "169.254.")))
        if any("." in address and not address.startswith("169.254.") for address in local):
            self.assertTrue(others, printed)
            self.assertIn("add --tls", printed)
        self.stop()

    def test_the_qr_code_has_its_marks_and_quiet_zone(self):
        printed = self.start("--qr")
        rows = [line for line in printed.splitlines() if line and not set(line) - set("█▀▄ ")]
        light = []
        for row in rows:
            light.append([mark in "█▀" for mark in row])
            light.append([mark in "█▄" for mark in row])
        size = len(light[0]) - 8
        self.assertEqual((size - 17) % 4, 0)
        code = [row[4:4 + size] for row in light[4:4 + size]]
        self.assertTrue(all(all(row) for row in light[:4]) and all(all(row[:4] + row[-4:]) for row in light))
        mark = ["#######", "#     #", "# ### #", "# ### #", "# ### #", "#     #", "#######"]
        for top, left in ((0, 0), (0, size - 7), (size - 7, 0)):
            self.assertEqual(["".join(" " if code[top + y][left + x] else "#" for x in range(7)) for y in range(7)], mark)
        # The timing pattern between the marks alternates.
        self.assertEqual([code[6][x] for x in range(8, size - 8)], [x % 2 == 1 for x in range(8, size - 8)])
        self.stop()


if __name__ == "__main__":
    unittest.main()
