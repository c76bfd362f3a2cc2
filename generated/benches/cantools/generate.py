"""Writes the C that cantools makes of a DBC, and calls of it for `main.c`: generate.py DBC FOLDER."""

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
    if (!(true{fits})) return false;
    {put}
    return {prefix}_pack(data, &m, 8) == 8;
}}
"""


def main(dbc, folder):
    command = [sys.executable, "-m", "cantools", "generate_c_source", "--database-name", "infy"]
    subprocess.run([*command, "--output-directory", folder, dbc], check=True, stdout=subprocess.DEVNULL)
    messages = cantools.database.load_file(dbc).messages
    functions = "".join(functions_of(message) for message in messages)
    rows = "".join(f"    X({snake(message.name)}, 0x{message.frame_id:X})\\\n" for message in messages)
    Path(folder, "calls.h").write_text(f'#include "infy.h"\n{functions}\n#define MESSAGES(X)\\\n{rows}\n')


def functions_of(message):
    name = snake(message.name)
    prefix = f"infy_{name}"
    signals = [snake(signal.name) for signal in message.signals]
    return FUNCTIONS.format(
        name=name,
        prefix=prefix,
        take=" ".join(f"take({prefix}_{signal}_decode(m.{signal}));" for signal in signals),
        keep=" ".join(f"v[{i}] = {prefix}_{signal}_decode(m.{signal});" for i, signal in enumerate(signals)),
        fits="".join(f" && {prefix}_{signal}_is_in_phys_range(v[{i}])" for i, signal in enumerate(signals)),
        put=" ".join(f"m.{signal} = {prefix}_{signal}_encode(v[{i}]);" for i, signal in enumerate(signals))
        or "m.dummy = 0;",
    )


def snake(name):
    return "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in name).lstrip("_")


main(*sys.argv[1:])
