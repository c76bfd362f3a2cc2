#!/usr/bin/env python3
"""Lets the controller of tests/downstream/charger drive modules of INFY that this program plays on a pty.

The modules are written from the document: they switch off after 10 s of silence, and come back as they were when they
hear anything (3.1). python-can is at one end of the line, and the controller at the other one. Between them frames are
lost, and the line is cut.

It is called as `charger.py PROGRAM`.
"""

import os
import pty
import random
import select
import struct
import subprocess
import sys
import threading
import time
import tty

import can

SILENCE, GAP, ROUND = 10.0, 0.05, 2.0
SETTINGS, SWITCH, VALUES, STATUS = 0x1C, 0x1A, 0x03, 0x04


class Module:
    """A module with an address in group 1."""

    def __init__(self, address):
        self.address, self.heard, self.boots = address, time.monotonic(), 0.0
        self.volts, self.amperes, self.is_on, self.was_on = 400_000, 5_000, True, False
        self.is_bare = False

    def tick(self, now):
        if now - self.heard > SILENCE and self.is_on:
            self.is_on, self.was_on = False, True

    def restart(self, now):
        self.volts = self.amperes = None
        self.is_on, self.was_on, self.boots, self.heard = False, False, now + 1.5, now

    def answer(self, command, data, now):
        """Returns what it answers, if it does."""
        if now < self.boots:
            return None
        self.tick(now)
        self.heard, self.is_on, self.was_on = now, self.is_on or self.was_on, False
        if command == SETTINGS:
            self.volts, self.amperes = struct.unpack(">II", data)
            return data
        if command == SWITCH:
            self.is_on = data[0] == 0
            self.is_bare |= self.is_on and self.volts is None
            return data
        if command == VALUES:
            output = (self.volts / 1000, self.amperes / 1000) if self.is_on else (0.0, 0.0)
            return struct.pack(">ff", *output)
        if command == STATUS:
            return bytes([0, 0, 1, 0, 30, 0, 0 if self.is_on else 1, 0])
        return None


class Line:
    """A serial line between two ptys, which loses frames, and is cut and mended."""

    def __init__(self):
        self.ends = [pty.openpty() for _ in range(2)]
        self.loss, self.is_cut, self.random = 0.0, False, random.Random(7)
        for _, slave in self.ends:
            tty.setraw(slave)
        self.ours, self.theirs = (os.ttyname(slave) for _, slave in self.ends)
        threading.Thread(target=self.carry, daemon=True).start()

    def carry(self):
        masters = [master for master, _ in self.ends]
        rest = {master: b"" for master in masters}
        while True:
            for master in select.select(masters, [], [])[0]:
                *lines, rest[master] = (rest[master] + os.read(master, 4096)).split(b"\r")
                other = masters[1 - masters.index(master)]
                for line in lines:
                    if line[:1] == b"T" and not self.is_cut and self.random.random() >= self.loss:
                        os.write(other, line + b"\r")


class Bus:
    """The modules, the controller, and what went wrong."""

    def __init__(self, program):
        self.line, self.modules = Line(), [Module(address) for address in range(4)]
        self.can = can.Bus(interface="slcan", channel=self.line.ours, ttyBaudrate=115200, sleep_after_open=0)
        self.sent, self.events = [], []
        self.program = program
        self.controller = None

    def start(self):
        self.controller = subprocess.Popen(
            [self.program, self.line.theirs], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        threading.Thread(target=lambda: self.events.extend(self.controller.stdout), daemon=True).start()

    def say(self, text):
        self.controller.stdin.write(text + "\n")
        self.controller.stdin.flush()

    def send(self, source, command, target, data):
        """Sends a frame of another controller."""
        frame = identifier(0xA, command, target, source), bytes(data)
        os.write(self.line.ends[1][0], f"T{frame[0]:08X}{len(data)}{frame[1].hex()}\r".encode())
        self.hear(*frame)

    def hear(self, number, data):
        now = time.monotonic()
        device, command = number >> 22 & 0xF, number >> 16 & 0x3F
        target, source = number >> 8 & 0xFF, number & 0xFF
        for module in self.modules:
            if (device, target) in [(0xA, module.address), (0xB, 1)]:
                answer = module.answer(command, data, now)
                if answer is not None:
                    number = identifier(device, command, source, module.address)
                    self.can.send(can.Message(arbitration_id=number, data=answer, is_extended_id=True))

    def run(self, seconds):
        """Lets time pass. Returns how long each module was on."""
        end, on = time.monotonic() + seconds, dict.fromkeys(range(4), 0.0)
        last = time.monotonic()
        while (now := time.monotonic()) < end:
            message = self.can.recv(0.01)
            if message is not None:
                self.sent.append((now, message.arbitration_id))
                self.hear(message.arbitration_id, bytes(message.data))
            for module in self.modules:
                module.tick(now)
                on[module.address] += (now - last) * module.is_on
            last = now
        return on

    def outputs(self):
        return [(module.is_on, module.volts, module.amperes) for module in self.modules]


def identifier(device, command, target, source):
    return device << 22 | command << 16 | target << 8 | source


def expect(is_so, what, bus):
    if not is_so:
        print("".join(bus.events), bus.outputs(), sep="\n")
        sys.exit(f"charger.py: {what}")


def main(program):
    bus = Bus(program)
    bus.run(SILENCE + 0.5)
    expect(not any(module.is_on for module in bus.modules), "the modules switch off in silence", bus)
    bus.start()
    on = bus.run(4)
    expect(max(on.values()) < 0.05, f"a controller that starts wakes no module: {on}", bus)

    bus.say("deliver 500000 10000")
    bus.run(8)
    expect(bus.outputs() == [(True, 500_000, 10_000)] * 4, "all modules deliver", bus)

    bus.line.loss = 0.2
    on = bus.run(15)
    expect(min(on.values()) > 14.9, f"frames that are lost switch no module off: {on}", bus)
    bus.line.loss = 0.0

    bus.line.is_cut = True
    bus.run(3)
    bus.say("stop")
    bus.run(SILENCE)
    bus.line.is_cut = False
    on = bus.run(2 * ROUND)
    expect(max(on.values()) < 0.05, f"a line that is mended wakes no module: {on}", bus)

    bus.say("deliver 400000 5000")
    bus.run(5)
    bus.modules[2].restart(time.monotonic())
    bus.run(6)
    expect(bus.outputs() == [(True, 400_000, 5_000)] * 4, "a module that has restarted delivers", bus)

    bus.send(0xF1, STATUS, 0, bytes(8))
    bus.run(SILENCE + 1)
    expect(bus.outputs() == [(True, 400_000, 5_000)] * 4, "another controller that reads changes nothing", bus)
    expect(not any("Rival" in event for event in bus.events), "another controller that reads is no rival", bus)
    bus.send(0xF1, SETTINGS, 0, struct.pack(">II", 300_000, 2_000))
    bus.run(SILENCE + 1)
    expect(any("Rival" in event for event in bus.events), "another controller that sets is told of", bus)
    expect(not any(module.is_on for module in bus.modules), "what nobody feeds goes off", bus)

    bus.say("deliver 400000 5000")
    bus.run(5)
    expect(bus.outputs() == [(True, 400_000, 5_000)] * 4, "what has given way delivers again", bus)
    bus.controller.stdin.close()
    bus.run(4)
    expect(bus.controller.poll() == 0, "the controller ends when its input does", bus)
    expect(not any(module.is_on for module in bus.modules), "all modules are off at the end", bus)
    expect(not any(module.is_bare for module in bus.modules), "no module is on without a set-point", bus)
    # On a busy machine frames wait for each other, so those of five seconds are counted.
    times = [at for at, _ in bus.sent]
    most = max(sum(at <= other < at + 5 for other in times) for at in times)
    expect(most <= 5 / GAP + 5, f"{most} frames come in five seconds", bus)
    bus.can.shutdown()
    print(f"a controller of four modules: {len(times)} frames, {len(bus.events)} lines told")


if __name__ == "__main__":
    main(sys.argv[1])
