"""What the YAML language server makes of the schema: it offers keys and words, marks mistakes, and tells what a key means.

The server is named by the variable SERVER; `.ci/editor` sets it.
"""

import itertools
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from server import NO_NETWORK, Server

ROOT = Path(__file__).parent.parent.parent
SPECS = ROOT / "specs"
SPEC = SPECS / "trio.yaml"
FIRST_LINE = "# yaml-language-server: $schema=canspec.schema.json\n"
REFERENCE = (ROOT / "docs" / "language" / "reference.md").read_text(encoding="utf-8")

# Lines of the spec, after which something is written.
SIGNAL = "      operation:       {bytes: 1, type: operation, erratum: T7}\n"
MESSAGE = "messages:\n"
TYPE = "types:\n"
ACCESS = "access:\n"
ERRATUM = "errata:\n"

UNITS = "V A W VA var Ah Wh Ω Hz °C K Pa % s ms min h rpm m".split()

names = itertools.count()


def setUpModule():
    global server
    server = Server(os.environ["SERVER"])
    unittest.addModuleCleanup(server.stop)


class Edited:
    """The spec with something written after a line; each `¦` marks a place."""

    def __init__(self, line, written):
        text = SPEC.read_text(encoding="utf-8")
        assert text.count("\n" + line) == 1, line
        head, *rest = text.replace("\n" + line, f"\n{line}{written}\n").split("¦")
        self.places = []
        for part in rest:
            self.places.append({"line": head.count("\n"), "character": len(head) - head.rfind("\n") - 1})
            head += part
        self.path = SPECS / f"edited_{next(names)}.yaml"
        self.diagnostics = server.open(self.path, head)

    def labels(self):
        return [item["label"] for item in server.completion(self.path, self.places[0])]

    def hover(self):
        return server.hover(self.path, self.places[0])

    def range(self):
        return {"start": self.places[0], "end": self.places[1]}


def rows(heading):
    """Returns the cells of each row in the first table of a section of the language reference."""
    section = re.split(rf"^## {re.escape(heading)}$", REFERENCE, flags=re.MULTILINE)[1]
    table = re.search(r"^\| (?:key|entry) .*\n\|[-|]*\n((\|.*\n)*)", section, flags=re.MULTILINE)[1]
    return [row.split("|")[1:] for row in table.splitlines()]


def documented(heading):
    """Returns the keys in such a table."""
    return {key for cells in rows(heading) for key in re.findall(r"`(\w+)`", cells[0])}


def choices(key):
    """Returns the words among which a key of a field chooses."""
    [choice] = [cells[2] for cells in rows("Fields") if cells[0].strip() == f"`{key}`"]
    return set(re.findall(r"`(\w+)`", choice))


class Completion(unittest.TestCase):
    """What is offered at the cursor."""

    def offered(self, line, written):
        labels = Edited(line, written).labels()
        self.assertEqual(len(labels), len(set(labels)), labels)
        return set(labels)

    def test_the_reference_has_the_keys_of_a_signal(self):
        keys = {"bytes", "bits", "type", "scale", "offset", "unit", "range", "values", "fields", "section"}
        self.assertLess(keys, documented("Fields"))
        self.assertEqual(documented("`errata`"), {"kind", "prints", "uses", "because", "section"})

    def test_a_signal_in_block_style_is_offered_its_keys(self):
        self.assertEqual(self.offered(SIGNAL, "      current:\n        ¦"), documented("Fields"))

    # Where a key is on the line, the server wants a first letter between the braces.

    def test_a_signal_in_flow_style_is_offered_its_keys(self):
        self.assertEqual(self.offered(SIGNAL, "      current: {s¦}"), documented("Fields"))

    def test_keys_that_are_there_are_not_offered_again(self):
        there = {"bytes", "scale", "unit"}
        written = "      current: {bytes: 2..3, scale: 1/10, s¦, unit: A}"
        self.assertEqual(self.offered(SIGNAL, written), documented("Fields") - there)

    def test_a_signal_of_a_word_and_the_only_signal_of_a_message_are_offered_their_keys(self):
        for line, written in [
            (SIGNAL, "      word:\n        bytes: 2\n        fields:\n          low: {b¦}"),
            (MESSAGE, "  current:\n    value: {b¦}"),
            (MESSAGE, "  current:\n    value:\n      ¦"),
        ]:
            self.assertEqual(self.offered(line, written), documented("Fields"), written)

    def test_a_field_of_the_identifier_is_offered_its_keys(self):
        self.assertEqual(self.offered("identifier:\n", "  more: {b¦}"), documented("Fields"))
        self.assertEqual(self.offered("identifier:\n", "  ¦"), documented("`identifier`"))

    def test_messages_and_accesses_are_offered_their_keys(self):
        for line, written, heading in [
            (MESSAGE, "  current:\n    ¦", "`messages`"),
            (ACCESS, "  read:\n    ¦", "`access`"),
        ]:
            self.assertEqual(self.offered(line, written), documented(heading), heading)

    def test_a_status_bit_is_offered_its_keys(self):
        written = "  alarms:\n    status:\n      fan_fault: {bit: 3, s¦}"
        self.assertEqual(self.offered(TYPE, written), documented("Status bits") - {"bit"})

    def test_the_top_level_is_offered_the_keys_that_are_missing(self):
        there = set(re.findall(r"^(\w+):", SPEC.read_text(encoding="utf-8"), flags=re.MULTILINE))
        self.assertEqual(self.offered("length: 8\n", "¦"), documented("The top level") - there)

    def test_a_unit_is_one_of_the_list(self):
        # YAML wants quotes around a value that begins with a per cent sign.
        units = {'"%"' if unit == "%" else unit for unit in UNITS}
        self.assertEqual(self.offered(SIGNAL, "      current: {bytes: 2, unit: ¦}"), units)
        self.assertEqual(self.offered(SIGNAL, "      current:\n        unit: ¦"), units)

    def test_words_are_offered_where_one_of_a_few_must_stand(self):
        kinds = {"request", "reply", "report"}
        answers = {"one", "each", "coordinator", "nobody"}
        for line, written, words in [
            (TYPE, "  alarms: {status: {fan_fault: {bit: 3, severity: ¦}}}", {"state", "alarm", "fault"}),
            (TYPE, "  current: {as: ¦}", choices("as")),
            (TYPE, "  group: {outside: ¦}", {"refused"}),
            (SIGNAL, "      current: {bytes: 2, in: [¦]}", kinds),
            (ACCESS, "  read: {in: [¦]}", kinds),
            (ACCESS, "  read: {answers: {point_to_point: ¦}}", answers),
            (MESSAGE, "  current: {answers: {point_to_point: ¦}}", answers),
            (MESSAGE, "  currents: {in: [¦]}", {"request", "reply"}),
            (ACCESS, "  read: {from: ¦}", {"module", "controller"}),
            (TYPE, "  current: {absent: ¦}", {"ones", "none"}),
            (MESSAGE, "  current: {reserved: {expect: ¦}}", {"sent", "any"}),
            (MESSAGE, "  current: {examples: [{origin: ¦}]}", {"ours", "captured"}),
            (ERRATUM, "  T0: {kind: ¦}", {"vendor", "translation", "ocr", "unclear", "gap", "note"}),
        ]:
            self.assertEqual(self.offered(line, written), words, written)


class Mistakes(unittest.TestCase):
    """What is marked in the text."""

    def assert_marked(self, line, written, message):
        edited = Edited(line, written)
        found = [(found["range"], found["message"]) for found in edited.diagnostics]
        self.assertEqual(found, [(edited.range(), message)], written)

    def test_a_wrong_key_is_named_at_its_place(self):
        message = "Property scal is not allowed."
        self.assert_marked(SIGNAL, "      current: {bytes: 2..3, ¦scal¦: 1/10, unit: A}", message)
        self.assert_marked(SIGNAL, "      current:\n        bytes: 2..3\n        ¦scal¦: 1/10", message)

    def test_a_wrong_key_of_the_identifier_is_named_at_its_place(self):
        self.assert_marked("identifier:\n", "  more: {¦bit¦: 28}", "Property bit is not allowed.")

    def test_a_missing_key_is_named(self):
        self.assert_marked(ERRATUM, "  ¦T0¦: {kind: ocr, prints: 1, uses: 2}", 'Missing property "because".')

    def test_a_value_of_another_kind_is_marked(self):
        message = "Incorrect type. Expected one of string, number."
        self.assert_marked(SIGNAL, "      current: {bytes: 2, scale: ¦[1]¦}", message)
        self.assert_marked(SIGNAL, "      current: {bytes: ¦true¦}", message)

    def test_another_word_than_those_of_the_list_is_marked(self):
        formats = "unsigned signed bcd float text bytes".split()
        message = "Value is not accepted. Valid values: " + ", ".join(f'"{known}"' for known in formats) + "."
        for known in ["integer", "[signed]", "5"]:
            self.assert_marked(SIGNAL, f"      current: {{bytes: 2, as: ¦{known}¦}}", message)

    def test_a_text_that_is_no_number_or_place_is_marked_with_what_to_write(self):
        number = "Write a number: `12`, `-40`, `0x1F`, `0b101`, `41.5` or `1/1024`."
        for line, written, message in [
            (SIGNAL, "      current: {bytes: ¦yes¦}", "Write `0..3` or one number."),
            ("identifier:\n", "  more: {bits: ¦28..¦}", "Write `7..4` or one number."),
            ("identifier:\n", "  ones: ¦four¦", "Write `7..4` or one number."),
            (SIGNAL, "      current: {bytes: ¦2-3¦}", "Write `0..3` or one number."),
            (SIGNAL, "      current: {bytes: 2, scale: ¦1 / 10¦}", number),
            (SIGNAL, "      current: {bytes: 2, range: ¦0 to 5¦}", "Write the limits as `41.5..58.5`."),
            (MESSAGE, "  current: {match: {command: ¦0x3G¦}}", number),
            (ACCESS, "  read: {request: {command: ¦three¦}}", number),
        ]:
            self.assert_marked(line, written, message)

    def test_numbers_and_places_of_every_form_are_not_marked(self):
        written = "      x: {bytes: 0x2..3, bits: 7, offset: -40, scale: 0x1/0x400, range: -1/2..0.5, const: 0xFD}"
        self.assertEqual(Edited(SIGNAL, written).diagnostics, [])

    def test_no_good_spec_is_marked(self):
        folders = [SPECS, *(ROOT / "tests" / "specs" / name for name in ["", "features", "devices"])]
        paths = [path for folder in folders for path in sorted(folder.glob("*.yaml"))]
        self.assertGreater(len(paths), 25)
        for path in paths:
            text = path.read_text(encoding="utf-8").removeprefix(FIRST_LINE)
            self.assertEqual(server.open(SPECS / f"good_{next(names)}.yaml", FIRST_LINE + text), [], path)


class Hover(unittest.TestCase):
    """What is said of the key under the cursor."""

    def test_a_key_is_explained(self):
        said = Edited(SIGNAL, "      current: {bytes: 2, sc¦ale: 1/10}").hover()
        self.assertIn("\n\nSize of one raw step in the field's unit, exact: `1/10` or `0.02`; 1 if absent.", said)

    def test_a_key_that_holds_keys_is_explained_with_its_example(self):
        said = Edited(MESSAGE, "  current:\n    val¦ue: {bytes: 2}").hover()
        self.assertIn("The only field of the message", said)
        self.assertIn("`{bytes: 4..7, as: float, unit: V}`", said)


class Schema(unittest.TestCase):
    """Where the schema comes from."""

    def in_folder(self, first_line):
        """Returns what is wrong with the key `colour`, beside a schema that has it."""
        with tempfile.TemporaryDirectory() as folder:
            schema = json.loads((SPECS / "canspec.schema.json").read_text(encoding="utf-8"))
            schema["properties"]["colour"] = {"enum": ["red", "green"]}
            (Path(folder) / "another.json").write_text(json.dumps(schema), encoding="utf-8")
            text = SPEC.read_text(encoding="utf-8").replace(FIRST_LINE, first_line)
            return [found["message"] for found in server.open(Path(folder) / "spec.yaml", text + "colour: blue\n")]

    def test_the_first_line_names_it(self):
        complaints = self.in_folder(FIRST_LINE.replace("canspec.schema", "another"))
        self.assertEqual(complaints, ['Value is not accepted. Valid values: "red", "green".'])

    def test_there_is_none_without_the_first_line(self):
        self.assertEqual(self.in_folder(""), [])

    def test_a_server_that_reached_for_the_network_would_have_ended(self):
        call = ["node", "--require", NO_NETWORK, "--eval", "require('node:http').get('http://127.0.0.1:9')"]
        done = subprocess.run(call, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (1, "the program reached for the network\n"))


if __name__ == "__main__":
    unittest.main()
