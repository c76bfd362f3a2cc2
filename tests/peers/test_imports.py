"""The comparison of `imports.py` finds mistakes.

The program is named by the variable CANSPEC; `.ci/peers` sets it.
"""

import os
import random
import unittest
from pathlib import Path

from imports import File

CANSPEC = os.environ["CANSPEC"]
PUMP = Path(__file__).parent.parent / "commands" / "import.in" / "pump.dbc"


class Mistakes(unittest.TestCase):
    """A spec that is changed between import and export."""

    def failures(self, before="", after=""):
        def change(spec):
            self.assertTrue(not before or spec.count(before) == 1, before)
            return spec.replace(before, after) if before else spec

        counts, failures = File(CANSPEC, PUMP, change).compare(random.Random(1))
        self.assertGreater(counts["frames"], 500)
        return failures

    def test_an_unchanged_spec_does_not_fail(self):
        self.assertEqual(self.failures(), [])

    def test_a_wrong_scale_fails(self):
        self.assertGreater(len(self.failures("scale: 0.5", "scale: 0.6")), 150)

    def test_a_wrong_byte_order_fails(self):
        self.assertGreater(len(self.failures("speed: {bytes: 1..0", "speed: {bytes: 0..1")), 150)

    def test_a_wrong_bit_fails(self):
        self.assertGreater(len(self.failures("bits: 2..0", "bits: 6..4")), 150)

    def test_a_wrong_sign_fails(self):
        # Half of the temperatures are negative.
        self.assertGreater(len(self.failures("as: signed, offset", "offset")), 70)

    def test_a_wrong_name_fails(self):
        self.assertGreater(len(self.failures("failed", "broken")), 70)

    def test_a_wrong_cycle_fails(self):
        self.assertEqual(self.failures("time: 500 ms", "time: 501 ms"), ["PumpStatus has another length or cycle"])

    def test_a_missing_signal_fails(self):
        self.assertGreater(len(self.failures("\n      flow: {bytes: 4..7, as: float, title: Flow in l/min}", "")), 150)


if __name__ == "__main__":
    unittest.main()
