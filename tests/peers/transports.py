"""Compares the transports of canspec's runtime with other people's: messages of all sizes, both ways.

Called as `transports.py TRANSPORTS` with the program; `.ci/peers` does that. The bus is a list, and time a number.
"""

import random
import subprocess
import sys

import isotp
import isotp.tools
from j1939 import j1939_21

OURS, THEIRS, ALL = 0x80, 0x90, 0xFF
# Identifiers of ISO-TP, which differ by 8.
REQUEST, RESPONSE = 0x7E0, 0x7E8


class Node:
    """A node that speaks by canspec's runtime."""

    def __init__(self, program, *arguments):
        pipe = subprocess.PIPE
        self.program = subprocess.Popen([program, *map(str, arguments)], stdin=pipe, stdout=pipe, text=True)

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

    def perf_counter_ns(self):
        return round(self.now * 1e9)


def word(sign, identifier, data):
    return f"{identifier:X}{sign}{bytes(data).hex().upper()}"


def parted(text):
    identifier, _, data = text.replace("#", "=").partition("=")
    return int(identifier, 16), bytearray.fromhex(data)


class J1939:
    """A node that speaks by can-j1939, and allows some packets at once."""

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


class IsoTp:
    """A node that speaks by can-isotp, and asks for blocks and a separation."""

    def __init__(self, block, separation, padding):
        self.clock = isotp.tools.time = Clock()
        self.came, self.frames, self.words = [], [], []
        settings = {"blocksize": block, "stmin": separation, "tx_padding": padding}
        settings["tx_data_min_length"] = None if padding is None else 8
        self.layer = isotp.TransportLayerLogic(
            rxfn=lambda _: self.came.pop(0) if self.came else None,
            txfn=lambda frame: self.frames.append(word("#", frame.arbitration_id, frame.data)),
            address=isotp.Address(txid=RESPONSE, rxid=REQUEST),
            error_handler=lambda error: self.words.append(f"!{type(error).__name__}"),
            params=settings | {"wait_func": lambda _: None},
        )

    def send(self, message):
        self.layer.send(parted(message)[1])

    def take(self, frame):
        identifier, data = parted(frame)
        self.came.append(isotp.CanMessage(arbitration_id=identifier, data=data))

    def taken(self):
        """Lets the node work, and waits for it if it has nothing to say yet. Returns its frames."""
        while not self.frames:
            self.layer.process()
            while (message := self.layer.recv()) is not None:
                self.words.append(word("=", REQUEST, message))
            delay = self.layer.next_cf_delay()
            if delay:
                self.clock.now += delay + 1e-9
            elif not self.came and not self.frames:
                break
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


def isotp_messages(sizes, rng):
    """Messages in both directions."""
    for size in sizes:
        yield word("=", REQUEST, rng.randbytes(size)), True
        yield word("=", RESPONSE, rng.randbytes(size)), False


def compare_j1939(program, rng):
    count = 0
    # One packet at a time takes long, so these are the sizes next to a change of the last or the first packets.
    edges = [9, 10, 13, 14, 15, 20, 21, 22, 112, 113, 1784, 1785]
    # The most packets that either node lets come at once.
    settings = [(255, 255, range(9, 1786)), (255, 16, range(9, 1786, 100)), (5, 255, edges), (255, 1, edges)]
    for mine, other, sizes in settings:
        messages = list(j1939_messages(sizes, rng))
        with Node(program, "j1939", mine) as ours:
            demand_none(failures(ours, J1939(other), messages), f"can-j1939, {mine} and {other} packets at once")
        count += len(messages)
    print(f"can-j1939: {count} messages of 9 to 1785 bytes come over, both ways, to one node and to all")


def compare_isotp(program, rng):
    count = 0
    # Every size with up to three digits in base 7, some larger ones, and the last two frames of the largest.
    many = [*range(1, 344), *range(344, 4080, 83), *range(4080, 4096)]
    edges = [1, 6, 7, 8, 13, 14, 20, 21, 111, 112, 118, 119, 255, 256, 4089, 4090, 4095]
    # Block, separation and padding: those of our node, and those of the other one.
    settings = [
        ((0, 0), (0, 0, None), many),
        ((8, 0, 0xCC), (15, 0, 0xAA), many),
        ((1, 0xF3, 0x00), (1, 10, 0xFF), edges),
        ((255, 127), (254, 0xF9, 0x55), edges),
    ]
    for mine, other, sizes in settings:
        messages = list(isotp_messages(sizes, rng))
        with Node(program, "isotp", *mine) as ours:
            demand_none(failures(ours, IsoTp(*other), messages), f"can-isotp, {mine} and {other}")
        count += len(messages)
    print(f"can-isotp: {count} messages of 1 to 4095 bytes come over, both ways")


def demand_none(failures, where):
    failures = list(failures)
    if failures:
        raise SystemExit(f"{where}: {len(failures)} messages do not come over, such as {failures[0]}")


def main(program):
    rng = random.Random(1)
    compare_j1939(program, rng)
    compare_isotp(program, rng)


if __name__ == "__main__":
    main(*sys.argv[1:])
