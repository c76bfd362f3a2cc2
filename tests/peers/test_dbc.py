"""The comparison of `dbc.py` finds mistakes, and each cause of a difference has a frame that shows it.

The programs are named by the variables CANSPEC and FRAMES; `.ci/peers` sets them.
"""

import os
import random
import re
import tempfile
import unittest
from pathlib import Path

from dbc import Protocol, cause, decoding, differences, encoding, run

CANSPEC, FRAMES = os.environ["CANSPEC"], os.environ["FRAMES"]
FEATURES = Path(__file__).parent.parent / "specs" / "features"
LITTLE_ENDIAN = FEATURES / "little_endian.yaml"
DALY = Path(__file__).parent.parent.parent / "specs" / "daly.yaml"


def changed(before, after):
    """Returns the spec with one mistake, and without the examples that would show it."""
    text = LITTLE_ENDIAN.read_text(encoding="utf-8")
    assert text.count(before) == 1, before
    return re.sub(r"\n    examples:.*?\n\n", "\n\n", text.replace(before, after), flags=re.DOTALL)


class Mistakes(unittest.TestCase):
    """A spec that is compared with the DBC of the right spec."""

    def failures(self, before, after):
        with tempfile.TemporaryDirectory() as folder:
            wrong = Path(folder) / "wrong.yaml"
            wrong.write_text(changed(before, after), encoding="utf-8")
            protocol = Protocol(CANSPEC, wrong, dbc_of=LITTLE_ENDIAN)
            frames = protocol.decode(run(FRAMES, "known", LITTLE_ENDIAN, 200, 1).splitlines())
            return len(frames), len(decoding(protocol, frames)[1])

    def test_an_unchanged_spec_does_not_fail(self):
        self.assertEqual(self.failures("scale: 0.02", "scale: 1/50"), (200, 0))

    # One frame in eight is all zeros, which mean the same at any scale and place.

    def test_a_wrong_scale_fails(self):
        self.assertGreater(self.failures("scale: 0.02", "scale: 0.03")[1], 150)

    def test_a_wrong_bit_fails(self):
        self.assertGreater(self.failures("bits: 63..56", "bits: 62..55")[1], 150)

    def test_a_wrong_sign_fails(self):
        # Every other current is negative.
        self.assertGreater(self.failures("as: signed, ", "")[1], 70)

    def test_a_wrong_scale_fails_in_encoding(self):
        # Half of the values are too large for the wrong spec, and are not compared.
        with tempfile.TemporaryDirectory() as folder:
            wrong = Path(folder) / "wrong.yaml"
            wrong.write_text(changed("scale: 1/2, unit: W", "scale: 1/4, unit: W"), encoding="utf-8")
            right = Protocol(CANSPEC, LITTLE_ENDIAN)
            frames = right.decode(run(FRAMES, "known", LITTLE_ENDIAN, 200, 1).splitlines())
            right.spec = wrong
            self.assertGreater(len(encoding(right, frames, random.Random(1))[2]), 50)


class Causes(unittest.TestCase):
    """A frame for each cause."""

    def test_address(self):
        protocol = Protocol(CANSPEC, FEATURES / "addressing.yaml")
        # Group 0x80: canspec notes that there is none, and cantools finds no message.
        (frame,) = protocol.decode(["008380F0#3200000000000000"])
        self.assertEqual(differences(protocol, frame), ["no message of the DBC has this identifier"])
        self.assertEqual(cause(frame), "address")

    def test_halfway(self):
        protocol = Protocol(CANSPEC, LITTLE_ENDIAN)
        (frame,) = protocol.decode(["083#0000000000000000"])
        # One step is 0.5 degrees.
        frame["signals"]["temperature"]["value"] = -39.75
        values = protocol.message(frame).decode(bytes(8)) | {"temperature": -39.75}
        frame["time"] = 0
        self.assertEqual(protocol.message(frame).encode(values)[3], 0)
        self.assertEqual(protocol.encode([frame])[0][3], 1)


class Directions(unittest.TestCase):
    """Hosts whose addresses have no bit in common, so no mask tells requests from replies."""

    REQUEST, REPLY = "18900140#0000000000000000", "18904001#0218021675300288"

    def test_a_dbc_by_a_mask_holds_replies_alone(self):
        protocol = Protocol(CANSPEC, DALY)
        request, reply = protocol.decode([self.REQUEST, self.REPLY])
        self.assertEqual([protocol.holds(request), protocol.holds(reply)], [False, True])
        self.assertEqual(decoding(protocol, [reply])[1], [])
        self.assertNotEqual(decoding(protocol, [request])[1], [])

    def test_a_dbc_of_nodes_holds_both(self):
        protocol = Protocol(CANSPEC, DALY, "--nodes", "1-2")
        frames = protocol.decode([self.REQUEST, self.REPLY])
        self.assertTrue(all(map(protocol.holds, frames)))
        self.assertEqual(decoding(protocol, frames)[1], [])


if __name__ == "__main__":
    unittest.main()
