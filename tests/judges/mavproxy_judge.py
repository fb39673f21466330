"""Flies the craft at a MAVLink door with MAVProxy: `mavproxy_judge.py ADDRESS`. Ends with 0 if everything was as expected."""

import pathlib
import queue
import subprocess
import sys
import tempfile
import threading
import time

PATIENCE_S = 120
WAYPOINTS = """QGC WPL 110
0\t1\t0\t16\t0\t0\t0\t0\t40.4635\t-79.5182\t300\t1
1\t0\t3\t16\t0\t0\t0\t0\t40.4639\t-79.5182\t12\t1
2\t0\t3\t16\t0\t0\t0\t0\t40.4639\t-79.5177\t12\t1
3\t0\t3\t21\t0\t0\t0\t0\t40.4635\t-79.5177\t0\t1
"""


class Proxy:
    def __init__(self, address, folder):
        program = pathlib.Path(sys.executable).with_name("mavproxy.py")
        modules = "arm,mode,wp,param,cmdlong,misc"
        options = [f"--master=tcp:{address}", f"--state-basedir={folder}", f"--default-modules={modules}"]
        pipes = dict(stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.process = subprocess.Popen([sys.executable, program, *options], text=True, cwd=folder, **pipes)
        self.lines, self.seen = queue.Queue(), []
        threading.Thread(target=lambda: [self.lines.put(line) for line in self.process.stdout], daemon=True).start()

    def type(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def wait(self, *words, again=None):
        """Waits for a line with one of the words. Types a line again once a second until then."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            try:
                line = self.lines.get(timeout=1)
            except queue.Empty:
                if again:
                    self.type(again)
                continue
            self.seen.append(line.rstrip())
            if any(word in line for word in words):
                return line
        raise AssertionError(f"never: {words}\n" + "\n".join(self.seen))


def main(address):
    with tempfile.TemporaryDirectory() as folder:
        began = time.monotonic()
        proxy = Proxy(address, folder)
        try:
            fly(proxy, pathlib.Path(folder), began)
        finally:
            proxy.process.kill()
            proxy.process.wait()
    print("MAVProxy: as expected")


def fly(proxy, folder, began):
    proxy.wait("Detected vehicle", "online system 1")
    print(f"connected in {time.monotonic() - began:.2f} s")
    proxy.wait("parameters", "Received")
    (folder / "sent.txt").write_text(WAYPOINTS)
    proxy.type(f"wp load {folder / 'sent.txt'}")
    proxy.wait("LAND is that of the ground")
    proxy.type("wp list")
    proxy.wait("waypoints to")
    proxy.type(f"wp save {folder / 'back.txt'}")
    end = time.monotonic() + PATIENCE_S
    while not (folder / "back.txt").exists() or (folder / "back.txt").read_text().count("\n") < 4:
        assert time.monotonic() < end, "no saved waypoints"
        time.sleep(0.1)
    back = [line.split("\t") for line in (folder / "back.txt").read_text().splitlines()[1:]]
    places = lambda lines: [(line[3], f"{float(line[8]):.5f}", f"{float(line[9]):.5f}") for line in lines]
    sent = [line.split("\t") for line in WAYPOINTS.splitlines()[1:]]
    assert places(back)[-3:] == places(sent)[-3:], (back, sent)

    proxy.type("arm throttle")
    proxy.wait("ARMED", again="arm throttle")
    proxy.type("long NAV_TAKEOFF 0 0 0 0 0 0 8")
    proxy.wait("NAV_TAKEOFF: ACCEPTED")
    time.sleep(4)
    proxy.type("disarm")
    proxy.wait("would fall")
    proxy.type("long MISSION_START")
    proxy.wait("MISSION_START: ACCEPTED")
    proxy.wait("waypoint 2")
    proxy.type("long DO_PAUSE_CONTINUE 0")
    proxy.wait("DO_PAUSE_CONTINUE: ACCEPTED")
    proxy.type("long DO_PAUSE_CONTINUE 1")
    proxy.wait("DO_PAUSE_CONTINUE: ACCEPTED")
    proxy.type("long NAV_RETURN_TO_LAUNCH")
    proxy.wait("NAV_RETURN_TO_LAUNCH: ACCEPTED")
    proxy.wait("DISARMED")


main(sys.argv[1])
