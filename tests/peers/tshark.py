#!/usr/bin/env python3
"""Compares what tshark says of frames, by the exported dissector, with what `canspec decode` says of them.

    tests/peers/tshark.py CANSPEC FRAMES

CANSPEC is the command, FRAMES the program that writes random frames (`canspec-tests`, bin `frames`).
"""

import collections
import glob
import itertools
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

from tshark_bench import PEERS, ROOT, SPEC, Bench, Dissector, processor_time, rows_of_plain_lua

# Protocols that Wireshark has itself.
TAKEN_NAMES = ("can", "j1939", "frame")
# Names at which Wireshark ends: words of its filters that are none of Rust's, its groups of preferences, and letters.
RESERVED_NAMES = """
    all all_eq all_ne and any any_eq any_ne bitand bitwise_and contains eq ge gt inf le lt matches nan ne not or xor
    capture console extcap gui nameres packet_list print protocols statistics stream taps a z
""".split()
# Random frames of all protocols together, of each protocol at least, and of each feature of the language.
OF_ALL_PROTOCOLS, OF_A_PROTOCOL, OF_A_FEATURE = 100_000, 10_000, 1_000
# What a frame has to do with others, which `canspec decode` does not say.
LINKS = ("request_in", "response_time", "response_in", "answers")
# Rules of notes that have the same text in both programs.
SAME_TEXTS = ("unknown_value", "unknown_bit")
# Texts of notes with every digit of a word of more than 32 bits, written by hand.
EDGES = {
    "0002F002#FFFFFFFFFFFFFFFF": "value 18446744073709551615 is outside 0..1000",
    "0003F002#FEFFFFFFFE07FFFF": "address -4294967298 is outside -1000..1000",
    "0004F002#E800000100000000": "end 0x1 has no name",
    "0005F002#FFFFFFFFFFFF0000": "raw has bits 0x7FFEFFFFFFFE set that have no name",
}
# What a mistake in the spec of the heater looks like: the text before and after.
MISTAKES = {
    "a wrong scale": ("scale: 1/10,", "scale: 1/100,"),
    "a wrong bit": ("overheated: {bit: 3,", "overheated: {bit: 4,"),
    "a wrong sign": ("as: signed, ", ""),
}


def rounded(number):
    """Writes a double with the 15 digits that tshark prints."""
    return f"{float(number):.15g}"


def whole_or_rounded(number):
    """Writes a double as texts of the dissector have it: a whole number with all its digits."""
    return f"{number:.0f}" if number.is_integer() and abs(number) < 2**53 else rounded(number)


def escaped(value):
    """Writes a text as the dissector has it: control characters and backslashes as escapes."""
    if not isinstance(value, str):
        return value
    known = {"\\": r"\\", "\n": r"\n", "\r": r"\r", "\t": r"\t"}
    return re.sub(r"[\x00-\x1f\x7f\\]", lambda found: known.get(found[0], f"\\x{ord(found[0]):02X}"), value)


def signal_fields(name, signal):
    """Returns the fields of a signal, and its value as it stands in the list of packets."""
    if "set" in signal:
        bits = {f"{name}.{bit}": "1" for bit in signal["set"]}
        unknown = [f"0x{signal['unknown']:X}"] if signal["unknown"] else []
        return {name: str(signal["raw"]), **bits}, " ".join(signal["set"] + unknown) or "none"
    raw, value = signal["raw"], escaped(signal["value"])
    if value is None:
        return {f"{name}.raw": str(raw)}, "?"
    fields = {name: rounded(value) if isinstance(value, float) else str(value), f"{name}.raw": str(raw)}
    text = whole_or_rounded(value) if isinstance(value, float) else str(value)
    return fields, text + (f" {signal['unit']}" if "unit" in signal and not isinstance(value, str) else "")


def alone(message, signals, dissector):
    """Returns the signals of a frame as the dissector lists them, with elements in place of arrays."""
    found = []
    for name, signal in signals.items():
        if not isinstance(signal["raw"], list):
            found.append((name, signal))
            continue
        first = next(number for number in itertools.count() if f"{message}.{name}_{number}" in dissector.types)
        for index in range(len(signal["raw"])):
            element = {key: item if key == "unit" else item[index] for key, item in signal.items()}
            found.append((f"{name}_{first + index}", element))
    order = {name: place for place, name in enumerate(dissector.types)}
    return sorted(found, key=lambda item: order.get(f"{message}.{item[0]}", 0))


# Rules of notes about the value of a signal.
OF_VALUES = ("unknown_value", "unknown_bit", "out_of_range", "not_finite")


def refusal(line):
    """Returns what stands in place of the values of a frame that reports an error, if it is one."""
    why = [note["text"] for note in line.get("notes", []) if note["rule"] == "error_code"]
    what = {"reply": "refused", "report": "in error"}.get(line.get("kind"))
    return f"{what}, {why[0]}" if what and why else None


# The frames of J1939-21's transport by their control byte, and those of ISO-TP by their first four bits.
KINDS = {
    "control": {16: "request_to_send", 17: "clear_to_send", 19: "end_of_message", 32: "broadcast", 255: "abort"},
    "pci": {0: "single_frame", 1: "first_frame", 2: "consecutive_frame", 3: "flow_control"},
}


def as_message(line):
    """Returns a line whose frame of a transport has the name and the signals of its message."""
    transport, _, part = (line["message"] or "").partition(".")
    if not part:
        return line
    selectors = dict(line["selectors"])
    chosen = {name: selectors.pop(name) for name in KINDS if name in selectors}
    kind = next((KINDS[name][value] for name, value in chosen.items()), part)
    numbers = {name: {"raw": number, "value": number} for name, number in selectors.items()}
    return line | {"message": f"{transport}_{kind}", "selectors": chosen, "signals": numbers | line["signals"]}


def expected(line, dissector):
    """Returns the fields that tshark must show of a decoded line."""
    line = as_message(line)
    of, groups = f"{dissector.protocol}.", dissector.groups
    numbers = [(groups["identifier"], line["identifier"]), (groups["selector"], line["selectors"])]
    fields = {f"{group}.{name}": str(value) for group, values in numbers for name, value in values.items()}
    fields[f"{of}identifier"] = str(int(line["id"], 16))
    if line["message"] is None:
        fields[f"{of}problem"] = line["problem"]["kind"]
        fields[f"{groups['note']}.unrecognised"] = "1"
        return fields, None
    # Reserved bits that are all 0 only say how long the frame is.
    keys = ("message", "access", "kind", "addressing", "reserved")
    fields |= {of + key: line[key] for key in keys if (line.get(key) or "").strip("0")}
    refused = refusal(line)
    texts = [refused] if refused else []
    for name, signal in {} if refused else alone(of + line["message"], line["signals"], dissector):
        more, text = signal_fields(f"{of}{line['message']}.{name}", signal)
        texts.append(f"{name} {text}")
        fields |= more
    rules = [note["rule"] for note in line["notes"] if not (refused and note["rule"] in OF_VALUES)]
    for rule, count in collections.Counter(rules).items():
        fields[f"{groups['note']}.{rule}"] = ",".join(["1"] * count)
    info = f"{line['access']} {line['message']} {line['kind']}" + (": " if texts else "") + ", ".join(texts)
    fields = with_names(fields, dissector.types)
    for whole in line["wholes"]:
        info += f", {'part of' if 'incomplete' in whole else 'whole'} {whole['message']}"
        add_whole(fields, whole, dissector, "pci" in line["selectors"])
    return fields, info


def add_whole(fields, whole, dissector, is_isotp):
    """Adds what tshark shows of a long message. A field that the frame has, too, gets another value."""
    of, note = f"{dissector.protocol}.", dissector.groups["note"]
    name, refused = of + whole["message"], is_isotp and refusal(whole)
    more = {f"{of}whole": whole["message"]}
    if is_isotp:
        more |= {of + key: whole[key] for key in ("access", "kind")}
        more |= {f"{dissector.groups['selector']}.{key}": str(value) for key, value in whole["selectors"].items()}
    for signal, known in [] if refused else alone(name, whole["signals"], dissector):
        # A part may have a signal of the same name.
        apart = f"{name}.whole.{signal}"
        place = apart if apart in dissector.types else f"{name}.{signal}"
        more |= signal_fields(place, known)[0] if known["raw"] is not None else {}
    rules = [known["rule"] for known in whole["notes"] if known["rule"] in (*OF_VALUES, "model_dependent", "count") and not refused]
    rules += ["incomplete"] * ("incomplete" in whole)
    more = with_names(more, dissector.types) | {f"{note}.{rule}": ",".join("1" for known in rules if known == rule) for rule in rules}
    for field, value in more.items():
        fields[field] = f"{fields[field]},{value}" if field in fields else value


def with_names(fields, types):
    """Moves the name of a special value to its own field, and leaves out raw fields where the value is the raw one."""
    known = {}
    for name, value in fields.items():
        is_special = f"{name}.name" in types and not is_number(value)
        name = f"{name}.name" if is_special else name
        if name in types or not name.endswith(".raw"):
            known[name] = value
    return {name: value for name, value in known.items() if value != ""}


def is_number(text):
    return text.lstrip("-")[:1].isdigit()


def plain(name, cell, types):
    """Returns a cell of tshark as `expected` has it."""
    kind = types[name]
    if kind == "FT_DOUBLE":
        return ",".join(map(rounded, cell.split(",")))
    if kind == "FT_BOOLEAN":
        return {"True": "1", "False": "0"}.get(cell, cell)
    return ",".join(str(int(number, 0)) for number in cell.split(",")) if "INT" in kind else cell


def difference(line, row, dissector):
    """Says what tshark shows otherwise, if anything."""
    types = dissector.types
    wanted, info = expected(line, dissector)
    if "_ws.lua.error" in row:
        return row["_ws.lua.error"]
    shown = {name: cell for name, cell in row.items() if name in types and name.split(".", 1)[1] not in LINKS}
    shown = {name: plain(name, cell, types) for name, cell in shown.items()}
    # Each bit of a status word is shown, set or not.
    shown = {name: cell for name, cell in shown.items() if types[name] != "FT_BOOLEAN" or cell != "0"}
    if shown != wanted:
        return f"decode {sorted(wanted.items() - shown.items())}, tshark {sorted(shown.items() - wanted.items())}"
    if info and row.get("_ws.col.Info") != info:
        return f"decode {info!r}, tshark {row.get('_ws.col.Info')!r}"
    same = [rule for rule in SAME_TEXTS if rule not in OF_VALUES or not refusal(line)]
    texts = [note["text"] for note in line.get("notes", []) if note["rule"] in same]
    missing = [text for text in texts if text not in row.get("_ws.expert.message", "")]
    if missing:
        return f"decode {missing}, tshark {row.get('_ws.expert.message')!r}"
    return None


def compare(bench, spec, log, dissected=None, model=None, by_heuristic=False, shown_as=None):
    """Compares a log frame by frame; `dissected` is the spec of the dissector, and `shown_as` its name, if they differ."""
    lines = bench.decoded(spec, log, model)
    protocol = shown_as or lines[0]["protocol"]
    dissector = Dissector(bench, dissected or spec, protocol)
    options = ["-o", f"{protocol}.model:{model}"] if model else []
    options += [] if by_heuristic else ["-d", f"can.subdissector,{protocol}"]
    rows, seconds = dissector.rows(bench.capture(log), *options)
    if len(lines) != len(rows):
        sys.exit(f"{spec}: {len(lines)} frames were decoded, {len(rows)} dissected")
    differences = []
    for line, row in zip(lines, rows):
        if by_heuristic and line["message"] is None:
            wrong = sorted(set(row) & set(dissector.types)) or None
        elif line["message"] is None and line["problem"]["kind"] == "frame":
            # The dissector takes classic data frames only.
            wrong = sorted(set(row) & set(dissector.types)) or None
        else:
            wrong = difference(line, row, dissector)
        if wrong:
            differences.append(f"{line['id']}#{line['data']}: {wrong}")
    return lines, rows, differences, seconds


def compare_plain_lua(bench, spec):
    """Compares random frames with what the dissector shows of them in plain Lua 5.4."""
    lines = bench.decoded(spec, bench.random_log(spec, OF_A_FEATURE), None)[:-1]
    dissector = Dissector(bench, spec, lines[0]["protocol"])
    started = processor_time()
    rows = rows_of_plain_lua(bench, dissector, lines, 0)
    seconds = processor_time() - started
    found = [(line, difference(line, row, dissector)) for line, row in zip(lines, rows, strict=True)]
    differences = [f"{line['id']}#{line['data']}: {wrong}" for line, wrong in found if wrong]
    return report(os.path.basename(spec), "random, in Lua 5.4", lines, differences, seconds)


def report(name, what, lines, differences, seconds):
    """Prints a row of the table, and the first differences."""
    recognised = sum(line["message"] is not None for line in lines)
    each = f"{1e6 * seconds / len(lines):5.0f} us a frame" if len(lines) >= OF_A_PROTOCOL else ""
    print(f"{name:20} {what:26} {len(lines):6} frames, {recognised:6} recognised, {len(differences):3} differ {each}")
    for text in differences[:5]:
        print(f"    {text}")
    return len(differences)


def compare_spec(bench, spec, count):
    """Compares the examples of a spec, and random frames, each device model's among them."""
    name = os.path.basename(spec)
    wrong, examples = 0, bench.log_of_examples(spec)
    if os.path.getsize(examples) > 0:
        lines, _, differences, seconds = compare(bench, spec, examples, by_heuristic=True)
        wrong += report(name, "examples, by heuristic", lines, differences, seconds)
    log = bench.random_log(spec, count)
    lines, _, differences, seconds = compare(bench, spec, log)
    wrong += report(name, "random", lines, differences, seconds)
    model = last_model(bench, spec)
    if model:
        lines, _, differences, seconds = compare(bench, spec, bench.random_log(spec, OF_A_FEATURE), model=model)
        wrong += report(name, f"model {model}", lines, differences, seconds)
    return wrong


def last_model(bench, spec):
    """Returns the device model that the dissector lists last."""
    prefs = bench.run("tshark", "-G", "currentprefs", "-X", f"lua_script:{bench.dissector(spec)}").splitlines()
    lists = [line for line in prefs if line.startswith("# One of: any")]
    return lists[0].rsplit(", ", 1)[1] if lists and ", " in lists[0] else None


def compare_edges(bench):
    """Compares frames with the numbers at the edges of words wider than 32 bits."""
    spec, log = (os.path.join(PEERS, f"tshark_wide.{ending}") for ending in ("yaml", "log"))
    lines, rows, differences, seconds = compare(bench, spec, log)
    for line, row in zip(lines, rows):
        text = EDGES.get(f"{line['id']}#{line['data']}", "")
        if text not in row.get("_ws.expert.message", ""):
            differences.append(f"{text!r} is not in {row.get('_ws.expert.message')!r}")
    return report("tshark_wide.yaml", "edges", lines, differences, seconds)


def frame_of_line(stamp, channel, frame):
    """Returns what a capture must have of a line of a log: time, channel, remote, bytes, identifier, length."""
    seconds, _, fraction = stamp.strip("()").partition(".")
    identifier, data = frame.split("#", 1)
    is_remote = data.startswith("R")
    count = 0 if is_remote else len(data[2:] if data.startswith("#") else data) // 2
    head = [f"{seconds}.{fraction:0<9}", channel, is_remote, 8 + count]
    # Of an error frame, tshark shows no identifier but what it stands for.
    is_error = len(identifier) == 8 and int(identifier, 16) >> 29 == 1
    return head + ([] if is_error else [int(identifier, 16), int(data[1:] or 0) if is_remote else count])


def frame_of_row(row):
    """Returns the same of a row of tshark."""
    stamp, channel, identifier, length, remote, count = row.split("\t")
    return [stamp, channel, remote == "1", int(count)] + ([int(identifier, 0), int(length)] if identifier else [])


def compare_sessions(bench, protocols):
    """Compares the logs of sessions with long messages, and the same frames where some are lost and some repeated. A
    session of device models is also compared as one of the last of them."""
    wrong = 0
    for spec in protocols:
        name = os.path.basename(spec).removesuffix(".yaml")
        logs = [glob.glob(os.path.join(folder, f"{name}-*.log")) for folder in (os.path.join(ROOT, "tests", "logs"), PEERS)]
        for path in sorted(sum(logs, [])):
            with open(path, encoding="utf-8") as file:
                frames = [line.rstrip("\n") for line in file if "#" in line]
            chosen = random.Random(20)
            disturbed = [frame for frame in frames for _ in range(chosen.choices((0, 1, 2), (5, 90, 5))[0])]
            model = last_model(bench, spec)
            logs_of_models = [("session", frames, None), ("disturbed session", disturbed, None)]
            logs_of_models += [(f"session of {model}", frames, model)] if model else []
            for what, log, model in logs_of_models:
                lines, _, differences, seconds = compare(bench, spec, bench.log(log), model=model)
                wholes = sum(len(line["wholes"]) for line in lines[:-1])
                wrong += report(name, f"{what}, {wholes} long", lines, differences, seconds)
    return wrong


def compare_captures(bench):
    """Compares the captures of logs with the lines themselves."""
    names = ["frame.time_epoch", "frame.interface_name", "can.id", "can.len", "can.flags.rtr", "frame.len"]
    call = [word for name in names for word in ("-e", name)]
    logs = [*glob.glob(os.path.join(ROOT, "tests", "logs", "*.log")), os.path.join(PEERS, "tshark_wide.log")]
    frames = wrong = 0
    for log in sorted(logs):
        rows = bench.run("tshark", "-n", "-r", bench.capture(log), "-T", "fields", *call).splitlines()
        with open(log, encoding="utf-8") as file:
            lines = [line.split()[:3] for line in file if "#" in line]
        for row, line in zip(rows, lines, strict=True):
            found, wanted = frame_of_row(row), frame_of_line(*line)
            frames += 1
            if found != wanted:
                wrong += 1
                print(f"    {' '.join(line)}: {found} in place of {wanted}")
    print(f"{'captures':20} {'times, channels, lengths':26} {frames:6} frames, {wrong:24} differ")
    return wrong


def compare_links(bench):
    """Compares the links of the heater's log with those written beside its frames."""
    spec = os.path.join(PEERS, "tshark.yaml")
    with open(os.path.join(PEERS, "tshark_links.log"), encoding="utf-8") as file:
        rows = [row.split("|") for row in file.read().splitlines() if not row.startswith("#")]
    log = bench.log(row[0] for row in rows)
    dissector = Dissector(bench, spec, "heater")
    shown, _ = dissector.rows(bench.capture(log), "-2", "-Y", "heater")
    wrong = 0
    for number, (row, (frame, *links)) in enumerate(zip(shown, rows, strict=True), start=1):
        found = [row.get(f"heater.{name}", "-") for name in LINKS]
        if found != [link.strip() for link in links]:
            wrong += 1
            print(f"    frame {number}, {frame.strip()}: {found} in place of {links}")
    linked = sum("heater.request_in" in row for row in shown)
    print(f"{'links':20} {'requests and replies':26} {len(shown):6} frames, {linked:6} linked, {wrong:9} differ")
    return wrong


def compare_taken_names(bench):
    """Compares by copies of a spec whose protocol is called as one of Wireshark's own."""
    wrong = 0
    for name in TAKEN_NAMES:
        spec = bench.copy(lambda text: re.sub("^protocol: .*$", f"protocol: {name}", text, flags=re.MULTILINE))
        lines, _, differences, seconds = compare(
            bench, spec, bench.random_log(spec, OF_A_FEATURE), shown_as=f"canspec_{name}"
        )
        wrong += report("tshark.yaml", f"as protocol {name}", lines, differences, seconds)
    return wrong


def find_reserved_names(bench):
    """Loads dissectors of protocols whose names Wireshark does not allow, all at once."""
    scripts = []
    for name in RESERVED_NAMES:
        spec = bench.copy(lambda text: re.sub("^protocol: .*$", f'protocol: "{name}"', text, flags=re.MULTILINE))
        path = bench.path(f"{name}.lua")
        os.rename(bench.dissector(spec), path)
        scripts += ["-X", f"lua_script:{path}"]
    done = subprocess.run(["tshark", "-G", "protocols", *scripts], capture_output=True, text=True)
    known = {row.split("\t")[2] for row in done.stdout.splitlines()}
    missing = [name for name in RESERVED_NAMES if f"canspec_{name}" not in known]
    print(f"{'tshark.yaml':20} {'reserved names':26} {len(RESERVED_NAMES):6} names, {len(missing):6} fail")
    if missing:
        print(f"    {' '.join(missing)}: {done.stderr.strip()}")
    return len(missing)


def find_mistakes(bench):
    """Dissects by wrong copies of a spec; each must be noticed."""
    log = bench.random_log(SPEC, OF_A_FEATURE)
    missed = 0
    for name, (before, after) in MISTAKES.items():
        def mistaken(text):
            if text.count(before) != 1:
                sys.exit(f"{before!r} stands {text.count(before)} times in {SPEC}")
            return text.replace(before, after)

        lines, _, differences, _ = compare(bench, SPEC, log, dissected=bench.copy(mistaken))
        print(f"{name:20} {'must be found':26} {len(lines):6} frames, {len(differences):6} differ")
        missed += not differences
    return missed


def main():
    if shutil.which("tshark") is None:
        print("SKIPPED: there is no tshark, so nothing compares the exported dissectors with `canspec decode`;")
        print("SKIPPED: `apt-get install --no-install-recommends tshark` installs it.")
        return 0
    canspec, frames = (os.path.abspath(path) for path in sys.argv[1:])
    protocols = sorted(glob.glob(os.path.join(ROOT, "specs", "*.yaml")))
    features = sorted(glob.glob(os.path.join(ROOT, "tests", "specs", "features", "*.yaml")))
    features += sorted(glob.glob(os.path.join(PEERS, "tshark*.yaml")))
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(canspec, frames, folder)
        print(bench.run("tshark", "--version").splitlines()[0])
        count = max(OF_A_PROTOCOL, -(-OF_ALL_PROTOCOLS // len(protocols)))
        wrong = sum(compare_spec(bench, spec, count) for spec in protocols)
        wrong += sum(compare_spec(bench, spec, OF_A_FEATURE) for spec in features)
        if shutil.which("lua5.4"):
            wrong += sum(compare_plain_lua(bench, spec) for spec in protocols + features)
        else:
            print("SKIPPED: there is no lua5.4, so the dissectors run in tshark's version of Lua alone;")
            print("SKIPPED: `apt-get install --no-install-recommends lua5.4` installs it.")
        wrong += compare_sessions(bench, protocols + features)
        wrong += compare_captures(bench) + compare_edges(bench) + compare_links(bench) + compare_taken_names(bench)
        wrong += find_reserved_names(bench) + find_mistakes(bench)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
