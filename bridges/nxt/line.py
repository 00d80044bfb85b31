"""A serial line with an NXT at its other end: telegrams out, replies in.

A Line opens its port when it is first needed, and again after it was lost.
Every exchange has a deadline, a time of time.monotonic().  After anything
that may leave half a reply on the line, the next exchange begins with a
resynchronisation, see resynchronise().
"""

import errno
import time

import serial

import telegram

try:
    from termios import error as TermiosError
except ImportError:                     # not Unix
    TermiosError = OSError

TROUBLE = (OSError, TermiosError)       # SerialException is an OSError

READ_SLICE = 0.05                       # seconds
WRITE_TIMEOUT = 1.0                     # seconds
LONGEST_REPLY = 300                     # bytes; more is garbage
# These have nothing that could be locked.
UNLOCKED = ('socket://', 'rfc2217://', 'loop://', 'cp2110://')

NO_SUCH = (errno.ENOENT, errno.ENODEV, errno.ENXIO, errno.ENOTDIR,
           errno.ECONNREFUSED)
FORBIDDEN = (errno.EACCES, errno.EPERM, errno.EROFS)
BUSY = (errno.EAGAIN, errno.EBUSY)


class LineError(Exception):
    """What went wrong: a kind for programs, a text for people."""

    def __init__(self, kind, text, **more):
        super().__init__(text)
        self.kind, self.more = kind, more


class Line:
    """One port.  Used by one thread, except cancel()."""

    def __init__(self, port, baudrate):
        self.port, self.baudrate = port, baudrate
        self.serial = None
        self.in_step = False            # no late bytes to be expected
        self.cancelled = False
        self.openings = 0

    def cancel(self):
        """End the exchange that another thread is waiting in."""
        self.cancelled = True

    # The port

    def open(self):
        if self.serial is not None:
            return
        self.in_step = False
        options = {} if self.port.startswith(UNLOCKED) else \
            {'exclusive': True}
        try:
            self.serial = serial.serial_for_url(
                self.port, baudrate=self.baudrate, timeout=READ_SLICE,
                write_timeout=WRITE_TIMEOUT, **options)
        except ValueError as problem:   # of a URL that makes no sense
            raise LineError('no_such_port', str(problem)) from None
        except TROUBLE as problem:
            raise LineError(opening_kind(problem), str(problem)) from None
        self.openings += 1

    def close(self):
        port, self.serial = self.serial, None
        if port is not None:
            try:
                port.close()
            except TROUBLE:
                pass                    # it is gone anyway

    def lost(self, problem):
        self.close()
        return LineError('line_lost', str(problem))

    # Bytes

    def write(self, data):
        try:
            self.serial.write(data)
        except serial.SerialTimeoutException:
            self.in_step = False
            raise LineError('timeout', 'the brick takes no more '
                            'bytes') from None
        except TROUBLE as problem:
            raise self.lost(problem) from None

    def read(self, size, deadline):
        """So many bytes, or fewer at the deadline."""
        data = b''
        while len(data) < size:
            if self.cancelled:
                raise LineError('cancelled', 'it is not waited for')
            try:
                data += self.serial.read(size - len(data))
            except TROUBLE as problem:
                raise self.lost(problem) from None
            if time.monotonic() >= deadline:
                break
        return data

    def drop_input(self):
        try:
            self.serial.reset_input_buffer()
        except TROUBLE as problem:
            raise self.lost(problem) from None

    # Telegrams

    def receive(self, deadline):
        """The next reply, whosever it is."""
        head = self.read(2, deadline)
        if not head:
            raise LineError('timeout', 'the brick is silent')
        size = head[0] + 256 * head[-1] if len(head) == 2 else 2
        if not 3 <= size <= LONGEST_REPLY and len(head) == 2:
            raise LineError('garbage', 'a reply of %d bytes' % size)
        body = self.read(size, deadline) if len(head) == 2 else b''
        if len(body) < size:
            raise LineError('timeout', 'the brick fell silent after '
                            '%d bytes of a reply' % len(head + body))
        if body[0] != telegram.REPLY:
            raise LineError('garbage', 'no reply: ' + body[:8].hex())
        return body

    def reply_to(self, opcode, deadline):
        while True:
            reply = self.receive(deadline)
            if reply[1] == opcode:
                return reply
            if time.monotonic() >= deadline:
                raise LineError('timeout', 'only replies to other commands')

    def resynchronise(self, deadline):
        """Find the place where the next reply will begin.

        Late replies are still to come, and the brick answers in order.  So
        it is asked for what nothing else here asks for, and all before
        that reply is thrown away, searched byte by byte, since the line
        may be in the middle of a frame.
        """
        self.drop_input()
        request = telegram.encode_request('KEEPALIVE', {}, True)
        self.write(telegram.frame(request))
        length = len(telegram.encode_reply('KEEPALIVE', 0))
        mark = bytes([length, 0, telegram.REPLY, request[1], 0])
        seen = b''
        while not seen.endswith(mark):
            byte = self.read(1, deadline)
            if not byte or time.monotonic() >= deadline:
                raise LineError('timeout', 'the brick is silent')
            seen = (seen + byte)[-len(mark):]
        if len(self.read(length - 3, deadline)) < length - 3:
            raise LineError('timeout', 'the brick fell silent')
        self.in_step = True

    def exchange(self, request, deadline):
        """Send a telegram; its reply, or None if it asks for none."""
        self.open()
        if not self.in_step:
            self.resynchronise(deadline)
        self.write(telegram.frame(request))
        if request[0] & telegram.NO_REPLY:
            return None
        try:
            return self.reply_to(request[1], deadline)
        except LineError:
            self.in_step = False
            raise


def opening_kind(problem):
    """The kind of error of an attempt to open a port."""
    numbers = set()
    while problem is not None:          # pyserial wraps what it catches
        numbers.add(getattr(problem, 'errno', None))
        if type(problem).__name__ == 'gaierror':
            return 'no_such_port'
        problem = problem.__cause__ or problem.__context__
    if numbers.intersection(NO_SUCH):
        return 'no_such_port'
    if numbers.intersection(FORBIDDEN):
        return 'permission'
    if numbers.intersection(BUSY):
        return 'busy_port'
    return 'open_failed'
