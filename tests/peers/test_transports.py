"""The comparison of `transports.py` finds mistakes.

The program is named by the variable TRANSPORTS; `.ci/peers` sets it.
"""

import logging
import os
import random
import unittest

from transports import J1939, IsoTp, Node, failures, isotp_messages, j1939_messages, parted, word

TRANSPORTS = os.environ["TRANSPORTS"]
# can-isotp writes down each mistake that it finds.
logging.disable()


def changed(data, place):
    return data[:place] + bytes([data[place] ^ 1]) + data[place + 1 :]


class Bus(unittest.TestCase):
    """A bus that spoils frames of a message of 30 bytes."""

    def fails(self, is_meant=lambda identifier, data: False, spoilt=lambda data: [data]):
        """Returns for each message whether it fails, if the bus spoils the frames that are meant."""

        def spoil(frame):
            identifier, data = parted(frame)
            return [word("#", identifier, data) for data in (spoilt(data) if is_meant(identifier, data) else [data])]

        def fails(message):
            with Node(TRANSPORTS, *self.node) as ours:
                return any(failures(ours, self.peer(), [message], spoil))

        return set(map(fails, self.messages([30], random.Random(1))))


class SpoiltJ1939(Bus):
    node = ["j1939", 255]
    messages = staticmethod(j1939_messages)

    def peer(self):
        return J1939(255)

    @staticmethod
    def packet(number):
        return lambda identifier, data: identifier >> 16 & 0xFF == 0xEB and data[0] == number

    def test_a_bus_that_spoils_nothing_does_not_fail(self):
        self.assertEqual(self.fails(), {False})

    def test_a_changed_byte_fails(self):
        self.assertEqual(self.fails(self.packet(2), lambda data: [changed(data, 5)]), {True})

    def test_a_lost_packet_fails(self):
        # can-j1939 counts no packets. So it sends another one where we ask for the lost one.
        self.assertEqual(self.fails(self.packet(2), lambda data: []), {True})

    def test_a_packet_with_other_data_that_comes_again_fails(self):
        self.assertEqual(self.fails(self.packet(3), lambda data: [data, changed(data, 7)]), {True})


class SpoiltIsoTp(Bus):
    node = ["isotp", 2, 0]
    messages = staticmethod(isotp_messages)

    def peer(self):
        return IsoTp(2, 0, None)

    @staticmethod
    def head(byte):
        return lambda identifier, data: data[0] == byte

    def test_a_bus_that_spoils_nothing_does_not_fail(self):
        self.assertEqual(self.fails(), {False})

    def test_a_changed_byte_fails(self):
        self.assertEqual(self.fails(self.head(0x22), lambda data: [changed(data, 5)]), {True})

    def test_a_changed_number_fails(self):
        self.assertEqual(self.fails(self.head(0x22), lambda data: [changed(data, 0)]), {True})

    def test_a_lost_or_repeated_frame_fails(self):
        self.assertEqual(self.fails(self.head(0x23), lambda data: []), {True})
        self.assertEqual(self.fails(self.head(0x23), lambda data: [data, data]), {True})

    def test_a_lost_or_refusing_flow_control_fails(self):
        self.assertEqual(self.fails(self.head(0x30), lambda data: []), {True})
        self.assertEqual(self.fails(self.head(0x30), lambda data: [b"\x32" + data[1:]]), {True})


if __name__ == "__main__":
    unittest.main()
