"""The programs that `tshark.py` compares, and what they show of frames."""

import collections
import json
import os
import resource
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PEERS = os.path.join(ROOT, "tests", "peers")
# A spec with some of everything.
SPEC = os.path.join(PEERS, "tshark.yaml")
# The last line of each log.
LAST = "(4000000.000000) can0 000#R"


def processor_time():
    """Returns the seconds that the programs called so far have worked."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Bench:
    """A folder with the programs that are compared."""

    def __init__(self, canspec, frames, folder):
        self.canspec, self.frames, self.folder = canspec, frames, folder

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *call):
        return subprocess.run(call, check=True, capture_output=True, text=True, cwd=self.folder).stdout

    def dissector(self, spec):
        path = self.path("protocol.lua")
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.run(self.canspec, "export", "wireshark", "--spec", spec))
        return path

    def capture(self, log):
        path = self.path("bus.pcapng")
        self.run(self.canspec, "decode", "--to", "pcapng", path, log)
        return path

    def decoded(self, spec, log, model):
        """Returns the decoded lines, each with the long messages that it ends."""
        chosen = ["--model", model] if model else []
        text = self.run(self.canspec, "decode", "--spec", spec, "--format", "jsonl", "--assemble", *chosen, log)
        lines = []
        for known in map(json.loads, text.splitlines()):
            if "lines" in known:
                lines[-1]["wholes"].append(known)
            else:
                lines.append(known | {"wholes": []})
        return lines

    def log_of_examples(self, spec):
        examples = self.run(self.canspec, "examples", "--spec", spec, "--format", "jsonl").splitlines()
        examples = [json.loads(line) for line in examples]
        frames = [f"{example['id']}#{example['data']}" for example in examples if example["data"]]
        return self.log(f"({number}.{number:09}) can0 {frame}" for number, frame in enumerate(frames))

    def random_log(self, spec, count):
        return self.log(self.run(self.frames, "any", spec, str(count), "227").splitlines())

    def copy(self, change):
        """Returns a changed copy of the spec that has some of everything, without its examples."""
        with open(SPEC, encoding="utf-8") as file:
            text, _ = file.read().split("\nexamples:\n")
        path = self.path("copy.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(change(text))
        return path

    def log(self, lines):
        """Writes a log. Its last frame is remote: what the end of the log ends stands there, and no dissector knows it."""
        path = self.path("bus.log")
        with open(path, "w", encoding="utf-8") as file:
            file.writelines(f"{line}\n" for line in (*lines, LAST))
        return path


class Dissector:
    """tshark with an exported dissector."""

    def __init__(self, bench, spec, protocol):
        self.bench, self.protocol, self.lua = bench, protocol, bench.dissector(spec)
        rows = bench.run("tshark", "-G", "fields", "-X", f"lua_script:{self.lua}").splitlines()
        rows = [row.split("\t") for row in rows]
        self.types = {row[2]: row[3] for row in rows if row[0] == "F" and row[2].startswith(protocol + ".")}

        self.groups = {name: self.group(name) for name in ("identifier", "selector", "note")}

    def group(self, name):
        """Returns the prefix of a group of fields, which gives way to a message of the same name."""
        is_taken = any(field.startswith(f"{self.protocol}.{name}_.") for field in self.types)
        return f"{self.protocol}.{name}{'_' if is_taken else ''}"

    def rows(self, capture, *options):
        """Returns the fields that each frame has, by name, and the processor time that it took."""
        names = ["_ws.lua.error", "_ws.col.Info", "_ws.expert.message", *self.types]
        call = ["tshark", "-n", "-r", capture, "-X", f"lua_script:{self.lua}", *options, "-T", "fields"]
        started = processor_time()
        done = subprocess.run(call + [word for name in names for word in ("-e", name)], capture_output=True, text=True)
        seconds = processor_time() - started
        if done.returncode != 0 or "Lua" in done.stderr:
            sys.exit(f"tshark: {done.stderr.strip()}")
        cells = (zip(names, line.split("\t")) for line in done.stdout.split("\n")[:-1])
        return [{name: cell for name, cell in row if cell != ""} for row in cells], seconds


def rows_of_plain_lua(bench, dissector, lines, model):
    """Returns the fields that each frame has in plain Lua 5.4."""
    frames = (
        f"{line['line']} {line['time']} {line['channel']} {line['id']} {29 if len(line['id']) == 8 else 11}"
        f" {line['data'] or '-'}\n"
        for line in lines
    )
    call = ["lua5.4", os.path.join(PEERS, "tshark_lua54.lua"), dissector.lua, str(model)]
    done = subprocess.run(call, input="".join(frames), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"lua5.4: {done.stderr.strip()}")
    rows = []
    for line in done.stdout.split("\n")[:-1]:
        row = collections.defaultdict(list)
        for name, _, value in (cell.partition("=") for cell in line.split("\t") if cell):
            row[name].append(value)
        rows.append({name: ",".join(values) for name, values in row.items() if values != [""]})
    return rows
