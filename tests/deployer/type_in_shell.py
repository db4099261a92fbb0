"""Types lines into an interactive shell on a terminal: type_in_shell.py SHELL SETUP LINE...

SETUP is the first command of the shell. LINE is the text typed before Enter, a tab is the tab key. Prints as JSON the
words of each line as the shell receives them.
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
# `took` records its words. In zsh keys are those of bash, and completion works once it has been requested.
FIRST = {"bash": "", "zsh": "bindkey -e; autoload -U compinit && compinit -u -D; "}
TOOK = """took() { printf '%s\\n' "$@" > words; : > words.whole; }"""
BEGINNING_OF_LINE = "\x01"

shell, setup, lines = sys.argv[1], sys.argv[2], sys.argv[3:]
words, whole = pathlib.Path("words"), pathlib.Path("words.whole")
seen = bytearray()


def drain(terminal):
    """Reads all output of the shell, which would block otherwise."""
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
