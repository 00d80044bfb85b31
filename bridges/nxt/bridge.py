#!/usr/bin/env python3
"""The bridge between Prolog and one NXT.

    python3 bridge.py PORT [--baudrate N]

PORT is a device, or any URL of pyserial, as socket://host:port.  Requests
come on the standard input, replies go to the standard output: one JSON
object per line, UTF-8, no line longer than 65536 bytes.

    {"id": 7, "do": "telegram", "command": "GETBATTERYLEVEL", "timeout": 3}
    {"id": 7, "ok": {"millivolts": 7423}}
    {"id": 8, "error": "timeout", "message": "the brick is silent"}

`do` is one of

    open                            open the port, ask for the firmware
    telegram command args reply     see telegram.py; reply may be missing
    sensor   port type mode         set up if it is not, read when valid
    i2c      port data rx           a transaction
    display  column row text        write on the display
    clear                           the display
    close                           the port; the next request opens it
    quit                            close, and end

Data are strings of hexadecimal digits.  Requests are served one after the
other; the timeout, in seconds, counts from when the line was read.  When
the standard input ends without `quit`, no program drives the robot any more:
the motors are let go, and the process ends.
"""

import argparse
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                '..', 'lib'))
from helper import BadRequest, Helper, Refusal, Unfit, \
    integer, text                                              # noqa: E402

try:
    import serial
    from brick_calls import BrickCalls
    from line import Line, LineError
except ImportError as problem:
    serial, MISSING = None, problem
import display                                                 # noqa: E402
import telegram                                                # noqa: E402

LONGEST_LINE = 65536                    # bytes
FAREWELL = 2.0                          # seconds, to let the motors go


def hexadecimal(value, field):
    try:
        return bytes.fromhex(value)
    except (TypeError, ValueError):
        raise BadRequest('%s: not hexadecimal digits' % field) from None


def arguments(name, values):
    """The values of a command, its data as bytes."""
    if not isinstance(values, dict):
        raise BadRequest('args: not an object')
    data = {field for field, kind in telegram.command_of(name).request
            if kind[0] in 'xm*'}
    return {field: hexadecimal(value, field) if field in data else value
            for field, value in values.items()}


class Bridge(Helper):
    """Serves requests with one brick, which keeps to their deadlines."""

    def __init__(self, line):
        super().__init__(watched=False, longest_line=LONGEST_LINE)
        self.line, self.calls = line, BrickCalls(line)

    def drop(self):
        self.line.cancel()

    def do(self, request, deadline):
        try:
            return super().do(request, deadline)
        except LineError as problem:
            raise Refusal(problem.kind, str(problem),
                          **problem.more) from None
        except telegram.BadTelegram as problem:
            raise BadRequest(str(problem)) from None

    def do_telegram(self, request, deadline):
        name = request.get('command')
        values = arguments(name, request.get('args', {}))
        return self.calls.telegram(name, values, request.get('reply'),
                                   deadline)

    def do_sensor(self, request, deadline):
        return self.calls.sensor(integer(request, 'port', 0, 3),
                                 integer(request, 'type', 0, 0x12),
                                 integer(request, 'mode', 0, 0xFF),
                                 deadline)

    def do_i2c(self, request, deadline):
        data = hexadecimal(request.get('data'), 'data')
        if not 1 <= len(data) <= 16:
            raise BadRequest('data: not 1 to 16 bytes')
        rx = integer(request, 'rx', 0, 15)
        port = integer(request, 'port', 0, 3)
        return {'data': self.calls.i2c(port, data, rx, deadline)}

    def do_display(self, request, deadline):
        words = text(request, 'text')
        return self.calls.show(
            display.write(integer(request, 'column', 0, 15),
                          integer(request, 'row', 0, 7), words), deadline)

    def do_clear(self, _request, deadline):
        return self.calls.show(display.clear(), deadline)

    def do_open(self, _request, deadline):
        return self.calls.open(deadline)

    def do_close(self, _request, _deadline):
        self.line.close()
        return {}

    do_quit = do_close

    def abandoned(self):
        """Let all motors go, if the line is open."""
        self.line.cancelled = False
        if self.line.serial is not None:
            try:
                self.calls.command('SETOUTPUTSTATE', {'port': 0xFF},
                                   time.monotonic() + FAREWELL, False)
            except LineError:
                pass
        self.line.close()


def main():
    parser = argparse.ArgumentParser(description='Bridge to an NXT.')
    parser.add_argument('port', help='device, or URL of pyserial')
    parser.add_argument('--baudrate', type=int, default=115200)
    options = parser.parse_args()
    if serial is None:
        Unfit('no_pyserial', MISSING).run()
    Bridge(Line(options.port, options.baudrate)).run()


if __name__ == '__main__':
    main()
