"""Compares the transports of canspec's runtime with other people's: messages of all sizes, both ways.

Called as `transports.py TRANSPORTS` with the program; `.ci/peers` does that. The bus is a list, and time a number.
"""

import random
import subprocess
import sys
from collections import Counter

from j1939 import j1939_21

OURS, THEIRS, ALL = 0x80, 0x90, 0xFF


class Node:
    """A node that speaks by canspec's runtime."""

    def __init__(self, program, transport):
        pipe = subprocess.PIPE
        self.program = subprocess.Popen([program, transport], stdin=pipe, stdout=pipe, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.program.communicate()

    def told(self, words):
        """Returns the frames that the node sends after some words, and the other words of its answer."""
        self.program.stdin.write(" ".join(words) + "\n")
        self.program.stdin.flush()
        answer = self.program.stdout.readline().split()
        return [word for word in answer if "#" in word], [word for word in answer if "#" not in word]


class Clock:
    """The time of a peer, in place of the module `time`."""

    def __init__(self):
        self.now = 1.0

    def time(self):
        return self.now


def word(sign, identifier, data):
    return f"{identifier:X}{sign}{bytes(data).hex().upper()}"


def parted(text):
    identifier, _, data = text.replace("#", "=").partition("=")
    return int(identifier, 16), bytearray.fromhex(data)


class J1939:
    """A node that speaks by can-j1939, and allows some packets at once."""

    transport = "j1939"

    def __init__(self, packets):
        self.clock = j1939_21.time = Clock()
        self.frames, self.words = [], []
        self.layer = j1939_21.J1939_21(
            self.frame, lambda: None, self.message, packets, None, None, lambda address: address == THEIRS
        )

    def frame(self, identifier, _, data):
        self.frames.append(word("#", identifier, data))

    def message(self, _priority, group, source, target, _time, data):
        target = target if group >> 8 & 0xFF < 0xF0 else 0
        self.words.append(word("=", group << 8 | target << 8 | source, data))

    def send(self, message):
        identifier, data = parted(message)
        page, pdu, target, source = identifier.to_bytes(4, "big")
        assert self.layer.send_pgn(page, pdu, target, 6, source, data, 0, None), message

    def take(self, frame):
        self.layer.notify(*parted(frame), self.clock.now)

    def taken(self):
        """Lets the node work, and waits for it if it has nothing to say yet. Returns its frames."""
        while not self.frames:
            wake = self.layer.async_job_thread(self.clock.now)
            # Without anything to wait for it comes again in five seconds, or at once if it is stuck.
            if self.frames or not 0 < wake - self.clock.now < 4:
                break
            self.clock.now = wake
        frames, self.frames = self.frames, []
        return frames


def exchange(ours, theirs, message, is_ours, spoilt=lambda frame: [frame]):
    """Sends a message, over a bus that may spoil each frame. Returns what both nodes say in the end."""
    theirs.words, said, words = [], [], []
    if is_ours:
        words = [message]
    else:
        theirs.send(message)
    while True:
        frames, more = ours.told(words) if words else ([], [])
        said += more
        for frame in frames:
            for changed in spoilt(frame):
                theirs.take(changed)
        words = [changed for frame in theirs.taken() for changed in spoilt(frame)]
        if not words:
            return said, theirs.words


def failures(ours, theirs, messages, spoilt=lambda frame: [frame]):
    """Returns the messages that do not come over whole, once, and nothing else."""
    for message, is_ours in messages:
        expected = (["sent"], [message]) if is_ours else ([message], [])
        if exchange(ours, theirs, message, is_ours, spoilt) != expected:
            yield message


def j1939_messages(sizes, rng):
    """Messages to one node (RTS/CTS) and to all (BAM), with a format for a receiver and with one that has none."""
    for size in sizes:
        for is_ours in (True, False):
            source, target = (OURS, THEIRS) if is_ours else (THEIRS, OURS)
            for group in (0xEF00 | target, 0xEF00 | ALL, 0x1FF12):
                yield word("=", group << 8 | source, rng.randbytes(size)), is_ours


def main(program):
    rng, counts = random.Random(1), Counter()
    # One packet at a time takes long, so these are the sizes next to a change of the last or the first packets.
    edges = [9, 10, 13, 14, 15, 20, 21, 22, 112, 113, 1784, 1785]
    for packets, sizes in ((255, range(9, 1786)), (16, range(9, 1786, 100)), (1, edges)):
        with Node(program, "j1939") as ours:
            messages = list(j1939_messages(sizes, rng))
            counts["messages"] += len(messages)
            wrong = list(failures(ours, J1939(packets), messages))
            if wrong:
                raise SystemExit(f"can-j1939, {packets} packets at once: {len(wrong)} do not come over: {wrong[0]}")
    print(f"can-j1939: {counts['messages']} messages of 9 to 1785 bytes come over, both ways, to one node and to all")


if __name__ == "__main__":
    main(*sys.argv[1:])
