"""How far a long run is, and how it ends early: what scripts/validate-all and scripts/mutate share."""
import fcntl
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

INTERRUPTED = 130


class Interrupted(Exception):
    """Ctrl-C or SIGTERM."""


def catch_signals():
    """From here on the first Ctrl-C or SIGTERM raises Interrupted; a second one kills. So does a closed pipe, quietly."""
    def stop(number, _frame):
        signal.signal(number, signal.SIG_DFL)
        raise Interrupted

    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)


def duration(seconds):
    seconds = round(seconds)
    return f"{seconds} s" if seconds < 100 else f"{seconds // 60} min {seconds % 60:02} s"


def only_one(folder):
    """Keeps a second run out of a folder, as long as what it returns is open."""
    folder.mkdir(parents=True, exist_ok=True)
    lock = open(folder / "lock", "w", encoding="utf-8")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: another one works in {folder}")
    return lock


class Progress:
    """A bar on stderr that redraws itself, on a terminal alone."""

    COLUMNS = 30

    def __init__(self):
        self.shown = sys.stderr.isatty()
        self.drawn = False

    def show(self, share, text):
        if self.shown:
            full = round(self.COLUMNS * min(1.0, share))
            print(f"\r[{'=' * full:{self.COLUMNS}}] {text}\x1b[K", end="", file=sys.stderr, flush=True)
            self.drawn = True

    def clear(self):
        if self.drawn:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
            self.drawn = False

    def say(self, line):
        """A line of output, above the bar."""
        self.clear()
        print(line, flush=True)


def write_whole(path, text):
    """The file has the old text or the new one, whenever the process ends."""
    part = f"{path}.part"
    with open(part, "w") as file:
        file.write(text)
    os.replace(part, path)


def write_json(path, value):
    write_whole(path, json.dumps(value, indent=1) + "\n")


def start(command, log, **options):
    """A child in a group of its own, which Ctrl-C does not reach, with all it prints in the file `log`."""
    with open(log, "w") as file:
        return subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                start_new_session=True, **options)


def kill(child):
    """The child and its own children."""
    if child.poll() is None:
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()


def wait(child, seconds=None, tick=None):
    """The exit status, or None if it took longer and was killed. `tick` is called several times a second."""
    begun = time.monotonic()
    try:
        while True:
            try:
                return child.wait(timeout=0.2)
            except subprocess.TimeoutExpired:
                if tick:
                    tick()
                if seconds is not None and time.monotonic() - begun > seconds:
                    return None
    finally:
        kill(child)
