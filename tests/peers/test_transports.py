"""The comparison of `transports.py` finds mistakes.

The program is named by the variable TRANSPORTS; `.ci/peers` sets it.
"""

import os
import random
import unittest

from transports import J1939, Node, failures, j1939_messages, parted, word

TRANSPORTS = os.environ["TRANSPORTS"]


class Mistakes(unittest.TestCase):
    """A bus that spoils a frame."""

    def failures(self, spoilt=lambda frame: [frame]):
        """Returns for each message whether it fails: to one and to two groups of all, from us and from them."""
        return [self.fails(message, spoilt) for message in j1939_messages([30], random.Random(1))]

    @staticmethod
    def fails(message, spoilt):
        with Node(TRANSPORTS, "j1939") as ours:
            return any(failures(ours, J1939(255), [message], spoilt))

    @staticmethod
    def packet(number, spoilt):
        """Returns a bus that spoils one packet."""

        def spoil(frame):
            identifier, data = parted(frame)
            is_meant = identifier >> 16 & 0xFF == 0xEB and data[0] == number
            return [word("#", identifier, data) for data in (spoilt(data) if is_meant else [data])]

        return spoil

    def test_a_bus_that_spoils_nothing_does_not_fail(self):
        self.assertEqual(self.failures(), [False] * 6)

    def test_a_changed_byte_fails(self):
        self.assertEqual(self.failures(self.packet(2, lambda data: [data[:5] + bytes([data[5] ^ 1]) + data[6:]])), [True] * 6)

    def test_a_lost_packet_fails(self):
        # can-j1939 counts no packets. So it sends another one where we ask for the lost one.
        self.assertEqual(self.failures(self.packet(2, lambda data: [])), [True] * 6)

    def test_a_packet_with_other_data_that_comes_again_fails(self):
        other = self.packet(3, lambda data: [data, data[:7] + bytes([data[7] ^ 1])])
        self.assertEqual(self.failures(other), [True] * 6)


if __name__ == "__main__":
    unittest.main()
