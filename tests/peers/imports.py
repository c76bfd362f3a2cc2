"""Imports the DBC files that cantools is tested with, and compares each with the DBC that is exported again.

Called as `imports.py CANSPEC FOLDER` with the program and the folder of the files; `.ci/peers` does that. Signals are matched by
their bits, since their names change.
"""

import math
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import cantools

FRAMES = 200
# What is found in the files of this version of cantools; another count is a failure.
EXPECTED = {
    "files": 89,
    "refused files": 2,
    "files that cantools refuses": 2,
    "messages": 405,
    "lost messages": 13,
    "lost signals": 9,
    "frames": 79894,
    "frames unknown to both": 653,
    "single": 53,
    "broken": 400,
}
# Files that are refused, and why.
REFUSED = {
    "issue_199.dbc": "274923520 is no identifier",
    "issue_199_extended.dbc": "4294967295 is no identifier",
}
# Why frames are not compared.
CAUSES = {
    "single": "a multiplexor that has one value is a constant in the exported DBC, which cantools does not compare",
    "broken": "cantools cannot decode a message with signals that overlap or lie outside of it",
}


def run(*call):
    """Runs a program; returns whether it succeeds, its output and its errors."""
    done = subprocess.run([str(part) for part in call], capture_output=True, text=True)
    return done.returncode == 0, done.stdout, done.stderr


def bits(signal):
    """Returns the bits of a signal, the most significant one first, bit 0 of byte 0 being 0."""
    if signal.byte_order == "little_endian":
        return tuple(range(signal.start + signal.length - 1, signal.start - 1, -1))
    first = signal.start // 8 * 8 + 7 - signal.start % 8
    return tuple(bit // 8 * 8 + 7 - bit % 8 for bit in range(first, first + signal.length))


def put(data, signal, value):
    for index, bit in enumerate(reversed(bits(signal))):
        data[bit // 8] = data[bit // 8] & ~(1 << bit % 8) | (value >> index & 1) << bit % 8


def random_data(message, chance):
    """Returns random bytes, in which multiplexors have mostly values that mean something."""
    data = bytearray(chance.randbytes(message.length))
    children = {}
    for signal in message.signals:
        if signal.multiplexer_signal and signal.multiplexer_ids:
            children.setdefault(signal.multiplexer_signal, []).extend(signal.multiplexer_ids)
    for name, values in children.items():
        if chance.random() < 0.9:
            put(data, message.get_signal_by_name(name), chance.choice(values))
    return bytes(data)


def decoded(message, data):
    """Returns signal, raw and physical value by the bits of the signal; nothing where a multiplexor has an unknown value."""
    try:
        raw = message.decode(data, decode_choices=False, scaling=False)
        physical = message.decode(data, decode_choices=False)
    except cantools.database.DecodeError:
        return None
    signals = [message.get_signal_by_name(name) for name in raw]
    return {bits(signal): (signal, raw[signal.name], physical[signal.name]) for signal in signals}


def is_same(one, other):
    return one == other or math.isnan(one) and math.isnan(other) or math.isclose(one, other, rel_tol=1e-12)


def letters(text):
    return re.sub("[^a-z0-9]", "", str(text).lower())


def choices(signal):
    """Returns the names of the raw values that the bits hold, in letters and digits alone."""
    low, high = (-(1 << signal.length - 1), (1 << signal.length - 1) - 1) if signal.is_signed else (0, (1 << signal.length) - 1)
    return {raw: letters(name) for raw, name in (signal.choices or {}).items() if low <= raw <= high}


def names_differ(theirs, ours):
    """Tests for values without a name in one of two signals, or with another one but for a prefix and a number."""
    theirs, ours = choices(theirs), choices(ours)
    return theirs.keys() != ours.keys() or any(name not in ours[raw] for raw, name in theirs.items() if name.isascii())


def cause(theirs, ours):
    """Returns why cantools may not decode a frame by the original, and by ours."""
    if not theirs.is_multiplexed():
        return "broken"
    constants = {bits(signal) for signal in ours.signals if not signal.is_multiplexer}
    return "single" if any(signal.is_multiplexer and bits(signal) in constants for signal in theirs.signals) else None


def decoding(theirs, ours, lost, before, after):
    """Returns what differs in a frame, as sentences."""
    found = []
    for place, (signal, raw, physical) in before.items():
        if place not in after:
            found += [] if f"{theirs.name}.{signal.name}" in lost else [f"{signal.name} is missing"]
            continue
        mine, my_raw, my_physical = after[place]
        if signal.is_multiplexer and mine.is_multiplexer:
            same = raw % (1 << signal.length) == my_raw
        else:
            same = is_same(raw, my_raw) and is_same(physical, my_physical) and not names_differ(signal, mine)
        found += [] if same else [f"{signal.name} is {raw} and {physical}, not {my_raw} and {my_physical}"]
    extra = [mine.name for place, (mine, *_) in after.items() if place not in before and not mine.name.endswith("_reserved")]
    return found + [f"{name} is new" for name in extra]


def encoding(theirs, ours, before, after):
    """Encodes what a frame means by both; returns what differs."""
    values = {mine.name: 0 for place, (mine, *_) in after.items() if place not in before}
    values.update({after[place][0].name: my[2] for place, my in before.items() if place in after})
    missing = {bit for place in before if place not in after for bit in place}
    expected = bytearray(theirs.encode({signal.name: physical for signal, _, physical in before.values()}, strict=False))
    for bit in missing:
        expected[bit // 8] &= ~(1 << bit % 8)
    found = ours.encode(values, strict=False)
    return [] if found == bytes(expected) else [f"{values} is {expected.hex()}, not {found.hex()}"]


class File:
    """A DBC file, and the DBC that is exported from the spec of it, which may be changed in between."""

    def __init__(self, canspec, path, change=lambda spec: spec):
        self.path, self.refusal = path, None
        with tempfile.TemporaryDirectory() as folder:
            spec = Path(folder) / f"{path.stem}.yaml"
            for call in ["import", "dbc", path, "-o", spec], ["check", spec], ["export", "dbc", "--spec", spec]:
                done, output, errors = run(canspec, *call)
                if not done:
                    self.refusal = f"{call[0]}: {errors.strip()}".replace(f"{path.parent}/", "").replace(f"{folder}/", "")
                    return
                if call[0] == "import":
                    spec.write_text(change(spec.read_text(encoding="utf-8")), encoding="utf-8")
            self.read(spec, output)

    def read(self, spec, output):
        self.lost = set(re.findall(r"^# - (?:signal|message) `(.*?)`", spec.read_text(encoding="utf-8"), re.MULTILINE))
        self.exported = cantools.database.load_string(output, "dbc", strict=True)

    def compare(self, chance):
        """Returns counts and differences."""
        counts, failures = Counter(), []
        theirs = cantools.database.load_file(self.path, strict=False)
        known = {(message.frame_id, message.is_extended_frame): message for message in self.exported.messages}
        for message in theirs.messages:
            mine = known.pop((message.frame_id, message.is_extended_frame), None)
            if mine is None:
                counts["lost messages"] += 1
                failures += [] if message.name in self.lost else [f"{message.name} is missing"]
                continue
            counts["messages"] += 1
            counts["lost signals"] += sum(f"{message.name}.{signal.name}" in self.lost for signal in message.signals)
            if (message.length, message.cycle_time or None) != (mine.length, mine.cycle_time or None):
                failures.append(f"{message.name} has another length or cycle")
            for _ in range(FRAMES):
                data = random_data(message, chance)
                before, after = decoded(message, data), decoded(mine, data)
                if before is not None and after is not None:
                    counts["frames"] += 1
                    failures += decoding(message, mine, self.lost, before, after) or encoding(message, mine, before, after)
                elif before is after:
                    counts["frames unknown to both"] += 1
                elif before is None and cause(message, mine):
                    counts[cause(message, mine)] += 1
                else:
                    failures.append(f"{message.name}: {data.hex()} is known to one only")
        return counts, failures + [f"{message.name} is new" for message in known.values()]


def main():
    canspec, folder = sys.argv[1:]
    paths = sorted(path for path in Path(folder).iterdir() if path.suffix.lower() == ".dbc")
    files = [File(canspec, path) for path in paths]
    refused = {file.path.name: file.refusal for file in files if file.refusal}
    counts, failures = Counter({"files": len(files), "refused files": len(refused)}), []
    for file in files:
        if file.refusal:
            continue
        try:
            found, differences = file.compare(random.Random(file.path.name))
        except cantools.database.UnsupportedDatabaseFormatError as error:
            counts["files that cantools refuses"] += 1
            print(f"{file.path.name} is not compared: {' '.join(str(error).split())}")
            continue
        counts += found
        failures += [f"{file.path.name}: {difference}" for difference in differences]
    print(f"DBC files of cantools {cantools.__version__}: " + ", ".join(f"{count} {what}" for what, count in counts.items()))
    for name in CAUSES:
        print(f"  {name}: {CAUSES[name]}")
    for name, why in refused.items():
        print(f"  {name}: {why}")
    for failure in failures[:10]:
        print("difference:", failure)
    wrong = refused.keys() ^ REFUSED.keys() or any(REFUSED[name] not in why for name, why in refused.items())
    if failures or wrong or counts != EXPECTED:
        raise SystemExit(f"{len(failures)} differences; expected were {EXPECTED}")


if __name__ == "__main__":
    main()
