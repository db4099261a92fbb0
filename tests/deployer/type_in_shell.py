"""Types lines into an interactive shell on a terminal: type_in_shell.py SHELL SETUP LINE...

SETUP is a command that the shell gets first. LINE is what is typed before Enter, a tab in it the key; prints as JSON the
words of each line as the shell then takes them.
"""

import json
import os
import pathlib
import pty
import sys
import threading
import time

PATIENCE_S = 60
START = {"bash": ["bash", "--norc", "--noprofile", "-i"], "zsh": ["zsh", "-f", "-i"]}
# `took` writes down its words. In zsh keys are those of bash, and completion is there once it has been asked for.
FIRST = {"bash": "", "zsh": "bindkey -e; autoload -U compinit && compinit -u -D; "}
TOOK = """took() { printf '%s\\n' "$@" > words; : > words.whole; }"""
BEGINNING_OF_LINE = "\x01"

shell, setup, lines = sys.argv[1], sys.argv[2], sys.argv[3:]
words, whole = pathlib.Path("words"), pathlib.Path("words.whole")
seen = bytearray()


def drain(terminal):
    """All that the shell writes, or it stands still."""
    try:
        while data := os.read(terminal, 4096):
            seen.extend(data)
    except OSError:
        pass  # the shell has ended


def enter(line):
    """Types a line; the words that `took` was called with."""
    whole.unlink(missing_ok=True)
    os.write(terminal, line.encode() + b"\n")
    end = time.monotonic() + PATIENCE_S
    while not whole.exists():
        if time.monotonic() > end:
            raise SystemExit(f"{line!r} was not taken: {seen.decode(errors='replace')}")
        time.sleep(0.005)
    return words.read_text().splitlines()


child, terminal = pty.fork()
if child == 0:
    os.environ.update(HISTFILE="", INPUTRC="/dev/null", PS1="> ", TERM="dumb")
    os.execvp(shell, START[shell])
threading.Thread(target=drain, args=(terminal,), daemon=True).start()
enter(f"{FIRST[shell]}{TOOK}; {setup}; took")
print(json.dumps([enter(f"{line}{BEGINNING_OF_LINE}took ") for line in lines]))
os.write(terminal, b"exit\n")
os.waitpid(child, 0)
