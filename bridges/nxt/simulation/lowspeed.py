"""I2C at a sensor port: one transaction at a time, 16 bytes of buffer.

The firmware answers an LSREAD when no bytes are there as if it had read
none; that it was sent is counted, since a client must not do so.
"""

OK, PENDING, BUS_ERROR, NOT_READY, BAD_SIZE = 0x00, 0x20, 0xDD, 0xE0, 0xED
BUFFER = 16
TRANSACTION = 0.0004            # seconds; some clients ask only 30 times


class LowSpeed:
    def __init__(self, port):
        self.port = port
        self.unread = b''
        self.coming = b''
        self.done_at = 0.0
        self.failed = False
        self.empty_reads = 0

    def usable(self, now):
        return self.port.digital() and self.port.valid(now)

    def finish(self, now):
        """What has been read ends up in a ring of 16 bytes, behind what
        was not fetched; a full ring looks like an empty one."""
        if self.coming and now >= self.done_at:
            unread = self.unread + self.coming
            fill = len(unread) % BUFFER
            self.unread = unread[len(unread) - fill:]
            self.coming = b''

    def status(self, now):
        """status and bytes ready"""
        if not self.usable(now):
            return NOT_READY, 0
        self.finish(now)
        if now < self.done_at:
            return PENDING, len(self.unread)
        return (BUS_ERROR if self.failed else OK), len(self.unread)

    def write(self, data, count, now):
        if len(data) > BUFFER or count > BUFFER:
            return BAD_SIZE
        if not self.usable(now) or now < self.done_at:
            return NOT_READY
        self.finish(now)
        self.done_at = now + TRANSACTION
        device = self.port.device
        self.failed = not data or data[0] & 0xfe != device.address
        if not self.failed:
            self.transact(device, data[1:], count)
        return OK

    def transact(self, device, data, count):
        register = data[0] if data else 0
        if len(data) > 1:
            device.write(register, data[1:])
        self.coming = device.read(register, count)

    def read(self, now):
        """status and all bytes that are ready"""
        status, ready = self.status(now)
        self.empty_reads += ready == 0
        if status not in (OK, PENDING):
            return status, b''
        data, self.unread = self.unread[:ready], b''
        return status, data
