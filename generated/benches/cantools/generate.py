"""Writes the C that cantools makes of a DBC, and calls of it for `main.c`: generate.py DBC FOLDER.

Of signals that share bytes, the multiplexor chooses one.
"""

import subprocess
import sys
from pathlib import Path

import cantools

FUNCTIONS = """
static void decode_{name}(const uint8_t *data, size_t length) {{
    struct {prefix}_t m;
    if ({prefix}_unpack(&m, data, length) == 0) {{ {take} }}
}}
static void values_{name}(const uint8_t *data, double *v) {{
    struct {prefix}_t m;
    {prefix}_unpack(&m, data, 8);
    {keep}
}}
static bool encode_{name}(const double *v, uint8_t *data) {{
    struct {prefix}_t m;
    {put}
    return {prefix}_pack(data, &m, 8) == 8;
}}
"""


def main(dbc, folder):
    protocol = Path(dbc).stem
    command = [sys.executable, "-m", "cantools", "generate_c_source", "--database-name", protocol]
    subprocess.run([*command, "--output-directory", folder, dbc], check=True, stdout=subprocess.DEVNULL)
    messages = cantools.database.load_file(dbc).messages
    functions = "".join(functions_of(protocol, message) for message in messages)
    rows = "".join(f"    X({snake(message.name)}, 0x{message.frame_id:X})\\\n" for message in messages)
    Path(folder, "calls.h").write_text(f'#include "{protocol}.h"\n{functions}\n#define MESSAGES(X)\\\n{rows}\n')


def functions_of(protocol, message):
    name = snake(message.name)
    prefix = f"{protocol}_{name}"
    takes = lambda signal, _: f"take({prefix}_{signal}_decode(m.{signal}));"
    keeps = lambda signal, i: f"v[{i}] = {prefix}_{signal}_decode(m.{signal});"
    puts = lambda signal, i: (
        f"if (!{prefix}_{signal}_is_in_phys_range(v[{i}])) return false; m.{signal} = {prefix}_{signal}_encode(v[{i}]);"
    )
    return FUNCTIONS.format(
        name=name,
        prefix=prefix,
        take=each(message, takes, is_taken=lambda signal: not signal.is_multiplexer),
        keep=each(message, keeps),
        put=each(message, puts) or "m.dummy = 0;",
    )


def each(message, does, is_taken=lambda signal: True):
    """Does something with each signal, and with the one that a multiplexor names."""
    plain = [signal for signal in message.signals if not signal.multiplexer_ids]
    own = " ".join(does(snake(signal.name), i) for i, signal in enumerate(plain) if is_taken(signal))
    named = [signal for signal in message.signals if signal.multiplexer_ids]
    if not named:
        return own
    cases = " ".join(
        f"case {value}: {does(snake(signal.name), len(plain))} break;"
        for signal in named
        for value in signal.multiplexer_ids
    )
    return f"{own} switch (m.{snake(named[0].multiplexer_signal)}) {{ {cases} }}"


def snake(name):
    return "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in name).lstrip("_")


main(*sys.argv[1:])
