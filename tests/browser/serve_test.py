#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`exactvo serve` over sockets, without a browser: which clients are let in, what is refused, and how it ends.

serve_test.py --program EXACTVO [TEST...]. Exit status 77 where the program was built without a server.
"""
import argparse
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.parse
import zlib

ARGS = None
NO_SERVER = "E_NOT_BUILT"

SCENARIO = {"name": "wall", "guidance": "none", "liveness": "off", "time_limit": 3,
            "robots": [{"id": "R1", "position": [0, 0], "goal": [12, 0], "max_speed": 2}],
            "obstacles": [{"id": "wall", "polyline": [[6, -3], [6, 3]]}]}


class Served:
    """A server in a folder of its own."""

    def __init__(self, place, *arguments, environment=None):
        self.process = subprocess.Popen([ARGS.program, "serve", *arguments], cwd=place, text=True, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, env={**os.environ, **(environment or {})})
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise RuntimeError(self.process.communicate()[1])
        parts = urllib.parse.urlsplit(self.address)
        self.port, self.path = parts.port, parts.path

    def stop(self, how=signal.SIGINT):
        self.process.send_signal(how)
        _, words = self.process.communicate(timeout=60)
        return self.process.returncode, words

    def send(self, raw, timeout=60):
        """The whole answer to these bytes; empty where the connection was closed without one."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=timeout) as connection:
            try:
                connection.sendall(raw)
            except OSError:
                pass  # it may answer and close before all is sent
            answer = b""
            try:
                while True:
                    some = connection.recv(65536)
                    if not some:
                        return answer
                    answer += some
            except OSError:
                return answer

    def request(self, method, path, body=b"", **headers):
        """(status, body). `headers` replace the usual ones; None leaves one out."""
        usual = {"Host": f"127.0.0.1:{self.port}"}
        if method == "POST":
            usual.update({"Content-Type": "application/json", "Content-Length": str(len(body))})
        usual.update({name.replace("_", "-"): value for name, value in headers.items()})
        lines = [f"{method} {path} HTTP/1.1", *(f"{name}: {value}" for name, value in usual.items() if value is not None)]
        answer = self.send("\r\n".join(lines).encode() + b"\r\n\r\n" + body)
        if not answer:
            return 0, b""
        head, _, rest = answer.partition(b"\r\n\r\n")
        return int(head.split()[1]), rest

    def ask(self, what="decide", **change):
        question = {"run": self.key(), "scenario": SCENARIO, **change}
        return self.request("POST", self.path + what, json.dumps(question).encode())

    def key(self):
        return "wall--orca"


def head_of(packed):
    data = zlib.decompress(packed)
    length = int.from_bytes(data[8:12], "little")
    return json.loads(data[12:12 + length])


class Serve(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = pathlib.Path(tempfile.mkdtemp(prefix="exactvo_serve_"))
        (cls.place / "s.json").write_text(json.dumps(SCENARIO))
        cls.server = Served(cls.place, "s.json", "--method", "orca")

    @classmethod
    def tearDownClass(cls):
        cls.server.stop()
        shutil.rmtree(cls.place, ignore_errors=True)

    def tearDown(self):
        self.assertEqual(self.server.ask()[0], 200, "it must still answer")

    def test_the_page_asks_only_its_own_server(self):
        status, page = self.server.request("GET", self.server.path)
        self.assertEqual(status, 200)
        self.assertIn(b"default-src 'none'; connect-src 'self';", page)
        self.assertEqual(page.count(b"connect-src"), 1)
        raw = self.server.send(f"GET {self.server.path} HTTP/1.1\r\nHost: 127.0.0.1:{self.server.port}\r\n\r\n".encode())
        head = raw.split(b"\r\n\r\n")[0].decode()
        for words in ["Content-Security-Policy: default-src 'none'; connect-src 'self'; ", "frame-ancestors 'none'", "Referrer-Policy: no-referrer",
                      "X-Content-Type-Options: nosniff", "Cross-Origin-Resource-Policy: same-origin", "Cache-Control: no-store"]:
            self.assertIn(words, head)
        self.assertNotIn("Access-Control", head)

    def test_it_listens_on_the_loopback_alone(self):
        inodes = [line.split() for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]]
        listening = [words[1] for words in inodes if words[3] == "0A" and int(words[1].split(":")[1], 16) == self.server.port]
        self.assertEqual(listening, [f"0100007F:{self.server.port:04X}"])

    def test_another_token_is_not_let_in(self):
        token = self.server.path.strip("/")
        self.assertRegex(token, "^[0-9a-f]{32}$")
        wrong = [token[:-1] + ("0" if token[-1] != "0" else "1"), "0" * 32, token[:-1], token + "0", "", token.upper() + "x"]
        for other in wrong:
            with self.subTest(other):
                self.assertEqual(self.server.request("GET", f"/{other}/")[0], 404)
                self.assertEqual(self.server.request("POST", f"/{other}/decide", b"{}")[0], 404)
        self.assertEqual(self.server.request("GET", "/")[0], 404)

    def test_each_start_has_its_own_token(self):
        other = Served(self.place, "s.json")
        self.assertNotEqual(other.path, self.server.path)
        other.stop()

    def test_another_host_or_origin_is_not_let_in(self):
        """A page elsewhere whose name resolves to 127.0.0.1, or that sends a form here."""
        port = self.server.port
        for host in ["evil.example", f"evil.example:{port}", "127.0.0.1", "127.0.0.1:1", f"127.0.0.1:{port}.evil.example", f"[::1]:{port}",
                     f"0.0.0.0:{port}", f"127.0.0.1:{port}, evil.example", "", None]:
            with self.subTest(host):
                self.assertIn(self.server.request("GET", self.server.path, Host=host)[0], [400, 403])
        twice = self.server.send(f"GET {self.server.path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nHost: evil.example\r\n\r\n".encode())
        self.assertIn(b" 403 ", twice.split(b"\r\n")[0])
        self.assertEqual(self.server.request("GET", self.server.path, Host=f"localhost:{port}")[0], 200)
        question = json.dumps({"run": "wall--orca", "scenario": SCENARIO}).encode()
        for origin in ["http://evil.example", "null", f"https://127.0.0.1:{port}", f"http://127.0.0.1:{port}.evil.example", "http://127.0.0.1"]:
            with self.subTest(origin):
                self.assertEqual(self.server.request("POST", self.server.path + "decide", question, Origin=origin)[0], 403)
        self.assertEqual(self.server.request("POST", self.server.path + "decide", question, Origin=f"http://127.0.0.1:{port}")[0], 200)

    def test_a_question_is_plain_json_of_a_bounded_size(self):
        decide = self.server.path + "decide"
        for headers in [{"Content_Type": "text/plain"}, {"Content_Type": None}, {"Content_Type": "application/x-www-form-urlencoded"},
                        {"Content_Type": "multipart/form-data; boundary=x"}, {"Content_Encoding": "gzip"}, {"Content_Encoding": "br"}]:
            with self.subTest(headers):
                self.assertEqual(self.server.request("POST", decide, b"{}", **headers)[0], 415)
        self.assertEqual(self.server.request("POST", decide, b"2\r\n{}\r\n0\r\n\r\n", Transfer_Encoding="chunked", Content_Length=None)[0], 415)
        for length in ["9000000", "99999999999999999999", "-1", "0x10", "", None]:
            with self.subTest(length):
                self.assertIn(self.server.request("POST", decide, b"{}", Content_Length=length)[0], [400, 413])
        self.assertIn(self.server.request("POST", decide, b"x" * (9 << 20))[0], [0, 413])
        self.assertEqual(self.server.request("PUT", decide, b"")[0], 405)
        self.assertEqual(self.server.request("DELETE", decide)[0], 405)

    def test_a_head_of_any_kind_is_survived(self):
        port, path = self.server.port, self.server.path
        ranges = ",".join("0-" for _ in range(2600))
        host = f"Host: 127.0.0.1:{port}\r\n"
        for raw in [f"GET {path} HTTP/1.1\r\n{host}Range: bytes={ranges}\r\n\r\n", f"GET /{'a' * 100000} HTTP/1.1\r\n{host}\r\n",
                    f"GET {path} HTTP/1.1\r\n{host}X: {'y' * 100000}\r\n\r\n", "".join([f"GET /x/ HTTP/1.1\r\n{host}"] + ["X: y\r\n"] * 20000 + ["\r\n"]),
                    "\r\n\r\n\r\n", "GET\r\n\r\n", "\x00\xff\x00", f"GET {path} HTTP/9.9\r\n{host}\r\n", f"GET {path}%zz HTTP/1.1\r\n{host}\r\n",
                    f"GET {path}%00 HTTP/1.1\r\n{host}\r\n", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"]:
            with self.subTest(raw[50:120]):
                answer = self.server.send(raw.encode("latin-1"), timeout=30)
                self.assertFalse(answer.startswith(b"HTTP/1.1 200"), answer[:100])

    def test_no_file_is_read(self):
        (self.place / "secret.wkt").write_text("POLYGON((20 20, 21 20, 21 21, 20 21, 20 20))")
        (self.place / "secret.csv").write_text("x,y,goal_x,goal_y\n0,0,1,1\n")
        for path in ["../s.json", "..%2fs.json", "%2e%2e/%2e%2e/etc/passwd", "s.json", "....//s.json", "/etc/passwd", "decide/../../s.json"]:
            with self.subTest(path):
                self.assertEqual(self.server.request("GET", self.server.path + path)[0], 404)
        for scenario in [{**SCENARIO, "obstacles": [{"file": name}]} for name in ["secret.wkt", str(self.place / "secret.wkt"), "/etc/passwd", "/dev/stdin"]] + \
                [{**SCENARIO, "robots": robots} for robots in ([{"file": str(self.place / "secret.csv")}], {"file": str(self.place / "secret.csv")})]:
            status, body = self.server.ask(scenario=scenario)
            self.assertEqual(status, 400)
            self.assertEqual(json.loads(body)["code"], "E_PATH_ESCAPE")

    def test_moments_among_discs_and_movers_are_computed(self):
        robot = {**SCENARIO["robots"][0], "velocity": [0.2, 0]}
        mover = {"id": "M", "disc": {"centre": [8, 6], "radius": 0.3}, "path": [[8, 6], [8, 9]], "speed": 0.1, "max_speed": 0.2}
        scenario = {**SCENARIO, "robots": [robot], "obstacles": [{"disc": {"centre": [-9, 9], "radius": 1}}], "moving_obstacles": [mover],
                    "acceleration": {"max": 1}, "guidance": "none"}
        for preferred in [None, [0, 0.3]]:
            with self.subTest(preferred):
                status, body = self.server.ask(scenario=scenario, time=1, robot=0, preferred=preferred)
                self.assertEqual(status, 200, body)

    def test_garbage_is_refused_with_its_place(self):
        decide = self.server.path + "decide"
        for body, code in [(b"", "E_JSON_SYNTAX"), (b"{", "E_JSON_SYNTAX"), (b"\xff\xfe", "E_JSON_SYNTAX"), (b"[" * 1000000, "E_NESTING"), (b"[]", "E_TYPE"),
                           (b"null", "E_TYPE"), (b"{}", "E_KEY_MISSING"), (b'{"run": 1}', "E_TYPE"), (b'{"run": "other"}', "E_OPTION"),
                           (b'{"run": "wall--orca"}', "E_KEY_MISSING"), (b'{"run": "wall--orca", "scenario": NaN}', "E_JSON_SYNTAX"),
                           (b'{"run": "wall--orca", "scenario": {"name": "x"}}', "E_KEY_MISSING"), (os.urandom(2000), "E_JSON_SYNTAX")]:
            with self.subTest(body[:40]):
                status, answer = self.server.request("POST", decide, body)
                self.assertEqual((status, json.loads(answer)["code"]), (400, code))
        robot = SCENARIO["robots"][0]
        for change, place in [({"robots": [{**robot, "radius": 0}]}, "/robots/0/radius"), ({"robots": [{**robot, "position": [0, "x"]}]}, "/robots/0/position/1"),
                              ({"robots": [{**robot, "position": [6, 0]}]}, "/robots/0/position"), ({"time_step": -1}, "/time_step"),
                              ({"robots": [{"circle": {"count": 10**9, "radius": 5}}]}, "/scenario/robots/0"),
                              ({"robots": {"circle": {"count": 10**9}}}, "/scenario/robots"), ({"robots": [robot] * 1001}, "/scenario/robots")]:
            with self.subTest(place):
                status, answer = self.server.ask(scenario={**SCENARIO, **change})
                self.assertEqual((status, json.loads(answer)["place"]), (400, place))
        for change, place in [({"robot": 1}, "/robot"), ({"robot": -1}, "/robot"), ({"robot": "R1"}, "/robot"), ({"robot": 0.5}, "/robot"),
                              ({"preferred": [1, 0], "preferred_robot": 1}, "/preferred_robot"), ({"preferred": [1]}, "/preferred"),
                              ({"preferred": [1, None]}, "/preferred/1"), ({"preferred": [1e300, 0]}, "/preferred/0"), ({"time": -1}, "/time"),
                              ({"time": "now"}, "/time"), ({"method": "best"}, "/method"), ({"method": 3}, "/method")]:
            with self.subTest(change):
                status, answer = self.server.ask(**change)
                self.assertEqual((status, json.loads(answer)["place"]), (400, place))
        status, answer = self.server.request("POST", decide, b'{"run": "wall--orca", "scenario": {"name": "x", "robots": [{"id": "R1", "position": [1e999, 0], "goal": [1, 1]}]}}')
        self.assertEqual((status, json.loads(answer)["code"]), (400, "E_JSON_SYNTAX"))

    def test_robots_are_held_against_where_things_are_at_the_moment(self):
        """They were held against the places at the beginning, and met the assertion of the simulation afterwards."""
        cart = {"id": "cart", "polygon": [[5, -4], [6, -4], [6, -3.2], [5, -3.2]], "path": [[0, 0], [5, 0]], "speed": 0.4}
        for time, x, status in [(0, 5.5, 400), (2.5, 5.3, 200), (2.5, 6.5, 400), (0, 6.5 + 0.2, 200), (10, 5.5, 200)]:
            with self.subTest((time, x)):
                robot = {**SCENARIO["robots"][0], "position": [x, -3.5], "radius": 0.2}
                found, answer = self.server.ask(scenario={**SCENARIO, "robots": [robot], "moving_obstacles": [cart]}, time=time)
                self.assertEqual(found, status)
                if status == 400:
                    self.assertEqual(json.loads(answer)["place"], "/robots/0/position")
        for change in ({"speed": -1}, {"path": []}, {"profile": [{"time": 3, "speed": 1}, {"time": 1, "speed": 1}]}):
            with self.subTest(change):
                found, answer = self.server.ask(scenario={**SCENARIO, "moving_obstacles": [{**cart, **change}]}, time=2)
                self.assertEqual(found, 400, answer[:300])

    def test_many_slow_clients_delay_no_other_for_long(self):
        slow = []
        for k in range(300):
            connection = socket.create_connection(("127.0.0.1", self.server.port), timeout=60)
            connection.sendall([b"", b"GET / HT", f"POST {self.server.path}decide HTTP/1.1\r\nHost: 127.0.0.1:{self.server.port}\r\n"
                                              f"Content-Type: application/json\r\nContent-Length: 1000\r\n\r\n{{".encode()][k % 3])
            slow.append(connection)
        begin = time.monotonic()
        statuses = []
        while time.monotonic() - begin < 50 and 200 not in statuses:
            for connection in slow[:50]:
                try:
                    connection.sendall(b" ")  # a byte now and then
                except OSError:
                    pass
            statuses.append(self.server.ask()[0])
            time.sleep(0.2)
        self.assertEqual(statuses[-1], 200, "slow clients are given up in bounded time")
        for connection in slow:
            connection.close()

    def test_questions_at_the_same_time_are_answered_each_by_itself(self):
        import concurrent.futures

        def chosen(k):
            status, packed = self.server.ask(preferred=[0.01 * k, 0])
            return status, head_of(packed)["run"]["name"]

        with concurrent.futures.ThreadPoolExecutor(24) as pool:
            self.assertEqual(list(pool.map(chosen, range(96))), [(200, "wall")] * 96)

    def test_a_run_on_from_a_moment_gives_way_to_the_next(self):
        import threading
        crossing = {"name": "long", "time_limit": 10000, "time_step": 0.001, "guidance": "none", "liveness": "off", "obstacles": [],
                    "robots": [{"id": f"R{k}", "position": [3 * k, 0], "goal": [3 * k, 9000]} for k in range(30)]}
        answers = []
        first = threading.Thread(target=lambda: answers.append(self.server.ask("run", scenario=crossing)))
        first.start()
        time.sleep(1)
        self.assertEqual(self.server.ask("run")[0], 200)
        first.join(30)
        self.assertFalse(first.is_alive())
        self.assertEqual(answers[0][0], 409)


class Ends(unittest.TestCase):
    def setUp(self):
        self.place = pathlib.Path(tempfile.mkdtemp(prefix="exactvo_serve_"))
        (self.place / "s.json").write_text(json.dumps(SCENARIO))

    def tearDown(self):
        shutil.rmtree(self.place, ignore_errors=True)

    def test_ctrl_c_ends_it_at_once_whoever_is_connected(self):
        for how in [signal.SIGINT, signal.SIGTERM]:
            server = Served(self.place, "s.json")
            idle = socket.create_connection(("127.0.0.1", server.port))
            begin = time.monotonic()
            status, words = server.stop(how)
            self.assertEqual(status, 0, words)
            self.assertIn("stopped", words)
            self.assertLess(time.monotonic() - begin, 9, "not by the watchdog")
            idle.close()

    def test_a_port_that_is_taken_is_named(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            done = subprocess.run([ARGS.program, "serve", "s.json", "--port", str(taken.getsockname()[1])], cwd=self.place, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"--port: found '\d+', expected .*\[E_PORT\]")

    def test_bad_input_starts_no_server(self):
        (self.place / "bad.json").write_text("{")
        for arguments in [["bad.json"], ["nothing.json"], ["nothing.evr"], ["s.json", "--port", "70000"], ["s.json", "s.json"]]:
            done = subprocess.run([ARGS.program, "serve", *arguments], cwd=self.place, capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)

    def test_open_hands_the_address_to_the_desktop(self):
        (self.place / "xdg-open").write_text('#!/bin/sh\nprintf %s "$1" > opened\n')
        (self.place / "xdg-open").chmod(0o755)
        server = Served(self.place, "s.json", "--open", environment={"PATH": f"{self.place}:{os.environ['PATH']}"})
        server.stop()
        self.assertEqual((self.place / "opened").read_text(), server.address)

    def test_a_run_and_the_scenes_are_served_too(self):
        subprocess.run([ARGS.program, "simulate", "s.json", "--no-figures", "--out", "run"], cwd=self.place, check=True, capture_output=True)
        for arguments in [["run"], ["run/recording.jsonl"], []]:
            server = Served(self.place, *arguments)
            self.assertEqual(server.request("GET", server.path)[0], 200)
            server.stop()

    def test_nothing_is_computed_from_a_recording_of_a_crowd(self):
        with open(os.path.join(self.place, "ring.json"), "w") as file:
            json.dump({"name": "ring", "time_limit": 2, "robots": [{"circle": {"count": 8, "radius": 5}}]}, file)
        subprocess.run([ARGS.program, "simulate", "ring.json", "--decisions", "none", "--record", "ring.evr"], cwd=self.place, check=True, capture_output=True)
        server = Served(self.place, "ring.evr")
        for what in ("decide", "run", "free"):
            status, answer = server.ask(what, run="ring--crowd")
            self.assertEqual((status, json.loads(answer)["code"]), (400, "E_OPTION"), what)
        server.stop()


def main():
    global ARGS
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("names", nargs="*")
    ARGS = parser.parse_args()
    missing = subprocess.run([ARGS.program, "serve", "no-such-file"], capture_output=True, text=True)
    if NO_SERVER in missing.stderr:
        print("skipped: built without cpp-httplib")
        sys.exit(77)
    loader = unittest.TestLoader()
    loader.testNamePatterns = [f"*{name}*" for name in ARGS.names] or None
    suite = unittest.TestSuite([loader.loadTestsFromTestCase(case) for case in (Serve, Ends)])
    sys.exit(0 if unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful() else 1)


if __name__ == "__main__":
    main()
