"""Reading requests and writing replies, byte by byte."""

import struct

INSANE = 0xBF


class Insane(Exception):
    """A request that ends too early."""


class Request:
    """The bytes of a telegram behind its opcode, taken from the left."""

    def __init__(self, data):
        self.data = data

    def take(self, layout):
        size = struct.calcsize('<' + layout)
        if len(self.data) < size:
            raise Insane
        values = struct.unpack('<' + layout, self.data[:size])
        self.data = self.data[size:]
        return values if len(values) > 1 else values[0]

    def name(self, size=20):
        """A name may be shorter than its field at the end of a telegram."""
        field, self.data = self.data[:size], self.data[size:]
        if not field:
            raise Insane
        return field.split(b'\0')[0].decode('latin-1')

    def rest(self):
        data, self.data = self.data, b''
        return data


def pack(layout, *values):
    return struct.pack('<' + layout, *values)


def packed_name(name, size=20):
    return name.encode('latin-1')[:size - 1].ljust(size, b'\0')
