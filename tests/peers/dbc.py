"""Compares canspec with cantools: the same frames decoded by a spec and by the DBC of it, the same values encoded.

Called as `dbc.py CANSPEC FRAMES SPEC...` with the two programs and the specs; `.ci/peers` does that.
"""

import json
import math
import os
import random
import re
import struct
import subprocess
import sys
from collections import Counter
from fractions import Fraction
from pathlib import Path

import cantools

COUNT = 10_000
UNITS = {"°C": "degC", "Ω": "Ohm"}
# Nodes of protocols that have none from 0 to 3.
NODES = {"groups": "256-259", "named_addresses": "80-81", "reports_only": "256-259", "trio": "224-227"}
# Why canspec and cantools may differ; anything else is a failure.
CAUSES = {
    "address": "a mask knows no ranges, so an address beyond those of the document may be found nowhere",
    "halfway": "cantools rounds half a step to the even neighbour, canspec away from zero",
}


def run(*call, text=None):
    """Returns what a program prints; an exit status of 1 means that some lines were refused."""
    done = subprocess.run([str(part) for part in call], input=text, capture_output=True, text=True)
    if done.returncode > 1:
        raise SystemExit(f"{call}: {done.stderr}")
    return done.stdout


class Protocol:
    """A spec and the DBC of it, which may have been made of another spec."""

    def __init__(self, canspec, spec, *options, dbc_of=None):
        self.canspec, self.spec = canspec, spec
        export = [canspec, "export", "dbc", "--spec", dbc_of or spec, *options]
        report = run(*export, "--report")
        # Signals in decimal digits, whose bits are all that a DBC has.
        self.decimal = set(re.findall(r"`(\S+)` is in decimal digits", report))
        # Messages, or kinds of their frames, that nothing in the mask tells from others, so the DBC has the others alone.
        self.missing = set(re.findall(r"`(\S+)`(?: \((\w+) to (\w+)\))? is missing in", report))
        mask = int(re.search("mask (0x[0-9A-F]+)", report)[1], 16)
        self.database = cantools.database.load_string(run(*export), "dbc", frame_id_mask=mask, strict=True)

    def examples(self):
        frames = map(json.loads, run(self.canspec, "examples", "--spec", self.spec, "--format", "jsonl").splitlines())
        return [f"{frame['id']}#{frame['data']}" for frame in frames if frame["data"] is not None]

    def decode(self, log):
        """Returns what canspec says of the frames that it recognises."""
        lines = run(self.canspec, "decode", "--spec", self.spec, "--format", "jsonl", text="\n".join(log)).splitlines()
        frames = [frame for frame in map(json.loads, lines) if frame["message"]]
        return [{**frame, "signals": dict(self.signals(frame))} for frame in frames]

    def holds(self, frame):
        """Tests whether the DBC has such frames."""
        kind = (frame["message"], frame["kind"], frame["access"])
        return self.missing.isdisjoint([kind, (frame["message"], "", "")])

    def signals(self, frame):
        """Returns the signals of a frame, with elements in place of arrays."""
        message = self.message(frame)
        known = [signal.name for signal in message.signals] if message else []
        for name, signal in frame["signals"].items():
            if not isinstance(signal["raw"], list):
                yield name, signal
                continue
            # The elements count from the lowest number that the DBC has; a status word has a signal for each bit.
            element = re.compile(re.escape(name_of(message, frame, name) if message else name) + r"_(\d+)(?:_|$)")
            first = min((int(found[1]) for found in map(element.match, known) if found), default=1)
            for index in range(len(signal["raw"])):
                yield f"{name}_{first + index}", {key: item if key == "unit" else item[index] for key, item in signal.items()}

    def encode(self, frames):
        """Returns data by the time of a frame; a frame that canspec refuses has none."""
        lines = run(self.canspec, "encode", "--spec", self.spec, "--from", "jsonl", text="\n".join(map(json.dumps, frames)))
        return {int(time): bytes.fromhex(data) for time, data in re.findall(r"\((\d+)\) (?:\S+ )?\w+#(\w*)", lines)}

    def message(self, frame):
        """Returns the DBC's message of a frame, or `None`."""
        try:
            return self.database.get_message_by_frame_id(int(frame["id"], 16), force_extended_id=len(frame["id"]) == 8)
        except KeyError:
            return None


def cause(frame):
    """Returns why the DBC may not have the message of a frame."""
    strange = any(note["rule"] in ("address", "addressing") for note in frame["notes"])
    return "address" if strange else None


def name_of(message, frame, signal):
    """Returns the name that a signal has in the DBC."""
    if not message.is_multiplexed():
        return signal
    if "." in frame["message"]:
        return beginning(message, frame) + signal
    return frame["message"] if signal == "value" else f"{frame['message']}_{signal}"


def beginning(message, frame):
    """Returns how the names of a transport's frame begin: the DBC names its kinds, which the first selector tells apart."""
    kind = next(iter(frame["selectors"].values()))
    return os.path.commonprefix([signal.name for signal in message.signals if kind in (signal.multiplexer_ids or [])])


def parts(message, name, raw):
    """Returns the signals of a status word or a packed value, each with its lowest bit in the whole."""
    inside = [message.get_signal_by_name(other) for other in raw if other.startswith(name + "_")]
    at = lambda signal: signal.start if signal.byte_order == "little_endian" else -(signal.start ^ 7)
    ends, low = [], 0
    for signal in sorted(inside, key=lambda s: at(s) if s.byte_order == "little_endian" else at(s) - s.length + 1):
        ends.append((signal, low))
        low += signal.length
    return ends


def differences(protocol, frame):
    """Returns what cantools says otherwise of a frame, as sentences."""
    message = protocol.message(frame)
    if message is None:
        return ["no message of the DBC has this identifier"]
    data = bytes.fromhex(frame["data"])
    try:
        is_short = len(data) < message.length
        raw = message.decode(data, decode_choices=False, scaling=False, allow_truncated=is_short)
        values = message.decode(data, allow_truncated=is_short)
    except (cantools.database.DecodeError, ValueError) as error:
        return [f"{message.name}: {error}"]
    found, seen = [], set()
    for selector, value in frame["selectors"].items():
        names = [name for name in raw if name == selector or name.endswith("_" + selector)]
        seen.update(names)
        if [raw[name] for name in names] != [value]:
            found.append(f"selector {selector} is {value}, not {[raw[name] for name in names]}")
    for signal, ours in frame["signals"].items():
        name = name_of(message, frame, signal)
        if name in raw:
            seen.add(name)
            if f"{frame['message']}.{signal}" not in protocol.decimal:
                found += compare(message.get_signal_by_name(name), ours, raw[name], values[name])
            elif raw[name] != ours["raw"]:
                found.append(f"raw {name} is {ours['raw']}, not {raw[name]}")
        else:
            inside = parts(message, name, raw)
            seen.update(part.name for part, _ in inside)
            found += compare_parts(name, inside, ours, raw)
    extra = [name for name in raw if name not in seen and not name.endswith("_reserved")]
    return found + [f"{name} is only in the DBC" for name in extra]


def compare(signal, ours, raw, value):
    """Compares a signal that is one in both."""
    found = []
    if signal.is_float:
        same = math.isnan(raw) if ours["value"] is None and math.isnan(raw) else struct.pack(">f", raw) == ours["raw"].to_bytes(4, "big")
    else:
        same = raw == ours["raw"]
    if not same:
        found.append(f"raw {signal.name} is {ours['raw']}, not {raw}")
    if isinstance(ours["value"], float):
        if not math.isclose(value, ours["value"], rel_tol=1e-12, abs_tol=abs(signal.scale) * 1e-6):
            found.append(f"{signal.name} is {ours['value']}, not {value}")
    elif ours["value"] is not None and str(value) != str(ours["value"]) and not is_text(signal, ours):
        found.append(f"{signal.name} is {ours['value']}, not {value}")
    if UNITS.get(ours.get("unit"), ours.get("unit")) != signal.unit:
        found.append(f"the unit of {signal.name} is {ours.get('unit')}, not {signal.unit}")
    return found


def is_text(signal, ours):
    """Tests whether a value is a text that the DBC has as a number: its bytes, filled up with one byte, or in hexadecimal."""
    if not isinstance(ours["value"], str) or signal.length % 8:
        return False
    raw, text = ours["raw"].to_bytes(signal.length // 8, "big"), ours["value"].encode()
    is_filled = raw.startswith(text) and len(set(raw[len(text):])) <= 1
    return is_filled or raw.hex().upper() == ours["value"]


def compare_parts(name, inside, ours, raw):
    """Compares a status word or a packed value with the signals of its parts."""
    whole = sum(raw[part.name] << low for part, low in inside)
    found = [] if whole == ours["raw"] else [f"raw {name} is {ours['raw']}, not {whole}"]
    if "set" in ours:
        bits = {part.name.removeprefix(name + "_") for part, _ in inside if raw[part.name]}
        if {bit for bit in bits if not bit.startswith("unnamed_")} != set(ours["set"]):
            found.append(f"{name} has {ours['set']} set, not {sorted(bits)}")
    return found


def is_halfway(value, number):
    """Tests whether a value lies exactly between two steps."""
    return (Fraction(value) - Fraction(number.offset)) / Fraction(number.scale) % 1 == Fraction(1, 2)


def set_values(protocol, frame, chance):
    """Puts other values into a frame; returns them as the DBC names them, and whether one lies between two steps."""
    message = protocol.message(frame)
    if message is None or differences(protocol, frame):
        return None, False
    data = bytes.fromhex(frame["data"])
    if len(data) < message.length:
        return None, False
    values = message.decode(data, decode_choices=False)
    values.update({name: 0 for name in values if name.endswith("_reserved")})
    halfway = False
    for signal, ours in frame["signals"].items():
        name = name_of(message, frame, signal)
        number = message.get_signal_by_name(name) if name in values else None
        if number is None or isinstance(ours["value"], str) or (ours["value"] is None and not number.is_float):
            continue
        if f"{frame['message']}.{signal}" in protocol.decimal:
            # A DBC does not know a scale of theirs, so numbers that have one stay as they are.
            if isinstance(ours["value"], int):
                ours["value"] = chance.randrange(10 ** (number.length // 4))
                values[name] = int(str(ours["value"]), 16)
            continue
        low, high = (number.minimum, number.maximum) if number.maximum is not None else (-1e6, 1e6)
        if isinstance(ours["value"], int):
            ours["value"] = chance.randint(math.ceil(low), math.floor(high))
        else:
            ours["value"] = chance.uniform(low, high)
            if not number.is_float and chance.random() < 0.01:
                steps = math.floor((ours["value"] - number.offset) / number.scale)
                ours["value"] = (steps + 0.5) * number.scale + number.offset
                halfway = True
            # Doubles of more than 2^51 steps lie there by themselves.
            halfway = halfway or is_halfway(ours["value"], number)
        values[name] = ours["value"]
    frame.pop("reserved", None)
    return values, halfway


def decoding(protocol, frames):
    """Counts the frames that differ by cause; the ones without a cause are returned too."""
    causes, failures = Counter(), []
    for frame in frames:
        if found := differences(protocol, frame):
            causes[cause(frame)] += 1
            failures += [] if cause(frame) else [(frame["id"], frame["data"], frame["message"], found)]
    return causes, failures


def encoding(protocol, frames, chance):
    """Encodes other values by both programs; returns how many value sets, and the rest as `decoding` does."""
    for time, frame in enumerate(frames):
        frame["time"] = time
    sets = [set_values(protocol, frame, chance) for frame in frames]
    ours = protocol.encode(frames)
    causes, failures, count = Counter(), [], 0
    for frame, (values, halfway) in zip(frames, sets):
        if values is None or frame["time"] not in ours or count == COUNT:
            continue
        count += 1
        theirs = protocol.message(frame).encode(values, strict=False)
        if theirs != ours[frame["time"]]:
            causes["halfway" if halfway else None] += 1
            failures += [] if halfway else [(frame["id"], frame["message"], values, theirs.hex(), ours[frame["time"]].hex())]
    return count, causes, failures


def shown(causes):
    return ", ".join(f"{count} {cause}" for cause, count in sorted(causes.items(), key=str)) or "none"


def compared(canspec, random_frames, spec):
    """Compares all frames of a spec; returns how many comparisons there were, the causes, and the failures."""
    protocol = Protocol(canspec, spec)
    documented = protocol.decode(protocol.examples())
    frames = documented + protocol.decode(run(random_frames, "known", spec, COUNT, 1).splitlines())
    held = [frame for frame in frames if protocol.holds(frame)]
    decoded, failures = decoding(protocol, held)
    others = protocol.decode(run(random_frames, "known", spec, COUNT * 21 // 20, 2).splitlines())
    sets, encoded, wrong = encoding(protocol, list(filter(protocol.holds, others)), random.Random(3))
    few = Protocol(canspec, spec, "--nodes", NODES.get(Path(spec).stem, "0-3"))
    found = [frame for frame in frames if few.message(frame) and few.holds(frame)]
    of_nodes, astray = decoding(few, found)
    print(
        f"{Path(spec).stem:<15} {len(documented):3} examples and {len(frames) - len(documented)} frames,"
        f" {len(held)} in the DBC decoded: {shown(decoded)};"
        f" {sets} value sets encoded: {shown(encoded)}; {len(found)} frames of four nodes decoded: {shown(of_nodes)}"
    )
    return len(held) + sets + len(found), decoded + encoded + of_nodes, failures + wrong + astray


def shown(causes):
    return ", ".join(f"{count} {cause}" for cause, count in sorted(causes.items(), key=str)) or "no difference"


def main():
    canspec, random_frames, *specs = sys.argv[1:]
    total, causes, failures = 0, Counter(), []
    for spec in specs:
        count, found, unexplained = compared(canspec, random_frames, spec)
        total, causes, failures = total + count, causes + found, failures + unexplained
    print(f"{total} comparisons with cantools {cantools.__version__}, {causes.total()} differences ({causes.total() / total:.2%})")
    for cause in filter(None, causes):
        print(f"  {causes[cause]} {cause}: {CAUSES[cause]}")
    for failure in failures[:10]:
        print("unexplained:", *failure)
    if failures or causes.total() > total / 100:
        raise SystemExit("canspec and cantools differ")


if __name__ == "__main__":
    main()
